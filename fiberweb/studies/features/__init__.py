"""Which readouts matter, Fig. 4: groups of readouts, and the fewest that keep a capacity."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Self

from pydantic import Field, model_validator

from fiberweb.model.authors import FEATURES_FORCE
from fiberweb.sections import FEATURES, Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, Table, crosshatch, every, first


class FeaturesSection(Section):
    """Which readouts matter, Fig. 4."""

    n: Size = key(6, "size of the crosshatch, N", "", FEATURES)
    length: Positive = key(0.5, "fibre length", "m", FEATURES)
    force: Some[Positive] = key(
        [0.1372, FEATURES_FORCE, 0.85],
        "forces: by Eq. 3, of the authors' scripts, of the text",
        "N",
        FEATURES,
    )
    alpha: Positive = key(0.1, "ridge penalty", "", FEATURES)
    verdict_force: Positive = key(FEATURES_FORCE, "the force by which claims are judged", "N")
    share: Annotated[float, Field(gt=0, lt=1)] = key(
        0.95, "share of a capacity that greedily chosen signals have to keep"
    )

    @model_validator(mode="after")
    def _verdict_was_run(self) -> Self:
        if self.verdict_force not in self.force:
            raise ValueError(
                f"features.verdict_force = {self.verdict_force:g} is not among features.force = "
                f"{self.force}; give one of them"
            )
        return self


SECTION = FeaturesSection


def points(section: FeaturesSection, lab: Lab) -> Iterator[Point]:
    """The network whose readouts are grouped, at each force."""
    network = crosshatch(section.n, length=section.length)
    for force in section.force:
        yield Point(lab.scene(network, force=force), "grid")


def verdict(runs: Sequence, section: FeaturesSection) -> Sequence:
    """The run by which claims are judged."""
    return [run for run in runs if run.scene.force == section.verdict_force][:1]


TABLES = {
    "features.csv": Table(
        "fiberweb.studies.features.tables:group_table",
        capacities=every, responses=every, choices=True,
        options=lambda section, _: {"alpha": section.alpha, "verdict_force": section.verdict_force},
    ),
    "features_greedy.csv": Table(
        "fiberweb.studies.features.tables:greedy_table",
        responses=verdict, single=True,
        options=lambda section, _: {"alpha": section.alpha, "share": section.share},
    ),
    "features_baselines.csv": Table(
        "fiberweb.scoring.tables:input_baselines", responses=first, single=True,
        options=lambda section, _: {"alpha": section.alpha},
    ),
}  # fmt: skip
FIGURES = {"features": Figure("fiberweb.studies.features.figure:draw", tuple(TABLES))}
JUDGED_BY = ("features.csv",)
