"""What accuracy costs and where the steps end: no runs of the paper's, and rules of its own."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from fiberweb.model.scene import Scene
from fiberweb.sections import NotNegative, Positive, Section, Size, Some, key
from fiberweb.simulation.plan import request
from fiberweb.studies.base import Figure, Lab, crosshatch


class StabilitySection(Section):
    """The box in which predicted limits of the step are held against found ones; from the middle,
    one key at a time."""

    spacing: Some[Positive] = key([0.005, 0.01, 0.02, 0.05, 0.2, 0.5], "spacings", "m")
    diameter: Some[Positive] = key([0.0002, 0.0005, 0.001, 0.004], "diameters", "m")
    tension: Some[NotNegative] = key([0.0, 0.1, 1.0, 5.0, 50.0], "tensions", "N")
    stiffness: Some[Positive] = key(
        [1.0, 10.0, 1e3, 1e4, 1e5, 1e6], "springs of the crossings", "N/m"
    )
    buckling: Some[Positive] = key([0.001, 2.0, 10.0, 100.0], "buckling numbers of the force")
    elements: Some[Annotated[int, Field(ge=1)]] = key([2, 3, 6, 8, 16], "elements per section")


class AccuracySection(Section):
    """What accuracy costs; the target `accuracy`, which no figure of the paper needs."""

    networks: Some[Size] = key([4, 8], "crosshatches, N; 4 is the ladder's")
    length: Positive = key(0.5, "fibre length", "m")
    buckling: Positive = key(0.8, "buckling number of the force")
    seconds: Positive = key(1.0, "length of the runs whose trajectories are compared", "s")
    duration: Positive = key(50.0, "length of the runs that are scored", "s")
    window: Annotated[int, Field(ge=10)] = key(2000, "steps in which PyElastica is timed")
    plane: Some[Positive] = key(
        [0.3, 0.5, 0.8, 1.5], "buckling numbers of the runs that may leave the plane"
    )
    plane_seconds: Positive = key(0.3, "length of these runs", "s")
    steps: Annotated[int, Field(ge=100)] = key(4000, "steps of a run that looks for a limit")
    drift_steps: Annotated[int, Field(ge=1_000_000)] = key(
        10_000_000, "steps of the undamped runs that have to keep their energy"
    )
    stability: StabilitySection = StabilitySection()


SECTION = AccuracySection
SETUPS = ()


def check(section: AccuracySection, lab: Lab) -> None:
    """Raise ValueError if the networks cannot be run, or their runs not be scored."""
    lab.check_duration("accuracy.duration", section.duration)
    for n in section.networks:
        try:
            request(Scene(crosshatch(n, length=section.length)))
        except ValueError as error:
            raise ValueError(f"accuracy.length = {section.length:g} m, N = {n}: {error}") from None


TABLES = {}
FIGURES = {
    name: Figure(
        f"fiberweb.studies.accuracy.figure:draw_{name}", given,
        caption=f"{name}.rst", category="Accuracy",
    )
    for name, given in {
        "speed_accuracy": ("speed_accuracy.csv",),
        "model_ladder": ("model_ladder.csv", "out_of_plane.csv"),
        "stability": ("stability.csv", "energy_drift.csv"),
    }.items()
}  # fmt: skip
