"""What a reader gives, and what is said about a file."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fiberweb.simulation.memory import of_this_machine

SEVERITIES = ("ok", "note", "repair", "warning", "refused")


FINDING = {
    "name": "what was looked at",
    "severity": f"{', '.join(SEVERITIES[:-1])} or {SEVERITIES[-1]}",
    "sentence": "what was found",
}


class Finding(NamedTuple):
    """One line of a recording's sanity list: what was looked at, how bad it is, one sentence."""

    name: str
    severity: str  # of `SEVERITIES`
    sentence: str


@dataclass
class Raw:
    """What a file holds, before its clock is looked at.

    Attributes:
        positions: (T, m, 2) of every marker in the file's own unit; NaN where it was not seen.
        names: of the m markers.
        input: (T,), or None if a marker's motion is to be the input.
        time: (T,) in the file's own unit, or None.
        rate: frames per second that the file states (Hz), or None.
        units: of the positions, one of `LENGTHS`, or "" where the file does not say.
        findings: what was repaired on the way.
        first_row: line of the file that the first frame stands in, or None if it has no lines.
        columns: of a table, what the time column and the input are called in it.
        time_unit: that the file states of its time, or None.
    """

    positions: np.ndarray
    names: list[str]
    input: np.ndarray | None = None
    time: np.ndarray | None = None
    rate: float | None = None
    units: str = ""
    findings: list[Finding] = field(default_factory=list)
    first_row: int | None = None
    columns: dict[str, str] = field(default_factory=dict)
    time_unit: str | None = None

    def place(self, frame: int) -> str:
        """Where a frame stands in the file, in words."""
        return f"frame {frame}" if self.first_row is None else f"row {frame + self.first_row}"


LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "px": 1.0}  # in m; pixels stay pixels


def check_size(path: Path, values: float) -> None:
    """Raise ValueError, one sentence, if so many numbers, and what is made of them, do not fit in
    memory: a small file may hold, or stand for, a great many."""
    if not 3 * 8 * values <= of_this_machine():  # what cannot be counted does not, either
        raise ValueError(
            f"{path} stands for {values:.3g} numbers, which take {24e-9 * values:.3g} GB, and this "
            f"machine has {1e-9 * of_this_machine():.3g} GB of memory: cut it into shorter files"
        )


def head(path: Path) -> bytes:
    """The first bytes of a file, a million.

    Raises:
        ValueError: it is not there, cannot be read, or is empty; one sentence.
    """
    if path.exists() and not path.is_file():  # opening a pipe would wait for ever
        raise ValueError(f"{path} is no file: name one")
    try:
        with path.open("rb") as file:
            first = file.read(1 << 20)
    except OSError as error:
        raise ValueError(
            f"{path} cannot be read ({error.strerror}): name a file that is there"
        ) from None
    if not first.strip():
        raise ValueError(f"{path} is empty: name a file with a header and rows of numbers")
    return first


def driven(name: str | None, names: list[str], plane: str) -> tuple[int, int] | None:
    """Marker and coordinate of an input such as "servo.x"; None if no marker is called so."""
    marker, _, axis = (name or "").rpartition(".")
    if marker in names and len(axis) == 1 and axis in plane:
        return names.index(marker), plane.index(axis)
    return None
