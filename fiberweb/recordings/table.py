"""A wide table of numbers, CSV or TSV: a row a frame, the columns time, input, a_x, a_y, ...

Columns are found by their names; which is which may be said in the options.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fiberweb.errors import brief
from fiberweb.recordings import READERS
from fiberweb.recordings import text as texts
from fiberweb.recordings.base import Raw, driven
from fiberweb.recordings.options import Reading

TIMES = {"time": None, "time_s": "s", "time_ms": "ms", "time (s)": "s", "time (ms)": "ms"}


def recognises(path: Path, head: bytes) -> bool:
    return path.suffix.lower() in READERS["table"].suffixes


def read(path: Path, options: Reading) -> Raw:
    """Read a table.

    Raises:
        ValueError: one sentence with file, column and row.
    """
    text = texts.sniff(path)
    skip = next((n for n, row in enumerate(text.lines) if any(map(str.strip, row))), 0)
    header = [cell.strip() for cell in text.lines[skip]]
    if twice := texts.duplicated(header):
        texts.find(text, header, twice[0], "markers")  # refuses it
    clock = options.time or next((name for name in header if name.lower() in TIMES), None)
    pairs = _pairs(text, header, options, taken={clock, options.input or "input"})
    wanted = {column: texts.find(text, header, column, "markers") for p in pairs.values()
              for column in p}  # fmt: skip
    given = options.input or "input"
    _check_roles(text, clock, given, pairs)
    own_column = given in header or not driven(given, list(pairs), "xy")
    if own_column:
        wanted[given] = texts.find(text, header, given, "input")
    if clock:
        wanted[clock] = texts.find(text, header, clock, "time")
    columns, first_row = texts.numbers(text, wanted, skip + 1, len(header))
    time, drive = columns.pop(clock, None), columns.pop(given) if own_column else None
    places = [(n, axis, c) for n, pair in enumerate(pairs.values()) for axis, c in enumerate(pair)]
    positions = np.empty((len(columns[places[0][2]]), len(pairs), 2))
    for number, axis, column in places:
        positions[:, number, axis] = columns[column]
        del columns[column]  # of ten million rows, each is 80 MB
    return Raw(
        positions, list(pairs), drive, time, findings=text.findings, first_row=first_row,
        time_unit=TIMES.get((clock or "").lower()),
        columns={"time": clock or "time", "input": given},
    )  # fmt: skip


def _check_roles(text, clock: str | None, given: str, pairs: dict[str, list[str]]) -> None:
    """Raise ValueError, one sentence, if a column is to be two things."""
    roles = [(clock, "the time"), (given, "the input")]
    for name, pair in pairs.items():
        roles += [(column, f"{axis} of marker {name!r}") for column, axis in zip(pair, "xy")]
    taken = {}
    for column, role in roles:
        if (first := taken.setdefault(column, role)) != role:
            raise ValueError(
                f"{text.path}: column {column!r} would be {first} and {role}: give each a column "
                "of its own"
            )


def _pairs(text, header: list[str], options: Reading, taken: set) -> dict[str, list[str]]:
    """The columns of each marker: as the options say, or all that end alike in x and y."""
    if isinstance(options.markers, dict):
        for name, pair in options.markers.items():
            if len(pair) != 2:
                raise ValueError(f"{text.path}: markers: {name} = {pair}: give two columns, [x, y]")
        return options.markers
    if options.markers is not None:
        raise ValueError(
            f"{text.path}: markers = {brief(options.markers)}: a table has no paths: give {{name: "
            "[column of x, column of y]}, or leave it out"
        )
    free = [name for name in header if name not in taken]
    pairs = {}
    for mark in "_. ":
        found = [name for name in free if name.lower().endswith(f"{mark}x")]
        for x in found:
            y = next((n for n in free if n[:-1] == x[:-1] and n[-1] in "yY"), None)
            if y is None:
                raise ValueError(f"{text.path} has a column {x!r} and none {x[:-1] + 'y'!r}")
            pairs[x[:-2]] = [x, y]
    if not pairs:
        raise ValueError(
            f"{text.path} has no columns like a_x, a_y among {', '.join(header)[:200]}: name them, "
            "as in markers: {a: [column of x, column of y]}"
        )
    return pairs
