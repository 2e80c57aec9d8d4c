"""Sizes of files in the logs of the jobs that wrote them."""

import contextlib

import pytest

from fiberweb import origin
from fiberweb.written import broken, clear, note


@pytest.fixture
def results(tmp_path):
    """Results of one job that wrote two files."""
    results = tmp_path / "logs" / "results"  # a name that may well come twice
    log = results / "logs" / "tables" / "topology.csv.log"
    log.parent.mkdir(parents=True)
    paths = [results / "tables" / name for name in ("topology.csv", "my table, 2 bytes")]
    paths[0].parent.mkdir()
    for path in paths:
        path.write_text("a,b\n1,2\n")
    with log.open("w") as file, contextlib.redirect_stdout(file):
        print("as a job does")
        note(log, [*paths, results / "tables" / "missing.csv"])
    return results


def test_whole_files_are_whole(results):
    assert broken(results) == {}


def test_a_file_cut_short_is_named_with_its_sizes(results):
    for name in ("topology.csv", "my table, 2 bytes"):
        path = results / "tables" / name
        path.write_text("a,b\n")
        sentence = f"{path} is broken: it has 4 bytes of the 8 written"
        assert broken(results) == {str(path): sentence}
        path.unlink()  # what is not there is missing, and not broken
        assert broken(results) == {}


def test_a_table_is_made_again_where_what_lies_beside_it_is_cut_short_or_gone(results):
    table = results / "tables" / "topology.csv"
    beside = origin.beside(table)
    beside.write_text("{}")
    with (results / "logs" / "topology.log").open("w") as file, contextlib.redirect_stdout(file):
        note(results / "logs" / "topology.log", [table])
    assert broken(results, read_all=True) == {}
    beside.write_text("{")
    sentence = f"{beside} is broken: it has 1 bytes of the 2 written"
    assert broken(results) == {str(table): sentence}
    beside.unlink()
    assert broken(results) == {str(table): f"{beside} is gone"}
    table.unlink()
    assert broken(results) == {}


def test_other_content_of_the_same_size_is_found_where_all_is_read(results):
    path = results / "tables" / "topology.csv"
    path.write_text("a,b\n1,3\n")
    assert broken(results) == {}
    sentence = f"{path} is broken: its content is not what was written"
    assert broken(results, read_all=True) == {str(path): sentence}


def test_a_note_of_an_older_version_has_a_size_alone(results):
    log = results / "logs" / "tables" / "topology.csv.log"
    log.write_text("wrote tables/topology.csv, 9 bytes\n")
    assert list(broken(results, read_all=True)) == [str(results / "tables" / "topology.csv")]


def test_what_was_killed_while_it_wrote_is_cleared_and_nothing_else(results):
    table = results / "tables" / "topology.csv"
    left, other = (table.with_name(name) for name in (".topology.csv.123", ".topology.csvs.1"))
    left.touch(), other.touch()
    clear([table])
    assert table.exists() and other.exists() and not left.exists()


def test_results_that_were_moved_are_checked_where_they_are(results):
    moved = results.rename(results.with_name("moved"))
    (moved / "tables" / "topology.csv").write_text("")
    assert list(broken(moved)) == [str(moved / "tables" / "topology.csv")]


def test_a_job_at_work_has_no_note_yet(results):
    (results / "logs" / "tables" / "topology.csv.log").write_text("started\n")
    (results / "tables" / "topology.csv").write_text("")
    assert broken(results) == {}


def test_no_results_yet(tmp_path):
    assert broken(tmp_path / "nothing") == {}
