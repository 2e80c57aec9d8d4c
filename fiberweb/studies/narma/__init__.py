"""The NARMA task of Fig. 6, on simulated networks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from fiberweb.scoring.tasks import ORDERS
from fiberweb.sections import Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, Table, crosshatch, every

LEAST_SAMPLES = 2 * max(ORDERS)


class NarmaSection(Section):
    """The NARMA task, Fig. 6, on simulated networks."""

    n: Some[Size] = key([6, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    order: Some[Literal[ORDERS]] = key([*ORDERS], "orders of the recursion")
    rate: Positive = key(10.0, "rate of the task", "Hz")
    alpha: Positive = key(1.0, "ridge penalty")


SECTION = NarmaSection
SETUPS = ("described",)


def points(section: NarmaSection, lab: Lab) -> Iterator[Point]:
    """The networks that are given the task."""
    for n in section.n:
        yield Point(lab.scene(crosshatch(n, length=section.length)), "eq3")


def check(section: NarmaSection, lab: Lab) -> None:
    """Raise ValueError if the recording cannot be sampled at the task's rate, or is too short."""
    duration, sample_rate = lab.defaults["duration"], lab.defaults["sample_rate"]
    check_samples(-(-round(duration * sample_rate) // frames_a_sample(sample_rate, section.rate)))


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
