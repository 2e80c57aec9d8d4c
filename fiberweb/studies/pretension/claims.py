"""Rules of the claims about pretension (Fig. 3)."""

from __future__ import annotations

import pandas as pd

from fiberweb.claims.judge import ALLOWANCE, Answer, Evidence, NotComputed, check, rises
from fiberweb.claims.rows import complete, falls

PEAK_TENSION = 1.0  # N


@check("P1")
def nonlinear_capacity_falls_with_tension(evidence: Evidence) -> Answer:
    """C_nl falls over F_t at each spacing and over spacing at each F_t: no step rises by more than
    0.03, and the whole falls by more than 0.03. Best at the least tension: some C_nl at 0.01 N is
    within 0.03 of the greatest of all."""
    c = _tensions(evidence, "c_nl")
    over_tension = [falls(row) for row in c.to_numpy()]
    over_spacing = [falls(column) for column in c.to_numpy().T]
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
        rises(list(up)) and falls(down) for up, down in zip(before.to_numpy(), after.to_numpy())
    ]
    text = (
        f"peaks near 1 N at {sum(peaks)} of {len(peaks)} spacings, rises over spacing at "
        f"{sum(over_spacing)} of {len(over_spacing)} F_t"
    )
    return Answer(text, all(peaks) and all(over_spacing))


def _tensions(evidence: Evidence, name: str) -> pd.DataFrame:
    """A capacity over spacing (rows, m) and tension (columns, N)."""
    table = evidence.table("pretension")
    c = table.pivot(index="spacing_m", columns="tension_N", values=name)
    if min(c.shape) < 2:
        raise NotComputed("needs two spacings and two tensions")
    return complete(c, c.columns, "F_t = {:g} N")
