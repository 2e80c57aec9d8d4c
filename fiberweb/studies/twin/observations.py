"""What the paper observed of its experiment (claims E1 to E5), as inequalities on scores.

Scores are rows of `tables.by_readouts` of one reading, over N and motor angle. Written down before
any run: the allowance is that of all claims, the rest stands beside it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import pandas as pd

from fiberweb.claims.judge import (
    ALLOWANCE,
    DIFFERS,
    HOLDS,
    NOT_COMPUTED,
    SUBSTANTIAL,
    Answer,
    NotComputed,
    numbers,
    rises,
)
from fiberweb.meanings import explained
from fiberweb.model.authors import LISTED_AT_500MM
from fiberweb.scoring import groups
from fiberweb.studies.twin.tables import CHANGE, FILM_COLUMNS

SMALL, LARGE = 4, 6  # N of the experiment
PLATEAU = 40.0  # degrees, from which on it lies, by the paper
NEAR_ZERO = 0.1  # in a capacity; our own choice: the paper draws it and gives no number
RECALLED = 0.8  # c of u 0.5 s ago, by the paper
KEPT = 0.85  # share of a capacity that counts as kept: what the paper calls so in Fig. 4
SIMULATED = max(c_m for _, c_m in LISTED_AT_500MM.values())  # the paper's best C_m of Fig. 1


COLUMNS = (
    {"setup": FILM_COLUMNS["setup"]}
    | CHANGE
    | {
        "observation": "id of the claim in claims.csv",
        "part": "of the claim, in words; empty where nothing of it is known",
        "verdict": f"{HOLDS}, {DIFFERS} or {NOT_COMPUTED}",
        "text": "our numbers, or why it does not hold or is not computed",
    }
)


@dataclass(frozen=True)
class Observed:
    """Numbers as text, and of each part of an observation why it fails: "" where it holds, None
    where there are too few angles to say."""

    text: str
    failed: dict[str, str | None]

    @property
    def answer(self) -> Answer:
        """The verdict on all parts, with what fails behind the numbers."""
        reasons = ", ".join(filter(None, self.failed.values()))
        return Answer(f"{self.text}: {reasons}" if reasons else self.text, not reasons)


def nonlinear_rises(scores: pd.DataFrame) -> Observed:
    """Rises: C_nl over the angle for 4x4 and 6x6; no step falls by more than 0.03 and the whole
    exceeds it. Alike: the mean over angles of their difference is at most 0.03 either way."""
    small, large = (over_angle(scores, n, "c_nl") for n in (SMALL, LARGE))
    if not small.index.equals(large.index):
        raise NotComputed("4x4 and 6x6 need the same angles")
    flat = [f"{n}x{n} does not rise" for n, c in ((4, small), (6, large)) if not rises([*c])]
    apart = (large - small).mean()
    parts = {
        "rises with the angle": ", ".join(flat),
        "alike for both": _unless(abs(apart) <= ALLOWANCE, f"6x6 is {apart:+.2f} from 4x4"),
    }
    return Observed(f"4x4 {numbers(small)}, 6x6 {numbers(large)}", parts)


def memory_rises(scores: pd.DataFrame) -> Observed:
    """4x4: C_m rises from the least to the largest angle by more than 0.03 and at most by 0.25.
    6x6: at most 0.1 at the least angle; from there to 40 degrees it rises by more than 0.25, and no
    step falls by more than 0.03. Plateau: beyond 40 degrees C_m of both stays within 0.03 of what
    it is there. 6x6 ends above 4x4 by more than 0.03."""
    small, large = (over_angle(scores, n, "c_m") for n in (SMALL, LARGE))
    late = {n: c[c.index >= PLATEAU] for n, c in ((4, small), (6, large))}
    if late[6].empty or len(large) < 2:
        raise NotComputed(f"needs angles below {PLATEAU:g} degrees and from there on")
    early = large[large.index <= late[6].index[0]]
    gain, rise = small.iloc[-1] - small.iloc[0], early.iloc[-1] - early.iloc[0]
    end = large.iloc[-1] - small.iloc[-1]
    moves = [
        f"{n}x{n} has no plateau"
        for n, c in late.items()
        if (c - c.iloc[0]).abs().max() > ALLOWANCE
    ]
    parts = {
        "4x4 rises modestly": _unless(
            ALLOWANCE < gain <= SUBSTANTIAL, f"4x4 changes by {gain:+.2f}"
        ),
        "6x6 begins near zero": _unless(
            large.iloc[0] <= NEAR_ZERO, f"6x6 begins at {large.iloc[0]:.2f}"
        ),
        "6x6 rises sharply": _unless(
            rises([*early]) and rise > SUBSTANTIAL, f"6x6 changes by {rise:+.2f} up to 40 degrees"
        ),
        "both reach a plateau": ", ".join(moves) if len(late[6]) > 1 else None,
        "6x6 ends above 4x4": _unless(end > ALLOWANCE, f"6x6 ends {end:+.2f} from 4x4"),
    }
    return Observed(f"4x4 {numbers(small)}, 6x6 {numbers(large)}{_input(scores, 'c_m')}", parts)


def recalls_half_a_second(scores: pd.DataFrame) -> Observed:
    """c of u 0.5 s ago of the 6x6 is above 0.8 at the largest angle."""
    c = over_angle(scores, LARGE, "recall_500ms").iloc[-1]
    text = f"{c:.2f}{_input(scores, 'recall_500ms')}"
    return Observed(text, {"6x6 recalls 0.5 s": _unless(c > RECALLED, "not above 0.8")})


def groups_keep(scores: pd.DataFrame) -> Observed:
    """At the largest angle, for 4x4 and 6x6. Strong groups: lateral midpoints and near springs keep
    0.85 of C_nl and of C_m of all markers. Near actuation keeps less C_nl than either. Memory: the
    share of C_m that is kept, as a mean over the three groups, is larger than that of C_nl."""
    texts, lost, strong_too, better = [], [], [], []
    for n in (SMALL, LARGE):
        kept = pd.DataFrame({name: shares(scores, n, name) for name in ("c_nl", "c_m")})
        strong = kept.loc[[groups.LATERAL, groups.NEAR_SPRINGS]]
        if not (strong >= KEPT).all(axis=None):
            lost.append(f"{n}x{n} loses in a strong group")
        if not kept.loc[groups.NEAR_ACTUATION, "c_nl"] < strong["c_nl"].min():
            strong_too.append(f"{n}x{n} near actuation is not weaker")
        if not kept["c_m"].mean() > kept["c_nl"].mean():
            better.append(f"{n}x{n} keeps C_nl better")
        texts.append(f"{n}x{n} C_nl {numbers(kept['c_nl'])}, C_m {numbers(kept['c_m'])}")
    parts = {
        "strong groups keep": ", ".join(lost),
        "near actuation is weaker": ", ".join(strong_too),
        "memory is kept better": ", ".join(better),
    }
    return Observed(f"lateral, near springs, near actuation: {'; '.join(texts)}", parts)


def exceeds_simulations(scores: pd.DataFrame, simulated: float = SIMULATED) -> Observed:
    """C_m of the 6x6 at 40 degrees and more exceeds the best C_m of a simulated crosshatch of
    Fig. 1 by more than 0.03."""
    c = over_angle(scores, LARGE, "c_m")
    c = c[c.index >= PLATEAU]
    if c.empty:
        raise NotComputed(f"needs an angle of {PLATEAU:g} degrees or more")
    text = f"6x6 {numbers(c)}, simulated up to {simulated:.2f}{_input(scores, 'c_m')}"
    above = c.min() > simulated + ALLOWANCE
    return Observed(text, {"more memory than simulated": _unless(above, "not above")})


OBSERVATIONS: dict[str, Callable[[pd.DataFrame], Observed]] = {
    "E1": nonlinear_rises,
    "E2": memory_rises,
    "E3": recalls_half_a_second,
    "E4": groups_keep,
    "E5": exceeds_simulations,
}


@explained(COLUMNS)
def table(sensitivity: pd.DataFrame) -> pd.DataFrame:
    """One row for each value of each parameter and part of an observation: whether it holds.

    Args:
        sensitivity: of `tables.sensitivity`. E5 is against the paper's own simulations.

    Returns:
        Columns `COLUMNS`. An observation of which nothing is known has one row, without a part.
    """
    records = []
    keys = ["setup", "parameter", "value"]
    for key, scores in sensitivity.groupby(keys, sort=False, dropna=False):
        for name, rule in OBSERVATIONS.items():
            try:
                found = rule(scores)
            except NotComputed as reason:
                records.append((*key, name, "", NOT_COMPUTED, str(reason)))
                continue
            for part, failed in found.failed.items():
                verdict = NOT_COMPUTED if failed is None else DIFFERS if failed else HOLDS
                records.append((*key, name, part, verdict, failed or found.text))
    return pd.DataFrame(records, columns=list(COLUMNS))


def over_angle(scores: pd.DataFrame, n: int, column: str, readouts: str = groups.ALL) -> pd.Series:
    """A column of one size over the angle (degrees); NotComputed if a run is missing or unstable.

    ValueError if there are two runs where one is needed.
    """
    rows = scores[(scores["n"] == n) & (scores["readouts"] == readouts)]
    c = rows.set_index("angle_deg")[column].sort_index()
    if c.empty:
        raise NotComputed(f"no {n}x{n}")
    if c.index.has_duplicates:
        raise ValueError(
            f"the twin table has several rows of the {n}x{n} at {c.index[0]:g} degrees; a claim "
            "needs exactly one, so leave the others out"
        )
    if c.isna().any():
        raise NotComputed(f"{n}x{n} at {c.index[c.isna()][0]:g} degrees is unstable")
    return c


def shares(scores: pd.DataFrame, n: int, column: str) -> pd.Series:
    """What each group keeps of a capacity of all markers at the largest angle."""
    of_all = over_angle(scores, n, column).iloc[-1]
    if of_all <= 0.0:
        raise NotComputed(f"{n}x{n} has no capacity to keep")
    return pd.Series(
        {g: over_angle(scores, n, column, g).iloc[-1] / of_all for g in groups.REDUCED}
    )


def _input(scores: pd.DataFrame, column: str) -> str:
    """What a readout of the input alone scores at the largest angle, as a remark."""
    try:
        return f" (u alone {over_angle(scores, LARGE, column, 'u').iloc[-1]:.2f})"
    except NotComputed:
        return ""


def _unless(holds: bool, reason: str) -> str:
    return "" if holds else reason
