"""The NARMA task of Fig. 6, on the experiment's twin and on simulated networks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

from fiberweb.scoring.tasks import ORDERS
from fiberweb.sections import EXPERIMENTS, VALIDATION, Angle, Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, Table, crosshatch, every

LEAST_SAMPLES = 2 * max(ORDERS)


class NarmaSection(Section):
    """The NARMA task, Fig. 6, on the experiment's twin and on simulated networks."""

    twin_n: Size = key(6, "size of the twin's crosshatch, N", "", VALIDATION)
    twin_angle: Angle = key(50.0, "its motor angle", "degrees", VALIDATION)
    n: Some[Size] = key([6, 8], "sizes of the simulated crosshatches, N")
    length: Positive = key(0.5, "their fibre length", "m")
    order: Some[Literal[ORDERS]] = key([*ORDERS], "orders of the recursion", "", VALIDATION)
    rate: Positive = key(10.0, "rate of the task", "Hz", VALIDATION)
    alpha: Positive = key(1.0, "ridge penalty", "", EXPERIMENTS)


SECTION = NarmaSection
SETUPS = ("described", "published")  # the authors' way of scoring is for the twin alone


def points(section: NarmaSection, lab: Lab) -> Iterator[Point]:
    """The networks that are given the task, and the twin."""
    if lab.setup == "described":
        for n in section.n:
            yield Point(lab.scene(crosshatch(n, length=section.length)), "eq3")
    yield lab.twin(section.twin_n, section.twin_angle)


def check(section: NarmaSection, lab: Lab) -> None:
    """Raise ValueError if a recording cannot be sampled at the task's rate, or is too short."""
    scene, given = lab.defaults, lab.experiment
    rates = [(scene["duration"], scene["sample_rate"], 1)]
    rates += [(given.duration, given.sample_rate, step) for step in given.frame_step]
    for duration, rate, step in rates:
        frames = -(-round(duration * rate) // step)
        check_samples(-(-frames // frames_a_sample(rate, section.rate)))


def frames_a_sample(sample_rate: float, rate: float) -> int:
    """How many frames (at a rate in Hz) a sample of the task (Hz) is; ValueError if no number."""
    step = round(sample_rate / rate)
    if step < 1 or abs(step * rate - sample_rate) > 1e-9 * sample_rate:
        raise ValueError(
            f"narma.rate = {rate:g} Hz does not divide the recording's {sample_rate:g} Hz; choose "
            "one that does"
        )
    return step


def check_samples(samples: int) -> None:
    """Raise ValueError if these are too few to be trained and tested on."""
    if samples < LEAST_SAMPLES:
        raise ValueError(
            f"the recording has {samples} samples at the rate of the NARMA task; record at least "
            f"{LEAST_SAMPLES}, two lengths of NARMA-{max(ORDERS)}"
        )


def asked(section: NarmaSection, runs: Sequence) -> dict:
    """Options: the task, how runs are filmed, and whose way of scoring it is."""
    (scoring,) = {run.scoring["scoring"] for run in runs if run.camera}
    return {
        "cameras": [run.camera for run in runs], "scoring": scoring,
        "orders": section.order, "rate": section.rate, "alpha": section.alpha,
    }  # fmt: skip


TABLES = {
    "narma.csv": Table("fiberweb.studies.narma.task:table", tables=("narma_errors.nc",)),
    "narma_errors.nc": Table(
        "fiberweb.studies.narma.task:of_runs", responses=every, options=asked
    ),
}  # fmt: skip
FIGURES = {"narma": Figure("fiberweb.studies.narma.figure:draw", tuple(TABLES))}
JUDGED_BY = ("narma.csv",)
