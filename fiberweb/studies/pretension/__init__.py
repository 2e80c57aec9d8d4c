"""Pretension at the best force of each spacing, Fig. 3."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Self

from pydantic import model_validator

from fiberweb.model.authors import PRETENSION_FORCES
from fiberweb.sections import PRETENSION, NotNegative, Positive, Section, Some, key
from fiberweb.studies.base import CHOICES, Figure, Lab, Point, crosshatch, one_row_per_run


class PretensionSection(Section):
    """Pretension at the best force of each spacing, Fig. 3."""

    spacing: Some[Positive] = key(
        [0.05, 0.06, 0.07, 0.08, 0.09, 0.1], "spacings, among the ridge's", "m", PRETENSION
    )
    tension: Some[NotNegative] = key(
        [0.01, 0.1, 0.5, 1.0, 2.0, 5.0], "tensions, F_t", "N", PRETENSION
    )
    published_force: Some[Positive] = key(
        PRETENSION_FORCES, "the authors' force of each spacing", "N"
    )

    @model_validator(mode="after")
    def _a_force_each(self) -> Self:
        if len(self.published_force) != len(self.spacing):
            raise ValueError(
                f"pretension.published_force = {self.published_force}: give one force for each of "
                f"the {len(self.spacing)} values of pretension.spacing"
            )
        return self


SECTION = PretensionSection
AFTER_RIDGE = True


def points(section: PretensionSection, lab: Lab) -> Iterator[Point]:
    """Every tension at the best force of each spacing for C_m, or at the authors'."""
    if lab.setup != "published":
        best = CHOICES[1]
        chosen = [
            (best, spacing, force)
            for spacing in section.spacing
            for force in lab.map.best.get((best, spacing), ())
        ]
    else:
        chosen = [("authors", *pair) for pair in zip(section.spacing, section.published_force)]
    for (choice, spacing, force), tension in product(chosen, section.tension):
        network = crosshatch(lab.map.n, spacing=spacing)
        yield Point(lab.scene(network, force=force, tension=tension), choice)


def check(section: PretensionSection, lab: Lab) -> None:
    """Raise ValueError if a spacing is not the ridge's."""
    for spacing in section.spacing:
        if spacing not in lab.map.spacings:
            raise ValueError(
                f"pretension.spacing holds {spacing:g} m, but ridge.spacing does not: the "
                "forces of this study come from the ridge, so use spacings of both"
            )


TABLES = {"pretension.csv": one_row_per_run()}
FIGURES = {
    "pretension": Figure(
        "fiberweb.studies.pretension.figure:draw", ("pretension.csv", "ridge_baselines.csv")
    )
}
JUDGED_BY = ("pretension.csv",)
