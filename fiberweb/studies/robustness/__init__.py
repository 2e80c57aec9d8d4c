"""Other seeds of the input, and other ridge penalties."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product

from fiberweb.model.authors import SEED
from fiberweb.model.scene import Seed
from fiberweb.sections import Positive, Section, Size, Some, key
from fiberweb.studies.base import (
    Figure,
    Lab,
    Point,
    Table,
    crosshatch,
    input_baselines,
    one_row_per_run,
)


class RobustnessSection(Section):
    """Seeds of the input and ridge penalties."""

    n: Some[Size] = key([4, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    seed: Some[Seed] = key([SEED, 1, 2, 3, 4], "seeds of the input")
    alpha: Some[Positive] = key([1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0], "ridge penalties")


SECTION = RobustnessSection
SETUPS = ("described",)


def points(section: RobustnessSection, lab: Lab) -> Iterator[Point]:
    """Other inputs of the same kind."""
    for n, seed in product(section.n, section.seed):
        yield Point(lab.scene(crosshatch(n, length=section.length), seed=seed), "eq3")


def first_seed(runs: Sequence, section: RobustnessSection) -> Sequence:
    """The runs of the first seed, one of each size."""
    return [run for run in runs if run.scene.seed == section.seed[0]]


TABLES = {
    "robustness.csv": one_row_per_run(),
    "robustness_alpha.csv": Table(
        "fiberweb.studies.robustness.tables:alphas", responses=first_seed, choices=True,
        options=lambda section, _: {"alpha": section.alpha},
    ),
    "robustness_baselines.csv": input_baselines(),
}  # fmt: skip
FIGURES = {"robustness": Figure("fiberweb.studies.robustness.figure:draw", tuple(TABLES))}
