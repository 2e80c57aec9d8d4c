"""Claims about pretension on both sides of their rule, and the figure."""

import numpy as np
import pandas as pd
import pytest

from fiberweb.claims import judge as claims
from fiberweb.figures import plots
from fiberweb.studies.pretension import figure as pretension
from tests.studies.sweeps import changed, pretension_tables, unstable

TENSIONS = (0.01, 0.1, 0.5, 1.0, 2.0, 5.0)


def pretension_table(setup="described"):
    """Agrees with P1 and P2."""
    rows = []
    for spacing in (0.05, 0.07, 0.1):
        for place, tension in enumerate(TENSIONS):
            c_m = 0.1 + 2 * spacing + 0.04 * (place if place <= 3 else 6 - place)
            rows.append((spacing, tension, 0.9 - 0.05 * place - 2 * spacing, c_m))
    columns = ["spacing_m", "tension_N", "c_nl", "c_m"]
    return pd.DataFrame(rows, columns=columns).assign(setup=setup, status="ok")


def judge(name, setup="described", published_tables=None, table=None):
    table = pretension_table(setup) if table is None else table
    tables = {"pretension": table}
    rules = ["fiberweb.studies.pretension.claims"]
    row = claims.evaluate(tables, setup, rules, published_tables).set_index("id").loc[name]
    return row["value"], row["verdict"]


@pytest.mark.parametrize("name", ["P1", "P2"])
def test_tables_that_agree_hold(name):
    assert judge(name)[1] == "holds"
    without = claims.evaluate({}, "described", ["fiberweb.studies.pretension.claims"])
    assert without.set_index("id").loc[name, "verdict"] == "not computed"


@pytest.mark.parametrize(
    ("name", "where", "values", "verdict"),
    [
        ("P1", "spacing_m == 0.05 and tension_N == 0.5", {"c_nl": 0.77}, "holds"),
        ("P1", "spacing_m == 0.05 and tension_N == 0.5", {"c_nl": 0.79}, "differs"),
        ("P1", "tension_N == 2.0", {"c_nl": 0.5}, "differs"),  # flat over spacing
        ("P1", "tension_N == 0.1", {"c_nl": 0.95}, "differs"),  # best at a greater tension
        ("P2", "spacing_m == 0.07 and tension_N == 2.0", {"c_m": 0.38}, "holds"),  # within 0.03
        ("P2", "spacing_m == 0.07 and tension_N == 2.0", {"c_m": 0.42}, "differs"),  # later peak
        ("P2", "spacing_m == 0.07 and tension_N == 5.0", {"c_m": 0.35}, "differs"),  # no fall
        ("P2", "spacing_m == 0.1", {"c_m": 0.2}, "differs"),
    ],
)
def test_pretension_is_judged_by_the_written_rule(name, where, values, verdict):
    assert judge(name, table=changed(pretension_table(), where, **values))[1] == verdict


def test_pretension_needs_every_run():
    table = unstable(pretension_table(), "spacing_m == 0.07 and tension_N == 5.0")
    expected = ("70 mm, F_t = 5 N missing or unstable", "not computed")
    assert judge("P1", table=table) == expected
    assert judge("P2", table=pretension_table().query("tension_N < 1"))[1] == "not computed"


def test_pretension_is_one_line_a_spacing_on_a_log_axis(unsaved):
    tables = pretension_tables()
    figure = pretension.draw(tables, "described", "unsaved")
    for ax, name in zip(figure.axes, plots.TOTALS):
        assert ax.get_xscale() == "log"
        assert ax.get_ylabel() == plots.TOTALS[name]
        drawn = [line.get_xydata() for line in ax.lines if len(line.get_xdata()) == len(TENSIONS)]
        rows = tables["pretension"].groupby("spacing_m")[["tension_N", name]]
        np.testing.assert_array_equal(drawn, [frame.to_numpy() for _, frame in rows])
    slack = pretension.draw(pretension_tables((0.0, 1.0)), "described", "unsaved")
    assert slack.axes[0].get_xscale() == "symlog"
