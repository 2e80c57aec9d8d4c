"""What the figures of force and spacing, size and pretension have in common."""

import numpy as np
import pytest

from fiberweb.figures import plots
from fiberweb.studies.pretension import figure as pretension
from fiberweb.studies.ridge import figure as ridge
from fiberweb.studies.ridge.onset import onsets
from fiberweb.studies.size import figure as size
from tests.figures.legible import BASELINES, assert_legible, assert_written, marked, said
from tests.studies.sweeps import pretension_tables, published_size, ridge_tables, size_tables

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


def test_both_files_are_written_in_double_width(drawn):
    figure, path = drawn
    assert_written(path)
    assert rf"{'published' if 'published' in path.name else 'described'} setup" in said(figure)


def test_every_figure_shows_baselines_and_unstable_runs(drawn):
    figure, _ = drawn
    assert "readouts made of the input alone" in said(figure)
    assert "unstable run" in said(figure)
    marks = marked(figure, "unstable")
    assert marks and {mark.get_marker() for mark in marks} == {"X"}


def test_no_text_overlaps_and_none_is_too_small(drawn):
    assert_legible(drawn[0])


@pytest.mark.parametrize("name", ["ridge", "size", "pretension"])
def test_every_capacity_has_its_standard_error_as_a_bar(unsaved, name):
    draw, tables, setup = CASES[name]
    tables = tables()
    figure = draw(tables, setup, "unsaved")
    stable = tables[name].dropna(subset=["c_nl", "c_m"])
    for column in ("c_nl", "c_m"):
        expected = [(c - e, c + e) for c, e in stable[[column, f"{column}_se"]].to_numpy()]
        axes = [ax for ax in figure.axes if ax.get_ylabel() == plots.TOTALS[column]]
        shown = [
            tuple(bar[:, 1].round(9))
            for ax in axes for container in ax.containers
            for bar in container.lines[2][0].get_segments() if len(bar)
        ]  # fmt: skip
        assert set(shown) <= {tuple(pair) for pair in np.round(expected, 9)}
        assert len(shown) >= len(stable) // 2  # the size's are of one choice of the force


def test_baselines_that_nearly_agree_share_one_label():
    labels = plots.baseline_labels(BASELINES, "c_nl", 0.05)
    assert [value for value, _ in labels] == pytest.approx([0.14, 0.41])
    assert [words for _, words in labels] == ["$u$, $u\\,…\\,u'''$", "$u\\,…\\,u^3$"]


@pytest.mark.parametrize("name", ["ridge", "size", "pretension"])
def test_a_study_in_which_nothing_was_stable_is_drawn(unsaved, name):
    draw, tables, setup = CASES[name]
    blown = tables()
    blown[name] = blown[name].assign(c_nl=np.nan, c_m=np.nan, c_nl_se=np.nan, c_m_se=np.nan)
    blown[name]["status"] = "unstable"
    if name == "ridge":
        few = blown["ridge"][blown["ridge"]["spacing_m"] < 0.04]
        blown |= {"ridge": few, "ridge_onset": onsets(few)}
    assert marked(draw(blown, setup, "unsaved"), "unstable")


@pytest.mark.parametrize("name", ["ridge", "size", "pretension"])
def test_a_setup_without_runs_is_refused(unsaved, name):
    draw, tables, _ = CASES[name]
    with pytest.raises(ValueError, match=f"the {name} table has no run of the published setup"):
        draw(tables(), "published", "unsaved")
