"""Rules of N1 to N5 on a made-up table that agrees with all of them, and on changed ones."""

import itertools

import numpy as np
import pandas as pd
import pytest

from fiberweb.claims import judge as claims
from tests.studies.sweeps import changed

RULES = ["fiberweb.studies.narma.claims"]
RMSE = {2: 0.0010, 5: 0.0100, 10: 0.0160}
RANGE = {2: 0.0025, 5: 0.0240, 10: 0.0410}
READOUTS = ("network", "echo_state", "u", "derivatives", "powers")
MAIN = "body == 'twin' and verdict and readout == 'network' and timing == 'same'"


def narma_table(setup="described"):
    """The twin in two readings beside a network; twice the error where it should not be read."""
    records = []
    cases = (("twin", 1, True), ("twin", 2, False), ("network", 1, False))
    for (body, step, verdict), order, readout, timing in itertools.product(
        cases, RMSE, READOUTS, ("same", "next")
    ):
        times = 1.0 if (verdict, readout, timing) == (True, "network", "same") else 2.0
        records.append({
            "setup": setup, "body": body, "n": 6, "frame_step": step, "verdict": verdict,
            "order": order, "readout": readout, "timing": timing, "status": "ok",
            "rmse": times * RMSE[order], "nrmse": 0.5 * times, "bias": 0.01 * RMSE[order],
            "interdecile_range": times * RANGE[order],
        })  # fmt: skip
    return pd.DataFrame(records)


def verdicts(table, setup="described"):
    result = claims.evaluate({"narma": table}, setup, RULES).set_index("id")
    return result.loc[["N1", "N2", "N3", "N4", "N5"], ["verdict", "value"]]


def test_what_agrees_holds_with_the_rest_beside_it():
    found = verdicts(narma_table())
    assert list(found["verdict"]) == ["holds"] * 5
    assert found.loc["N2", "value"] == (
        "0.01000 (input alone 0.02000; next sample 0.02000; one frame in 2 0.02000; "
        "the target's mean 0.02000)"
    )
    assert found.loc["N4", "value"].startswith("0.00250, 0.02400, 0.04100 (next sample 0.00500, ")


@pytest.mark.parametrize(
    ("claim", "order", "values"),
    [
        ("N1", 2, {"rmse": 0.0021}), ("N2", 5, {"rmse": 0.015}), ("N3", 10, {"rmse": 0.0070}),
        ("N4", 5, {"interdecile_range": 0.037}), ("N5", 10, {"bias": -0.0041}),
    ],
)  # fmt: skip
def test_what_is_wrong_differs(claim, order, values):
    found = verdicts(changed(narma_table(), f"{MAIN} and order == {order}", **values))
    assert dict(found["verdict"]) == dict.fromkeys(found.index, "holds") | {claim: "differs"}


def test_what_is_missing_is_not_computed():
    table = narma_table()
    for part in (table[table["body"] == "network"], table[table["order"] < 10], table.assign(n=4)):
        found = verdicts(part)
        assert set(found["verdict"]) == {"not computed"}
        assert found.loc["N1", "value"] == "no 6x6 twin with all of NARMA-2, -5 and -10"
    lost = changed(table, "body == 'twin'", status="unstable", rmse=np.nan)
    assert set(verdicts(lost)["value"]) == {"6x6 twin unstable"}
    assert set(verdicts(narma_table("compliant"), "compliant")["verdict"]) == {"not applicable"}
