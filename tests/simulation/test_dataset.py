"""What a file keeps of a motion is enough for the scoring, and no more."""

import numpy as np
import pytest
import xarray as xr

from fiberweb import Scene, crosshatch, score, simulate
from fiberweb.simulation import dataset

NYLON = dict(youngs_modulus=3e9)
STEEL = dict(youngs_modulus=2e11, density=7850.0)
WEB = crosshatch(4, length=0.5)


@pytest.mark.parametrize(
    "fields",
    [
        dict(force=1e-7),
        dict(force=1e-5),
        dict(force=1e-4),
        dict(diameter=2e-4),
        dict(damping=300.0, force=1e-6),  # what the ramp starts is gone when scoring begins
        NYLON | dict(force=1e-7, tension=5.0),
        NYLON | dict(tension=50.0),
        STEEL | dict(force=1e-5, tension=50.0),
    ],
    ids=lambda fields: ",".join(f"{key}={value:g}" for key, value in fields.items()),
)
def test_stored_and_unstored_responses_score_alike(fields, tmp_path):
    """Single precision on top of the static stretch: C_nl .780 for .306 at 1e-5 N."""
    response = simulate(Scene(WEB, duration=40.0, **fields), "draft")
    dataset.save(response, tmp_path / "response.nc")
    before, after = score(response), score(dataset.load(tmp_path / "response.nc"))
    for name in ("c_nl", "c_m", "c_nl_raw", "c_m_raw"):
        assert float(after[name]) == pytest.approx(float(before[name]), abs=1e-3), name


def test_files_hold_metres_in_double_precision_at_no_more_bytes_than_single(tmp_path):
    response = simulate(Scene(WEB, duration=20.0), "draft")
    dataset.save(response, tmp_path / "response.nc")
    with xr.open_dataset(tmp_path / "response.nc") as plain:
        kept, moved = plain["displacement"].values, response["displacement"].values
    assert kept.dtype == moved.dtype == np.float64
    single = response.assign(displacement=response["displacement"].astype(np.float32))
    deflated = {name: {"zlib": True, "complevel": 1} for name in ("displacement", "energy")}
    single.to_netcdf(tmp_path / "single.nc", encoding=deflated)
    sizes = [(tmp_path / name).stat().st_size for name in ("response.nc", "single.nc")]
    assert sizes[0] < 1.05 * sizes[1]
    quietest = np.min([part.std(axis=0) for part in np.split(moved, 10)], axis=0)
    error = np.sqrt(np.mean((kept - moved) ** 2, axis=0)) / quietest
    assert 1e-7 < error.max() < 3e-7  # a unit of 2^-21 to 2^-20, evenly spread


def test_the_unit_is_that_of_the_quietest_tenth_and_not_of_the_start():
    time = np.arange(2000) / 250.0
    small = 1e-9 * np.sin(20.0 * time)
    moved = np.column_stack([small + 3e-3, small + 1e-3 * np.exp(-20.0 * time), 0.0 * time + 0.1])
    kept = dataset.rounded(moved)
    assert np.abs(kept - moved)[:, :2].max() < 2.0**-20 * 1e-9
    np.testing.assert_array_equal(kept[:, 2], moved[:, 2])
    np.testing.assert_array_equal(dataset.rounded(moved[:1]), moved[:1])
    lost = np.r_[moved, np.full((5, 3), np.nan)]
    np.testing.assert_array_equal(dataset.rounded(lost), np.r_[kept, np.full((5, 3), np.nan)])


def test_the_same_response_gives_the_same_bytes(tmp_path):
    response = simulate(Scene(crosshatch(2, length=0.5), duration=1.0, centre_lines=True), "draft")
    paths = [tmp_path / folder / "response.nc" for folder in ("one", "two")]
    for path in paths:
        path.parent.mkdir()
        dataset.save(response, path)
    assert paths[0].read_bytes() == paths[1].read_bytes()
    lines = dataset.load(paths[0])["centre_line"]
    assert "2^-20" in lines.attrs["comment"]
    assert float(np.abs(lines - response["centre_line"]).max()) < 1e-9


def test_a_damaged_file_is_refused_and_never_read_as_something_else(tmp_path):
    response = simulate(Scene(crosshatch(2, length=0.5), duration=4.0), "draft")
    dataset.save(response, tmp_path / "whole.nc")
    content = (tmp_path / "whole.nc").read_bytes()
    whole = dataset.load(tmp_path / "whole.nc")
    refused = 0
    for at in np.linspace(0, len(content), 24, endpoint=False).astype(int):
        damaged = bytearray(content)
        damaged[at : at + 32] = bytes(32)  # a block that never reached the disk
        (tmp_path / "damaged.nc").write_bytes(damaged)
        try:
            read = dataset.load(tmp_path / "damaged.nc")
        except ValueError as error:
            assert "damaged.nc cannot be read" in str(error) and "\n" not in str(error)
            refused += 1
        else:
            for name in ("input", "displacement", "time", "rest_x", "fibre"):
                np.testing.assert_array_equal(read[name], whole[name])
    assert refused >= 12
