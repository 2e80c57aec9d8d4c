"""What is left after jobs or Snakemake itself were killed: the next call makes it right."""

import subprocess
import sys

import psutil
import pytest

KEYS = """
results: killed
scene: {duration: 3.3}
numerics: {accuracy: draft}
topology: {crosshatch: [2], polygon: []}
"""


def killed(tree, stage, *arguments):
    """How many jobs of a stage a call started, each of which was killed; the call must fail."""
    call = subprocess.Popen(
        [sys.executable, "-m", "snakemake", *arguments, "--cores", "2"],
        cwd=tree.folder, env=tree.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        text=True,
    )  # fmt: skip
    found = set()
    while call.poll() is None:
        for process in psutil.Process(call.pid).children(recursive=True):
            try:
                # Snakemake copies a script under another name, before it is started by a shell
                if process.name() != "bash" and process.cmdline()[-1].endswith(f".{stage}.py"):
                    process.kill()
                    found.add(process.pid)
            except (psutil.NoSuchProcess, IndexError):
                continue
        try:
            call.wait(0.02)
        except subprocess.TimeoutExpired:
            continue
    printed = call.stdout.read()
    assert call.returncode != 0, printed
    return len(found)


@pytest.mark.slow
def test_what_is_killed_after_a_change_leaves_nothing_of_the_old_config(smoked, edited):
    """Each stage in turn, by the same command, which has to come to the end of the next one."""
    config, target = smoked.folder / "killed.yaml", "killed/figures/topology.png"
    command = (target, "--configfile", "killed.yaml")
    config.write_text(KEYS)
    smoked.snakemake(*command)
    old = (smoked.folder / target).read_bytes()
    config.write_text(KEYS + "scoring: {alpha: 0.5}\n")
    assert killed(smoked, "capacity", *command) == 1
    assert killed(smoked, "table", *command) == 2  # the others do without capacities
    assert killed(smoked, "figure", *command) == 1
    smoked.snakemake(*command)
    assert (smoked.folder / target).read_bytes() != old
    assert smoked.planned(*command) == {}
    # likewise after an edit: the figure hangs on it only through tables, which are deleted
    edited("fiberweb/scoring/tables.py", "\nEDITED = True\n")
    assert killed(smoked, "table", *command) == 3
    assert smoked.planned(*command) == {"table": 3, "figure": 1}
