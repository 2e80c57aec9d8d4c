"""Claims about the NARMA tasks (Fig. 6), judged on the 6x6 twin of the experiment, by the timing of
the authors' script, which estimates y of the same sample, and by the first reading of the frame
rate. Beside the verdict: the next sample, other readings, and what the input alone scores."""

from __future__ import annotations

import pandas as pd

from fiberweb.claims.judge import Answer, Evidence, NotComputed, check, within_tolerance
from fiberweb.scoring.tasks import ORDERS

SIZE = 6  # N of the experiment
OF_CLAIM = {"N1": 2, "N2": 5, "N3": 10}
UNBIASED = 0.25  # of the RMSE, which a mean error "well under" it does not exceed; our own choice
DIGITS = ".5f"  # those of the paper


@check("N1", "N2", "N3")
def root_mean_square_error(evidence: Evidence) -> Answer:
    """|ours - paper| <= tolerance, for the order of the claim."""
    order = OF_CLAIM[evidence.claim["id"]]
    table = _twin(evidence)
    ours = _value(table, "rmse", order)
    names = ("u", "derivatives", "powers")
    alone = min(_value(table, "rmse", order, readout=name) for name in names)
    row = _row(table, order)
    remarks = [
        f"input alone {alone:{DIGITS}}",
        *_beside(table, "rmse", [order]),
        f"the target's mean {row['rmse'] / row['nrmse']:{DIGITS}}",
    ]
    near = within_tolerance(evidence.claim, ours)
    return Answer(f"{ours:{DIGITS}}", near).with_remarks(remarks)


@check("N4")
def interdecile_range(evidence: Evidence) -> Answer:
    """|ours - paper| <= tolerance for each of the orders."""
    table, claim = _twin(evidence), evidence.claim
    ours = [_value(table, "interdecile_range", order) for order in ORDERS]
    near = [
        within_tolerance({"paper": paper, "tolerance": tolerance}, value)
        for value, paper, tolerance in zip(ours, claim["paper"], claim["tolerance"], strict=True)
    ]
    text = ", ".join(f"{value:{DIGITS}}" for value in ours)
    return Answer(text, all(near)).with_remarks(_beside(table, "interdecile_range", ORDERS))


@check("N5")
def unbiased(evidence: Evidence) -> Answer:
    """|mean error| <= 0.25 RMSE for each of the orders."""
    table = _twin(evidence)
    parts = [_value(table, "bias", order) / _value(table, "rmse", order) for order in ORDERS]
    text = ", ".join(f"{part:+.2f}" for part in parts)
    return Answer(f"mean error over RMSE {text}", all(abs(part) <= UNBIASED for part in parts))


def _twin(evidence: Evidence) -> pd.DataFrame:
    """The rows of the twin; NotComputed without them, or if it was unstable."""
    table = evidence.table("narma")
    table = table[(table["body"] == "twin") & (table["n"] == SIZE)]
    if not set(ORDERS) <= set(table["order"]):
        raise NotComputed(f"no {SIZE}x{SIZE} twin with all of NARMA-2, -5 and -10")
    if (table["status"] == "unstable").any():
        raise NotComputed(f"{SIZE}x{SIZE} twin unstable")
    return table


def _row(
    table: pd.DataFrame, order: int, readout: str = "network", timing: str = "same", step=None
) -> dict:
    """One row; step None is the reading of the verdict."""
    reading = table["verdict"] if step is None else table["frame_step"] == step
    same = (table["order"] == order) & (table["readout"] == readout) & (table["timing"] == timing)
    (row,) = table[reading & same].to_dict("records")
    return row


def _value(table: pd.DataFrame, column: str, order: int, **which) -> float:
    return float(_row(table, order, **which)[column])


def _beside(table: pd.DataFrame, column: str, orders) -> list[str]:
    """The column by the other timing, and by the other readings of the frame rate."""
    steps = sorted(table.loc[~table["verdict"], "frame_step"].unique())
    others = {"next sample": {"timing": "next"}} | {
        f"one frame in {step}": {"step": step} for step in steps
    }
    return [
        f"{name} "
        + ", ".join(f"{_value(table, column, order, **which):{DIGITS}}" for order in orders)
        for name, which in others.items()
    ]
