"""Rules of the claims about topology (Fig. 1), and the authors' table of the crosshatches."""

from __future__ import annotations

import pandas as pd

from fiberweb.claims.judge import (
    ALLOWANCE,
    CROSSHATCHES,
    ROUND_OFF,
    SUBSTANTIAL,
    Answer,
    Evidence,
    NotComputed,
    check,
    inside_range,
    network,
    numbers,
    rises,
    within_tolerance,
)

VERY_HIGH = 0.99  # the paper's own word for c > 0.99
RECALLED = 0.5  # an input is recalled at a lag where c is above this
# s; the paper says "up to 0.5 s" of curves in a plot. The tolerance is our own choice, a fifth.
PAPERS_REACH, REACH_TOLERANCE = 0.5, 0.1
POLYGONS = (6, 8, 10, 12)


@check("T1", "T2", "T3", "T4")
def single_target_of_8x8(evidence: Evidence) -> Answer:
    """|c - paper| <= tolerance, for c of the 8x8 crosshatch at one target: P_4, P_7, and recall
    at 0.2 s and 0.4 s. In the compliant setup the crossings were fitted to these: calibrated."""
    places = {"T1": ("order", 4), "T2": ("order", 7), "T3": ("lag", 0.2), "T4": ("lag", 0.4)}
    value = evidence.at("crosshatch", 8, *places[evidence.claim["id"]])
    return Answer(f"{value:.3f}", within_tolerance(evidence.claim, value))


@check("T5")
def nonlinear_capacity_saturates(evidence: Evidence) -> Answer:
    """Rises: C_nl(N+2) >= C_nl(N) - 0.03 for N = 2, 4, 6, and C_nl(8) > C_nl(2) + 0.03.
    Adds little or nothing: C_nl(10) and C_nl(12) <= C_nl(8) + 0.03."""
    c = evidence.totals("crosshatch", CROSSHATCHES, "c_nl")
    return Answer(
        f"C_nl {numbers(c)}", rises(c[:4]) and all(dense <= c[3] + ALLOWANCE for dense in c[4:])
    )


@check("T6")
def very_high_orders_do_not_fall(evidence: Evidence) -> Answer:
    """With k(N) the highest Legendre order of c > 0.99 (0 if none): some network has k > 0, and
    from each N to the next, N = 2 to 12, the larger network has an order of at least k(N) with
    c > 0.99 - 0.03."""
    curves = [evidence.curve("crosshatch", n, "order") for n in CROSSHATCHES]
    highest = [_last_above(curve, VERY_HIGH) for curve in curves]
    allowed = [_last_above(curve, VERY_HIGH - ALLOWANCE) for curve in curves]
    kept = all(larger >= smaller for smaller, larger in zip(highest, allowed[1:], strict=False))
    text = " ".join(f"{order:.0f}" for order in highest)
    return Answer(f"highest order {text}", kept and max(highest) > 0)


@check("T7")
def memory_capacity_peaks(evidence: Evidence) -> Answer:
    """Rises: C_m(N+2) >= C_m(N) - 0.03 for N = 2, 4, 6, and C_m(8) > C_m(2) + 0.03.
    Plateaus: C_m(10) <= C_m(8) + 0.03, and no substantial decay, C_m(10) > 0.75 C_m(8).
    Decays substantially: C_m(12) <= 0.75 C_m(10), a loss of a quarter or more."""
    c = evidence.totals("crosshatch", CROSSHATCHES, "c_m")
    kept = 1 - SUBSTANTIAL
    plateaus = kept * c[3] < c[4] <= c[3] + ALLOWANCE
    return Answer(f"C_m {numbers(c)}", rises(c[:4]) and plateaus and c[5] <= kept * c[4])


@check("T8")
def larger_networks_recall_further(evidence: Evidence) -> Answer:
    """With the horizon h(N) the last lag of c > 0.5, and h'(N) that of c > 0.5 - 0.03: h'(N+2) >=
    h(N) for N = 2, 4, 6 (beyond 8x8 the paper's own C_m falls); h(8) > h(2); h'(10) and h'(12) >=
    h(2); and the longest h is 0.5 s, give or take 0.1 s."""
    curves = [evidence.curve("crosshatch", n, "lag") for n in CROSSHATCHES]
    horizon = [_last_above(curve, RECALLED) for curve in curves]
    allowed = [_last_above(curve, RECALLED - ALLOWANCE) for curve in curves]
    grows = horizon[3] > horizon[0] and all(allowed[i + 1] >= horizon[i] for i in range(3))
    beyond_smallest = all(dense >= horizon[0] for dense in allowed[4:])
    reach = abs(max(horizon) - PAPERS_REACH) <= REACH_TOLERANCE + ROUND_OFF
    return Answer(f"horizon {numbers(horizon)} s", grows and beyond_smallest and reach)


@check("T9")
def polygons_stay_below(evidence: Evidence) -> Answer:
    """For each polygon N = 6, 8, 10, 12: C_nl and C_m <= those of the 2x2 crosshatch + 0.03. Best:
    C_nl(6) >= C_nl(N) - 0.03 for the others. Alike: each C_m within 0.03 of the middle of their
    range, max C_m - min C_m <= 0.06."""
    columns = ("c_nl", "c_m")
    polygon = {name: evidence.totals("polygon", POLYGONS, name) for name in columns}
    (nl,), (m,) = (evidence.totals("crosshatch", (2,), name) for name in columns)
    below = max(polygon["c_nl"]) <= nl + ALLOWANCE and max(polygon["c_m"]) <= m + ALLOWANCE
    hexagon_best = polygon["c_nl"][0] >= max(polygon["c_nl"]) - ALLOWANCE
    alike = max(polygon["c_m"]) - min(polygon["c_m"]) <= 2 * ALLOWANCE + ROUND_OFF
    return Answer(
        f"C_nl {numbers(polygon['c_nl'])}, C_m {numbers(polygon['c_m'])}; 2x2 {nl:.2f}, {m:.2f}",
        below and hexagon_best and alike,
    )


@check("G3")
def authors_density_table(evidence: Evidence) -> Answer:
    """Largest |C_m - theirs| and |C_nl - theirs| over the crosshatches that both tables hold, with
    spacing and force equal within 1 %, inside the range."""
    ours = evidence.table("topology")
    ours = ours[ours["topology"] == "crosshatch"]
    theirs = evidence.authors_table(
        "density_500mm.csv",
        ("num_threads", "spacing(mm)", "force_mag(N)", "nonlinearity", "memory"),
    )
    both = ours.merge(theirs, left_on="n", right_on="num_threads")
    same_spacing = (1e3 * both["spacing_m"] / both["spacing(mm)"] - 1).abs() < 0.01
    same_force = (both["force_N"] / both["force_mag(N)"] - 1).abs() < 0.01
    both = both[same_spacing & same_force].reset_index(drop=True)
    if both.empty:
        raise NotComputed
    if both["c_m"].isna().any():
        raise NotComputed(f"{network('crosshatch', both['n'][both['c_m'].isna()].min())} unstable")
    c_m = (both["c_m"] - both["memory"]).abs()
    c_nl = (both["c_nl"] - both["nonlinearity"]).abs()
    text = (
        f"C_m {c_m.max():.3f} (N = {both['n'][c_m.idxmax()]}), "
        f"C_nl {c_nl.max():.3f} (N = {both['n'][c_nl.idxmax()]}), of {len(both)} networks"
    )
    return Answer(text, inside_range(evidence.claim, max(c_m.max(), c_nl.max())))


def _last_above(curve: pd.Series, threshold: float) -> float:
    """The last order or lag where c exceeds the threshold; 0 if there is none."""
    above = curve.index[curve > threshold]
    return float(above[-1]) if len(above) else 0.0
