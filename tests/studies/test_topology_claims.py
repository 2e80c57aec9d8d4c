"""Claims about topology are judged by their written rule, on tables on both sides of it."""

import numpy as np
import pandas as pd
import pytest

from fiberweb.claims import judge as claims
from tests.claims.agreeing import (
    HIGHEST,
    HORIZON,
    MEMORY,
    NONLINEAR,
    POLYGON_MEMORY,
    curve_table,
    topology_table,
)


def judge(name, setup="published", topology=None, curves=None, published_tables=None):
    tables = {
        "topology": topology_table(setup) if topology is None else topology,
        "topology_curves": curve_table(setup) if curves is None else curves,
    }
    rules = ["fiberweb.studies.topology.claims"]
    row = claims.evaluate(tables, setup, rules, published_tables).set_index("id").loc[name]
    return row["value"], row["verdict"]


@pytest.mark.parametrize("name", ["T1", "T2", "T3", "T4", "T5", "T6", "T7", "T8", "T9"])
def test_tables_that_agree_hold(name):
    assert judge(name)[1] == "holds"


@pytest.mark.parametrize("name", ["T1", "T2", "T3", "T4"])
def test_the_fitted_claims_are_calibrated_in_the_compliant_setup_alone(name):
    text, verdict = judge(name, setup="compliant")
    assert verdict == "calibrated"
    assert float(text) > 0
    assert judge(name, setup="described") == (text, "holds")


@pytest.mark.parametrize(
    ("name", "place", "limit", "sign"),
    [
        ("T1", ("order", 4.0), 0.994, -1),
        ("T2", ("order", 7.0), 0.946, 1),
        ("T3", ("lag", 0.2), 0.987, -1),
        ("T4", ("lag", 0.4), 0.613, -1),
    ],
)
def test_a_value_holds_up_to_its_tolerance(name, place, limit, sign):
    assert judge(name, curves=curve_table(eight={place: limit})) == (f"{limit:.3f}", "holds")
    beyond = curve_table(eight={place: limit + sign * 0.001})
    assert judge(name, curves=beyond)[1] == "differs"


@pytest.mark.parametrize(
    ("name", "changed", "verdict"),
    [
        ("T5", {"c_nl": {6: 0.68}}, "holds"),  # a step back within the allowance
        ("T5", {"c_nl": {6: 0.66}}, "differs"),
        ("T5", {"c_nl": {10: 0.94}}, "differs"),  # adds more than little
        ("T5", {"c_nl": {12: 0.94}}, "differs"),
        ("T5", {"c_nl": {10: 0.5, 12: 0.5}}, "holds"),  # adds nothing
        ("T5", {"c_nl": dict.fromkeys(NONLINEAR, 0.5)}, "differs"),  # flat does not rise
        ("T7", {"c_m": {4: 0.11}}, "differs"),
        ("T7", {"c_m": {10: 0.59}}, "differs"),  # still rising
        ("T7", {"c_m": {10: 0.41, 12: 0.1}}, "differs"),  # decays at 10x10 already
        ("T7", {"c_m": {12: 0.40}}, "differs"),  # decays, not substantially
        ("T7", {"c_m": {12: 0.38}}, "holds"),
        ("T7", {"c_m": dict.fromkeys(MEMORY, 0.5) | {12: 0.1}}, "differs"),
        ("T9", {"polygon_c_nl": {6: 0.52}}, "holds"),
        ("T9", {"polygon_c_nl": {6: 0.54}}, "differs"),  # above the 2x2
        ("T9", {"polygon_c_m": dict.fromkeys(POLYGON_MEMORY, 0.19)}, "differs"),
        ("T9", {"polygon_c_nl": {6: 0.40}}, "differs"),  # the octagon is better
        ("T9", {"polygon_c_m": {12: 0.07}}, "differs"),  # not alike
        ("T9", {"polygon_c_m": {12: 0.08}}, "holds"),
    ],
)
def test_totals_are_judged_by_the_written_rule(name, changed, verdict):
    assert judge(name, topology=topology_table(**changed))[1] == verdict


@pytest.mark.parametrize(
    ("name", "changed", "verdict"),
    [
        ("T6", {"highest": {6: 1}}, "differs"),
        ("T6", {"highest": {12: 4}}, "differs"),
        ("T6", {"highest": dict.fromkeys(HIGHEST, 0), "eight": {("order", 1.0): 0.9}}, "differs"),
        ("T6", {"highest": {8: 5}, "eight": {("order", 5.0): 0.97}}, "holds"),
        ("T6", {"highest": {8: 2}, "eight": {("order", 3.0): 0.97}}, "holds"),  # within 0.03
        ("T6", {"highest": {8: 2}, "eight": {("order", 3.0): 0.95}}, "differs"),
        ("T8", {"horizon": {6: 0.24}}, "differs"),
        ("T8", {"horizon": {12: 0.08}}, "differs"),  # less far back than the 2x2
        ("T8", {"horizon": {8: 0.64}}, "differs"),  # further than the paper
        ("T8", {"horizon": {8: 0.39, 10: 0.39}}, "differs"),  # not as far
        ("T8", {"horizon": dict.fromkeys(HORIZON, 0.5)}, "differs"),  # nothing grows
        ("T8", {"horizon": {8: 0.34, 10: 0.45}, "eight": {("lag", 0.36): 0.48}}, "holds"),
        ("T8", {"horizon": {8: 0.34, 10: 0.45}, "eight": {("lag", 0.36): 0.46}}, "differs"),
    ],
)
def test_curves_are_judged_by_the_written_rule(name, changed, verdict):
    changed.setdefault("eight", {("order", 99.0): 0.0})  # no single value set by hand
    assert judge(name, curves=curve_table(**changed))[1] == verdict


def test_cells_hold_our_numbers():
    assert judge("T5")[0] == "C_nl 0.50 0.70 0.80 0.90 0.88 0.91"
    assert judge("T7")[0] == "C_m 0.15 0.30 0.42 0.55 0.52 0.25"
    assert judge("T8")[0] == "horizon 0.12 0.28 0.36 0.52 0.48 0.24 s"
    plain = curve_table(eight={("order", 99.0): 0.0})
    assert judge("T6", curves=plain)[0] == "highest order 1 2 3 5 5 6"
    assert judge("T9")[0].endswith("C_m 0.14 0.12 0.13 0.11; 2x2 0.50, 0.15")


def test_an_unstable_run_leaves_the_claims_that_need_it_not_computed():
    table = topology_table(c_nl={12: np.nan}, c_m={12: np.nan})
    assert judge("T5", topology=table) == ("12x12 crosshatch unstable", "not computed")
    assert judge("T7", topology=table)[1] == "not computed"
    assert judge("T9", topology=table)[1] == "holds"  # does not need it
    curves = curve_table()
    curves.loc[curves["n"] == 8, "c"] = np.nan
    for name in ("T1", "T2", "T3", "T4", "T6", "T8"):
        assert judge(name, curves=curves) == ("8x8 crosshatch unstable", "not computed")
    table = topology_table(polygon_c_m={10: np.nan})
    assert judge("T9", topology=table) == ("10-sided polygon unstable", "not computed")


def test_missing_sizes_are_not_computed():
    table, curves = topology_table(), curve_table()
    small, small_curves = table[table["n"] <= 4], curves[curves["n"] <= 4]
    for name in ("T1", "T4", "T5", "T6", "T7", "T8", "T9"):
        assert judge(name, topology=small, curves=small_curves) == ("", "not computed")


def test_lags_that_are_not_recorded_are_not_computed():
    curves = curve_table()
    curves = curves[(curves["target"] == "order") | (curves["at"] < 0.3)]
    assert judge("T3", curves=curves)[1] == "holds"
    assert judge("T4", curves=curves) == ("", "not computed")


def test_two_runs_of_one_network_are_refused():
    table = pd.concat([topology_table(), topology_table().query("n == 4")])
    with pytest.raises(ValueError, match="several runs of the 4x4 crosshatch"):
        judge("T5", topology=table)


def authors_table(folder, memory=0.002, nonlinear=0.009, sizes=(2, 4, 6, 8, 10, 12)):
    """A table in the authors' layout, `memory` above ours for the 6x6 and equal elsewhere."""
    table = topology_table().query("topology == 'crosshatch'").set_index("n").loc[list(sizes)]
    table = table.reset_index()
    pd.DataFrame(
        {
            "num_threads": table["n"],
            "spacing(mm)": 1e3 * table["spacing_m"],
            "length(mm)": 500.0,
            "force_mag(N)": table["force_N"].round(4),
            "nonlinearity": table["c_nl"] - np.where(table["n"] == 4, nonlinear, 0.0),
            "memory": table["c_m"] + np.where(table["n"] == 6, memory, 0.0),
        }
    ).to_csv(folder / "density_500mm.csv", index=False)
    return folder


def test_the_authors_table_is_compared_point_by_point(tmp_path):
    text, verdict = judge("G3", published_tables=authors_table(tmp_path, memory=0.008))
    assert text == "C_m 0.008 (N = 6), C_nl 0.009 (N = 4), of 6 networks"
    assert verdict == "holds"
    for change in ({"memory": 0.012}, {"nonlinear": 0.012}):
        assert judge("G3", published_tables=authors_table(tmp_path, **change))[1] == "differs"
    common = authors_table(tmp_path, sizes=(4, 8))
    assert judge("G3", published_tables=str(common))[0].endswith("of 2 networks")


def test_the_authors_table_needs_the_same_networks(tmp_path):
    folder = authors_table(tmp_path)
    shorter = topology_table().assign(spacing_m=0.01)
    assert judge("G3", topology=shorter, published_tables=folder)[1] == "not computed"
    unstable = topology_table(c_m={6: np.nan})
    assert judge("G3", topology=unstable, published_tables=folder) == (
        "6x6 crosshatch unstable",
        "not computed",
    )


def test_the_authors_table_is_for_the_published_setup_only(tmp_path):
    text = judge("G3", setup="described", published_tables=authors_table(tmp_path))
    assert text == ("", "not applicable")


def test_a_folder_without_the_authors_table_is_one_sentence(tmp_path):
    with pytest.raises(ValueError, match=r"density_500mm.csv does not exist; put"):
        judge("G3", published_tables=tmp_path)
    (tmp_path / "density_500mm.csv").write_text("num_threads,memory\n2,0.1\n")
    with pytest.raises(ValueError, match=r"has no column 'spacing\(mm\)'"):
        judge("G3", published_tables=tmp_path)
