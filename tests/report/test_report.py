"""The report of a smoke run in headless Chromium: all of it is there, loads, and asks for nothing.

`make test-report` starts it. Screenshots of everything lie in results/smoke/screenshots/
afterwards, to be looked at.
"""

import json
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

from tests.report.browser import opened

ROOT = Path(__file__).parents[2]
SMOKE = "config/smoke.yaml"
RESULTS = ROOT / "results" / "smoke"
PYTHON = ROOT / ".venv" / "bin" / "python"
SCREENSHOTS = RESULTS / "screenshots"
EXPECTED = f"""
import json
from fiberweb.config import load
from fiberweb.files import Files
print(json.dumps(Files(load("config/config.yaml", "{SMOKE}")).reported("described")))
"""
KINDS = ["first", "second", "checkpoint again"]


def made(folder):
    """The HTML file and the zip that `make report` writes."""
    command = ["make", "report", f"CONFIG={SMOKE}", f"REPORT={folder}/report"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder / "report.html", folder / "report.zip"


@pytest.fixture(scope="module", params=KINDS)
def files(request, tmp_path_factory):
    """A report of fresh results, of the same once more, and after the checkpoint ran again."""
    if request.param == "checkpoint again":
        command = [PYTHON, "-m", "snakemake", "report_described", "--forcerun", "ridge_best"]
        again = [*command, "--configfile", SMOKE, "--cores", "2"]
        printed = subprocess.run(again, cwd=ROOT, capture_output=True, text=True, check=True)
        assert "Looking for the best unbuckled force" in printed.stdout + printed.stderr
    return made(tmp_path_factory.mktemp("report"))


@pytest.fixture(scope="module")
def expected():
    """Paths of all that is to be shown: pictures, and pages of the rest."""
    done = subprocess.run(
        [PYTHON, "-c", EXPECTED], cwd=ROOT, capture_output=True, text=True, check=True
    )
    shown = {file for file in json.loads(done.stdout) if file.endswith((".png", ".html"))}
    return shown | {"results/smoke/report/provenance.html"}


@pytest.fixture(scope="module", params=["html", "zip"])
def report(request, files, tmp_path_factory):
    """Either report, open; at the end nothing had gone wrong, and nothing had left the machine."""
    path = files[0]
    if request.param == "zip":
        folder = tmp_path_factory.mktemp("unpacked")
        zipfile.ZipFile(files[1]).extractall(folder)
        path = folder / "report" / "report.html"
    with opened(path) as report:
        report.screenshots = SCREENSHOTS / request.param
        yield report
        assert report.wrong == [] and report.outside == []


def looked_at(report, name):
    """Take a screenshot."""
    report.screenshots.mkdir(parents=True, exist_ok=True)
    report.page.screenshot(path=report.screenshots / f"{name}.png")


def test_everything_is_in_it(report, expected):
    assert set(report.results()) == expected


def test_statistics_are_drawn(report):
    for name, drawn in (("Workflow", "#rulegraph"), ("Statistics", "#timeline")):
        report.menu(name)
        report.page.locator(f"{drawn} :is(svg, canvas)").first.wait_for()
        looked_at(report, name)
    report.page.locator("#runtimes :is(svg, canvas)").first.wait_for()


@pytest.mark.parametrize("category", ["Figures", "Tables", "Animations", "Claims", "Provenance"])
def test_every_result_is_shown_with_its_caption(report, expected, category):
    of_category = [path for path in expected if category in kinds(path)]
    report.menu(category)
    rows = report.rows()
    assert rows.count() == len(of_category) > 0
    for at in range(rows.count()):
        name = rows.nth(at).locator("td").first.inner_text()
        report.press(rows.nth(at), 0)
        size = drawn(report)
        assert size[0] > 100 and size[1] > 20, name
        report.press(rows.nth(at), 1)
        if category != "Provenance":
            assert len(report.page.locator("nav li.prose").inner_text()) > 20, name
        looked_at(report, f"{category}-{Path(name).name}")
        report.menu(category)


def kinds(path):
    """The category of a result."""
    if path.endswith("provenance.html"):
        return ["Provenance"]
    if path.endswith("claims.csv.html"):
        return ["Claims"]
    return [
        {".png": "Figures", ".gif": "Animations"}.get(path.removesuffix(".html")[-4:], "Tables")
    ]


def drawn(report):
    """Width and height of what is shown, which must be all of a picture and the start of a page."""
    picture = report.content().locator("img, iframe").first
    picture.wait_for()
    if picture.evaluate("shown => shown.tagName") == "IFRAME":
        inside = picture.content_frame.locator("table, img, .xr-wrap").first
        inside.wait_for()
        assert inside.evaluate("shown => shown.tagName != 'IMG' || shown.naturalWidth > 0")
        return [inside.bounding_box()[side] for side in ("width", "height")]
    picture.evaluate("picture => picture.decode()")
    assert picture.evaluate("picture => picture.naturalWidth") > 100
    box, window = picture.bounding_box(), report.page.viewport_size
    assert box["x"] >= 0 and box["x"] + box["width"] <= window["width"] + 1
    assert box["y"] >= 0 and box["y"] + box["height"] <= window["height"] + 1
    return box["width"], box["height"]


@pytest.mark.parametrize("name", ["topology.csv", "claims.csv", "narma_errors.nc"])
def test_a_table_can_be_saved(report, name, tmp_path):
    report.menu("Claims" if name == "claims.csv" else "Tables")
    report.press(report.rows().filter(has_text=f"/{name}"), 0)
    drawn(report)
    with report.page.expect_download() as saving:
        report.content().locator("iframe").content_frame.get_by_text("Save the file").click()
    saving.value.save_as(tmp_path / name)
    table = RESULTS / "tables" / "described" / name
    assert (tmp_path / name).read_bytes() == table.read_bytes()


def test_the_commit_is_among_what_it_says_of_provenance(report):
    report.menu("Provenance")
    report.press(report.rows(), 0)
    said = report.content().locator("iframe").content_frame.locator("body").inner_text()
    calls = json.loads((RESULTS / "provenance.json").read_text())
    assert calls[-1]["commit"] in said and calls[-1]["engine_source"] in said


def test_chromium_is_there():
    assert shutil.which("chromium"), "apt-get install chromium, or name another by CHROMIUM=..."
