"""Claims about size on both sides of their rule, and the figure."""

import itertools

import numpy as np
import pandas as pd
import pytest

from fiberweb.claims import judge as claims
from fiberweb.studies.size import figure as size
from tests.figures.legible import BASELINES, marked, said
from tests.studies.sweeps import SPACINGS, changed, published_size, size_tables, unstable

CLAIMED_SPACINGS = [0.02, 0.04, 0.06, 0.08, 0.1, 0.12, 0.14]
SIZES = (2, 4, 6, 8, 10, 12)


def size_table(setup="described"):
    """Agrees with S1 and S2."""
    rows = []
    for choice, spacing, n in itertools.product(("c_nl", "c_m"), CLAIMED_SPACINGS, SIZES):
        c_nl = 0.4 + 0.04 * min(n, 8) + 0.01 * max(n - 8, 0) if spacing < 0.13 else 0.7 - 0.02 * n
        c_m = 0.2 + (0.02 * n if 0.05 <= spacing <= 0.07 else 0.0)
        rows.append((f"best_{choice}", spacing, n, c_nl, c_m))
    columns = ["force_choice", "spacing_m", "n", "c_nl", "c_m"]
    table = pd.DataFrame(rows, columns=columns)
    return table.assign(setup=setup, status="ok", time_step_s=1e-5)


def judge(name, setup="described", published_tables=None, table=None):
    table = size_table(setup) if table is None else table
    tables = {"size": table}
    rules = ["fiberweb.studies.size.claims"]
    row = claims.evaluate(tables, setup, rules, published_tables).set_index("id").loc[name]
    return row["value"], row["verdict"]


@pytest.mark.parametrize("name", ["S1", "S2"])
def test_tables_that_agree_hold(name):
    assert judge(name)[1] == "holds"
    without = claims.evaluate({}, "described", ["fiberweb.studies.size.claims"]).set_index("id")
    assert without.loc[name, "verdict"] == "not computed"


@pytest.mark.parametrize(
    ("name", "where", "values", "verdict"),
    [
        ("S1", "spacing_m == 0.06 and n == 6", {"c_nl": 0.54}, "holds"),  # within the allowance
        ("S1", "spacing_m == 0.06 and n == 6", {"c_nl": 0.5}, "differs"),
        ("S1", "spacing_m == 0.06 and n == 12", {"c_nl": 1.0}, "differs"),  # fastest beyond 8x8
        ("S1", "spacing_m == 0.14", {"c_nl": 0.5}, "differs"),  # does not fall
        ("S1", "spacing_m == 0.12", {"c_nl": 0.5}, "holds"),  # on neither side
        ("S1", "force_choice == 'best_c_m'", {"c_nl": 0.0}, "holds"),  # not at that force
        ("S2", "spacing_m == 0.06", {"c_m": 0.2}, "differs"),  # no gain in the band
        ("S2", "spacing_m != 0.06 and n == 12", {"c_m": 0.6}, "differs"),  # more elsewhere
        ("S2", "force_choice == 'best_c_nl'", {"c_m": 0.0}, "holds"),
    ],
)
def test_size_is_judged_by_the_written_rule(name, where, values, verdict):
    assert judge(name, table=changed(size_table(), where, **values))[1] == verdict


def test_size_needs_every_size_stable():
    missing = size_table("published").query("n == 2").replace("best_", "authors_", regex=True)
    text, verdict = judge("S1", "published", table=missing)
    assert (text, verdict) == ("20 mm, N = 4 missing or unstable", "not computed")
    blown = unstable(size_table(), "spacing_m == 0.04 and n == 2")
    assert judge("S1", table=blown) == ("40 mm, N = 2 missing or unstable", "not computed")
    # the run at a shorter step takes its place
    repeated = size_table().query("spacing_m == 0.04 and n == 2").assign(time_step_s=5e-6)
    assert judge("S1", table=pd.concat([blown, repeated]))[1] == "holds"
    # and not that of a run that was stable
    wrong = changed(repeated, "n == 2", c_nl=0.9)
    assert judge("S1", table=pd.concat([size_table(), wrong]))[1] == "holds"
    lost = unstable(size_table(), "spacing_m == 0.14")
    assert judge("S1", table=lost)[0] == "140 mm, N = 2 missing or unstable"


def test_size_is_drawn_over_n_at_the_force_for_each_capacity(unsaved):
    tables = size_tables()
    wrong = tables["size"]["force_choice"] == "best_c_m"
    tables["size"].loc[wrong, "c_nl"] = 0.999
    figure = size.draw(tables, "described", "unsaved")
    nonlinear, memory = figure.axes[:2]
    lines = [line for line in nonlinear.lines if list(line.get_xdata()) == [2, 4, 6]]
    assert len(lines) == len(SPACINGS)
    np.testing.assert_allclose([line.get_ydata() for line in lines], [[0.5, 0.6, 0.7]] * 14)
    assert not marked(nonlinear, "unstable") and len(marked(memory, "unstable")) == 1


def test_the_published_size_shows_what_the_shorter_step_gives(unsaved):
    figure = size.draw(published_size(), "published", "unsaved")
    memory = figure.axes[1]
    assert "step of 5 µs" in said(figure) and "step of 2.5 µs" in said(figure)
    longer, shorter = (line for line in memory.lines if len(line.get_xdata()) == len(SPACINGS))
    assert np.isnan(longer.get_ydata()[-1]) and shorter.get_ydata()[-1] == 0.123
    marks = [mark for mark in marked(memory, "unstable") if len(mark.get_xdata())]
    assert [list(mark.get_xdata()) for mark in marks] == [[150.0]]
    both = pd.concat([published_size()["size"], size_tables(setup="published")["size"]])
    tables = {"size": both, "ridge_baselines": BASELINES}
    figure = size.draw(tables, "published", "unsaved")
    labels = [ax.get_xlabel() for ax in figure.axes if ax.get_xlabel()]
    assert labels == ["Fibres in each direction, $N$"] * 2 + ["Spacing (mm)"] * 2
