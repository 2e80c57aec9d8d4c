"""Configs of any kind end in a table of runs or in one sentence, and Snakemake reads from a file
what was looked at."""

import json
import os
import subprocess
import sys
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from snakemake.common.configfile import load_configfile

from fiberweb.arguments import plain
from fiberweb.config import load
from fiberweb.recorded import recorded
from fiberweb.runs import run_table
from fiberweb.untrusted import values
from tests.fuzz.cases import CASES, USED, damaged, is_one_sentence
from tests.fuzz.hostile import HOSTILE
from tests.workflow.conftest import ROOT
from tests.workflow.test_accepted import LEAVES, SMOKE, changes

TOKENS = [
    b"&a ", b"*a", b"<<: *a", b"<<: [*a, *a]", b"!!python/name:os.system ", b"!!float ", b"- ",
    b"? ", b"[", b"{", b"]", b"}", b": ", b"|\n", b'"', b"'", b"\\u0000", b"\\ud800", b"#", b"\t",
    b"__use_yte__: true\n", b".inf", b".nan", b"1e999", b"0x_", b"2024-13-01", b"null", b"---\n",
    b"...\n", b"%YAML 1.1\n", b"\xef\xbb\xbf", b"\xc2\x85", b"~", b"=", b"recordings: [{path: x}]",
]  # fmt: skip
SECONDS, MEGABYTES = 2.0, 500  # of CPU time, and of memory in all
SCALARS = st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=20)
ANYTHING = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner),
    max_leaves=12,
)
SMALL = [values(path) for path in SMOKE]
ALL_REFUSED = """
import sys
from fiberweb.config import load
from fiberweb.recorded import recorded
from fiberweb.runs import run_table
for path in sys.argv[3:]:
    try:
        config = load(*sys.argv[1:3], path)
        recorded(config.recordings)
        for run in run_table(config).values():
            run.check_request()
    except ValueError:
        continue
    sys.exit(path)
"""
KEYS = [*sorted(LEAVES), ("results",), ("published_tables",)]
KEYS += [("recordings", name) for name in ("path", "name", "read", "card")]


def ends(*layers):
    """Whether a config is accepted; it is refused with one sentence otherwise."""
    try:
        config = load(*layers)
        recorded(config.recordings)
        for run in run_table(config).values():
            run.check_request()
    except ValueError as error:
        assert is_one_sentence(error)
        return False
    return True


@pytest.mark.parametrize(("content", "words"), HOSTILE.values(), ids=HOSTILE)
def test_a_hostile_config_is_refused_with_the_limit_that_it_hit(tmp_path, content, words):
    path = tmp_path / "my.yaml"
    path.write_bytes(content)
    start = time.process_time()
    with pytest.raises(ValueError) as caught:
        config = load(*SMALL, path)
        recorded(config.recordings)
        for run in run_table(config).values():
            run.check_request()
    assert time.process_time() - start < SECONDS
    assert is_one_sentence(caught.value)
    assert all(word in str(caught.value) for word in words), str(caught.value)


def test_none_of_them_takes_much_memory(tmp_path):
    (configs := tmp_path / "configs").mkdir()
    for name, (content, _) in HOSTILE.items():
        (configs / name).write_bytes(content)
    child = [sys.executable, "-c", ALL_REFUSED, *SMOKE, *sorted(configs.iterdir())]
    done = subprocess.run(
        [sys.executable, "-c", USED, *child],
        cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT)}, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert float((tmp_path / "used").read_text().split()[1]) < MEGABYTES


@CASES
@given(paths=st.lists(st.sampled_from(KEYS), min_size=1, max_size=3), data=st.data())
def test_a_key_of_any_value(paths, data):
    changed: dict = {}
    for path in paths:
        value = data.draw(ANYTHING)
        if path[0] == "recordings" and path[1:]:
            changed["recordings"] = [{"path": "a.csv", path[1]: value}]
            continue
        section = changed
        for name in path[:-1]:
            section = section.setdefault(name, {})
        section[path[-1]] = value
    ends(*SMALL, changed)


@CASES
@given(changed=changes())
def test_values_near_those_of_a_config(changed):
    ends(*SMALL, changed)


@CASES
@given(data=st.data())
def test_a_file_of_damaged_text(tmp_path_factory, data):
    """What Snakemake makes of a file that passes is what was checked."""
    path = tmp_path_factory.getbasetemp() / "damaged.yaml"
    changed = data.draw(changes())
    text = json.dumps(changed).encode() if data.draw(st.booleans()) else SMOKE[1].read_bytes()
    path.write_bytes(data.draw(damaged(text, TOKENS)))
    try:
        held = values(path)
    except ValueError as error:
        assert is_one_sentence(error)
        return
    if isinstance(held, dict):
        assert repr(plain(load_configfile(path))) == repr(plain(held))
    ends(*SMALL, path)
