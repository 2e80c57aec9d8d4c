"""`python -m fiberweb.tools.compare OLD.csv NEW.csv`: how far capacities moved between two tables.

The tables are of one study, such as results/tables/described/ridge.csv before and after a change
of the numerics. Rows of one design point are compared: those that agree in all that is not an
outcome. Where the mesh or the step is what a study varies, rows that agree are taken in its order.

Ends with 0 if no capacity moved by more than the tolerance and no run became stable or unstable,
with 1 if one did, with 2 and one sentence if the tables cannot be compared.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from fiberweb import tables as files
from fiberweb.scoring import tables
from fiberweb.studies.calibration import tables as calibration
from fiberweb.studies.chaos import tables as chaos

CAPACITIES = ("c_nl", "c_m")
TOLERANCE = 0.01
DIGITS = 9  # fewer than a table keeps
OUTCOMES = {
    *tables.SCALARS, "status", "run", "buckling_number", *tables.NUMERICS,
    "n_signals", "effective_rank", "verdict",  # features
    "kind", "fibre", "section", "axis", "kept", "needed",  # features_greedy
    "recall_500ms",  # twin
    "amplitude_m", *chaos.COLUMNS, *calibration.TARGETS, "misfit",
}  # fmt: skip


def read(path: str | Path) -> pd.DataFrame:
    """A table with a row for each design point and the columns c_nl and c_m.

    Raises:
        ValueError: one sentence: no such file, or no such table.
    """
    try:
        frame = files.read(path)
    except (OSError, ValueError) as error:  # pandas' own errors about content are ValueErrors
        reason = getattr(error, "strerror", None) or "not a CSV table"
        raise ValueError(
            f"{path} cannot be read ({reason}); give a table such as "
            "results/tables/described/ridge.csv"
        ) from None
    for name in CAPACITIES:
        if name not in frame.columns or not pd.api.types.is_numeric_dtype(frame[name]):
            raise ValueError(
                f"{path} has no column {name!r} of numbers; give a table of capacities such as "
                "results/tables/described/ridge.csv"
            )
    return frame


def match(old: pd.DataFrame, new: pd.DataFrame) -> tuple[pd.DataFrame, list[str]]:
    """Rows of the same design point side by side.

    Returns:
        A frame of the columns that identify a point, as text, those of the outcomes with the
        suffixes _old and _new, and ``side``: "both", "old" or "new". And the names of the
        columns that identify a point.

    Raises:
        ValueError: tables of different studies, or without a common point.
    """
    kept = [[name for name in frame.columns if name not in OUTCOMES] for frame in (old, new)]
    if different := sorted(set(kept[0]) ^ set(kept[1])):
        raise ValueError(
            f"the column {different[0]!r} is in one table only; give two tables of one study"
        )
    points = kept[0]
    sides = [_side(frame, points) for frame in (old, new)]
    side_by_side = sides[0].merge(
        sides[1], how="outer", on=[*points, "rank"], suffixes=("_old", "_new"), indicator="side",
        validate="one_to_one",
    )  # fmt: skip
    names = {"left_only": "old", "right_only": "new"}
    side_by_side["side"] = side_by_side["side"].astype(str).replace(names)
    if not (side_by_side["side"] == "both").any():
        raise ValueError(
            "no row of one table has its design point in the other; give two tables of one study "
            "and config"
        )
    return side_by_side, points


def _side(frame: pd.DataFrame, points: list[str]) -> pd.DataFrame:
    """Outcomes that are compared, by the design point as text and a number within it."""
    by_mesh = [name for name in tables.NUMERICS if name in frame.columns]
    rows = frame.sort_values(by_mesh, kind="stable") if by_mesh else frame
    # as text, because an empty cell turns a column of whole numbers into one of decimals
    rows = rows.assign(**{name: rows[name].map(_text) for name in points})
    status = rows["status"] if "status" in rows.columns else "ok"
    rows = rows[[*points, *CAPACITIES]].assign(status=status)
    return rows.assign(rank=rows.groupby(points).cumcount() if points else range(len(rows)))


def _text(value) -> str:
    number = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
    return f"{value:.{DIGITS}g}" if number else str(value)


def moves(matched: pd.DataFrame) -> pd.DataFrame:
    """The moves of C_nl and C_m in rows of both tables: columns c_nl and c_m, infinite
    where the status changed or a capacity is known on one side only."""
    largest = {}
    for name in CAPACITIES:
        old, new = matched[f"{name}_old"], matched[f"{name}_new"]
        moved = (new - old).abs().round(DIGITS).mask(old.isna() & new.isna(), 0.0)
        largest[name] = moved.mask(matched["status_old"] != matched["status_new"]).fillna(np.inf)
    return pd.DataFrame(largest)


def report(old: pd.DataFrame, new: pd.DataFrame, tolerance: float) -> tuple[str, bool]:
    """Text of the comparison, and whether something moved by more than the tolerance.

    Raises:
        ValueError: see `match`.
    """
    rows, points = match(old, new)
    varied = [name for name in points if rows[name].nunique() > 1]

    def at(row) -> str:
        return ", ".join(f"{name} = {row[name]}" for name in varied) or "the only point"

    def change(row, name: str) -> str:
        states = (
            f"{row[f'{name}_{side}']:.4f} ({row[f'status_{side}']})" for side in ("old", "new")
        )
        return " -> ".join(states)

    matched = rows[rows["side"] == "both"]
    lines = [f"{len(matched)} rows in both tables"]
    for side in ("old", "new"):
        alone = rows[rows["side"] == side]
        lines.append(f"{len(alone)} only in the {side} one")
        lines += [f"  {at(row)}" for _, row in alone.iterrows()]
    moved = moves(matched)
    for name in CAPACITIES:
        known = moved.loc[np.isfinite(moved[name]), name]
        if known.empty:
            lines.append(f"{name} changed its status in every row")
            continue
        row = matched.loc[known.idxmax()]
        lines.append(f"{name} moved by {known.max():.4f} at most: {change(row, name)}, {at(row)}")
    beyond = moved.gt(tolerance).any(axis=1)
    lines.append(f"{beyond.sum()} rows moved by more than {tolerance:g}, or changed their status")
    lines += [
        f"  {at(row)}: " + ", ".join(f"{name} {change(row, name)}" for name in CAPACITIES)
        for _, row in matched[beyond].iterrows()
    ]
    return "\n".join(lines), bool(beyond.any())


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the comparison; the exit code."""
    parser = argparse.ArgumentParser(
        prog="python -m fiberweb.tools.compare", description="How far capacities moved."
    )
    parser.add_argument("old", help="CSV table before")
    parser.add_argument("new", help="CSV table after, of the same study")
    parser.add_argument("--tolerance", type=float, default=TOLERANCE, help="largest move allowed")
    given = parser.parse_args(arguments)
    try:
        if not given.tolerance >= 0.0:
            raise ValueError(f"--tolerance = {given.tolerance:g} is not usable; give 0 or more")
        text, moved = report(read(given.old), read(given.new), given.tolerance)
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    print(text)
    return int(moved)


if __name__ == "__main__":
    sys.exit(main())
