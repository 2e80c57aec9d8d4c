"""The compliant setup's three parameters against T1 to T4."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Self

from pydantic import model_validator

from fiberweb.sections import NotNegative, Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, Table, crosshatch, every


class CalibrationSection(Section):
    """The compliant setup's three parameters against T1 to T4."""

    n: Some[Size] = key([4, 8], "sizes of the crosshatch, N; 8 among them, for T1 to T4")
    length: Positive = key(0.5, "fibre length", "m")
    crossing_stiffness: Some[Positive] = key([40.0, 70.0, 100.0], "springs", "N/m")
    crossing_damping: Some[NotNegative] = key([2.0, 3.0, 5.0], "dampers", "N s/m")
    damping: Some[NotNegative] = key([2.5, 5.0, 10.0, 20.0], "rates of velocity damping", "1/s")

    @model_validator(mode="after")
    def _has_8(self) -> Self:
        if 8 not in self.n:
            raise ValueError(
                f"calibration.n = {self.n}: T1 to T4 are about the 8x8 crosshatch, so list 8 too"
            )
        return self


SECTION = CalibrationSection
SETUPS = ("compliant",)


def points(section: CalibrationSection, lab: Lab) -> Iterator[Point]:
    """The grid of unreported parameters."""
    grid = product(section.crossing_stiffness, section.crossing_damping, section.damping)
    for (stiffness, damper, rate), n in product(grid, section.n):
        network = crosshatch(n, length=section.length)
        scene = lab.scene(
            network, crossing_stiffness=stiffness, crossing_damping=damper, damping=rate
        )
        yield Point(scene, "eq3")


TABLES = {
    "calibration.csv": Table("fiberweb.studies.calibration.tables:table", capacities=every),
    "calibration_check.csv": Table(
        "fiberweb.studies.calibration.tables:check", tables=("calibration.csv",)
    ),
}
FIGURES = {
    "calibration": Figure(
        "fiberweb.studies.calibration.figure:draw", (*TABLES, "ridge_baselines.csv")
    )
}
