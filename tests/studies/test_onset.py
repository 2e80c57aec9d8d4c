"""The onset of the drop lies between the two neighbouring B where C_nl falls most."""

import numpy as np
import pandas as pd
import pytest

from fiberweb.studies.ridge.onset import COLUMNS, onsets


def ridge(c_nl, b=(0.25, 0.5, 0.9, 1.6, 3.0), spacing=0.1, **columns):
    """One spacing; NaN is an unstable run."""
    table = pd.DataFrame({"buckling_number": b, "c_nl": c_nl}).assign(
        setup="described", spacing_m=spacing, c_m=np.linspace(0.1, 0.3, len(b))
    )
    table["force_N"] = 0.16 * table["buckling_number"]
    table["status"] = np.where(table["c_nl"].isna(), "unstable", "ok")
    table.loc[table["c_nl"].isna(), "c_m"] = np.nan
    return table.assign(**columns)


def test_the_onset_is_the_geometric_mean_of_the_steepest_neighbours():
    found = onsets(ridge([0.5, 0.6, 0.7, 0.3, 0.25]).sample(frac=1.0, random_state=1))
    assert list(found.columns) == list(COLUMNS)
    (row,) = found.itertuples()
    assert row.onset_B == pytest.approx(1.2)  # sqrt(0.9 * 1.6)
    assert (row.below_B, row.above_B, row.points) == (0.9, 1.6, 5)
    assert row.below_force_N == pytest.approx(0.144)
    assert row.fall == pytest.approx(0.4)
    assert (row.best_c_nl, row.best_c_nl_B) == (0.7, 0.9)
    assert (row.best_c_m, row.best_c_m_B) == (0.3, 3.0)
    assert row.best_c_m_force_N == pytest.approx(0.48)


def test_unstable_runs_are_skipped():
    (row,) = onsets(ridge([0.5, 0.6, np.nan, 0.3, 0.25])).itertuples()
    assert (row.below_B, row.above_B, row.points) == (0.5, 1.6, 4)
    assert row.onset_B == pytest.approx(np.sqrt(0.8))


@pytest.mark.parametrize("c_nl", [[0.1, 0.2, 0.3, 0.4, 0.5], [0.4] * 5])
def test_without_a_fall_there_is_no_onset(c_nl):
    (row,) = onsets(ridge(c_nl)).itertuples()
    assert np.isnan([row.onset_B, row.below_B, row.above_B, row.fall]).all()
    assert row.best_c_nl == max(c_nl)


def test_one_stable_run_or_none_has_no_onset():
    (row,) = onsets(ridge([np.nan, 0.6, np.nan, np.nan, np.nan])).itertuples()
    assert (row.points, row.best_c_nl) == (1, 0.6) and np.isnan(row.onset_B)
    (row,) = onsets(ridge([np.nan] * 5)).itertuples()
    assert row.points == 0 and np.isnan(row.best_c_nl)


def test_each_spacing_has_its_row():
    falls = ridge([0.5, 0.6, 0.7, 0.3, 0.25])
    both = onsets(pd.concat([falls.assign(spacing_m=0.12), falls.assign(spacing_m=0.02)]))
    assert list(both["spacing_m"]) == [0.02, 0.12]
