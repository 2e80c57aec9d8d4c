"""docs/own-network.md does what it says."""

import ast
import re

import matplotlib as mpl
import matplotlib.image
import numpy as np
import pytest
import yaml

from fiberweb.config import load
from fiberweb.runs import check, run_table, runs
from tests.workflow.conftest import ROOT

PAGE = (ROOT / "docs" / "own-network.md").read_text(encoding="utf-8")


def blocks(kind):
    return re.findall(rf"```{kind}\n(.*?)```", PAGE, re.DOTALL)


@pytest.fixture(scope="module")
def names(tmp_path_factory):
    """What the page's code leaves."""
    folder, names = tmp_path_factory.mktemp("page"), {}
    with pytest.MonkeyPatch.context() as patch, mpl.rc_context():
        patch.chdir(folder)
        mpl.use("agg")
        for block in blocks("python"):
            for statement in ast.parse(block).body:  # as if typed, where an indented one would
                assert not hasattr(statement, "body")  # need a line without anything after it
            exec(block, names)
    return names | {"folder": folder}


def test_the_code_of_the_page_runs(names):
    assert names["response"].attrs["status"] == "ok"
    assert names["response"].attrs["energy_residual"] < 1e-6
    assert len(names["totals"]) == 3
    c = [float(scored.c_m) for scored in names["totals"].values()]
    assert all(0.0 < each <= 1.0 for each in c) and len(set(c)) == 3
    assert np.ptp(mpl.image.imread(names["folder"] / "my-web.png")[..., :3]) > 0.5


def test_the_config_of_the_page_is_the_same_scene(names):
    (keys,) = blocks("yaml")
    config = load(ROOT / "config" / "config.yaml", yaml.safe_load(keys))
    check(run_table(config).values())
    middle, near = runs(config, "webs", "described")
    assert middle.scene.to_json() == names["scene"].to_json()
    assert near.scene.to_json() != names["scene"].to_json()
    assert (middle.choice, near.choice) == ("middle", "near end")
