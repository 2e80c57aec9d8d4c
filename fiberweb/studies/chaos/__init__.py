"""Divergence of pairs of runs that differ by a hair at the start, about buckling."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from fiberweb.sections import Positive, Section, Size, Some, key
from fiberweb.studies.base import (
    Figure,
    Lab,
    Point,
    Table,
    crosshatch,
    every,
    input_baselines,
    one_row_per_run,
)


class ChaosSection(Section):
    """Divergence of perturbed pairs of runs about buckling."""

    n: Size = key(4, "size of the crosshatch, N")
    spacing: Positive = key(0.1, "spacing", "m")
    buckling: Some[Positive] = key(
        [0.2, 0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0],
        "buckling numbers of the force",
    )
    disturbance: Positive = key(
        1e-9, "by how much the driven points of a perturbed pair differ at the start", "m"
    )


SECTION = ChaosSection
SETUPS = ("described",)


def points(section: ChaosSection, lab: Lab) -> Iterator[Point]:
    """Pairs over forces about buckling: the second starts disturbed twice as far as the first.

    Both are disturbed because responses of disturbed scenes alone keep every digit.
    """
    network = crosshatch(section.n, spacing=section.spacing)
    for number in section.buckling:
        force = number * lab.critical_force(section.spacing)
        scene = lab.scene(network, force=force)
        for times in (1, 2):
            yield Point(replace(scene, disturbance=times * section.disturbance), "buckling")


TABLES = {
    "chaos.csv": one_row_per_run(),
    "chaos_rates.csv": Table(
        "fiberweb.studies.chaos.tables:rates", responses=every, tables=("chaos.csv",)
    ),
    "chaos_separations.csv": Table("fiberweb.studies.chaos.tables:separations", responses=every),
    "chaos_baselines.csv": input_baselines(),
}
FIGURES = {
    "chaos": Figure(
        "fiberweb.studies.chaos.figure:draw",
        ("chaos_rates.csv", "chaos_separations.csv", "chaos_baselines.csv"),
    )
}
