"""Every variable that is written has a name, and a unit if it is a number."""

import numpy as np
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch, score, simulate
from fiberweb.scoring.capacity import traces
from fiberweb.simulation import dataset
from fiberweb.simulation.conventions import CONVENTIONS


@pytest.fixture(scope="module")
def response():
    scene = Scene(crosshatch(2, length=0.3), duration=4.0, centre_lines=True)
    return simulate(scene, "draft")


@pytest.mark.parametrize(
    "make", [lambda of: of, score, traces], ids=["response", "score", "traces"]
)
def test_names_and_units(response, make, tmp_path):
    dataset.save(make(response), tmp_path / "a.nc")
    with xr.open_dataset(tmp_path / "a.nc") as data:
        data.load()
    for name, variable in data.variables.items():
        assert variable.attrs["long_name"], name
        assert ("units" in variable.attrs) == (variable.dtype.kind in "iuf"), name
    assert data.attrs["Conventions"] == CONVENTIONS and data.attrs["title"]
    assert data.attrs["engine_source"] == response.attrs["engine_source"] or make is traces


def test_attributes_without_values(response, tmp_path):
    dataset.save(response, tmp_path / "a.nc")
    found = dataset.attributes(tmp_path / "a.nc")
    for name, value in dataset.load(tmp_path / "a.nc").attrs.items():
        assert np.all(found[name] == value), name
    (tmp_path / "b.nc").write_bytes(b"nothing")
    with pytest.raises(ValueError, match=r"b\.nc cannot be read"):
        dataset.attributes(tmp_path / "b.nc")
