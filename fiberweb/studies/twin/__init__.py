"""The paper's experiment as a digital twin, Fig. 5: capacities over the motor angle."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal, Self

from pydantic import model_validator

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

OF_ANGLE = "angle"  # the choice of the runs of Fig. 5


class SensitivitySection(Section):
    """Values of what the paper does not report, one changed at a time."""

    angle: Some[Angle] = key([25.0, 50.0], "motor angles, among twin.angle", "degrees")
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


PARAMETERS = tuple(name for name in SensitivitySection.model_fields if name != "angle")


class TwinSection(Section):
    """The experiment's digital twin, Fig. 5."""

    n: Some[Size] = key([4, 6], "sizes of the crosshatch, N", "", VALIDATION)
    angle: Some[Angle] = key(
        [25.0, 30.0, 35.0, 40.0, 45.0, 50.0], "motor angles of u = 1", "degrees", VALIDATION
    )
    sensitivity: SensitivitySection = SensitivitySection()

    @model_validator(mode="after")
    def _angles_are_run(self) -> Self:
        missing = [angle for angle in self.sensitivity.angle if angle not in self.angle]
        if missing:
            raise ValueError(
                f"twin.sensitivity.angle = {self.sensitivity.angle} has {missing[0]:g} degrees, "
                f"which is not among twin.angle = {self.angle}; give some of these"
            )
        return self


SECTION = TwinSection
SETUPS = ("described", "published")  # one scene, which the authors' way and a clean one score


def points(section: TwinSection, lab: Lab) -> Iterator[Point]:
    """Every network at every angle; then, at some, with each parameter changed by itself."""
    for n in section.n:
        for angle in section.angle:
            yield lab.twin(n, angle, OF_ANGLE)
    for name in PARAMETERS:
        for value in getattr(section.sensitivity, name):
            for n in section.n:
                for angle in section.sensitivity.angle:
                    yield lab.twin(n, angle, f"{name}={value:g}", **{name: value})


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
    """The runs with a parameter changed, and those of the same angles with none."""
    angles = section.sensitivity.angle
    same = [r for r in of_angles(runs, section) if round(r.scene.motor_angle, 6) in angles]
    return same + [run for run in runs if run.choice != OF_ANGLE]


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
