"""Networks just below and just above B = 1: snapshots and animations."""

from __future__ import annotations

from collections.abc import Iterator

from fiberweb.sections import Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, crosshatch, one_row_per_run


class BucklingSection(Section):
    """Snapshots and animations about B = 1."""

    n: Size = key(4, "size of the crosshatch, N")
    spacing: Positive = key(0.1, "spacing", "m")
    buckling: Some[Positive] = key([0.9, 1.2], "buckling numbers: just below and just above")
    frame_rate: Positive = key(25.0, "rate of the animation", "Hz")
    seconds: Positive = key(8.0, "length of the animation", "s")


SECTION = BucklingSection
SETUPS = ("described",)


def points(section: BucklingSection, lab: Lab) -> Iterator[Point]:
    """Just below and just above B = 1, with the centre lines kept."""
    network = crosshatch(section.n, spacing=section.spacing)
    for number in section.buckling:
        force = number * lab.critical_force(section.spacing)
        yield Point(lab.scene(network, force=force, centre_lines=True), "buckling")


def check(section: BucklingSection, lab: Lab) -> None:
    """Raise ValueError if two animations would have one name."""
    names = [f"{number:g}" for number in section.buckling]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"buckling.buckling holds {name} twice: keep one of them")


TABLES = {"buckling.csv": one_row_per_run()}
# the animations have a rule of their own
FIGURES = {
    "buckling": Figure(
        "fiberweb.studies.buckling.figure:draw", responses=True,
        options=lambda section: {"seconds": section.seconds},
    )
}  # fmt: skip
