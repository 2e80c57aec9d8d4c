"""The figures of force and spacing, size and pretension, from synthetic tables."""

import itertools

import numpy as np
import pandas as pd
import pytest
from matplotlib.lines import Line2D
from matplotlib.text import Text

from fiberweb.claims import judge as claims
from fiberweb.figures import plots, style
from fiberweb.model.buckling import critical_force
from fiberweb.studies.pretension import figure as pretension
from fiberweb.studies.ridge import figure as ridge
from fiberweb.studies.ridge.onset import onsets
from fiberweb.studies.size import figure as size
from tests.figures.legible import assert_legible

BASELINES = pd.DataFrame(
    {
        "readout": ["u", "derivatives", "powers"],
        "c_nl": [0.14, 0.14, 0.41],
        "c_m": [0.09, 0.28, 0.09],
    }
)
SPACINGS = np.linspace(0.02, 0.15, 14).round(3)
FORCES = np.geomspace(0.015, 6.25, 18)


def finish(rows, **columns):
    """A table of one setup whose last run is unstable."""
    table = pd.DataFrame(rows).assign(
        n=4, setup="described", status="ok", c_nl_se=0.02, c_m_se=0.04
    )
    table = table.assign(**columns)
    table.loc[len(table) - 1, ["c_nl", "c_m", "status"]] = [np.nan, np.nan, "unstable"]
    return table


def ridge_tables(spacings=SPACINGS, forces=FORCES, **columns):
    rows = []
    for spacing, force in itertools.product(spacings, forces):
        b = force / critical_force(spacing, 2e-3, 1e8)
        c_nl, c_m = (0.8 + 0.1 * np.log10(b), 0.3 + 0.03 * np.log10(b)) if b < 1.2 else (0.4, 0.15)
        rows.append(
            {"spacing_m": spacing, "force_N": force, "buckling_number": b, "c_nl": c_nl, "c_m": c_m}
        )
    table = finish(rows, **columns)
    return {"ridge": table, "ridge_onset": onsets(table), "ridge_baselines": BASELINES}


def size_tables(sizes=(2, 4, 6), **columns):
    rows = [
        {"force_choice": choice, "spacing_m": spacing, "n": n, "c_nl": 0.4 + 0.05 * n, "c_m": 0.2}
        for choice, spacing, n in itertools.product(("best_c_nl", "best_c_m"), SPACINGS, sizes)
    ]
    table = finish(rows, time_step_s=5e-6, **columns).assign(n=[row["n"] for row in rows])
    return {"size": table, "ridge_baselines": BASELINES}


def published_size():
    """N = 2 at two steps, of which the longer was unstable once."""
    longer = size_tables((2,), setup="published")["size"]
    shorter = longer.assign(time_step_s=2.5e-6, status="ok").fillna({"c_nl": 0.5, "c_m": 0.123})
    return {"size": pd.concat([longer, shorter], ignore_index=True), "ridge_baselines": BASELINES}


def pretension_tables(tensions=(0.01, 0.1, 0.5, 1.0, 2.0, 5.0)):
    rows = [
        {"spacing_m": spacing, "tension_N": tension, "c_nl": 0.7 - 0.05 * tension, "c_m": 0.2}
        for spacing, tension in itertools.product(SPACINGS[3:9], tensions)
    ]
    return {"pretension": finish(rows), "ridge_baselines": BASELINES}


CASES = {
    "ridge": (ridge.draw, ridge_tables, "described"),
    "size": (size.draw, size_tables, "described"),
    "size-published": (size.draw, published_size, "published"),
    "pretension": (pretension.draw, pretension_tables, "described"),
}


@pytest.fixture(scope="module", params=CASES)
def drawn(request, tmp_path_factory):
    draw, tables, setup = CASES[request.param]
    path = tmp_path_factory.mktemp("figures") / f"{request.param}.png"
    return draw(tables(), setup, path), path


@pytest.fixture
def unsaved(monkeypatch):
    """Figures are made and not written, which is most of the work."""
    monkeypatch.setattr(style, "save", lambda figure, path: None)


def artists(figure, gid):
    return figure.findobj(lambda artist: artist.get_gid() == gid)


def said(figure):
    return " ".join(text.get_text() for text in figure.findobj(Text) if text.get_visible())


def test_both_files_are_written_in_double_width(drawn):
    figure, path = drawn
    header = path.read_bytes()[:24]
    assert int.from_bytes(header[16:20]) == pytest.approx(style.DOUBLE / 25.4 * 300, abs=1)
    assert path.with_suffix(".pdf").read_bytes().startswith(b"%PDF")
    assert rf"{'published' if 'published' in path.name else 'described'} setup" in said(figure)


def test_every_figure_shows_baselines_and_unstable_runs(drawn):
    figure, _ = drawn
    assert "readouts made of the input alone" in said(figure)
    assert "unstable run" in said(figure)
    marks = artists(figure, "unstable")
    assert marks and {mark.get_marker() for mark in marks} == {"X"}


def test_no_text_overlaps_and_none_is_too_small(drawn):
    assert_legible(drawn[0])


def test_cells_of_the_ridge_lie_about_their_force_and_spacing(unsaved):
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
    marks = [mark for mark in artists(figure, "onset") if isinstance(mark, Line2D)]
    onset = [tuple(mark.get_xydata()[0]) for mark in marks]
    assert [at for at, _ in onset] == pytest.approx(list(1e3 * SPACINGS))
    assert [b for _, b in onset] == pytest.approx(list(tables["ridge_onset"]["onset_B"]))


def test_the_band_of_the_onset_is_the_one_of_the_claim():
    (claimed,) = (claim["range"] for claim in claims.load() if claim["id"] == "R2")
    assert list(ridge.CLAIMED) == claimed


@pytest.mark.parametrize("name", ["ridge", "size", "pretension"])
def test_every_capacity_has_its_standard_error_as_a_bar(unsaved, name):
    draw, tables, setup = CASES[name]
    tables = tables()
    figure = draw(tables, setup, "unsaved")
    stable = tables[name].dropna(subset=["c_nl", "c_m"])
    for column in ("c_nl", "c_m"):
        expected = [(c - e, c + e) for c, e in stable[[column, f"{column}_se"]].to_numpy()]
        panels = [ax for ax in figure.axes if ax.get_ylabel() == plots.TOTALS[column]]
        shown = [
            tuple(bar[:, 1].round(9))
            for ax in panels for container in ax.containers
            for bar in container.lines[2][0].get_segments() if len(bar)
        ]  # fmt: skip
        assert set(shown) <= {tuple(pair) for pair in np.round(expected, 9)}
        assert len(shown) >= len(stable) // 2  # the size's are of one choice of the force


def test_baselines_that_nearly_agree_share_one_label():
    labels = plots.baseline_labels(BASELINES, "c_nl", 0.05)
    assert [value for value, _ in labels] == pytest.approx([0.14, 0.41])
    assert [words for _, words in labels] == ["$u$, $u\\,…\\,u'''$", "$u\\,…\\,u^3$"]


def test_a_thinned_ridge_leaves_cells_out(unsaved):
    table = ridge_tables(setup="published")["ridge"].query("0.3 < buckling_number < 4")
    tables = {"ridge": table, "ridge_onset": onsets(table), "ridge_baselines": BASELINES}
    figure = ridge.draw(tables, "published", "unsaved")
    assert "not run" in said(figure)


@pytest.mark.parametrize(("spacings", "forces"), [((0.06, 0.08), (0.05, 0.4)), ((0.06,), (0.05,))])
def test_a_tiny_ridge_is_drawn(unsaved, spacings, forces):
    tables = ridge_tables(spacings, forces)
    figure = ridge.draw(tables, "described", "unsaved")
    assert len(artists(figure, "unstable")) == 4  # one run in four panels


def test_size_is_drawn_over_n_at_the_force_for_each_capacity(unsaved):
    tables = size_tables()
    wrong = tables["size"]["force_choice"] == "best_c_m"
    tables["size"].loc[wrong, "c_nl"] = 0.999
    figure = size.draw(tables, "described", "unsaved")
    nonlinear, memory = figure.axes[:2]
    lines = [line for line in nonlinear.lines if list(line.get_xdata()) == [2, 4, 6]]
    assert len(lines) == len(SPACINGS)
    np.testing.assert_allclose([line.get_ydata() for line in lines], [[0.5, 0.6, 0.7]] * 14)
    assert not artists(nonlinear, "unstable") and len(artists(memory, "unstable")) == 1


def test_the_published_size_shows_what_the_shorter_step_gives(unsaved):
    figure = size.draw(published_size(), "published", "unsaved")
    memory = figure.axes[1]
    assert "step of 5 µs" in said(figure) and "step of 2.5 µs" in said(figure)
    longer, shorter = (line for line in memory.lines if len(line.get_xdata()) == len(SPACINGS))
    assert np.isnan(longer.get_ydata()[-1]) and shorter.get_ydata()[-1] == 0.123
    marks = [mark for mark in artists(memory, "unstable") if len(mark.get_xdata())]
    assert [list(mark.get_xdata()) for mark in marks] == [[150.0]]
    both = pd.concat([published_size()["size"], size_tables(setup="published")["size"]])
    tables = {"size": both, "ridge_baselines": BASELINES}
    assert len(size.draw(tables, "published", "unsaved").axes) == 5  # and a key


def test_pretension_is_one_line_a_spacing_on_a_log_axis(unsaved):
    figure = pretension.draw(pretension_tables(), "described", "unsaved")
    ax = figure.axes[0]
    assert ax.get_xscale() == "log"
    assert sum(len(line.get_xdata()) == 6 for line in ax.lines) == 6
    slack = pretension.draw(pretension_tables((0.0, 1.0)), "described", "unsaved")
    assert slack.axes[0].get_xscale() == "symlog"


@pytest.mark.parametrize("name", ["ridge", "size", "pretension"])
def test_a_study_in_which_nothing_was_stable_is_drawn(unsaved, name):
    draw, tables, setup = CASES[name]
    blown = tables()
    blown[name] = blown[name].assign(c_nl=np.nan, c_m=np.nan, c_nl_se=np.nan, c_m_se=np.nan)
    blown[name]["status"] = "unstable"
    if name == "ridge":
        few = blown["ridge"][blown["ridge"]["spacing_m"] < 0.04]
        blown |= {"ridge": few, "ridge_onset": onsets(few)}
    assert artists(draw(blown, setup, "unsaved"), "unstable")


@pytest.mark.parametrize("name", ["ridge", "size", "pretension"])
def test_a_setup_without_runs_is_refused(unsaved, name):
    draw, tables, _ = CASES[name]
    with pytest.raises(ValueError, match=f"the {name} table has no run of the published setup"):
        draw(tables(), "published", "unsaved")
