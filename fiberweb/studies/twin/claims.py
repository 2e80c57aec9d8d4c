"""Claims about the experiment (Fig. 5), judged on its twin by the first reading of the frame rate;
the others are printed beside. `published` is the authors' scoring of the twin, with a shuffled
split of the nonlinear targets; `described` a clean, chronological one."""

from __future__ import annotations

from collections.abc import Callable

import pandas as pd

from fiberweb.claims.judge import CROSSHATCHES, Answer, Evidence, NotComputed, check
from fiberweb.studies.twin import observations


@check("E1", "E2", "E3", "E4")
def observation(evidence: Evidence) -> Answer:
    """The function of that claim in `observations.OBSERVATIONS`."""
    return _judged(evidence, observations.OBSERVATIONS[evidence.claim["id"]])


@check("E5")
def memory_exceeds_that_of_simulations(evidence: Evidence) -> Answer:
    """`observations.exceeds_simulations`, against the best C_m of the crosshatches of the same
    setup in the topology study."""
    topology = evidence.table("topology")
    c_m = topology.loc[topology["topology"] == "crosshatch", ["n", "c_m"]].dropna()
    if not set(CROSSHATCHES) <= set(c_m["n"]):
        raise NotComputed("needs all simulated networks of Fig. 1")
    best = float(c_m["c_m"].max())
    return _judged(evidence, lambda scores: observations.exceeds_simulations(scores, best))


def _judged(evidence: Evidence, rule: Callable[[pd.DataFrame], observations.Observed]) -> Answer:
    """The verdict's answer, with the text of the other readings behind it."""
    twin = evidence.table("twin")
    verdict = rule(twin[twin["verdict"]]).answer
    beside = []
    for step, scores in twin[~twin["verdict"]].groupby("frame_step"):
        try:
            beside.append(f"one frame in {step}: {rule(scores).answer.text}")
        except NotComputed as reason:
            beside.append(f"one frame in {step}: {reason}")
    return verdict.with_remarks(beside)
