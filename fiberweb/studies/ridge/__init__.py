"""The force-spacing ridge, Fig. 2a and b: every force at every spacing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated

from pydantic import Field

from fiberweb.model.authors import EQ3_SPACINGS, FORCES
from fiberweb.sections import SCALING, Positive, Section, Size, Some, key
from fiberweb.studies.base import (
    Figure,
    Lab,
    Point,
    Table,
    crosshatch,
    input_baselines,
    one_row_per_run,
)


class RidgeSection(Section):
    """The force-spacing ridge, Fig. 2a and b."""

    n: Size = key(4, "size of the crosshatch, N", "", SCALING)
    spacing: Some[Positive] = key(EQ3_SPACINGS, "spacings", "m", SCALING)
    force: Some[Positive] = key(FORCES, "forces, of every spacing", "N", SCALING)
    published_forces: Annotated[int, Field(ge=2, multiple_of=2)] = key(
        6, "how many forces about B = 1 the published setup runs of each spacing"
    )


SECTION = RidgeSection


def points(section: RidgeSection, lab: Lab) -> Iterator[Point]:
    """The runs of the study; thinned in the published setup unless all are asked for."""
    for spacing in section.spacing:
        network = crosshatch(section.n, spacing=spacing)
        forces = sorted(section.force)
        if lab.setup == "published" and lab.thinned:
            forces = about(forces, lab.critical_force(spacing), section.published_forces)
        for force in forces:
            yield Point(lab.scene(network, force=force), "grid")


def about(forces: list[float], critical: float, count: int) -> list[float]:
    """As many of the sorted forces as asked for, half of them on either side of the critical one;
    fewer where the list ends."""
    below = [force for force in forces if force < critical]
    above = [force for force in forces if force >= critical]
    return below[-(count // 2) :] + above[: count // 2]


# ridge_best.csv has a rule of its own, a checkpoint
TABLES = {
    "ridge.csv": one_row_per_run(),
    "ridge_onset.csv": Table("fiberweb.studies.ridge.onset:onsets", tables=("ridge.csv",)),
    "ridge_baselines.csv": input_baselines(),
}
FIGURES = {"ridge": Figure("fiberweb.studies.ridge.figure:draw", tuple(TABLES))}
JUDGED_BY = ("ridge.csv", "ridge_onset.csv")
