"""What accuracy costs and where the steps end: no runs of the paper's, and rules of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Annotated

from pydantic import Field

from fiberweb.model.scene import Scene
from fiberweb.sections import NotNegative, Positive, Section, Size, Some, key
from fiberweb.simulation.plan import request
from fiberweb.studies.base import Figure, Lab, Table, crosshatch


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
    window: Annotated[int, Field(ge=10, le=1_000_000)] = key(
        2000, "steps in which PyElastica is timed"
    )
    plane: Some[Positive] = key(
        [0.3, 0.5, 0.8, 1.5], "buckling numbers of the runs that may leave the plane"
    )
    plane_seconds: Positive = key(0.3, "length of these runs", "s")
    steps: Annotated[int, Field(ge=100, le=1_000_000)] = key(
        4000, "steps of a run that looks for a limit"
    )
    drift_steps: Annotated[int, Field(ge=1_000_000, le=10**10)] = key(
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


@dataclass(frozen=True)
class Measured(Table):
    """A table of no setup.

    Attributes:
        workers: whether `make` is told how many threads its job has, which then runs alone, since
            it times something: a machine that is busy with other things still spoils that.
    """

    workers: bool = False


def _runs(section: AccuracySection, _: Sequence) -> dict:
    names = ("length", "buckling", "seconds", "duration", "window")
    return {name: getattr(section, name) for name in names}


def _networks(section: AccuracySection, _: Sequence) -> dict:
    return {"networks": section.networks} | _runs(section, _)


def _plane(section: AccuracySection, _: Sequence) -> dict:
    return {"buckling": section.plane, "seconds": section.plane_seconds}


def _limits(section: AccuracySection, _: Sequence) -> dict:
    return {"box": section.stability.model_dump(), "steps": section.steps}


def _drift(section: AccuracySection, _: Sequence) -> dict:
    return {"steps": section.drift_steps}


TABLES = {}
# not every platform has a wheel of it; then the other tables are made without
EXUDYN = ("exudyn.csv",) if find_spec("exudyn") else ()
_FROM = "fiberweb.validation"
# tables of no setup, by the job that makes them
JOBS = {
    "exudyn": {"exudyn.csv": Measured(f"{_FROM}.exudyn_check:table")},
    "speed_accuracy": {
        "speed_accuracy.csv": Measured(
            f"{_FROM}.accuracy:speed_accuracy", tables=EXUDYN, options=_networks, workers=True
        ),
    },
    "model_ladder": {
        "model_ladder.csv": Measured(f"{_FROM}.accuracy:ladder", options=_runs, workers=True),
        "out_of_plane.csv": Measured(f"{_FROM}.limits:out_of_plane", options=_plane),
    },
    "stability": {
        "stability.csv": Measured(f"{_FROM}.limits:stability", options=_limits),
        "energy_drift.csv": Measured(f"{_FROM}.limits:drift", options=_drift),
    },
}
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
