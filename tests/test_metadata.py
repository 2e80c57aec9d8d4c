"""What is said of the project in several files is the same in all, pyproject.toml being the first.

Whether `CITATION.cff` is valid is looked at by `make test-report`.
"""

import json
import re
import tomllib
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
CITATION = yaml.safe_load((ROOT / "CITATION.cff").read_text())
CODEMETA = json.loads((ROOT / "codemeta.json").read_text())


def test_version_and_licence():
    assert CITATION["version"] == CODEMETA["version"] == PROJECT["version"]
    assert CITATION["license"] == CODEMETA["license"].rpartition("/")[2] == PROJECT["license"]
    assert CODEMETA["runtimePlatform"].split()[1] == PROJECT["requires-python"].removeprefix(">=")


def test_authors_keywords_and_paper():
    (author,), (project,) = CITATION["authors"], PROJECT["authors"]
    assert author["name"] == CODEMETA["author"][0]["name"]
    assert author["name"].lower() == project["name"].lower()
    assert CITATION["keywords"] == CODEMETA["keywords"]
    assert set(PROJECT["keywords"]) < set(CITATION["keywords"])
    assert CITATION["references"][0]["url"] == CODEMETA["referencePublication"]
    assert CITATION["title"].startswith(CODEMETA["name"])


def test_the_catalog_says_what_there_is():
    usage = yaml.safe_load((ROOT / ".snakemake-workflow-catalog.yml").read_text())["usage"]
    snakefile = (ROOT / "Snakefile").read_text()
    assert usage["report"] and re.search("^report:", snakefile, re.M)
    rules = [path.read_text() for path in (ROOT / "workflow" / "rules").glob("*.smk")]
    assert usage["software-stack-deployment"]["conda"] and any("conda:" in rule for rule in rules)
    assert not any("container:" in text for text in [snakefile, *rules])


@pytest.mark.parametrize("name", ["config/README.md", "README.md", "LICENSE", "config/config.yaml"])
def test_what_the_catalog_looks_for(name):
    assert (ROOT / name).is_file()
