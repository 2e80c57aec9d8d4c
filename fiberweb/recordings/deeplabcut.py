"""DeepLabCut's CSV: three rows of header (scorer, bodyparts, coords), a frame number, then x, y and
likelihood of each part. It has no clock, so the rate is stated."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fiberweb.recordings import text as texts
from fiberweb.recordings.base import Finding, Raw
from fiberweb.recordings.options import Reading

HEADER = 3


def recognises(path: Path, head: bytes) -> bool:
    return head.removeprefix(b"\xef\xbb\xbf").startswith(b"scorer,")


def read(path: Path, options: Reading) -> Raw:
    """Read DeepLabCut's tracks; points below the likelihood are NaN.

    Raises:
        ValueError: one sentence with file, column and row.
    """
    texts.refuse_markers(path, options)
    text = texts.sniff(path)
    rows = [[cell.strip() for cell in row] for row in text.lines[:HEADER]]
    if [row[0] for row in rows if row] != ["scorer", "bodyparts", "coords"]:
        raise ValueError(f"{path} does not begin with rows of scorer, bodyparts and coords")
    header = [f"{part}.{kind}" for part, kind in zip(rows[1], rows[2], strict=True)]
    if twice := texts.duplicated(header):
        texts.find(text, header, twice[0], "markers")  # refuses it
    parts = list(dict.fromkeys(rows[1][1:]))
    kinds = ("x", "y", "likelihood")
    wanted = {f"{part}.{kind}": texts.find(text, header, f"{part}.{kind}", "markers")
              for part in parts for kind in kinds}  # fmt: skip
    columns, first_row = texts.numbers(text, wanted, HEADER, len(header))
    positions = np.stack(
        [np.stack([columns[f"{part}.{axis}"] for axis in "xy"], -1) for part in parts], 1
    )
    likely = np.stack([columns[f"{part}.likelihood"] for part in parts], 1) >= options.likelihood
    positions[~likely] = np.nan
    share = 1.0 - likely.mean()
    found = Finding(
        "likelihood", "note",
        f"{share:.2%} of the points are less likely than {options.likelihood:g} and count as not "
        "seen",
    )  # fmt: skip
    return Raw(positions, parts, units="px", findings=[*text.findings, found], first_row=first_row)
