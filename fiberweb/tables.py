"""Reading and writing tables: CSV with the same bytes every time; `fiberweb.scoring.tables` and
the studies make what is in them."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

# Rows are put in this order, so that a table does not depend on the order in which runs end.
SORTED_BY = ("setup", "topology", "n", "spacing_m", "force_N", "tension_N", "run", "target", "at")
FLOAT_FORMAT = "%.10g"
TEXT = {"name": str}  # of a network, as its user calls it: "007" as well


def write(frame: pd.DataFrame, path: str | Path) -> None:
    """Write a table as CSV: same frame, same bytes, however its rows were ordered."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    # encoding and newline are fixed because both would follow the machine
    with partial.open("w", encoding="utf-8", newline="") as file:
        ordered(frame).to_csv(file, index=False, float_format=FLOAT_FORMAT, lineterminator="\n")
    partial.replace(path)  # a killed job leaves no half table under the right name


def read(path: str | Path) -> pd.DataFrame:
    """The table that `write` wrote; an empty cell is NaN."""
    return pd.read_csv(path, dtype=TEXT, keep_default_na=False, na_values=[""])  # "NA" is text


def ordered(frame: pd.DataFrame) -> pd.DataFrame:
    """Rows in the order of `SORTED_BY`; rows that are equal in it keep theirs."""
    keys = [name for name in SORTED_BY if name in frame.columns]
    return frame.sort_values(keys, kind="stable", ignore_index=True) if keys else frame
