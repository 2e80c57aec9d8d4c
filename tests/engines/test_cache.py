"""Compiled kernels are those of the sources, wherever they are kept and whatever happens there."""

import importlib.util
import os
import shutil
import subprocess
import sys
import warnings

import numba
import pytest

from fiberweb import source
from fiberweb.engines import cache, jit

CALLER = """
from fiberweb.engines.jit import entry
from fiberweb.engines.toy_callee import value

@entry
def call():
    return value()
"""
CALLEE = """
from fiberweb.engines.jit import kernel

@kernel
def value():
    return 1
"""
TOY = """
from fiberweb.engines.jit import entry

@entry
def square(x):
    return x * x
"""


@pytest.mark.slow
def test_an_edited_kernel_runs_and_clones_share_it_though_the_place_is_given(tmp_path):
    """As clusters do; its caller is in another file, which did not change."""
    package = shutil.copytree(source.ROOT, tmp_path / "fiberweb")
    engines = package / "engines"
    (engines / "toy_caller.py").write_text(CALLER)
    with (engines / "stepping.py").open("a") as file:  # so that responses depend on it
        file.write("\nfrom fiberweb.engines import toy_callee as toy_callee\n")
    environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / "c")}
    environment.pop("FIBERWEB_CACHE", None)
    asked = "from fiberweb.engines.toy_caller import call;print(call(), len(call.stats.cache_hits))"

    def printed(folder):
        done = subprocess.run(
            [sys.executable, "-c", asked],
            cwd=folder, env=environment, capture_output=True, text=True,
        )  # fmt: skip
        return done.stdout or done.stderr

    for value in ("1", "2"):
        (engines / "toy_callee.py").write_text(CALLEE.replace("1", value))
        assert printed(tmp_path) == f"{value} 0\n"
    assert len(list((tmp_path / "c").iterdir())) == 2  # one folder for each state of the sources
    shutil.copytree(package, tmp_path / "clone" / "fiberweb")
    assert printed(tmp_path / "clone") == "2 1\n"  # compiled for the other, of the same sources


@pytest.mark.parametrize("given", ["FIBERWEB_CACHE", "NUMBA_CACHE_DIR", "HOME"])
def test_the_folder_belongs_to_the_sources(tmp_path, monkeypatch, given):
    for name in ("FIBERWEB_CACHE", "NUMBA_CACHE_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv(given, str(tmp_path))
    folder = cache.folder()
    assert folder.is_dir() and folder.is_relative_to(tmp_path)
    assert folder.name == source.source_hash()


def test_a_place_that_cannot_be_written(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    monkeypatch.setenv("FIBERWEB_CACHE", str(tmp_path / "file" / "cache"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.warns(UserWarning, match="cannot be kept in .*/file/cache/"):
        folder = cache.folder()
    assert folder.is_dir() and folder.parent.parent == tmp_path
    assert folder.name == source.source_hash()
    assert folder.parent.stat().st_mode & 0o077 == 0


def test_a_home_folder_that_the_system_does_not_know(tmp_path, monkeypatch):
    monkeypatch.setenv("FIBERWEB_CACHE", "~nobody-of-this-name/cache")
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.warns(UserWarning, match="cannot be kept in ~nobody-of-this-name/cache/"):
        assert cache.folder().is_dir()


def test_a_temporary_place_of_somebody_else_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    theirs = cache._temporary()
    theirs.chmod(0o777)
    assert cache._temporary() != theirs


def test_kernels_are_kept_there_though_numba_was_imported_before():
    assert numba.config.CACHE_DIR.endswith(source.source_hash())
    assert jit.kernel(lambda: 1)._cache.cache_path.startswith(numba.config.CACHE_DIR)


@pytest.mark.parametrize("suffix", ["nbi", "nbc"])
@pytest.mark.parametrize("left", [0, 10, -10])
def test_a_broken_file_is_compiled_anew(tmp_path, monkeypatch, suffix, left):
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "cache"))
    (tmp_path / "toy.py").write_text(TOY)
    spec = importlib.util.spec_from_file_location("toy", tmp_path / "toy.py")

    def loaded():
        """A call's result, and whether it came from the cache."""
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module.square(3), sum(module.square.stats.cache_hits.values())

    assert loaded() == (9, 0) and loaded() == (9, 1)
    (path,) = (tmp_path / "cache").rglob(f"*.{suffix}")
    path.write_bytes(path.read_bytes()[:left])
    with pytest.warns(UserWarning, match="cannot be read"):
        assert loaded() == (9, 0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert loaded() == (9, 1)
