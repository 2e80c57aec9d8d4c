"""Recordings of any bytes end in a Dataset or in one sentence."""

import warnings

import h5py
import numpy as np
import pytest
import scipy.io
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from fiberweb import read_recording
from tests.fuzz.cases import CASES, damaged, is_one_sentence
from tests.recordings import files
from tests.recordings.files import RATE, body

CELLS = [
    b",", b"\n", b"\r", b"\r\n", b";", b'"', b"1e308", b"-1e308", b"nan", b"inf", b"1e999", b"x",
    b"\xff", b"\0", b"0", b"9" * 30, b"--", b"scorer,", b"Format Version", b"frame", b"1,5", b" ",
]  # fmt: skip
WORDS = [b"\0" * 4, b"\xff" * 4, b"\xff\xff\xff\x7f", b"\0\0\0\x80", b"\x01", b"OHDR", b"SNOD"]
OPTIONS = st.fixed_dictionaries(
    {},
    optional={
        "rate": st.sampled_from([RATE, 1e-300, 1e300]),
        "max_gap": st.sampled_from([0.0, 10.0, 1e300]),
        "hidden": st.just("leave out"),
        "likelihood": st.sampled_from([0.0, 1.0]),
        "time_unit": st.sampled_from(["ms", "us"]),
        "plane": st.sampled_from(["xz", "yz"]),
    },
)


def made(folder):
    """A file of each format, with the options that it is read with."""
    time, u, positions = body(80, markers=2)
    likelihood = np.ones(positions.shape[:2])
    arrays = {"servo": u, "points": positions, "fps": RATE}
    named = {"input": "tracked.servo", "markers": "tracked.points"}
    mat, mat73, prc, nc = (folder / f"a.{end}" for end in ("mat", "v73.mat", "h5", "nc"))
    scipy.io.savemat(mat, {"tracked": arrays})
    scipy.io.savemat(packed := folder / "b.mat", {"tracked": arrays}, do_compression=True)
    with h5py.File(mat73, "w") as file:
        for name, values in arrays.items():
            file[f"tracked/{name}"] = np.asarray(values).T
    with h5py.File(prc, "w") as file:
        file["time_series/time"] = time
        file["time_series/actuation_signals/0"] = u
        file.create_dataset("time_series/nodes/positions", data=positions, compression="gzip")
    xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), positions)},
        {"time": time},
    ).to_netcdf(nc, engine="netcdf4")
    driven = {"input": "motor.x", "rate": RATE}
    return {
        "table": (files.wide(folder / "a.csv", time, u, positions), {}),
        "deeplabcut": (files.deeplabcut(folder / "dlc.csv", u, positions, likelihood), driven),
        "trackpy": (
            files.trackpy(folder / "tp.csv", u, positions), {"input": "p0.x", "rate": RATE},
        ),
        "motive": (files.motive(folder / "mo.csv", time, u, positions), {"input": "motor.x"}),
        "matlab": (mat, named),
        "matlab packed": (packed, named),
        "matlab 7.3": (mat73, named),
        "openprc": (prc, {}),
        "netcdf": (nc, {}),
    }  # fmt: skip


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    return made(tmp_path_factory.mktemp("whole"))


def ends(path, options):
    """Read a file; a result is finite, and what is refused is one sentence with its name."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of numbers near the largest
            response = read_recording(path, quiet=True, **options)
    except ValueError as error:
        assert is_one_sentence(error)
        return
    assert all(np.isfinite(response[name]).all() for name in ("input", "displacement", "time"))


FORMATS = ("table", "deeplabcut", "trackpy", "motive")
BINARY = ("matlab", "matlab packed", "matlab 7.3", "openprc", "netcdf")


@CASES
@given(data=st.data())
def test_a_damaged_table(whole, data, tmp_path_factory):
    path, options = whole[data.draw(st.sampled_from(FORMATS))]
    bad = tmp_path_factory.getbasetemp() / "damaged.csv"
    bad.write_bytes(data.draw(damaged(path.read_bytes(), CELLS)))
    ends(bad, options | data.draw(OPTIONS))


@CASES
@given(data=st.data())
def test_a_damaged_file_of_arrays(whole, data, tmp_path_factory):
    path, options = whole[data.draw(st.sampled_from(BINARY))]
    bad = tmp_path_factory.getbasetemp() / f"damaged{path.suffix}"
    bad.write_bytes(data.draw(damaged(path.read_bytes(), WORDS)))
    ends(bad, options | data.draw(OPTIONS))


@CASES
@given(content=st.binary(max_size=200), suffix=st.sampled_from([".csv", ".mat", ".nc", ".h5", ""]))
def test_any_bytes(content, suffix, tmp_path_factory):
    path = tmp_path_factory.getbasetemp() / f"any{suffix}"
    path.write_bytes(content)
    ends(path, {"rate": RATE, "input": "a.x"})


def test_every_format_is_read_before_it_is_damaged(whole):
    for path, options in whole.values():
        assert read_recording(path, quiet=True, **options).sizes["readout"] >= 1
