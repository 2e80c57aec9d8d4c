"""Rules of E1 to E5 on a made-up table that agrees with all of them, and on changed ones."""

import itertools

import numpy as np
import pandas as pd
import pytest

from fiberweb.claims import judge as claims
from fiberweb.studies.twin import observations, sensitivity
from tests.claims.agreeing import topology_table
from tests.studies.sweeps import changed

ANGLES = (25.0, 30.0, 35.0, 40.0, 45.0, 50.0)
RULES = ["fiberweb.studies.twin.claims"]
C_NL = dict(zip(ANGLES, (0.40, 0.48, 0.55, 0.60, 0.64, 0.66)))
C_M = {
    4: dict(zip(ANGLES, (0.50, 0.55, 0.60, 0.62, 0.62, 0.63))),
    6: dict(zip(ANGLES, (0.05, 0.25, 0.50, 0.74, 0.75, 0.76))),
}
KEPT = {  # of C_nl and of C_m
    "all": (1.0, 1.0), "lateral_midpoints": (0.90, 0.97), "near_springs": (0.91, 0.98),
    "near_actuation": (0.75, 0.92), "u": (0.3, 0.4),
}  # fmt: skip


def twin_table(setup="described", angles=ANGLES):
    """What the paper observed, in one reading; in another everything is half."""
    records = []
    for n, angle, group, step in itertools.product((4, 6), angles, KEPT, (1, 2)):
        of_c_nl, of_c_m = KEPT[group]
        records.append({
            "setup": setup, "n": n, "angle_deg": angle, "frame_step": step, "verdict": step == 1,
            "readouts": group, "status": "ok", "c_nl": C_NL[angle] * of_c_nl / step,
            "c_m": C_M[n][angle] * of_c_m / step, "recall_500ms": 0.9 * of_c_m / step,
        })  # fmt: skip
    return pd.DataFrame(records)


def verdicts(table, setup="described", **tables):
    given = {"twin": table, "topology": topology_table(setup)} | tables
    result = claims.evaluate(given, setup, RULES).set_index("id")
    return result.loc[["E1", "E2", "E3", "E4", "E5"], ["verdict", "value"]]


def test_what_agrees_holds():
    found = verdicts(twin_table())
    assert list(found["verdict"]) == ["holds"] * 5
    assert found.loc["E1", "value"].startswith("4x4 0.40 0.48 0.55 0.60 0.64 0.66, 6x6 0.40")
    assert "one frame in 2: 4x4 0.20" in found.loc["E1", "value"]
    assert found.loc["E3", "value"].startswith("0.90 (u alone 0.36) (one frame in 2: 0.45")
    assert "simulated up to 0.55" in found.loc["E5", "value"]


MAIN = "verdict and readouts == 'all'"
GROUP = "verdict and readouts == '{}' and n == {}"
HIGHER = [c + 0.05 for c in C_NL.values()]
WRONG = {  # id, size and angles or group, what is changed, and what the text says
    "one size does not rise": (
        "E1", f"{MAIN} and n == 6 and angle_deg == 50", {"c_nl": 0.40}, "6x6 does not rise"),
    "sizes are not alike": (
        "E1", f"{MAIN} and n == 6", {"c_nl": HIGHER}, "6x6 is +0.05 from 4x4"),
    "begins high": (
        "E2", f"{MAIN} and n == 6 and angle_deg == 25", {"c_m": 0.2}, "6x6 begins at 0.20"),
    "rises little": (
        "E2", f"{MAIN} and n == 6 and angle_deg >= 40", {"c_m": 0.28}, "changes by +0.23 up to 40"),
    "no plateau": (
        "E2", f"{MAIN} and n == 4 and angle_deg == 50", {"c_m": 0.70}, "4x4 has no plateau"),
    "4x4 ends higher": (
        "E2", f"{MAIN} and n == 6 and angle_deg >= 40", {"c_m": 0.62}, "6x6 ends -0.01 from 4x4"),
    "4x4 is flat": ("E2", f"{MAIN} and n == 4", {"c_m": 0.6}, "4x4 changes by +0.00"),
    "forgets": (
        "E3", f"{MAIN} and n == 6 and angle_deg == 50", {"recall_500ms": 0.79}, "not above 0.8"),
    "springs lose": (
        "E4", GROUP.format("near_springs", 4), {"c_m": 0.3}, "4x4 loses in a strong group"),
    "actuation is strong": (
        "E4", GROUP.format("near_actuation", 6), {"c_nl": 0.65}, "near actuation is not weaker"),
    "C_nl is kept better": (
        "E4", GROUP.format("near_actuation", 6), {"c_m": 0.3}, "6x6 keeps C_nl better"),
    "no more than simulated": (
        "E5", f"{MAIN} and n == 6 and angle_deg == 40", {"c_m": 0.57}, "not above"),
}  # fmt: skip


@pytest.mark.parametrize(("claim", "where", "values", "words"), WRONG.values(), ids=WRONG)
def test_what_is_wrong_differs_and_says_why(claim, where, values, words):
    found = verdicts(changed(twin_table(), where, **values))
    assert found.loc[claim, "verdict"] == "differs"
    assert words in found.loc[claim, "value"]


def test_the_other_reading_changes_no_verdict():
    table = changed(twin_table(), "frame_step == 2", c_nl=0.9, c_m=0.0, recall_500ms=0.0)
    assert list(verdicts(table)["verdict"]) == ["holds"] * 5


def test_what_is_missing_is_not_computed():
    table = twin_table()
    assert set(verdicts(table[table["n"] == 4])["verdict"]) == {"not computed"}
    lost = changed(table, "n == 6 and angle_deg == 40", c_nl=np.nan, c_m=np.nan)
    found = verdicts(lost)
    assert found.loc["E1", "value"] == "6x6 at 40 degrees is unstable"
    assert verdicts(table[table["angle_deg"] < 40]).loc["E2", "verdict"] == "not computed"
    assert verdicts(table, topology=topology_table()[:3]).loc["E5", "verdict"] == "not computed"
    with pytest.raises(ValueError, match="several rows of the 4x4 at 25 degrees"):
        verdicts(pd.concat([table, table]))


def test_the_experiment_is_judged_in_two_setups():
    for setup, verdict in (("published", "holds"), ("compliant", "not applicable")):
        found = verdicts(twin_table(setup), setup)
        assert set(found["verdict"]) == {verdict}


def test_a_panel_judges_few_angles():
    scores = twin_table(angles=(25.0, 50.0)).query("verdict")
    short = changed(scores, "n == 6", recall_500ms=0.1)
    table = observations.table(
        pd.concat(
            [
                scores.assign(parameter="none", value=np.nan),
                short.assign(parameter="lever", value=1.0),
            ]
        )
    )
    found = table.pivot(index=["observation", "part"], columns="parameter", values="verdict")
    # one angle from 40 degrees on says nothing of a plateau
    known = found.drop(index=("E2", "both reach a plateau"))
    assert len(known) == 11 and set(known["none"]) == {"holds"}
    assert list(known.index[known["lever"] == "differs"]) == [("E3", "6x6 recalls 0.5 s")]
    assert set(found.loc[("E2", "both reach a plateau")]) == {"not computed"}
    assert set(sensitivity.OBSERVED) == set(known.index)
