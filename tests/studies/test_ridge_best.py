"""The best force of each spacing: below buckling, stable, and back from its file."""

import numpy as np
import pandas as pd

from fiberweb.studies.ridge import best
from fiberweb.tables import write


def made_up_ridge():
    """Two spacings over three forces: buckled and unstable runs would be the best by far."""
    rows = [
        (0.04, 0.5, 0.3, 0.60, 0.20, "ok"),
        (0.04, 0.8, 0.6, 0.70, 0.15, "ok"),
        (0.04, 2.0, 1.1, 0.95, 0.90, "ok"),
        (0.08, 0.1, 0.2, 0.50, 0.30, "ok"),
        (0.08, 0.2, 0.5, np.nan, np.nan, "unstable"),
        (0.12, 0.1, 0.5, np.nan, np.nan, "unstable"),
        (0.12, 0.2, 1.0, 0.70, 0.40, "ok"),
    ]
    columns = ["spacing_m", "force_N", "buckling_number", "c_nl", "c_m", "status"]
    return pd.DataFrame(rows, columns=columns).assign(setup="described")


def test_the_best_force_is_below_buckling_and_stable():
    found = best.best_unbuckled(made_up_ridge())
    assert list(found.columns) == list(best.COLUMNS)
    assert found[["spacing_m", "choice", "force_N", "capacity"]].to_numpy().tolist() == [
        [0.04, "best_c_m", 0.5, 0.20],
        [0.04, "best_c_nl", 0.8, 0.70],
        [0.08, "best_c_nl", 0.1, 0.50],
        [0.08, "best_c_m", 0.1, 0.30],
    ]
    buckled = made_up_ridge().assign(buckling_number=2.0)
    assert list(best.best_unbuckled(buckled).columns) == list(best.COLUMNS)
    assert best.best_unbuckled(buckled).empty


def test_the_best_forces_come_back_from_their_file(tmp_path):
    write(best.best_unbuckled(made_up_ridge()), tmp_path / "best.csv")
    assert best.read_best(tmp_path / "best.csv") == {
        ("best_c_m", 0.04): 0.5,
        ("best_c_nl", 0.04): 0.8,
        ("best_c_nl", 0.08): 0.1,
        ("best_c_m", 0.08): 0.1,
    }
