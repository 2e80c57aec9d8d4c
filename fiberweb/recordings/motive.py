"""OptiTrack Motive's CSV: a line of keys and values, then rows Type, Name, ID, perhaps Parent, a
row of Rotation or Position, the row of axes, and the data with blanks where a marker was hidden."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fiberweb.recordings import arrays
from fiberweb.recordings import text as texts
from fiberweb.recordings.base import Raw
from fiberweb.recordings.options import Reading

UNITS = {"meters": "m", "centimeters": "cm", "millimeters": "mm"}
TYPES = ("Marker", "Rigid Body Marker")  # a rigid body and a bone are made of these
TIME = "Time (Seconds)"


def recognises(path: Path, head: bytes) -> bool:
    first = head.removeprefix(b"\xef\xbb\xbf").split(b"\n", 1)[0]
    return first.startswith(b"Format Version") or b"Export Frame Rate" in first


def read(path: Path, options: Reading) -> Raw:
    """Read Motive's markers; those of rigid bodies are taken as they were measured.

    Raises:
        ValueError: one sentence with file, column and row.
    """
    texts.refuse_markers(path, options)
    text = texts.sniff(path)
    facts = dict(zip(text.lines[0][::2], text.lines[0][1::2], strict=False))
    rows = {row[1].strip(): row for row in text.lines[1:8] if len(row) > 1 and row[1].strip()}
    last = next((n for n, row in enumerate(text.lines) if row[:1] == ["Frame"]), None)
    if last is None or not {"Type", "Name"} <= set(rows):
        raise ValueError(f"{path} has no rows Type, Name and Frame as Motive writes them")
    axes, kinds, titles = text.lines[last], text.lines[last - 1], rows["Name"]
    where = {}
    columns = zip(rows["Type"], titles, kinds, axes, strict=False)
    for number, (kind, name, what, axis) in enumerate(columns):
        if kind in TYPES and what == "Position" and axis in ("X", "Y", "Z"):
            where.setdefault(name, {})[axis.lower()] = number
    where = {name: xyz for name, xyz in where.items() if len(xyz) == 3}
    if not where:
        raise ValueError(f"{path} has no column of type Marker; export markers from Motive")
    wanted = {f"{name}.{axis}": n for name, xyz in where.items() for axis, n in xyz.items()}
    if TIME in axes:
        wanted[TIME] = axes.index(TIME)
    columns, first_row = texts.numbers(text, wanted, last + 1, len(axes))
    positions = np.stack(
        [np.stack([columns[f"{name}.{axis}"] for axis in "xyz"], -1) for name in where], 1
    )
    stated = facts.get("Export Frame Rate") or facts.get("Capture Frame Rate")
    try:
        rate = float(stated) if stated else None
    except ValueError:
        raise ValueError(f"{path}, row 1: Export Frame Rate = {stated!r} is no number") from None
    return Raw(
        arrays.in_plane(positions, options.plane), list(where), None, columns.get(TIME), rate,
        UNITS.get(facts.get("Length Units", "").lower(), ""), text.findings, first_row,
        {"time": TIME},
    )  # fmt: skip
