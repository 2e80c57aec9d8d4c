"""What rules of several studies ask of tables over spacings."""

from __future__ import annotations

from collections.abc import Iterable

import pandas as pd

from fiberweb.claims.judge import NotComputed, rises

SAME = 1e-3  # relative, of spacings and forces that are the same but for rounding


def within(spacing: float, band: tuple[float, float]) -> bool:
    """Whether a spacing lies in a band (m), ends included, give or take rounding."""
    return band[0] * (1 - SAME) <= spacing <= band[1] * (1 + SAME)


def mm(spacing: float) -> str:
    """A spacing (m) as text."""
    return f"{1e3 * spacing:g} mm"


def stable(table: pd.DataFrame) -> pd.DataFrame:
    """The rows whose capacities are known."""
    return table[table["status"] == "ok"]


def complete(table: pd.DataFrame, columns: Iterable, label: str) -> pd.DataFrame:
    """A table over spacings with these columns; NotComputed at the first value that is missing."""
    table = table.reindex(columns=list(columns))
    missing = table.isna()
    if missing.any(axis=None):
        spacing, column = missing.stack().idxmax()
        raise NotComputed(f"{mm(spacing)}, {label.format(column)} missing or unstable")
    return table


def falls(c: Iterable[float]) -> bool:
    return rises([-value for value in c])
