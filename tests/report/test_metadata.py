"""Files that describe the project and its results, each by a checker of its own kind."""

import hashlib
import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from requests import Response
from rocrate.vocabs import RO_CRATE
from rocrate_validator import models, services
from rocrate_validator.utils.http import HttpRequester

from fiberweb.tools import crate

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "results" / "smoke"
BIN = Path(sys.executable).parent
PROFILE = "workflow-run-crate-0.5"
# What CF recommends and does not require, and why it is not so
LEFT = (
    # it takes time for a date, which needs an epoch; ours is in seconds from the start
    "Coordinate variable 'time' should have standard_name='time'",
    # a line with the time of each change; no file depends on the clock
    "global attribute history should exist",
    # of maps, which these are not
    "dimensions are not in the recommended order T, Z, Y, X",
)


def test_citation_is_valid():
    done = subprocess.run(
        [BIN / "cffconvert", "--validate"], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.fixture
def offline(monkeypatch):
    """The context of RO-Crate 1.1 from rocrate's own package; everything else is out of reach."""

    def get(self, url, **_):
        response = Response()
        known = url == RO_CRATE["@id"]
        response.status_code = 200 if known else 504
        response._content = json.dumps(RO_CRATE if known else {}).encode()
        response.headers["Content-Type"] = "application/ld+json"
        return response

    monkeypatch.setattr(HttpRequester, "get", get, raising=False)


@pytest.fixture
def described(tmp_path):
    """A crate of what a smoke run left, but for its runs but one, and the path of its metadata."""
    folder = tmp_path / "results"
    shutil.copytree(RESULTS, folder, ignore=shutil.ignore_patterns("runs", "report", "screenshots"))
    run = next((RESULTS / "runs").iterdir())
    shutil.copytree(run, folder / "runs" / run.name)
    return crate.describe(folder)


def test_results_are_a_workflow_run_crate(described, offline):
    settings = services.ValidationSettings(
        rocrate_uri=str(described.parent), profile_identifier=PROFILE, offline=True,
        requirement_severity=models.Severity.REQUIRED,
    )  # fmt: skip
    found = services.validate(settings)
    assert found.passed(), [issue.message for issue in found.get_issues()]


def test_a_call_that_failed_is_said_to_have(described):
    assert "CompletedActionStatus" in described.read_text()
    progress = described.with_name("progress.json")
    progress.write_text(progress.read_text().replace('"finished"', '"failed"'))
    assert "FailedActionStatus" in crate.describe(described.parent).read_text()


def test_the_validator_does_find_what_is_wrong(described, offline):
    said = json.loads(described.read_text())
    said["@graph"] = [each for each in said["@graph"] if each["@type"] != "CreateAction"]
    described.write_text(json.dumps(said))
    settings = services.ValidationSettings(
        rocrate_uri=str(described.parent), profile_identifier=PROFILE, offline=True
    )
    assert not services.validate(settings).passed()


def test_every_file_is_in_the_crate_by_its_content(described):
    entities = {each["@id"]: each for each in json.loads(described.read_text())["@graph"]}
    folder = described.parent
    paths = [path for path in folder.rglob("*") if path.is_file() and path != described]
    assert len(paths) > 100
    for path in paths:
        said = entities[path.relative_to(folder).as_posix()]
        assert said["sha256"] == hashlib.sha256(path.read_bytes()).hexdigest(), path
        assert int(said["contentSize"]) == path.stat().st_size
    results = {each["@id"] for each in entities["#run"]["result"]}
    assert "tables/described/claims.csv" in results and "figures/topology.png" in results
    assert "source/config/config.yaml" in {each["@id"] for each in entities["#run"]["object"]}


def test_results_without_a_call_are_refused(tmp_path):
    with pytest.raises(ValueError, match=r"has no provenance\.json: run the workflow first"):
        crate.describe(tmp_path)


def one_of_each():
    """A NetCDF file of each kind."""
    of_run = sorted((RESULTS / "runs").iterdir())[0]
    return [*of_run.glob("*.nc"), *(RESULTS / "tables").rglob("*.nc")]


def test_netcdf_files_follow_cf(tmp_path):
    paths = one_of_each()
    assert {path.name for path in paths} >= {"response.nc", "capacity.nc", "narma_errors.nc"}
    report = tmp_path / "cf.json"
    command = [BIN / "compliance-checker", "--test=cf:1.11", "--format=json_new", "-o", report]
    subprocess.run([*command, *paths], capture_output=True, check=False)
    for path, checked in json.loads(report.read_text()).items():
        checks = checked["cf:1.11"]
        wrong = [text for each in checks["high_priorities"] for text in each["msgs"]]
        wrong += [text for each in checks["medium_priorities"] for text in each["msgs"]]
        assert [text for text in wrong if not any(left in text for left in LEFT)] == [], path
