"""Where files lie, and what is told of them."""

import pytest

from fiberweb import studies
from fiberweb.config import load
from fiberweb.files import Files
from fiberweb.folders import tables_in
from fiberweb.recorded import findings
from fiberweb.studies.base import Figure

FILES = Files(load({"results": "out"}))


def test_a_table_of_a_setup_and_one_of_none():
    assert FILES.table("ridge_best.csv", "compliant") == "out/tables/compliant/ridge_best.csv"
    assert FILES.table("energy_drift.csv", "described") == "out/tables/energy_drift.csv"


def test_figures_of_the_described_setup_have_no_suffix():
    names = [FILES.figure("size", setup) for setup in ("described", "published")]
    assert names == ["out/figures/size.png", "out/figures/size-published.png"]


def test_runs_are_counted_together_and_other_files_by_folder():
    made = ["out/runs/a/response.nc", "out/runs/b/capacity.nc", "out/figures/size.png"]
    assert FILES.counted(made) == "1 file in out/figures, 2 files in out/runs"


def test_a_file_that_no_study_makes_is_one_sentence(monkeypatch):
    figures = {"ridge": Figure("a.module:draw", ("rigde.csv",))}
    monkeypatch.setattr(studies.load("ridge"), "FIGURES", figures)
    with pytest.raises(ValueError, match=r"no study makes the table rigde\.csv: .*'ridge\.csv'"):
        Files(load())


def test_a_caption_names_the_setup():
    caption = studies.caption("size", "published")
    assert "published" in caption and "{{" not in caption


def test_what_is_not_in_order_with_a_recording(tmp_path):
    path = tmp_path / "sanity.csv"
    path.write_text('severity,sentence\nok,the clock\nwarning,"a gap, of 3"\n')
    assert list(findings({"take": path})) == ["take: warning: a gap, of 3"]


def test_tables_of_a_folder(tmp_path):
    for name in ("b.csv", "a.csv", "c.txt"):
        (tmp_path / name).touch()
    assert tables_in(str(tmp_path)) == [str(tmp_path / name) for name in ("a.csv", "b.csv")]
    assert tables_in(None) == []
