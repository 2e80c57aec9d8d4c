"""Claims about groups of readouts (Fig. 4), judged at the features study's verdict force on the
chronological split; the other forces and the shuffled split are printed beside. A shuffled split
changes only C_nl: the authors shuffled nothing for C_m."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import pandas as pd

from fiberweb.claims.judge import (
    ALLOWANCE,
    SUBSTANTIAL,
    Answer,
    Evidence,
    NotComputed,
    check,
    inside_range,
    within_tolerance,
)

# in a capacity: the most by which a group is "slightly" better or worse; our own choice, three
# allowances
SLIGHT = 0.1
THIRD_TOLERANCE = 0.05  # of all outputs; our own choice
CROSSINGS = ("crossing_x", "crossing_y")
LATERAL = ("horizontal_midpoint_y", "vertical_midpoint_x")
MIDPOINTS = ("horizontal_midpoint_x", "vertical_midpoint_y", *LATERAL)
SHORT = {
    "crossing_x": "cross x", "crossing_y": "cross y", "horizontal_midpoint_x": "hor x",
    "horizontal_midpoint_y": "hor y", "vertical_midpoint_x": "ver x",
    "vertical_midpoint_y": "ver y",
}  # fmt: skip


@check("F1")
def midpoints_beat_crossings(evidence: Evidence) -> Answer:
    """Crossings score below: the mean over x and y of crossings is less than the mean over the
    four subgroups of midpoints, in C_nl and in C_m. Two best: C_nl of horizontal-midpoint y and of
    vertical-midpoint x >= that of each of the other four subgroups - 0.03."""

    def judge(scores: pd.DataFrame) -> Answer:
        totals = scores[["c_nl", "c_m"]]
        means = totals.loc[[*CROSSINGS]].mean(), totals.loc[[*MIDPOINTS]].mean()
        below = all(means[0][name] < means[1][name] for name in totals)
        c_nl = scores["c_nl"]
        others = c_nl[[*CROSSINGS, *MIDPOINTS]].drop([*LATERAL])
        best = c_nl[[*LATERAL]].min() >= others.max() - ALLOWANCE
        crossings, midpoints = (f"{mean['c_nl']:.2f}/{mean['c_m']:.2f}" for mean in means)
        text = f"crossings {crossings}, midpoints {midpoints} (C_nl/C_m); C_nl "
        return Answer(text + _ranked(c_nl[[*CROSSINGS, *MIDPOINTS]]), bool(below and best))

    return _judged(evidence, judge)


@check("F2")
def memory_lies_in_horizontal_midpoints(evidence: Evidence) -> Answer:
    """By far: C_m of each of the other five subgroups <= 0.75 that of horizontal-midpoint y, and
    below it by more than 0.03."""

    def judge(scores: pd.DataFrame) -> Answer:
        c_m = scores["c_m"][[*CROSSINGS, *MIDPOINTS]]
        best, other = c_m["horizontal_midpoint_y"], c_m.drop("horizontal_midpoint_y").max()
        far = other <= (1 - SUBSTANTIAL) * best and other < best - ALLOWANCE
        return Answer(f"C_m {_ranked(c_m)}", bool(far))

    return _judged(evidence, judge, shuffled=False)


@check("F3")
def lateral_midpoints_keep_nonlinear_capacity(evidence: Evidence) -> Answer:
    """C_nl of lateral midpoints over C_nl of all outputs, inside the range."""
    return _judged(evidence, lambda scores: _in_range(evidence, scores, "c_nl"))


@check("F4")
def lateral_midpoints_keep_memory(evidence: Evidence) -> Answer:
    """C_m of lateral midpoints over C_m of all outputs, inside the range; and lateral midpoints
    are a third of all outputs, give or take 0.05."""

    def judge(scores: pd.DataFrame) -> Answer:
        answer = _in_range(evidence, scores, "c_m")
        part = _share(scores, "lateral_midpoints", "n_signals")
        third = abs(part - 1 / 3) <= THIRD_TOLERANCE
        return Answer(f"{answer.text} with {part:.2f} of the outputs", answer.holds and third)

    return _judged(evidence, judge, shuffled=False)


@check("F5")
def near_springs_against_lateral_midpoints(evidence: Evidence) -> Answer:
    """Slightly is up to 0.1, and either direction may be missed by 0.03. C_nl: near springs
    between lateral - 0.1 and lateral + 0.03; C_m: between lateral - 0.03 and lateral + 0.1."""

    def judge(scores: pd.DataFrame) -> Answer:
        lateral, springs = scores.loc["lateral_midpoints"], scores.loc["near_springs"]
        worse = springs["c_nl"] - lateral["c_nl"]
        better = springs["c_m"] - lateral["c_m"]
        holds = -SLIGHT <= worse <= ALLOWANCE and -ALLOWANCE <= better <= SLIGHT
        return Answer(f"C_nl {worse:+.3f}, C_m {better:+.3f}", bool(holds))

    return _judged(evidence, judge)


@check("F6")
def near_actuation_nonlinear_capacity(evidence: Evidence) -> Answer:
    """C_nl of near actuation over C_nl of all outputs: |ours - paper| <= tolerance."""
    return _judged(evidence, lambda scores: _near_paper(evidence, scores, "c_nl"))


@check("F7")
def near_actuation_memory(evidence: Evidence) -> Answer:
    """C_m of near actuation over C_m of all outputs: |ours - paper| <= tolerance."""
    return _judged(evidence, lambda scores: _near_paper(evidence, scores, "c_m"), shuffled=False)


def _judged(
    evidence: Evidence, judge: Callable[[pd.DataFrame], Answer], shuffled: bool = True
) -> Answer:
    """The verdict's answer, with the text of the other forces and splits behind it."""
    frame = evidence.table("features")
    verdict, beside = None, []
    for label, is_verdict, rows in _parts(frame, shuffled):
        if rows["group"].duplicated().any():
            raise ValueError(
                f"the features table of the {evidence.setup} setup has several runs at {label}; "
                "a claim needs exactly one, so leave the others out of the table"
            )
        unstable = rows["c_nl"].isna().any()
        if is_verdict and unstable:
            raise NotComputed(f"the run at {label} is unstable")
        answer = Answer("unstable", False) if unstable else judge(rows.set_index("group"))
        if is_verdict:
            verdict = answer
        else:
            beside.append(f"{label}: {answer.text}")
    if verdict is None:
        raise NotComputed("no run at the verdict force")
    return verdict.with_remarks(beside)


def _parts(frame: pd.DataFrame, shuffled: bool) -> Iterator[tuple[str, bool, pd.DataFrame]]:
    """(label, whether it is the verdict's, rows) of each force and split."""
    for (force, split), rows in frame.groupby(["force_N", "split"], sort=True):
        chronological = split == "chronological"
        if chronological or shuffled:
            label = f"{force:g} N" if chronological else f"{force:g} N shuffled"
            yield label, chronological and bool(rows["verdict"].all()), rows


def _share(scores: pd.DataFrame, group: str, column: str) -> float:
    """Part of all outputs' value that a group has; NaN where there is none to keep."""
    whole = scores.loc["all", column]
    return float(scores.loc[group, column] / whole) if whole > 0 else math.nan


def _in_range(evidence: Evidence, scores: pd.DataFrame, column: str) -> Answer:
    share = _share(scores, "lateral_midpoints", column)
    return Answer(f"{share:.3f}", inside_range(evidence.claim, share))


def _near_paper(evidence: Evidence, scores: pd.DataFrame, column: str) -> Answer:
    share = _share(scores, "near_actuation", column)
    return Answer(f"{share:.3f}", within_tolerance(evidence.claim, share))


def _ranked(values: pd.Series) -> str:
    """The best two groups with their values."""
    best = values.sort_values(ascending=False, kind="stable").head(2)
    return ", ".join(f"{SHORT[name]} {value:.2f}" for name, value in best.items())
