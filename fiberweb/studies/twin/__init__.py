"""The paper's experiment as a digital twin, Fig. 5: capacities over the motor angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

from fiberweb.scoring.limits import check_frames
from fiberweb.sections import (
    VALIDATION,
    Angle,
    NotNegative,
    NotNegativeOrRigid,
    Positive,
    Section,
    Size,
    Some,
    key,
)
from fiberweb.studies.base import Figure, Lab, Point, Table

OF_ANGLE, SAME = "angle", "same"  # choices: runs of Fig. 5, and of the panel with nothing changed


class SensitivitySection(Section):
    """Values of what the paper does not report, one changed at a time."""

    angle: Some[Angle] = key([25.0, 50.0], "motor angles", "degrees")
    element: Positive = key(
        0.06, "longest element of these runs, which are compared with one another alone", "m"
    )
    tension: list[NotNegative] = key([0.2, 3.0], "pretensions", "N")
    lever: list[Positive] = key([0.035], "arms: half, where the thread has slack", "m")
    direction: list[Literal[-1, 1]] = key([1], "directions of the pull")
    damping: list[NotNegative] = key([1.0, 25.0], "rates at which velocity decays", "1/s")
    loss_factor: list[NotNegative] = key([0.0, 0.1], "tan(delta) of the material at 10 Hz")
    bond_stiffness: list[NotNegativeOrRigid] = key(
        [0.0], "of crossings against turning: none", "N m"
    )
    youngs_modulus: list[Positive] = key([2.0e9], "of nylon", "Pa")
    marker_noise: list[NotNegative] = key([0.0, 0.03, 0.3, 1.0], "noise of the camera", "px")


PARAMETERS = tuple(
    name for name in SensitivitySection.model_fields if name not in ("angle", "element")
)


class TwinSection(Section):
    """The experiment's digital twin, Fig. 5."""

    n: Some[Size] = key([4, 6], "sizes of the crosshatch, N", "", VALIDATION)
    angle: Some[Angle] = key(
        [25.0, 30.0, 35.0, 40.0, 45.0, 50.0], "motor angles of u = 1", "degrees", VALIDATION
    )
    sensitivity: SensitivitySection = SensitivitySection()


SECTION = TwinSection
SETUPS = ("described", "published")  # one scene, which the authors' way and a clean one score


def points(section: TwinSection, lab: Lab) -> Iterator[Point]:
    """Every network at every angle; then, at some, with each parameter changed by itself."""
    for n in section.n:
        for angle in section.angle:
            yield lab.twin(n, angle, OF_ANGLE)
    few = section.sensitivity
    changed = [(name, value) for name in PARAMETERS for value in getattr(few, name)]
    changes = {SAME: {}} | {f"{name}={value:g}": {name: value} for name, value in changed}
    for choice, change in changes.items():
        for n in section.n:
            for angle in few.angle:
                yield lab.twin(n, angle, choice, element=few.element, **change)


def check(section: TwinSection, lab: Lab) -> None:
    """Raise ValueError if what the camera leaves of the recording is too short to be scored."""
    given = lab.experiment
    for step in given.frame_step:
        frames = -(-round(given.duration * given.sample_rate) // step)
        try:
            check_frames(frames, given.sample_rate, skip=given.skip)
        except ValueError as error:
            raise ValueError(
                f"experiment.duration = {given.duration:g} s with experiment.frame_step = {step} "
                f"and experiment.skip = {given.skip}: {error}"
            ) from None


def of_angles(runs: Sequence, section: TwinSection) -> Sequence:
    """The runs of Fig. 5."""
    return [run for run in runs if run.choice == OF_ANGLE]


def of_sensitivity(runs: Sequence, section: TwinSection) -> Sequence:
    """The runs of the panel."""
    return [run for run in runs if run.choice != OF_ANGLE]


def filmed(section: TwinSection, runs: Sequence) -> dict:
    """Options: how each run is filmed, and how all are scored."""
    return {"cameras": [run.camera for run in runs], "scoring": dict(runs[0].scoring)}


TABLES = {
    "twin.csv": Table(
        "fiberweb.studies.twin.tables:by_readouts", responses=of_angles, options=filmed
    ),
    "twin_curves.csv": Table(
        "fiberweb.studies.twin.tables:curves", responses=of_angles, options=filmed
    ),
    "twin_sensitivity.csv": Table(
        "fiberweb.studies.twin.tables:sensitivity", responses=of_sensitivity, choices=True,
        options=filmed,
    ),
    "twin_observations.csv": Table(
        "fiberweb.studies.twin.observations:table", tables=("twin_sensitivity.csv",)
    ),
}  # fmt: skip
FIGURES = {
    "twin": Figure("fiberweb.studies.twin.figure:draw", ("twin.csv", "twin_curves.csv")),
    "twin_sensitivity": Figure(
        "fiberweb.studies.twin.sensitivity:draw",
        ("twin_sensitivity.csv", "twin_observations.csv"), caption="sensitivity.rst",
    ),
}  # fmt: skip
JUDGED_BY = ("twin.csv",)
