"""Readout noise: what a camera or a sensor would leave of the capacities."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from fiberweb.sections import Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, Table, crosshatch, every, input_baselines


class NoiseSection(Section):
    """Readout noise: what a camera or a sensor would leave."""

    n: Some[Size] = key([4, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    noise: Some[Positive] = key(
        [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3], "standard deviations of the noise", "m"
    )
    seeds: Annotated[int, Field(ge=1, le=1000)] = key(3, "draws of the noise at each level")


SECTION = NoiseSection
SETUPS = ("described",)


def points(section: NoiseSection, lab: Lab) -> Iterator[Point]:
    """The networks whose readouts get noise."""
    for n in section.n:
        yield Point(lab.scene(crosshatch(n, length=section.length)), "eq3")


TABLES = {
    "noise.csv": Table(
        "fiberweb.studies.noise.tables:table", responses=every, choices=True,
        options=lambda section, runs: {
            "noise": section.noise, "seeds": section.seeds, "alpha": runs[0].scoring["alpha"]
        },
    ),
    "noise_baselines.csv": input_baselines(),
}  # fmt: skip
FIGURES = {"noise": Figure("fiberweb.studies.noise.figure:draw", tuple(TABLES))}
