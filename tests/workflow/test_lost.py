"""Jobs killed, Snakemake killed, files cut short: the same command makes it right."""

import os
import re
import signal
import subprocess
import sys
import time

import psutil
import pytest

from tests.workflow.conftest import SMOKE

KEYS = """
results: tiny
scene: {duration: 3.3}
numerics: {accuracy: draft}
topology: {crosshatch: [2], polygon: []}
"""
FIGURE = "tiny/figures/topology.png"
RULES = {
    "warmup", "simulate", "capacity", "table", "ridge_best", "figure", "animation", "setup_claims",
    "page",
}  # fmt: skip
COMMAND = (FIGURE, "--configfile", "tiny.yaml")


@pytest.fixture
def tiny(smoked):
    """The tree after the smallest of runs."""
    (smoked.folder / "tiny.yaml").write_text(KEYS)
    smoked.snakemake(*COMMAND)
    return smoked


def start(tree, *arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "snakemake", *arguments, "--cores", "2"],
        cwd=tree.folder, env=tree.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True, start_new_session=True,
    )  # fmt: skip


def scripts(call, stage):
    """Processes that a call started for jobs of a stage."""
    for process in psutil.Process(call.pid).children(recursive=True):
        try:
            # Snakemake gives it a name such as .snakemake/scripts/tmp1234.table.py
            if process.name() != "bash" and process.cmdline()[-1].endswith(f".{stage}.py"):
                yield process
        except (psutil.NoSuchProcess, IndexError):
            continue


def killed(tree, stage, *arguments):
    """How many jobs of a stage a call started, each of which was killed; the call must fail."""
    call, found = start(tree, *arguments), set()
    while call.poll() is None:
        for process in scripts(call, stage):
            process.kill()
            found.add(process.pid)
        time.sleep(0.1)  # a script takes longer to start, and a look is not free
    assert call.returncode != 0, call.stdout.read()
    return len(found)


@pytest.mark.slow
def test_files_cut_short_are_named_and_made_again(tiny):
    out = tiny.folder / "tiny"
    (run,) = (out / "runs").iterdir()
    broken = [run / "response.nc", run / "capacity.nc", out / "tables/described/topology.csv"]
    whole = [path.read_bytes() for path in broken]
    for path, content in zip(broken, whole, strict=True):
        # a table in the middle of a line's end, where nobody sees it
        path.write_bytes(content[: content.rindex(b"\n", 0, -1) + 1])
    calls = out / "provenance.json"
    calls.write_text(calls.read_text()[:-40])
    printed = tiny.snakemake(*COMMAND)
    for path in (*broken, calls):
        assert re.search(rf"{path.relative_to(tiny.folder)} is broken", printed), printed
    assert [path.read_bytes() for path in broken] == whole
    assert calls.read_text().startswith("[")
    assert "broken" not in tiny.snakemake(*COMMAND)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pattern", "target", "expected"),
    [
        ("runs/crosshatch-n04*-f50.0mN-*/response.nc", "features", {"simulate": 1, "capacity": 1}),
        ("tables/described/ridge_best.csv", "size", {"ridge_best": 1}),  # a checkpoint
        ("figures/noise.png", "noise", {"figure": 1}),
    ],
)
def test_a_file_cut_short_blocks_nothing_else(smoked, pattern, target, expected):
    (path,) = (smoked.folder / "out").glob(pattern)
    content, stat = path.read_bytes(), path.stat()
    path.write_bytes(content[:20])
    try:
        printed = smoked.snakemake("topology", "--dry-run", *SMOKE)
        assert f"{path.relative_to(smoked.folder)} is broken: it has 20 bytes" in printed
        assert "Nothing to be done" in printed
        planned = smoked.planned(target, *SMOKE)
        assert planned[target] == 1 and expected.items() <= planned.items()
    finally:
        path.write_bytes(content)
        os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))


@pytest.mark.slow
def test_after_snakemake_was_killed(tiny):
    call = start(tiny, *COMMAND, "--forcerun", "capacity")
    while not list(scripts(call, "capacity")):
        assert call.poll() is None, call.stdout.read()
        time.sleep(0.02)
    os.killpg(call.pid, signal.SIGKILL)
    call.wait()
    # as people type it, without --cores
    for asked in (("--unlock",), ("--summary",), ("--dag",), ("--report", "tiny/report.html")):
        done = subprocess.run(
            [sys.executable, "-m", "snakemake", FIGURE, *asked, "--configfile", "tiny.yaml"],
            cwd=tiny.folder, env=tiny.environment, capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        if asked == ("--unlock",):
            tiny.snakemake(*COMMAND, "--forcerun", "capacity")
    assert (tiny.folder / "tiny" / "report.html").stat().st_size > 1e5


@pytest.mark.slow
def test_a_job_that_fails_is_told_on_the_last_line(tiny, edited):
    edited("fiberweb/studies/topology/figure.py", "\nraise ValueError('ink = 0: give more')\n")
    call = start(tiny, *COMMAND)
    printed, _ = call.communicate()
    assert call.returncode == 1
    log = "tiny/logs/figures/topology.log"
    assert printed.splitlines()[-1] == (
        f"figure topology failed: ValueError: ink = 0: give more. Log: {log}. "
        "What to do: change what it names, then give the same command again."
    )
    assert "Traceback (most recent call last)" in (tiny.folder / log).read_text()


@pytest.mark.slow
def test_every_log_says_what_is_done_how_long_it_takes_and_what_was_chosen(tiny):
    shown = "tiny/report/tables/described/topology.csv.html"
    tiny.snakemake(shown, *COMMAND[1:])
    assert "<td>kirchhoff</td>" in (tiny.folder / shown).read_text()
    folders = [tiny.folder / out / "logs" for out in ("tiny", "out")]
    logs = {path: folder for folder in folders for path in folder.rglob("*/*.log")}
    assert {path.relative_to(folder).parts[0] for path, folder in logs.items()} == {
        "warmup", "simulate", "capacity", "tables", "figures", "claims", "report"
    }  # fmt: skip
    for path in logs:
        lines = path.read_text().splitlines()
        rule, _, does = lines[0].partition(": ")
        assert rule in RULES and re.match(r"\w", does), path
        (taken,) = [at for at, line in enumerate(lines) if re.match(r"takes: \w", line)]
        chosen = [line for line in lines[taken + 1 :] if re.match(r"\w[\w ]*: ?\S", line)]
        assert chosen or rule == "warmup", path
        assert lines[-1].startswith("took "), path


@pytest.mark.slow
def test_the_last_line_names_what_was_made_and_nothing_else(tiny):
    printed = tiny.snakemake("tiny/tables/described/topology.csv", "--force", *COMMAND[1:])
    assert re.findall("^Done: .*", printed, re.M) == ["Done: 1 file in tiny/tables/described."]


@pytest.mark.slow
def test_what_is_killed_after_a_change_leaves_nothing_of_the_old_config(tiny, edited):
    """Each stage in turn, by the same command, which has to come to the end of the next one."""
    old = (tiny.folder / FIGURE).read_bytes()
    (tiny.folder / "tiny.yaml").write_text(KEYS + "scoring: {alpha: 0.5}\n")
    assert killed(tiny, "capacity", *COMMAND) == 1
    assert killed(tiny, "table", *COMMAND) == 2  # the others do without capacities
    assert killed(tiny, "figure", *COMMAND) == 1
    assert "Done: 2 files in tiny/figures.\n" in tiny.snakemake(*COMMAND)
    assert (tiny.folder / FIGURE).read_bytes() != old
    assert tiny.planned(*COMMAND) == {}
    # likewise after an edit: the figure hangs on it only through tables, which are deleted
    edited("fiberweb/scoring/tables.py", "\nEDITED = True\n")
    assert killed(tiny, "table", *COMMAND) == 3
    assert tiny.planned(*COMMAND) == {"table": 3, "figure": 1}
