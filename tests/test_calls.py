"""Which call is gone on with, and when it is not."""

import os
import subprocess
import sys

import pytest

from fiberweb import calls
from fiberweb.tools import resume

HOLD = "from fiberweb import calls; calls.{}; print(flush=True); input()"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(calls, "_held", [])
    monkeypatch.setattr("sys.argv", ["resume"])
    monkeypatch.setenv("PYTHONPATH", str(calls.__file__).rpartition("/fiberweb/")[0])
    return tmp_path


def begun(*arguments):
    """The note of a call that has ended since."""
    note = calls.begin(arguments)
    calls._held.clear()
    return note


def busy(what):
    """Another process that is at work."""
    other = subprocess.Popen(
        [sys.executable, "-c", HOLD.format(what)],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    )  # fmt: skip
    other.stdout.readline()
    return other


def test_where_nothing_was_called_nothing_is_resumed(folder, capsys):
    assert resume.main() == 0
    assert "there is nothing to resume" in capsys.readouterr().out
    assert list(folder.iterdir()) == []


def test_the_last_call_that_did_not_end_well(folder):
    first, second = begun("figures"), begun("topology", "--cores", "2")
    os.utime(first, (0, 0))
    assert calls.unfinished()[1]["arguments"] == ["topology", "--cores", "2"]
    second.unlink()  # as after it ended well
    assert calls.unfinished()[1]["arguments"] == ["figures"]
    assert begun("figures") == first
    first.write_text("{")  # of a disk that was full
    assert calls.unfinished() is None


@pytest.mark.parametrize(
    ("what", "said"),
    [("begin(['twin'])", "`snakemake twin` is at work"), ("join()", "jobs are still")],
)
def test_nobody_is_disturbed(folder, what, said):
    begun("figures")
    other = busy(what)
    with pytest.raises(SystemExit, match=said) as refused:
        resume.main()
    assert str(other.pid) in str(refused.value)
    other.communicate("\n")
    assert calls.at_work(calls.unfinished()[1]) is None


def test_a_lock_of_another_machine_is_left_alone(folder):
    begun("figures")
    _, call = calls.unfinished()
    assert calls.at_work(call | {"host": "login2"}) is None
    calls.SNAKEMAKES.mkdir(parents=True)
    assert "locked by a call on login2" in calls.at_work(call | {"host": "login2"})
