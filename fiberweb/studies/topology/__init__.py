"""The topology study, Fig. 1: crosshatches and polygons of one outer length and rising N."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from fiberweb.model.authors import SKIPPED_FRAMES
from fiberweb.sections import NETWORK, TOPOLOGY, Positive, Section, key
from fiberweb.studies.base import (
    Figure,
    Lab,
    Point,
    Table,
    crosshatch,
    every,
    input_baselines,
    one_row_per_run,
    polygon,
    scoring_of,
)

EXAMPLE = 8  # N of the crosshatch whose computations Fig. 1d shows


class DiagonalsSection(Section):
    """Which diagonals of a polygon are fibres, in each setup."""

    described: Literal["all", "skip-one"] = key("all", "as the text says", "", NETWORK)
    published: Literal["all", "skip-one"] = key(
        "skip-one", "as the authors' code does: diameters, and vertices two apart"
    )
    compliant: Literal["all", "skip-one"] = key("all", "as the text says", "", NETWORK)


class TopologySection(Section):
    """The topology study, Fig. 1."""

    length: Positive = key(
        0.5,
        "fibre length of a crosshatch, diameter of a polygon's circumscribed circle",
        "m",
        TOPOLOGY,
    )
    crosshatch: list[Annotated[int, Field(ge=2)]] = key(
        [2, 4, 6, 8, 10, 12], "numbers of fibres in each direction, N", "", TOPOLOGY
    )
    polygon: list[Annotated[int, Field(ge=6, multiple_of=2)]] = key(
        [6, 8, 10, 12], "numbers of vertices, N", "", TOPOLOGY
    )
    diagonals: DiagonalsSection = DiagonalsSection()

    @model_validator(mode="after")
    def _not_empty(self) -> Self:
        if not (self.crosshatch or self.polygon):
            raise ValueError(
                "topology.crosshatch = [] and topology.polygon = []: list at least one network"
            )
        return self


SECTION = TopologySection


def points(section: TopologySection, lab: Lab) -> Iterator[Point]:
    """The runs of the study."""
    for n in section.crosshatch:
        yield Point(lab.scene(crosshatch(n, length=section.length)), "eq3")
    for n in section.polygon:
        diagonals = getattr(section.diagonals, lab.setup)
        yield Point(lab.scene(polygon(n, section.length, diagonals)), "eq3")


def check(section: TopologySection, lab: Lab) -> None:
    """Raise ValueError if published polygons are too short to be scored."""
    if section.polygon:
        lab.check_duration(
            "scene.duration", lab.defaults["duration"],
            SKIPPED_FRAMES / lab.defaults["sample_rate"],
            f" and the {SKIPPED_FRAMES} frames that published polygons drop",
        )  # fmt: skip


def example(runs: Sequence, section: TopologySection) -> Sequence:
    """The run whose computations Fig. 1d shows: the 8x8 crosshatch, or the nearest to it."""
    crosshatches = [run for run in runs if run.scene.network.topology == "crosshatch"]
    return [min(crosshatches or runs, key=lambda run: abs(run.scene.network.n - EXAMPLE))]


TABLES = {
    "topology.csv": one_row_per_run(certificates=True),
    "topology_curves.csv": Table("fiberweb.scoring.tables:curves", capacities=every),
    "topology_baselines.csv": input_baselines(of=example),
    "topology_traces.nc": Table(
        "fiberweb.studies.topology.traces:example_traces",
        responses=example,
        single=True,
        options=scoring_of,
    ),
}
FIGURES = {"topology": Figure("fiberweb.studies.topology.figure:draw", tuple(TABLES))}
JUDGED_BY = ("topology.csv", "topology_curves.csv")
