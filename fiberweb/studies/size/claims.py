"""Rules of the claims about size (Fig. 2c)."""

from __future__ import annotations

import numpy as np

from fiberweb.claims.judge import (
    ALLOWANCE,
    CROSSHATCHES,
    Answer,
    Evidence,
    NotComputed,
    check,
    rises,
)
from fiberweb.claims.rows import SAME, complete, falls, stable, within

SIZE_LIMIT = 0.12  # m, below it C_nl rises with N
SIZE_BAND = (0.05, 0.07)  # m, where C_m improves with N


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
    falling = [falls(c) for c in above.values()]
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


def _sizes(evidence: Evidence, name: str) -> dict[float, list[float]]:
    """A capacity at N = 2 to 12 for each spacing, at the force that is best for it. Of a size that
    was run at two steps it is the longer stable one, the authors' own if that was stable."""
    table = evidence.table("size")
    table = table[table["force_choice"].str.endswith(name)]
    spacings = sorted(table["spacing_m"].unique())
    table = stable(table).sort_values("time_step_s")
    table = table.drop_duplicates(["spacing_m", "n"], keep="last")
    by_size = table.pivot(index="spacing_m", columns="n", values=name).reindex(spacings)
    return {s: list(row) for s, row in complete(by_size, CROSSHATCHES, "N = {}").iterrows()}
