"""Rules of the claims about size (Fig. 2c) and pretension (Fig. 3)."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd

from fiberweb.claims.judge import (
    ALLOWANCE,
    CROSSHATCHES,
    Answer,
    Evidence,
    NotComputed,
    check,
    rises,
)
from fiberweb.studies.ridge.claims import SAME, mm, stable, within

SIZE_LIMIT = 0.12  # m, below it C_nl rises with N
SIZE_BAND = (0.05, 0.07)  # m, where C_m improves with N
PEAK_TENSION = 1.0  # N


@check("S1")
def size_helps_nonlinear_capacity(evidence: Evidence) -> Answer:
    """Over N = 2 to 12 at the best force for C_nl. At each spacing below 120 mm C_nl rises (no step
    falls by more than 0.03, the whole exceeds 0.03), and faster a step up to 8x8 than beyond:
    (C(8) - C(2)) / 3 > (C(12) - C(8)) / 2. At each spacing above 120 mm it falls: no step rises by
    more than 0.03, and the whole falls by more than 0.03."""
    sizes = _sizes(evidence, "c_nl")
    below = {s: c for s, c in sizes.items() if s < SIZE_LIMIT * (1 - SAME)}
    above = {s: c for s, c in sizes.items() if s > SIZE_LIMIT * (1 + SAME)}
    if not below or not above:
        raise NotComputed("needs spacings below and above 120 mm")
    rising = [rises(c) and (c[3] - c[0]) / 3 > (c[5] - c[3]) / 2 for c in below.values()]
    falling = [_falls(c) for c in above.values()]
    text = (
        f"rises at {sum(rising)} of {len(rising)} spacings below 120 mm, falls at "
        f"{sum(falling)} of {len(falling)} above"
    )
    return Answer(text, all(rising) and all(falling))


@check("S2")
def size_helps_memory_in_a_band(evidence: Evidence) -> Answer:
    """At the best force for C_m, with the gain of a spacing the greatest C_m over N = 4 to 12 less
    that of N = 2: each gain of 50 to 70 mm > 0.03, and their mean exceeds the mean gain of the
    other spacings by more than 0.03."""
    gain = {s: max(c[1:]) - c[0] for s, c in _sizes(evidence, "c_m").items()}
    inside = [value for spacing, value in gain.items() if within(spacing, SIZE_BAND)]
    outside = [value for spacing, value in gain.items() if not within(spacing, SIZE_BAND)]
    if not inside or not outside:
        raise NotComputed("needs spacings of 50 to 70 mm and others")
    means = np.mean(inside), np.mean(outside)
    text = f"mean gain {means[0]:.2f} at 50 to 70 mm, {means[1]:.2f} elsewhere"
    return Answer(text, min(inside) > ALLOWANCE and means[0] > means[1] + ALLOWANCE)


@check("P1")
def nonlinear_capacity_falls_with_tension(evidence: Evidence) -> Answer:
    """C_nl falls over F_t at each spacing and over spacing at each F_t: no step rises by more than
    0.03, and the whole falls by more than 0.03. Best at the least tension: some C_nl at 0.01 N is
    within 0.03 of the greatest of all."""
    c = _tensions(evidence, "c_nl")
    over_tension = [_falls(row) for row in c.to_numpy()]
    over_spacing = [_falls(column) for column in c.to_numpy().T]
    least = c[c.columns.min()].max() >= c.to_numpy().max() - ALLOWANCE
    text = (
        f"falls over F_t at {sum(over_tension)} of {len(over_tension)} spacings, over spacing at "
        f"{sum(over_spacing)} of {len(over_spacing)} F_t"
    )
    return Answer(text, all(over_tension) and all(over_spacing) and bool(least))


@check("P2")
def memory_peaks_over_tension(evidence: Evidence) -> Answer:
    """C_m rises over spacing at each F_t. At each spacing it rises over F_t up to 1 N and falls
    from there on, where the allowance makes 1 N stand for 'near 1 N': a rise has no step that falls
    by more than 0.03 and exceeds 0.03 as a whole, and a fall is a rise the other way."""
    c = _tensions(evidence, "c_m")
    if not (min(c.columns) < PEAK_TENSION < max(c.columns) and PEAK_TENSION in c.columns):
        raise NotComputed("needs F_t = 1 N and tensions on both sides")
    over_spacing = [rises(list(column)) for column in c.to_numpy().T]
    before, after = (
        c[c.columns[keep]] for keep in (c.columns <= PEAK_TENSION, c.columns >= PEAK_TENSION)
    )
    peaks = [
        rises(list(up)) and _falls(down) for up, down in zip(before.to_numpy(), after.to_numpy())
    ]
    text = (
        f"peaks near 1 N at {sum(peaks)} of {len(peaks)} spacings, rises over spacing at "
        f"{sum(over_spacing)} of {len(over_spacing)} F_t"
    )
    return Answer(text, all(peaks) and all(over_spacing))


def _sizes(evidence: Evidence, name: str) -> dict[float, list[float]]:
    """A capacity at N = 2 to 12 for each spacing, at the force that is best for it. Of a size that
    was run at two steps it is the longer stable one, the authors' own if that was stable."""
    table = evidence.table("size")
    table = table[table["force_choice"].str.endswith(name)]
    spacings = sorted(table["spacing_m"].unique())
    table = stable(table).sort_values("time_step_s")
    table = table.drop_duplicates(["spacing_m", "n"], keep="last")
    found = table.pivot(index="spacing_m", columns="n", values=name).reindex(spacings)
    return {s: list(row) for s, row in _complete(found, CROSSHATCHES, "N = {}").iterrows()}


def _tensions(evidence: Evidence, name: str) -> pd.DataFrame:
    """A capacity over spacing (rows, m) and tension (columns, N)."""
    table = evidence.table("pretension")
    found = table.pivot(index="spacing_m", columns="tension_N", values=name)
    if min(found.shape) < 2:
        raise NotComputed("needs two spacings and two tensions")
    return _complete(found, found.columns, "F_t = {:g} N")


def _complete(found: pd.DataFrame, columns: Iterable, label: str) -> pd.DataFrame:
    """The table with these columns; NotComputed at the first value that is missing."""
    found = found.reindex(columns=list(columns))
    missing = found.isna()
    if missing.any(axis=None):
        spacing, column = missing.stack().idxmax()
        raise NotComputed(f"{mm(spacing)}, {label.format(column)} missing or unstable")
    return found


def _falls(c: Iterable[float]) -> bool:
    return rises([-value for value in c])
