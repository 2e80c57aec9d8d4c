"""What Snakemake itself would choke on, or run, is refused before Snakemake reads it."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from fiberweb.untrusted import guard
from tests.fuzz.cases import USED
from tests.fuzz.hostile import HOSTILE, LAUGHS
from tests.workflow.conftest import within_a_call

ROOT = Path(__file__).parents[2]
SECONDS, MEGABYTES = 2.0, 500  # of CPU time beyond a call that does nothing, and in all
OBEYED = b"""__use_yte__: true
__definitions__: ["import os; os.mkdir('harm')"]
results: ?os.mkdir('harm')
"""


def called(folder, *options, snakefile=("--snakefile", ROOT / "Snakefile")):
    """What a dry run from another folder that has to fail prints, and its CPU time (s) and memory
    (MB)."""
    command = [sys.executable, "-m", "snakemake", "topology", "-n", "--cores", "1"]
    done = subprocess.run(
        [sys.executable, "-c", USED, *command, *snakefile, *options],
        cwd=folder, env=os.environ | {"PYTHONPATH": str(ROOT)}, text=True,
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    assert done.returncode == 1
    return done.stdout, *map(float, (folder / "used").read_text().split())


@pytest.fixture(scope="module")
def start(tmp_path_factory):
    """CPU time that Snakemake takes to start (s)."""
    text, seconds, _ = called(tmp_path_factory.mktemp("start"), "--configfile", "missing.yaml")
    assert "missing.yaml is no file" in text
    return seconds


@pytest.mark.parametrize(
    ("content", "words"),
    [(OBEYED, ["__use_yte__"]), HOSTILE["merge keys"], HOSTILE["100 MB"]],
    ids=["template", "merge keys", "100 MB"],
)
def test_a_file_is_refused_before_it_is_read(tmp_path, start, content, words):
    (tmp_path / "my.yaml").write_bytes(content)
    text, seconds, megabytes = called(tmp_path, "--configfile", "my.yaml")
    sentence = text.splitlines()[-1]
    assert len(text.splitlines()) == 2 and all(word in sentence for word in words), text
    assert not (tmp_path / "harm").exists()
    assert megabytes < MEGABYTES and seconds < start + SECONDS, (megabytes, seconds)


def test_options_in_one_and_a_linked_snakefile_hide_nothing(tmp_path):
    (tmp_path / "my.yaml").write_bytes(OBEYED)
    text, _, _ = called(tmp_path, "--configfile", "my.yaml", snakefile=[f"-ns{ROOT}/Snakefile"])
    assert "has __use_yte__" in text and not (tmp_path / "harm").exists()
    (tmp_path / "Snakefile").symlink_to(ROOT / "Snakefile")
    (tmp_path / "profiles").symlink_to(ROOT / "profiles")
    text, _, _ = called(tmp_path, "--configfile", "my.yaml", snakefile=[])
    assert "has __use_yte__" in text and not (tmp_path / "harm").exists()


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (["--configfile", "bomb.yaml", "--config", "results=x"], "10000 keys and values"),
        (["-n", "--configfiles", "missing.yaml"], "missing.yaml is no file"),
        (["--configfile=bomb.yaml", "--", "figures"], "10000 keys and values"),
        (["-C", f"scene={{{LAUGHS.decode().replace(chr(10), ', ')}}}"], "--config holds more than"),
        (["-nC", "scene=" + "[" * 100], "--config has more than 20 groups"),
        (["-pkC", "scene={seed: 0x10}"], "0x10, which YAML reads as hexadecimal: write"),
        (["--configfile", "empty.yaml"], "empty.yaml holds no keys"),
        (["--configfile", "no\nsuch.yaml"], r"'no\nsuch.yaml' is no file"),
        (["--config", "results=x", "scene=" + "[" * 100], "--config has more than 20 groups"),
        (["--config", "scene={seed: !!int 1}"], "--config has the tag"),
        (["--config", "a={b: &x {c: 1}, d: *x, b: 2}"], "--config gives a.b twice: keep"),
    ],
)
def test_a_call_in_any_spelling(tmp_path, monkeypatch, call, words):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bomb.yaml").write_bytes(LAUGHS)
    (tmp_path / "empty.yaml").write_text("# nothing\n")
    with pytest.raises(SystemExit) as caught:
        within_a_call(guard, ["topology", *call])
    assert words in str(caught.value.code)


def test_an_honest_call_passes(tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT)
    within_a_call(guard, ["topology", "--configfile", "config/smoke.yaml", "config/config.yaml"])
    config = ("results=a", "scene={seed: 1}", "published_all=True")
    within_a_call(guard, ["--config", *config, "-n"])
