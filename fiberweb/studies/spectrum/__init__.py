"""Total information-processing capacity by degree and delay, over size and over force, beside what
bounds it (Dambre et al. 2012, Sci. Rep. 2, 514)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated

from pydantic import Field

from fiberweb.sections import Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, Table, crosshatch, every, first


class SpectrumSection(Section):
    """Total information-processing capacity by degree and delay."""

    n: Some[Size] = key([2, 4, 6, 8, 10, 12], "sizes of the crosshatch, N, at the force of Eq. 3")
    length: Positive = key(0.5, "fibre length", "m")
    force_n: Size = key(4, "size of the crosshatch whose force is varied")
    force: Some[Positive] = key(
        [0.0148148, 0.0289352, 0.0685871, 0.0976562, 0.145773, 0.231481, 0.4, 0.78125, 1.25, 3.75],
        "its forces; by default those that ridge and capacity_origin run too, in every setup",
        "N",
    )
    degree: Annotated[int, Field(ge=1, le=12)] = key(
        10, "highest degree, if the run is long enough; degree d goes back degree / d - 1 knots"
    )


SECTION = SpectrumSection


def points(section: SpectrumSection, lab: Lab) -> Iterator[Point]:
    """Every size at the force of Eq. 3, then one size at every force."""
    for n in section.n:
        yield Point(lab.scene(crosshatch(n, length=section.length)), "eq3")
    network = crosshatch(section.force_n, length=section.length)
    for force in section.force:
        yield Point(lab.scene(network, force=force), "grid")


def _options(section: SpectrumSection, runs: Sequence) -> dict:
    return {"alpha": runs[0].scoring["alpha"], "degree": section.degree}


TABLES = {
    "spectrum.csv": Table(
        "fiberweb.studies.spectrum.tables:table",
        capacities=every, responses=every, choices=True, options=_options,
    ),
    "spectrum_baselines.csv": Table(
        "fiberweb.studies.spectrum.tables:baselines",
        responses=first, single=True, options=_options,
    ),
}  # fmt: skip
FIGURES = {"spectrum": Figure("fiberweb.studies.spectrum.figure:draw", tuple(TABLES))}
