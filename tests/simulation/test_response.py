"""A response says what was run, by what, and how it ended; and its file gives all of it back."""

import numpy as np
import pytest

from fiberweb import Scene, crosshatch
from fiberweb.engines import ENGINES, load
from fiberweb.engines.base import Numerics, Recording
from fiberweb.model.drive import spline
from fiberweb.model.mesh import build
from fiberweb.model.readouts import places
from fiberweb.simulation import dataset
from fiberweb.simulation.response import response

SCENE = Scene(crosshatch(2, spacing=0.1), duration=0.4, sample_rate=50.0)
FORMS = ["kinetic", "elastic", "work", "dissipated"]


def made_up(engine="kirchhoff", unstable_from=None):
    """A response to a recording of known numbers."""
    mesh = build(SCENE, 2)
    moved = np.arange(SCENE.samples * len(mesh.readouts) * 2, dtype=float)
    moved = moved.reshape(SCENE.samples, -1, 2)
    energy = np.outer(np.arange(SCENE.samples), [1.0, 2.0, 5.0, 1.0])
    moved[unstable_from:] = moved[unstable_from:] if unstable_from is None else np.nan
    unstable_at = None if unstable_from is None else unstable_from / SCENE.sample_rate
    recording = Recording(moved, energy, unstable_at)
    return moved, response(mesh, Numerics(engine, 2, 1e-4), recording)


def test_it_holds_the_recording_at_the_places_of_the_network():
    moved, data = made_up()
    np.testing.assert_array_equal(data["displacement"], moved)
    np.testing.assert_array_equal(data["time"], np.arange(20) / 50.0)
    np.testing.assert_array_equal(data["input"], spline()(data["time"].values))
    assert data["form"].values.tolist() == FORMS
    for name, column in zip(("kind", "fibre", "section"), zip(*places(SCENE.network))):
        assert data[name].values.tolist() == list(column)
    rest = np.column_stack([data["rest_x"], data["rest_y"]])
    np.testing.assert_allclose(rest, [place[3:] for place in places(SCENE.network)], atol=1e-12)


def test_it_says_what_was_run():
    _, data = made_up()
    assert Scene.from_json(data.attrs["scene"]) == SCENE
    expected = {
        "status": "ok", "setup": "described", "engine": "kirchhoff", "elements": 24,
        "elements_per_section": 2, "time_step": 1e-4, "sample_rate": 50.0,
    }  # fmt: skip
    assert expected.items() <= data.attrs.items()
    assert "unstable_at" not in data.attrs
    # kinetic + elastic + dissipated - work is a fifth of the work throughout
    assert data.attrs["energy_residual"] == pytest.approx(0.2)


@pytest.mark.parametrize("engine", ENGINES)
def test_it_names_the_packages_of_its_engine(engine):
    _, data = made_up(engine)
    named = [entry.split()[0] for entry in data.attrs["versions"].split(", ")]
    assert tuple(named) == load(engine).PACKAGES


def test_an_unstable_run_says_when():
    _, data = made_up(unstable_from=7)
    assert data.attrs["status"] == "unstable"
    assert data.attrs["unstable_at"] == pytest.approx(0.14)
    assert np.isfinite(data["displacement"][:7]).all() and data["displacement"][7:].isnull().all()
    assert np.isfinite(data["input"]).all()


def test_its_file_gives_all_of_it_back(tmp_path):
    _, data = made_up(unstable_from=7)
    dataset.save(data, tmp_path / "new" / "response.nc")
    kept = dataset.load(tmp_path / "new" / "response.nc")
    assert "2^-20" in kept["displacement"].attrs.pop("comment")
    assert kept.identical(data)  # whole numbers are multiples of any unit below 1
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["response.nc"]
    with pytest.raises(FileNotFoundError):
        dataset.load(tmp_path / "response.nc")
