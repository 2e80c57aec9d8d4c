"""The list of calls survives what happens to its file."""

import json

import pytest

from fiberweb.provenance import add_call
from fiberweb.source import source_hash


def test_calls_are_added(tmp_path):
    laid = tmp_path / "my.yaml"
    laid.write_text("results: mine\n")
    add_call(tmp_path)
    add_call(tmp_path, [laid])
    calls = json.loads((tmp_path / "provenance.json").read_text())
    assert len(calls) == 2
    assert calls[0]["versions"]["numba"]
    assert [call["config"] for call in calls] == [{}, {str(laid): "results: mine\n"}]
    assert calls[1]["engine_source"] == source_hash()
    page = (tmp_path / "report" / "provenance.html").read_text()
    assert page.count(calls[0]["engine_source"]) == 2 and calls[1]["started"] in page


def test_a_broken_list_is_set_aside_with_a_sentence(tmp_path, capsys):
    add_call(tmp_path)
    path = tmp_path / "provenance.json"
    path.write_text(path.read_text()[:100])
    add_call(tmp_path)
    assert len(json.loads(path.read_text())) == 1
    assert f"{path} is broken" in capsys.readouterr().err
    assert len(path.with_suffix(".broken").read_text()) == 100


@pytest.mark.parametrize("text", ["null", "[1]", "{}", "5", '"calls"'])
def test_what_is_no_list_of_calls_is_set_aside(tmp_path, capsys, text):
    path = tmp_path / "provenance.json"
    path.write_text(text)
    add_call(tmp_path)
    assert len(json.loads(path.read_text())) == 1
    assert f"{path} is broken" in capsys.readouterr().err
    assert path.with_suffix(".broken").read_text() == text


def test_the_commit_is_that_of_the_code(tmp_path, monkeypatch):
    """And not of the repository in which results happen to be."""
    add_call(tmp_path / "a")
    monkeypatch.chdir(tmp_path)
    add_call(tmp_path / "b")
    a, b = (json.loads((tmp_path / x / "provenance.json").read_text()) for x in "ab")
    assert [call["commit"] for call in a] == [call["commit"] for call in b]
