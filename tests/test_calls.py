"""Which call is gone on with, and when it is not."""

import os
import subprocess
import sys
from subprocess import CompletedProcess as ended

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


def begun(*arguments, directory=None):
    """The note of a call that has ended since."""
    note = calls.begin(arguments, directory)
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


@pytest.mark.parametrize("text", ["{", "[]", "5", '{"arguments": []}', '{"arguments": null}'])
def test_a_note_that_says_nothing_is_none(folder, text):
    note = begun("figures")
    note.write_text(text)  # `{`: of a disk that was full
    assert calls.unfinished() is None and not note.exists()


def test_the_files_that_a_call_names_are_seen_from_where_it_was_given_every_time(
    folder, tmp_path_factory, monkeypatch
):
    """With `--directory`, Snakemake works in another folder than the one of the shell."""
    shell, given = str(tmp_path_factory.mktemp("shell")), []
    monkeypatch.setenv("PWD", shell)
    begun("figures", f"-d{folder}", "--configfile", "my.yaml", directory=folder)
    monkeypatch.setenv("PWD", str(folder))  # where it is resumed from

    def run(command, cwd, env):
        given.append((cwd, env["PWD"]))
        return subprocess.CompletedProcess(command, 1)

    monkeypatch.setattr(subprocess, "run", run)
    assert resume.main() == 1
    assert given == [(shell, shell)]


@pytest.mark.parametrize("looked", [["--dry-run"], ["--dryr"], ["-n"], ["-pn"], ["--unlock"]])
def test_a_call_that_only_looks_is_not_the_end_of_it(folder, monkeypatch, looked):
    note = begun("figures", "--cores", "2")
    monkeypatch.setattr(subprocess, "run", lambda command, **_: ended(command, 0))
    monkeypatch.setattr("sys.argv", ["resume", *looked])
    assert resume.main() == 0 and note.exists()
    monkeypatch.setattr("sys.argv", ["resume", "--cores", "8"])
    assert resume.main() == 0 and not note.exists()


def test_options_are_added_before_targets_that_stand_alone(folder, monkeypatch):
    begun("--config", "a=1", "--", "figures")
    calls.SNAKEMAKES.mkdir(parents=True)
    given = []
    monkeypatch.setattr(subprocess, "run", lambda command, **_: ended(given.append(command[3:]), 0))
    monkeypatch.setattr("sys.argv", ["resume", "--cores", "8"])
    assert resume.main() == 0
    call = ["--config", "a=1", "--cores", "8"]
    assert given == [[*call, "--unlock", "--", "figures"], [*call, "--", "figures"]]


def test_jobs_in_the_queue_of_a_cluster_are_at_work(folder, monkeypatch):
    squeue = folder / "bin" / "squeue"
    squeue.parent.mkdir()
    squeue.write_text(f"#!/bin/sh\necho 7 /another/folder\necho 12 {folder}\n")
    squeue.chmod(0o755)
    monkeypatch.setenv("PATH", str(squeue.parent), prepend=os.pathsep)
    begun("figures")
    assert calls.at_work(calls.unfinished()[1]) is None
    begun("figures", "--profile", "profiles/slurm")
    assert "`scancel 12`, before it is resumed" in calls.at_work(calls.unfinished()[1])


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
