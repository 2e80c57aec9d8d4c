"""The NARMA task of Fig. 6, on simulated networks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from fiberweb.sections import Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, Table, crosshatch, every


class NarmaSection(Section):
    """The NARMA task, Fig. 6, on simulated networks."""

    n: Some[Size] = key([6, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    order: Some[Literal[2, 5, 10]] = key([2, 5, 10], "orders of the recursion")
    rate: Positive = key(10.0, "rate of the task", "Hz")
    alpha: Positive = key(1.0, "ridge penalty")


SECTION = NarmaSection
SETUPS = ("described",)


def points(section: NarmaSection, lab: Lab) -> Iterator[Point]:
    """The networks that are given the task."""
    for n in section.n:
        yield Point(lab.scene(crosshatch(n, length=section.length)), "eq3")


TABLES = {
    "narma.csv": Table(
        "fiberweb.studies.narma.task:table", capacities=every, choices=True,
        tables=("narma_errors.nc",),
    ),
    "narma_errors.nc": Table(
        "fiberweb.studies.narma.task:of_runs", responses=every,
        options=lambda section, _: {
            "orders": section.order, "rate": section.rate, "alpha": section.alpha
        },
    ),
}  # fmt: skip
FIGURES = {"narma": Figure("fiberweb.studies.narma.figure:draw", tuple(TABLES))}
