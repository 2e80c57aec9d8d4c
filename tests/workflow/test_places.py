"""Where the clone, the interpreter and the results may lie."""

import re
import subprocess
import sys
import sysconfig
import venv

import pytest

from tests.workflow.conftest import SMOKE


@pytest.fixture
def elsewhere(tmp_path):
    """An interpreter in a folder with a blank, which finds what this one has."""
    venv.create(tmp_path / "my clone" / ".venv", symlinks=True)
    (site,) = (tmp_path / "my clone" / ".venv").glob("lib/python*/site-packages")
    (site / "same.pth").write_text(sysconfig.get_path("purelib"))
    return tmp_path / "my clone"


@pytest.mark.slow
def test_an_interpreter_in_a_folder_with_a_blank(smoked, elsewhere):
    target = "out/tables/described/topology.csv"
    done = subprocess.run(
        [elsewhere / ".venv/bin/python", "-m", "snakemake", target, "--force", "--cores", "1",
         *SMOKE],
        cwd=smoked.folder, env=smoked.environment, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.slow
def test_called_from_elsewhere(smoked, tmp_path, edited):
    """What is made lies there, and hangs on the code here."""
    folder, target = tmp_path / "data", "results/warmup/kirchhoff.done"
    folder.mkdir()
    environment = {key: value for key, value in smoked.environment.items() if key != "PYTHONPATH"}
    for place in (("--directory", str(folder)), ()):
        call = [sys.executable, "-m", "snakemake", target, "-s", smoked.folder / "Snakefile"]
        done = subprocess.run(
            [*call, "--cores", "1", *place],
            cwd=tmp_path if place else folder, env=environment, capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
        assert (folder / target).exists()
    assert "Nothing to be done" in done.stderr
    edited("fiberweb/engines/kirchhoff.py", "\nEDITED = True\n")
    done = subprocess.run(
        [*call, "--dry-run"], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert re.search(r"^warmup +1$", done.stdout + done.stderr, re.MULTILINE)


@pytest.mark.slow
def test_another_way_to_write_the_same_results(smoked):
    assert smoked.planned("topology", *SMOKE[:-1], "results=./out/") == {}


def test_results_on_a_disk_that_is_not_mounted_are_refused(tree):
    printed = tree.refused("topology", "--config", "results=/mnt/no such disk/out")
    assert "results = '/mnt/no such disk/out' is on a disk that is not mounted" in printed


@pytest.mark.parametrize(
    "given",
    [
        ("--configfile", "date.yaml"),
        ("--config", "results=1e3"),
        ("--config", "results=o{u}t"),
    ],
)
def test_results_that_are_no_name_are_refused_in_one_sentence(tree, given):
    (tree.folder / "date.yaml").write_text("results: 2024-01-01\n")
    *snakemakes_own, sentence = tree.refused("topology", *given).splitlines()
    assert sentence.startswith("results = ")
    assert all(line.startswith(("Using", "Config file")) for line in snakemakes_own)
