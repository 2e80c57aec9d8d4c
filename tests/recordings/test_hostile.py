"""Recordings that are made to do harm: nothing in them is run, none reads another file of the
machine, and none takes more memory than there is."""

import gzip
import os
import pickle

import h5py
import numpy as np
import pytest
import scipy.io

from fiberweb import read_recording
from fiberweb.recordings import READERS, base
from fiberweb.source import ROOT
from tests.recordings.files import RATE, body, wide

POSITIONS = "time_series/nodes/positions"
MAT = {"input": "u", "markers": "points", "rate": RATE}


def openprc(path, write):
    time, u, _ = body(50)
    with h5py.File(path, "w") as file:
        file["time_series/time"] = time
        file["time_series/actuation_signals/0"] = u
        write(file)
    return path


def in_a_raw_file(file):
    file.create_dataset(POSITIONS, (50, 2, 2), float, external=[("/etc/passwd", 0, 1600)])


def in_another_file(file):
    with h5py.File(os.path.join(os.path.dirname(file.filename), "other.h5"), "w") as other:
        other["positions"] = np.zeros((50, 2, 2))
    file[POSITIONS] = h5py.ExternalLink("other.h5", "positions")


def virtual(file):
    layout = h5py.VirtualLayout((50, 2, 2), float)
    layout[:] = h5py.VirtualSource("other.h5", "positions", (50, 2, 2))
    file.create_virtual_dataset(POSITIONS, layout)


def of_objects(file):
    kind = h5py.special_dtype(vlen=np.dtype("uint8"))
    file.create_dataset(POSITIONS, (50, 2, 2), kind)


def huge(file):
    """A petabyte of zeros in some kilobytes."""
    file.create_dataset(POSITIONS, (50, 10**9, 2), float, chunks=(50, 100, 2))


@pytest.mark.parametrize(
    ("write", "words"),
    [
        (in_a_raw_file, "is kept in another file"),
        (in_another_file, "is kept in another file"),
        (virtual, "is kept in another file"),
        (of_objects, "no numbers"),
        (huge, "of memory"),
    ],
)
def test_an_array_that_is_none(tmp_path, write, words):
    with pytest.raises(ValueError, match=words) as caught:
        read_recording(openprc(tmp_path / "a.h5", write), quiet=True)
    assert str(caught.value).isprintable()


@pytest.fixture
def small(monkeypatch):
    """A machine of 100 MB."""
    monkeypatch.setattr(base, "of_this_machine", lambda: 10**8)


def test_an_array_that_is_small_only_while_it_is_packed(tmp_path, small):
    path = tmp_path / "a.mat"
    values = {"u": np.zeros(1000), "points": np.zeros((1000, 2500, 2))}
    scipy.io.savemat(path, values, do_compression=True)
    assert path.stat().st_size < 10**5
    with pytest.raises(ValueError, match=r"stands for .* numbers"):
        read_recording(path, quiet=True, **MAT)


def test_a_point_in_a_frame_far_away(tmp_path, small):
    path = tmp_path / "a.csv"
    path.write_text("x,y,frame,particle\n1,1,0,0\n1,1,90000000000000000,1\n1,1,10000000,1\n")
    options = {"input": "p0.x", "rate": RATE, "hidden": "leave out"}
    with pytest.raises(ValueError, match=r"row 3: 9e.16 is no whole number"):
        read_recording(path, quiet=True, **options)
    path.write_text(path.read_text().replace("90000000000000000", "9000000000"))
    with pytest.raises(ValueError, match=r"stands for 3.6e.10 numbers"):
        read_recording(path, quiet=True, **options)


def test_a_header_of_more_columns_than_a_recording_has(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(",".join(f"{n}_x,{n}_y" for n in range(20_000)) + "\n1\n1\n")
    with pytest.raises(ValueError, match="has 40000 columns: more than 20000"):
        read_recording(path, quiet=True)


@pytest.mark.parametrize("text", ["a" * 200_000 + ",b\n1,2\n", "a,b\rc,d\n1,2\n"])
def test_a_cell_that_is_none(tmp_path, text):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"a\.csv"):
        read_recording(path, quiet=True)


def test_a_table_is_not_unpacked(tmp_path):
    path = tmp_path / "a.csv.gz"
    path.write_bytes(gzip.compress(wide(tmp_path / "a.csv", *body(50)).read_bytes()))
    with pytest.raises(ValueError, match="no text"):
        read_recording(path, quiet=True, format="table")


def test_a_pipe_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.csv")
    with pytest.raises(ValueError, match="is no file"):
        read_recording(tmp_path / "a.csv", quiet=True)


class Harm:
    def __reduce__(self):
        return os.mkdir, ("harm",)


@pytest.mark.parametrize("reader", READERS)
def test_a_pickle_is_not_loaded(tmp_path, monkeypatch, reader):
    monkeypatch.chdir(tmp_path)
    np.save(path := tmp_path / "a.npy", np.array([Harm()], dtype=object), allow_pickle=True)
    for content in (path.read_bytes(), pickle.dumps(Harm())):
        path.write_bytes(content)
        with pytest.raises(ValueError):
            read_recording(path, quiet=True, format=reader)
    assert not os.path.exists("harm")


def test_no_reader_can_load_one():
    for path in (ROOT / "recordings").glob("*.py"):
        text = path.read_text()
        assert not any(word in text for word in ("pickle", "np.load(", "eval(", "exec("))


def test_one_frame_in_which_all_is_seen_is_no_recording(tmp_path):
    """Found by `make fuzz`: a table that was cut off in its second row."""
    path = tmp_path / "a.csv"
    path.write_text("time,input,a_x,a_y\n0.0,0.5,1.0,2.0\n0.02,0.1")
    with pytest.raises(ValueError, match="no two frames in which all is seen"):
        read_recording(path, quiet=True)
