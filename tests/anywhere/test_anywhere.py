"""The same bytes wherever clone and results lie, whoever calls, whatever the machine is set to."""

import glob
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from tests.workflow.conftest import ROOT, Tree

KEYS = """
scene: {duration: 3.3}
numerics: {accuracy: draft}
topology: {crosshatch: [2], polygon: []}
"""
MADE = ("figures/topology.png", "tables/described/topology.csv")
RAM = Path("/dev/shm")


class Clone:
    """A clone, with a config beside it, and snakemake on it."""

    def __init__(self, folder):
        folder.mkdir(parents=True)
        self.folder = Tree(folder).folder
        self.keys = folder / "tiny.yaml"
        self.keys.write_text(KEYS)

    def call(self, results, *more, target=None, python=sys.executable):
        """The command that makes the figure; results None: those of the config."""
        named = ("--config", f"results={results}") if results else ()
        target = target or f"{results}/{MADE[0]}"
        return [str(python), "-m", "snakemake", target, "--cores", "2",
                "--configfile", str(self.keys), *named, *more]  # fmt: skip

    def run(self, command, at=None, **environment):
        """Run it in a folder (the clone); it must succeed."""
        own = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        done = subprocess.run(
            list(map(str, command)), cwd=at or self.folder, env=own | environment,
            capture_output=True, text=True,
        )  # fmt: skip
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout + done.stderr


def made(results):
    return [(Path(results) / name).read_bytes() for name in MADE]


@pytest.fixture(scope="session")
def plain(tmp_path_factory):
    """What a clone in a plain folder makes."""
    clone = Clone(tmp_path_factory.mktemp("plain") / "clone")
    clone.run(clone.call("out"))
    return made(clone.folder / "out")


@pytest.fixture
def clone(tmp_path):
    return Clone(tmp_path / "clone")


def test_a_folder_with_blanks_and_other_letters(plain, tmp_path):
    clone = Clone(tmp_path / "mein Klon, été 蜘蛛")
    clone.run(clone.call("out put/é"))
    assert made(clone.folder / "out put/é") == plain


@pytest.mark.skipif(not RAM.is_dir(), reason="there is no second disk")
def test_results_on_another_disk(plain, clone, tmp_path):
    results = RAM / f"fiberweb-{os.getpid()}"
    assert os.stat(RAM).st_dev != os.stat(tmp_path).st_dev
    try:
        clone.run(clone.call(results))
        assert made(results) == plain
    finally:
        shutil.rmtree(results, ignore_errors=True)


def test_results_behind_a_link(plain, clone, tmp_path):
    (tmp_path / "elsewhere").mkdir()
    (clone.folder / "results").symlink_to(tmp_path / "elsewhere", target_is_directory=True)
    clone.run(clone.call("results"))
    assert made(tmp_path / "elsewhere") == plain
    assert "Nothing to be done" in clone.run(clone.call("results", "--dry-run"))


@pytest.mark.parametrize("given", ["-s", "--directory"])
def test_called_from_elsewhere(plain, clone, tmp_path, given):
    work = tmp_path / "work"
    work.mkdir()
    place = ("--directory", str(work)) if given == "--directory" else ()
    command = clone.call("out", "-s", clone.folder / "Snakefile", *place)
    clone.run(command, at=tmp_path if place else work)
    assert made(work / "out") == plain


@pytest.mark.skipif(
    subprocess.run(["unshare", "--mount", "true"], capture_output=True, check=False).returncode
    != 0,
    reason="only root may mount",
)
def test_a_clone_that_cannot_be_written(plain, clone, tmp_path):
    work = tmp_path / "work"
    work.mkdir()
    tree = clone.folder
    mount = (
        'mount --bind "$0" "$0" && mount -o remount,ro,bind "$0" && ! touch "$0/it" && exec "$@"'
    )
    command = clone.call("out", "-s", tree / "Snakefile", "--directory", work)
    clone.run(["unshare", "--mount", "bash", "-c", mount, tree, *command], at=work)
    assert made(work / "out") == plain
    assert not (tree / ".snakemake").exists()


def test_a_config_of_another_system(plain, clone):
    text = f"results: out\n{KEYS}".replace("\n", "\r\n")
    clone.keys.write_bytes(b"\xef\xbb\xbf" + text.encode())
    clone.run(clone.call(None, target=f"out/{MADE[0]}"))
    assert made(clone.folder / "out") == plain


def test_a_matplotlibrc_of_ones_own(plain, clone):
    (clone.folder / "matplotlibrc").write_text("text.usetex: True\nfont.size: 30\n")
    clone.run(clone.call("out"))
    assert made(clone.folder / "out") == plain


def test_a_machine_that_knows_ascii_alone(plain, tmp_path):
    clone = Clone(tmp_path / "été")
    plainest = {"LANG": "C", "LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    clone.run(clone.call("out"), **plainest)
    assert made(clone.folder / "out") == plain


def test_two_versions_on_one_machine_at_once(plain, clone, tmp_path):
    other = Clone(tmp_path / "other")
    edited = other.folder / "fiberweb" / "engines" / "kirchhoff.py"
    edited.write_text(edited.read_text() + "\nANOTHER_VERSION = True\n")
    shared = os.environ | {"FIBERWEB_CACHE": str(tmp_path / "cache")}
    calls = [
        subprocess.Popen(each.call("out"), cwd=each.folder, env=shared, text=True,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        for each in (clone, other)
    ]  # fmt: skip
    for call in calls:
        printed, _ = call.communicate()
        assert call.returncode == 0, printed
    assert made(clone.folder / "out") == made(other.folder / "out") == plain
    assert len(list((tmp_path / "cache").iterdir())) == 2


def interpreter(version):
    """The path of a Python, or None."""
    found = glob.glob(f"{Path.home()}/.pyenv/versions/{version}.*/bin/python")
    return found[-1] if found else shutil.which(f"python{version}")


@pytest.mark.parametrize("version", ["3.11", "3.12", "3.13"])
def test_python(plain, tmp_path, version):
    if (python := interpreter(version)) is None:
        pytest.skip(f"there is no Python {version}")
    clone = Clone(tmp_path / "clone")
    shutil.copy(ROOT / "Makefile", clone.folder)
    clone.run(["make", "env", f"PYTHON={python}"])
    clone.run(clone.call("out", python=clone.folder / ".venv" / "bin" / "python"))
    table = pd.read_csv(clone.folder / "out" / MADE[1])
    assert list(table["status"]) == ["ok"]
    assert made(clone.folder / "out") == plain
