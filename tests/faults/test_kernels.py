"""A folder of compiled kernels that is damaged, missing, or shared by many; no home folder."""

import os
import shutil
import signal
import subprocess
import sys
import time

import pytest

from fiberweb.engines import cache
from tests.faults.conftest import finished, one_way
from tests.workflow.conftest import ROOT

# as a user who is no root, whom the system has no name for, and whose files these are
NOBODY = ("unshare", "--user", "--map-user=12345", "--map-group=12345")
nobody = pytest.mark.skipif(
    subprocess.run([*NOBODY, "true"], capture_output=True).returncode != 0,
    reason="no user of another number can be made here",
)


@pytest.fixture
def kernels(done, tmp_path):
    """A copy of the compiled kernels; simulations of `done` look for them here."""
    place = tmp_path / "kernels"
    shutil.copytree(cache.folder(), place / cache.folder().name)
    done.environment["FIBERWEB_CACHE"] = str(place)
    return place


def logs(tree):
    return "".join(path.read_text() for path in (tree.out / "logs" / "simulate").iterdir())


def simulated_again(tree, expected, *before):
    """What a call prints that makes every response again, to the same bytes, and their logs."""
    snakemake = (sys.executable, "-m", "snakemake", "out/figures/topology.png", "--cores", "2")
    options = ("--configfile", "tiny.yaml", "--forcerun", "simulate", "warmup")
    printed = tree.call(*before, *snakemake, *options)
    assert finished(printed) == sum("response.nc" in name for name in expected)
    assert tree.made() == expected
    return printed + logs(tree) + (tree.out / "logs/warmup/kirchhoff.log").read_text()


def test_kernels_cut_short(done, expected, kernels):
    for path in kernels.rglob("*.nb?"):
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    said = simulated_again(done, expected)
    assert f"a compiled kernel in {kernels}" in said and "it is compiled anew" in said


@one_way
def test_kernels_of_another_engine_and_none_of_this(done, expected, kernels):
    """Those of the other stay as they are."""
    (ours,) = kernels.iterdir()
    other = ours.rename(kernels / "0123456789ab")
    before = {path: path.stat().st_mtime_ns for path in other.rglob("*")}
    simulated_again(done, expected)
    assert list(ours.rglob("kirchhoff.*.nbi"))
    assert {path: path.stat().st_mtime_ns for path in other.rglob("*")} == before


@nobody
@one_way
def test_kernels_that_cannot_be_kept(done, expected, kernels, tmp_path):
    """The temporary folder has them, which here has them already."""
    instead = tmp_path / "temporary" / "fiberweb-12345"
    shutil.copytree(kernels, instead)
    instead.chmod(0o700)
    for path in (kernels, *kernels.rglob("*")):
        path.chmod(0o500 if path.is_dir() else 0o400)
    done.environment["TMPDIR"] = str(instead.parent)
    done.environment["LOGNAME"] = "somebody"
    said = simulated_again(done, expected, *NOBODY)
    assert "compiled kernels cannot be kept in" in said and str(instead) in said
    assert "set FIBERWEB_CACHE to a folder that can be written" in said


@nobody
@one_way
@pytest.mark.parametrize("home", [[], ["HOME=/proc/nobody"]], ids=["none", "not there"])
def test_no_home_folder(fresh, expected, home):
    """As in a container, for a user without a name: make finds a place for all of it."""
    call = fresh.start()
    fresh.job(call, "simulate")
    os.killpg(call.pid, signal.SIGKILL)
    call.wait()
    kept = fresh.folder / ".snakemake" / "home" / ".cache" / "fiberweb" / cache.folder().name
    shutil.copytree(cache.folder(), kept)
    shutil.copy(ROOT / "Makefile", fresh.folder)
    (fresh.folder / ".venv").symlink_to(sys.prefix)
    unset = ("FIBERWEB_CACHE", "NUMBA_CACHE_DIR", "HOME", "USER", "LOGNAME")
    without = [f"--unset={name}" for name in unset]
    fresh.call(*NOBODY, "env", *without, *home, "make", "--old-file=.venv/.installed", "resume")
    assert fresh.made() == expected
    assert "cannot be kept" not in logs(fresh)


TOY = """
import time
import numba
from fiberweb.engines.jit import entry

@entry
def total(x):
    found = 0.0
    for i in range(len(x)):
        found += x[i] ** 2 + numba.float64(i)
    return found

import numpy as np
time.sleep(max(0.0, float(__import__("sys").argv[1]) - time.time()))
print(repr(float(total(np.linspace(0.0, 1.0, 1000)))))
"""


def test_sixteen_jobs_compile_into_one_folder_at_once(tmp_path):
    script = tmp_path / "toy.py"
    script.write_text(TOY)
    root = os.getcwd()
    environment = os.environ | {"FIBERWEB_CACHE": str(tmp_path / "kernels"), "PYTHONPATH": root}
    for _ in ("compiled", "loaded"):
        at = time.time() + 25.0
        jobs = [
            subprocess.Popen(
                [sys.executable, str(script), str(at)],
                env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            )
            for _ in range(16)
        ]  # fmt: skip
        said = [job.communicate() for job in jobs]
        assert len(set(said)) == 1 and said[0][1] == "", said


@one_way
def test_sixteen_jobs_compile_and_load_the_default_engine_at_once(undisturbed, tmp_path):
    """Nothing is warned of, and what they compiled serves those that come later."""
    tree, kept = undisturbed[1], tmp_path / "kernels"
    warm = "from fiberweb.engines import warmup; warmup('kirchhoff')"
    indices = []
    for _ in ("compiled", "loaded"):
        jobs = [
            subprocess.Popen(
                [sys.executable, "-c", warm], cwd=tree.folder, stderr=subprocess.PIPE,
                env=tree.environment | {"FIBERWEB_CACHE": str(kept)},
            )
            for _ in range(16)
        ]  # fmt: skip
        assert [job.communicate()[1] for job in jobs] == [b""] * 16
        assert {job.returncode for job in jobs} == {0}
        indices.append({file: file.stat().st_mtime_ns for file in kept.rglob("*.nbi")})
    assert indices[0] and indices[0] == indices[1]
