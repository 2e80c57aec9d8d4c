"""What a table rests on stands beside it: runs with their scenes, and what ran them."""

import json

import pandas as pd
import pytest

from fiberweb import Scene, crosshatch, origin, products, simulate


@pytest.fixture(scope="module")
def paths(tmp_path_factory):
    """Two responses that differ in seed and force."""
    folder = tmp_path_factory.mktemp("runs")
    for name, seed, force in (("a", 1, 0.05), ("b", 2, 0.06)):
        scene = Scene(crosshatch(2, length=0.3), duration=0.1, seed=seed, force=force)
        response = simulate(scene, "draft")
        response.attrs["run"] = name
        products.write(response, folder / name / "response.nc")
    return sorted(folder.glob("*/response.nc"))


def note(table):
    return json.loads(origin.beside(table).read_text())["notes"][0]


def test_a_table_of_runs(paths, tmp_path):
    origin.write(tmp_path / "t.csv", paths, "0a1b")
    said = note(tmp_path / "t.csv")
    assert said["runs"] == {"a": {"seed": 1, "force": 0.05}, "b": {"seed": 2, "force": 0.06}}
    scene = json.loads(products.read(paths[0]).attrs["scene"])
    shared = {key: value for key, value in scene.items() if key not in ("seed", "force")}
    assert said["scene"] == shared | {"crossing_stiffness": "Infinity"}
    attrs = products.read(paths[1]).attrs
    assert said["engines"] == {attrs["engine_source"]: attrs["versions"]}
    assert said["recipe"] == "0a1b" and said["versions"]["numpy"]
    assert json.loads(origin.beside(tmp_path / "t.csv").read_text())["url"] == "t.csv"


def test_a_table_of_tables_has_all_of_theirs(paths, tmp_path):
    for path in paths:
        origin.write(tmp_path / f"{path.parent.name}.csv", [path], "1")
    tables = [tmp_path / name for name in ("a.csv", "b.csv")]
    products.write(pd.DataFrame({"theirs": [1.0]}), tmp_path / "authors.csv")
    origin.write(tmp_path / "claims.csv", [*tables, tmp_path / "authors.csv"], "2")
    said = note(tmp_path / "claims.csv")
    assert {run: own["seed"] for run, own in said["runs"].items()} == {"a": 1, "b": 2}
    assert said["made_of"] == ["a.csv", "authors.csv", "b.csv"] and len(said["engines"]) == 1


def test_the_same_again_are_the_same_bytes(paths, tmp_path):
    for name in ("one", "two"):
        origin.write(tmp_path / f"{name}.csv", paths, "1")
    one, two = (origin.beside(tmp_path / f"{name}.csv").read_text() for name in ("one", "two"))
    assert one.replace("one.csv", "") == two.replace("two.csv", "")
