"""docs/extending.md does what it says: its study is added in the places that it names, and runs."""

import re
import shutil

import matplotlib as mpl
import matplotlib.image
import numpy as np
import pandas as pd
import pytest
import yaml

from fiberweb import score, simulate
from fiberweb.config import load
from fiberweb.layers import overlay
from fiberweb.runs import check, run_table, runs
from tests.workflow.conftest import ROOT

PAGE = (ROOT / "docs" / "extending.md").read_text()
FILE = re.compile(r"^`([\w/.]+)`:\n\n```\w+\n(.*?)^```", re.MULTILINE | re.DOTALL)


def section(title):
    return PAGE.split(f"\n## {title}\n")[1].split("\n## ")[0]


def added(text):
    """(line before, line to add) of each diff block."""
    for block in re.findall(r"```diff\n(.*?)```", text, re.DOTALL):
        lines = block.splitlines()
        at = next(i for i, line in enumerate(lines) if line.startswith("+"))
        yield lines[at - 1][1:] + "\n", lines[at][1:] + "\n"


@pytest.mark.slow
def test_the_study_of_the_page(smoked, edited):
    tree, page = smoked, section("A study")
    before = {path for path in (tree.folder / "fiberweb").rglob("*")}
    for name, text in FILE.findall(page):
        path = tree.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    ((above, line),) = added(page)
    registry = tree.folder / "fiberweb" / "studies" / "__init__.py"
    assert registry.read_text().count(above) == 1
    edited("fiberweb/studies/__init__.py", "", registry.read_text().replace(above, above + line))
    (keys,) = re.findall(r"In `config/config.yaml`.*?```yaml\n(.*?)```", page, re.DOTALL)
    edited("config/config.yaml", f"\n{keys}")
    # one folder, one line of the registry, one section of the config
    new = {path for path in (tree.folder / "fiberweb").rglob("*")} - before
    assert {path.relative_to(tree.folder / "fiberweb").parts[:2] for path in new} == {
        ("studies", "stiffness")
    }
    keys = "results: toy\nstiffness: {n: 2, youngs_modulus: [1.0e+8, 3.0e+8]}\n"
    (tree.folder / "short.yaml").write_text(keys)
    small = ("--configfile", "config/smoke.yaml", "short.yaml")
    tree.snakemake("stiffness", *small)
    out = tree.folder / "toy"
    table = pd.read_csv(out / "tables" / "described" / "stiffness.csv")
    assert list(table["youngs_modulus_Pa"]) == [1e8, 3e8]
    assert table["buckling_number"].nunique() == 1 and (table["status"] == "ok").all()
    assert np.ptp(mpl.image.imread(out / "figures" / "stiffness.png")) > 0.5
    assert tree.planned("stiffness", *small) == {}
    shutil.rmtree(tree.folder / "fiberweb" / "studies" / "stiffness")


def test_the_body_of_the_page_is_one_and_runs():
    page = section("A body of another kind")
    blocks = [re.findall(rf"```{kind}\n(.*?)```", page, re.DOTALL) for kind in ("yaml", "python")]
    ((keys,), (code,)) = blocks
    values, names = yaml.safe_load(keys), {}
    exec(code.split("capacity = ")[0], names)
    config = load(ROOT / "config" / "config.yaml", values)
    check(run_table(config).values())
    assert runs(config, "topology", "described")[0].scene == names["scene"]

    short = {"scene": {"duration": 3.0}, "topology": {"crosshatch": [2]}}
    (run,) = runs(load(overlay(values, short)), "topology", "described")
    response = simulate(run.scene, accuracy="draft")
    assert response.attrs["status"] == "ok"
    assert response.attrs["energy_residual"] < 1e-6
    capacity = score(response)
    assert 0.0 < float(capacity.c_nl) <= 1.0 and 0.0 < float(capacity.c_m) <= 1.0


TITLES = ["A study", "A figure of an existing study", "An engine", "A recording format"]


@pytest.mark.parametrize("title", TITLES)
def test_lines_to_change_are_there(title):
    for (above, _), name in zip(
        added(section(title)), re.findall(r"In `([\w/]+\.py)`, add", section(title)), strict=True
    ):
        assert (ROOT / name).read_text().count(above) == 1, name
