"""What a score card says in words."""

from __future__ import annotations

import json
from collections.abc import Mapping

import numpy as np
import pandas as pd

BODY, TAPS = "body", "delay line"
FEW, MANY = 5, 20  # blocks of the test part: too few to tell, and enough for an interval
CALLED = {
    "c_nl": "C_nl", "c_m": "C_m", "ipc": "capacity in all", "ipc_1": "capacity of degree 1",
    "ipc_2": "capacity of degree 2", "ipc_3": "capacity of degree 3",
}  # fmt: skip
CALLED_READOUTS = {
    BODY: "the body", "u": "its input", "powers": "its powers", "derivatives": "its derivatives",
    TAPS: "the delay line",
}  # fmt: skip


def verdict(quantities: Mapping[str, Mapping[str, tuple]], facts: Mapping) -> str:
    """What the body computes that its input and a delay line do not, in one sentence.

    Args:
        quantities: of each readout, by name, (value, redrawn values or None); the draws are the
            same for all readouts, so that differences are those of the same frames.
        facts: of the card.
    """
    than = (
        f"its input, the powers and derivatives of it, or a delay line of {facts['taps']} taps "
        f"({1e3 * facts['taps_s']:.3g} ms)"
    )
    told = facts["blocks"] >= FEW
    better = []
    for name, (value, draws) in quantities[BODY].items():
        lower = name.endswith("_nmse")
        if not (lower or name in CALLED):
            continue
        sign = -1.0 if lower else 1.0
        rivals = {other: each[name] for other, each in quantities.items() if other != BODY}
        ahead = all(sign * (value - rival) > 0 for rival, _ in rivals.values())
        if told and ahead:
            ahead = all(
                np.percentile(sign * (draws - theirs), 2.5) > 0 for _, theirs in rivals.values()
            )
        if ahead:
            best = max(rivals.values(), key=lambda rival: sign * rival[0])[0]
            better.append(f"{_called(name)} {value:.3f} against {best:.3f}")
    if told:
        if better:
            return f"The body computes more than {than}: {', '.join(better)}."
        return (
            f"As far as {facts['tested_s']:.3g} s of test part tell, the body computes nothing "
            f"that {than} does not compute as well."
        )
    by_value = f"by value alone it is ahead in {', '.join(better)}"
    if not better:
        by_value = "by value alone it is ahead in nothing"
    return (
        f"{facts['blocks']} whole blocks of {facts['horizon_s']:g} s are too few to tell whether "
        f"the body computes more than {than}; {by_value}."
    )


def notes(scores: pd.DataFrame, facts: Mapping, sanity: str | None) -> list[str]:
    """What has to be known beside the numbers, a sentence each.

    Args:
        scores, facts: of the card.
        sanity: of the recording, as JSON; None of a simulation.
    """
    said = []
    if facts["recipe"]:
        said.append(f"Made by the recipe {facts['recipe']!r}, not by the defaults.")
    if facts["blocks"] < MANY:
        said.append(
            f"The test part is {facts['tested_s']:.3g} s, {facts['blocks']} whole blocks of "
            f"{facts['horizon_s']:g} s: the intervals are wide, and rough themselves."
        )
    if facts["cut_frames"]:
        said.append(
            f"Only the last {facts['frames']} frames were scored, and {facts['cut_frames']} before "
            "them were not."
        )
    said += [f"{sentence}; it was left out." for sentence in facts["refused"]]
    if facts["bar"]:
        said += _passed(scores, facts["bar"])
    found = json.loads(sanity) if sanity else []
    said += [f"Of the file: {text}." for _, severity, text in found if severity == "warning"]
    return said


def _passed(scores: pd.DataFrame, bar: float) -> list[str]:
    """Who passes a bar in each NARMA task."""
    said = []
    tasks = scores[scores["quantity"].str.endswith("_nmse")]
    for task, rows in tasks.groupby("quantity", sort=False):
        nmse = rows.set_index("readout")["value"]
        passed = [f"{called} ({nmse[name]:.3f})" for name, called in CALLED_READOUTS.items()
                  if nmse[name] < bar]  # fmt: skip
        who = f"is passed by {' and by '.join(passed)}" if passed else "is passed by none"
        if nmse[BODY] >= bar:
            who += f", not by the body ({nmse[BODY]:.3f})"
        said.append(f"{_called(task)}: the bar of {bar:.0%} {who}.")
    return said


def _called(name: str) -> str:
    if name.endswith("_nmse"):
        return f"NARMA-{name.removeprefix('narma').removesuffix('_nmse')} NMSE"
    return CALLED[name]
