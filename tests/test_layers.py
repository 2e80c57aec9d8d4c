"""A key given twice in a file is refused; the command line gives what a file would."""

import pytest

from fiberweb.config import load
from fiberweb.layers import check_call, read, typed
from fiberweb.untrusted import called
from tests.workflow.conftest import within_a_call

TWICE = {
    "yaml": ("scene:\n  duration: 20\n  seed: 1\n  duration: 30\n", "scene.duration", "2 and 4"),
    "sections": ("scene: {seed: 1}\nridge: {n: 3}\nscene: {tension: 1.0}\n", "scene", "1 and 3"),
    "one line": ("scene: {seed: 1, seed: 1}", "scene.seed", "1"),
    "in a list": ("ridge:\n  force: [{a: 1, a: 2}]\n", "ridge.force.a", "2"),
    "deep": ("setups:\n  published:\n    ends: null\n    'ends': pinned\n",
             "setups.published.ends", "3 and 4"),
    "json by tabs": ('{"scene": {\n\t"seed": 1,\n\t"seed": 2}}', "scene.seed", "2 and 3"),
    "byte-order mark": ("\ufeffscene: {seed: 1}\r\nscene: {seed: 2}\r\n", "scene", "1 and 2"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "key", "lines"), TWICE.values(), ids=TWICE)
def test_a_key_given_twice_is_refused_with_its_lines(tmp_path, text, key, lines):
    path = tmp_path / "my.yaml"
    path.write_text(text, encoding="utf-8", newline="")
    with pytest.raises(ValueError, match=rf"my\.yaml gives {key} twice, in lines? {lines}: keep"):
        read(path)


def test_a_config_that_gives_a_key_twice_is_not_loaded(tmp_path):
    path = tmp_path / "my.yaml"
    path.write_text(TWICE["sections"][0])
    with pytest.raises(ValueError, match="gives scene twice"):
        load(path)


def test_the_same_key_in_two_groups_or_below_an_anchor_is_fine(tmp_path):
    path = tmp_path / "my.yaml"
    path.write_text("size: &a {n: [2]}\nnoise: *a\nrobustness:\n  n: [2]\n")
    assert read(path) == {"size": {"n": [2]}, "noise": {"n": [2]}, "robustness": {"n": [2]}}


@pytest.mark.parametrize("text", ["scene: {seed: 1", "scene:\n\tseed: 1", "a: b: c"])
def test_what_is_no_yaml_is_one_sentence(tmp_path, text):
    path = tmp_path / "my.yaml"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"my\.yaml is no YAML: [^\n]* in line \d") as caught:
        read(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("20", 20), ("2.5", 2.5), ("1e-3", 1e-3), ("1.0e+8", 1e8), (".inf", float("inf")),
        ("true", True), ("null", None), ("", None), ("clamped", "clamped"),
        ("2024-01-01", "2024-01-01"), ("{a", "{a"),
        ("2024-99-99", "2024-99-99"), ("[" * 3000, "[" * 3000), ("1:30", "1:30"), ("010", "010"),
        ("1" + ":1" * 2000 + ".0", "1" + ":1" * 2000 + ".0"), ("9" * 5000, "9" * 5000),
    ],
)  # fmt: skip
def test_what_the_command_line_gives_within_a_group_is_what_a_file_would(text, value):
    given = {"results": "1e3", "scene": {"key": text, "list": [text], "group": {"key": text}}}
    group = {"key": value, "list": [value], "group": {"key": value}}
    assert typed(given) == {"results": "1e3", "scene": group}


@pytest.mark.parametrize(
    ("call", "key"),
    [
        (["--config", "scene={seed: 1, seed: 2}"], "scene.seed"),
        (["-C", "results=a", "scene={seed: 1}", "scene={seed: 2}", "--dry-run"], "scene.seed"),
        (["-nC", "results=a", "results=b"], "results"),
        (["--config", "setups={published: {ends: null, 'ends': pinned}}"], "setups.published.ends"),
    ],
)
def test_a_key_given_twice_on_the_command_line_is_refused(call, key):
    with pytest.raises(ValueError, match=rf"--config gives {key} twice: keep one of them"):
        within_a_call(check_call, ["figures", *call])


def test_groups_in_parts_and_other_options_are_no_key_twice():
    call = ["--config", "scene={seed: 1}", "scene={duration: 2}", "results={a", "n=[1, 1]"]
    others = ("--set-threads", "simulate=2", "--set-resources", "simulate:mem_mb=2")
    within_a_call(check_call, [*call, *others])


def test_snakemake_as_a_library_has_no_command_line_to_check():
    with pytest.raises(LookupError):
        called()
    assert check_call() is None
