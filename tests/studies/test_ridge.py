"""The onset of the drop, the best force of each spacing, and the figure of both."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.lines import Line2D

from fiberweb.claims import judge as claims
from fiberweb.studies.ridge import best
from fiberweb.studies.ridge import figure as ridge
from fiberweb.studies.ridge.onset import COLUMNS, onsets
from fiberweb.tables import write
from tests.figures.legible import BASELINES, marked, said
from tests.studies.sweeps import FORCES, SPACINGS, ridge_tables

# --- the onset: between the two neighbouring B where C_nl falls most ---


def spacing(c_nl, b=(0.25, 0.5, 0.9, 1.6, 3.0), at=0.1, **columns):
    """One spacing; NaN is an unstable run."""
    table = pd.DataFrame({"buckling_number": b, "c_nl": c_nl}).assign(
        setup="described", spacing_m=at, c_m=np.linspace(0.1, 0.3, len(b))
    )
    table["force_N"] = 0.16 * table["buckling_number"]
    table["status"] = np.where(table["c_nl"].isna(), "unstable", "ok")
    table.loc[table["c_nl"].isna(), "c_m"] = np.nan
    return table.assign(**columns)


def test_the_onset_is_the_geometric_mean_of_the_steepest_neighbours():
    table = onsets(spacing([0.5, 0.6, 0.7, 0.3, 0.25]).sample(frac=1.0, random_state=1))
    assert list(table.columns) == list(COLUMNS)
    (row,) = table.itertuples()
    assert row.onset_B == pytest.approx(1.2)  # sqrt(0.9 * 1.6)
    assert (row.below_B, row.above_B, row.points) == (0.9, 1.6, 5)
    assert row.below_force_N == pytest.approx(0.144)
    assert row.fall == pytest.approx(0.4)
    assert (row.best_c_nl, row.best_c_nl_B) == (0.7, 0.9)
    assert (row.best_c_m, row.best_c_m_B) == (0.3, 3.0)
    assert row.best_c_m_force_N == pytest.approx(0.48)


def test_unstable_runs_are_skipped():
    (row,) = onsets(spacing([0.5, 0.6, np.nan, 0.3, 0.25])).itertuples()
    assert (row.below_B, row.above_B, row.points) == (0.5, 1.6, 4)
    assert row.onset_B == pytest.approx(np.sqrt(0.8))


@pytest.mark.parametrize("c_nl", [[0.1, 0.2, 0.3, 0.4, 0.5], [0.4] * 5])
def test_without_a_fall_there_is_no_onset(c_nl):
    (row,) = onsets(spacing(c_nl)).itertuples()
    assert np.isnan([row.onset_B, row.below_B, row.above_B, row.fall]).all()
    assert row.best_c_nl == max(c_nl)


def test_one_stable_run_or_none_has_no_onset():
    (row,) = onsets(spacing([np.nan, 0.6, np.nan, np.nan, np.nan])).itertuples()
    assert (row.points, row.best_c_nl) == (1, 0.6) and np.isnan(row.onset_B)
    (row,) = onsets(spacing([np.nan] * 5)).itertuples()
    assert row.points == 0 and np.isnan(row.best_c_nl)


def test_each_spacing_has_its_row():
    falls = spacing([0.5, 0.6, 0.7, 0.3, 0.25])
    both = onsets(pd.concat([falls.assign(spacing_m=0.12), falls.assign(spacing_m=0.02)]))
    assert list(both["spacing_m"]) == [0.02, 0.12]


# --- the best force of each spacing: below buckling, stable, and back from its file ---


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
    table = best.best_unbuckled(made_up_ridge())
    assert list(table.columns) == list(best.COLUMNS)
    assert table[["spacing_m", "choice", "force_N", "capacity"]].to_numpy().tolist() == [
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


# --- the figure ---


def test_cells_of_the_ridge_lie_around_their_force_and_spacing(unsaved):
    tables = ridge_tables()
    figure = ridge.draw(tables, "described", "unsaved")
    assert "not run" not in said(figure)
    mesh = next(c for ax in figure.axes for c in ax.collections if c.get_array() is not None)
    corners = mesh.get_coordinates()
    assert corners.shape == (len(FORCES) + 1, len(SPACINGS) + 1, 2)
    for edges, centres in ((corners[0, :, 0], 1e3 * SPACINGS), (corners[:, 0, 1], FORCES)):
        assert (edges[:-1] < centres).all() and (centres < edges[1:]).all()
    table = tables["ridge"]
    expected = table.pivot(index="force_N", columns="spacing_m", values="c_nl").to_numpy()
    np.testing.assert_array_equal(np.ma.filled(mesh.get_array(), np.nan), expected)
    marks = [mark for mark in marked(figure, "onset") if isinstance(mark, Line2D)]
    onset = [tuple(mark.get_xydata()[0]) for mark in marks]
    assert [at for at, _ in onset] == pytest.approx(list(1e3 * SPACINGS))
    assert [b for _, b in onset] == pytest.approx(list(tables["ridge_onset"]["onset_B"]))


def test_the_band_of_the_onset_is_the_one_of_the_claim():
    (claimed,) = (claim["range"] for claim in claims.load() if claim["id"] == "R2")
    assert list(ridge.CLAIMED) == claimed


def test_a_thinned_ridge_leaves_cells_out(unsaved):
    table = ridge_tables(setup="published")["ridge"].query("0.3 < buckling_number < 4")
    tables = {"ridge": table, "ridge_onset": onsets(table), "ridge_baselines": BASELINES}
    figure = ridge.draw(tables, "published", "unsaved")
    assert "not run" in said(figure)


@pytest.mark.parametrize(("spacings", "forces"), [((0.06, 0.08), (0.05, 0.4)), ((0.06,), (0.05,))])
def test_a_tiny_ridge_is_drawn(unsaved, spacings, forces):
    tables = ridge_tables(spacings, forces)
    figure = ridge.draw(tables, "described", "unsaved")
    lost = tables["ridge"].iloc[-1]
    in_maps, over_b = 1e3 * lost["spacing_m"], lost["buckling_number"]
    places = [mark.get_xdata()[0] for mark in marked(figure)]
    assert places == pytest.approx([in_maps, in_maps, over_b, over_b])
