"""Every format gives the same recording; options say what a file does not."""

import re
from pathlib import Path

import h5py
import numpy as np
import pytest
import scipy.io

from fiberweb import read_recording, score
from fiberweb.recordings import READERS, Reader, sanity
from fiberweb.simulation import dataset
from tests.recordings import files
from tests.recordings.files import RATE, body, names


@pytest.fixture(scope="module")
def made():
    return body()


def assert_same(response, made, scale=1.0, first=0):
    """The recording is the one that was made, but for where each marker starts."""
    time, u, positions = made
    moved = scale * (positions - positions[first])[first:]
    np.testing.assert_allclose(response["time"], time[first:] - time[first], atol=1e-12)
    np.testing.assert_allclose(response["input"], u[first:], atol=1e-12)
    np.testing.assert_allclose(response["displacement"], moved, atol=1e-9)
    assert response.attrs["sample_rate"] == pytest.approx(RATE)


def of_table(folder, made):
    return files.wide(folder / "film.csv", *made), {}


def of_tabs(folder, made):
    table = files.frame(*made).rename(columns={"time": "t", "input": "servo", "a_x": "X of a"})
    table.to_csv(folder / "film.tsv", sep="\t", index=False)
    pairs = {name: [f"{name}_x", f"{name}_y"] for name in names(3)} | {"a": ["X of a", "a_y"]}
    return folder / "film.tsv", {"time": "t", "input": "servo", "markers": pairs}


def of_netcdf(folder, made):
    made_of = read_recording(files.wide(folder / "n.csv", *made), quiet=True)
    dataset.save(made_of, folder / "film.nc")
    return folder / "film.nc", {}


def struct(made):
    _, u, positions = made
    return {"servo": np.column_stack([u, u**2]), "points": positions, "samplerate": RATE}


def of_matlab(folder, made):
    scipy.io.savemat(folder / "film.mat", {"tracked": {"inner": struct(made)}})
    return folder / "film.mat", {"input": "tracked.inner.servo[0]",
                                 "markers": "tracked.inner.points"}  # fmt: skip


def of_matlab_73(folder, made):
    with h5py.File(folder / "film.mat", "w", userblock_size=512) as file:
        for name, values in struct(made).items():
            file[f"tracked/inner/{name}"] = np.asarray(values).T  # column by column
    with open(folder / "film.mat", "r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\0\2IM")
    return folder / "film.mat", {"input": "tracked.inner.servo[0]",
                                 "markers": "tracked.inner.points"}  # fmt: skip


def of_deeplabcut(folder, made):
    _, u, positions = made
    likely = np.ones(positions.shape[:2])
    return files.deeplabcut(folder / "film.csv", u, positions, likely), {
        "rate": RATE, "input": "motor.x",
    }  # fmt: skip


def of_trackpy(folder, made):
    _, u, positions = made
    return files.trackpy(folder / "film.csv", u, positions), {"rate": RATE, "input": "p0.x"}


def of_motive(folder, made):
    return files.motive(folder / "film.csv", *made), {"input": "motor.x", "plane": "xz"}


def of_openprc(folder, made):
    time, u, positions = made
    with h5py.File(folder / "film.h5", "w") as file:
        file.attrs["fps"] = RATE
        file["time_series/time"] = time
        file["time_series/actuation_signals/0"] = u[:, None]
        file["time_series/nodes/positions"] = np.concatenate([positions, positions[:, :, :1]], 2)
    return folder / "film.h5", {}


MAKERS = {
    "table": of_table, "tabs": of_tabs, "netcdf": of_netcdf, "matlab": of_matlab,
    "matlab 7.3": of_matlab_73, "deeplabcut": of_deeplabcut, "trackpy": of_trackpy,
    "motive": of_motive, "openprc": of_openprc,
}  # fmt: skip


@pytest.mark.parametrize("kind", MAKERS)
def test_every_format_gives_the_same_recording(kind, tmp_path, made):
    path, options = MAKERS[kind](tmp_path, made)
    response = read_recording(path, quiet=True, **options)
    assert_same(response, made, 1e-3 if kind == "motive" else 1.0)
    assert response["displacement"].attrs["units"] == ("m" if kind == "motive" else "px")
    assert set(sanity(response)["severity"]) <= {"ok", "note"}, sanity(response).to_string()


def test_every_reader_is_tried():
    assert {kind.removesuffix(" 7.3").replace("tabs", "table") for kind in MAKERS} == set(READERS)


def test_a_recording_is_scored_like_a_simulation(tmp_path, made):
    response = read_recording(files.wide(tmp_path / "film.csv", *made), quiet=True)
    scored = score(response)
    assert scored.attrs["scoring"] == "clean" and 0.0 < float(scored["c_m"]) < 1.0


def test_the_sanity_list_is_printed(tmp_path, made, capsys):
    read_recording(files.wide(tmp_path / "film.csv", *made))
    printed = capsys.readouterr().out
    for name in ("rate", "gaps", "constant", "duplicated", "jumps", "drift", "clipping", "lag"):
        assert f"{name}: " in printed
    assert "400 frames in 7.98 s: 50 Hz" in printed


def test_an_unlikely_point_is_not_seen(tmp_path, made):
    _, u, positions = made
    likely, wrong = np.ones(positions.shape[:2]), positions.copy()
    likely[100, 1], wrong[100, 1] = 0.3, 9999.0
    path = files.deeplabcut(tmp_path / "film.csv", u, wrong, likely)
    response = read_recording(path, quiet=True, rate=RATE, input="motor.x")
    between = (positions[99, 1] + positions[101, 1]) / 2 - positions[0, 1]
    np.testing.assert_allclose(response["displacement"][100, 1], between)
    with_all = read_recording(path, quiet=True, rate=RATE, input="motor.x", likelihood=0.2)
    assert with_all["displacement"][100, 1, 0] > 9000


def test_particles_that_vanish_are_left_out_where_that_is_said(tmp_path, made):
    _, u, positions = made
    positions = positions.copy()
    positions[50:80, 1] = np.nan
    path = files.trackpy(tmp_path / "film.csv", u, positions)
    options = {"quiet": True, "rate": RATE, "input": "p0.x"}
    with pytest.raises(ValueError, match=r"'p2' is not seen from 1 s to 1\.58 s .* leave out"):
        read_recording(path, **options)
    response = read_recording(path, hidden="leave out", **options)
    assert response["readout"].values.tolist() == ["p1", "p3"]
    assert "'p2' is not seen" in " ".join(sanity(response)["sentence"])


@pytest.mark.parametrize("blank", [True, False])
def test_motive_without_a_clock_has_the_rate_of_its_first_line(tmp_path, made, blank):
    rate = {"Export Frame Rate": "50.000000", "Length Units": "Meters"}
    path = files.motive(tmp_path / "film.csv", *made, first=rate, blank=blank)
    text = path.read_text().replace("Time (Seconds)", "TimeCode")
    path.write_text(text)
    response = read_recording(path, quiet=True, input="motor.x", plane="xz")
    assert_same(response, made)
    assert response["displacement"].attrs["units"] == "m"


def test_a_marker_that_motive_did_not_see_is_filled_in(tmp_path, made):
    time, u, positions = made
    hidden = positions.copy()
    hidden[40:43, 2] = np.nan
    path = files.motive(tmp_path / "film.csv", time, u, hidden)
    response = read_recording(path, quiet=True, input="motor.x", plane="xz")
    line = np.linspace(positions[39, 2], positions[43, 2], 5) - positions[0, 2]
    np.testing.assert_allclose(response["displacement"][39:44, 2], 1e-3 * line, atol=1e-9)
    assert "3 points not seen" in " ".join(sanity(response)["sentence"])


def test_an_uneven_clock_is_made_even(tmp_path):
    rng = np.random.default_rng(5)
    time = np.arange(400) / RATE + 0.2 / RATE * rng.uniform(-1, 1, 400)
    wave = np.sin(2 * np.pi * 0.5 * time)
    positions = np.repeat(wave[:, None, None], 2, axis=2) * 3
    response = read_recording(files.wide(tmp_path / "a.csv", time, wave, positions), quiet=True)
    rate = response.attrs["sample_rate"]
    assert rate == pytest.approx(RATE, rel=0.002)
    grid = response["time"].values
    np.testing.assert_allclose(np.diff(grid), 1 / rate, rtol=1e-9)
    expected = np.sin(2 * np.pi * 0.5 * (grid + time[0]))
    np.testing.assert_allclose(response["input"], expected, atol=5e-3)
    assert "resampled" in sanity(response).set_index("name").loc["rate", "sentence"]


def test_missing_frames_are_filled_up_to_the_stated_length(tmp_path, made):
    time, u, positions = made
    kept = np.r_[0:100, 104:400]
    path = files.wide(tmp_path / "a.csv", time[kept], u[kept], positions[kept])
    response = read_recording(path, quiet=True)
    assert response.sizes["time"] == 400
    np.testing.assert_allclose(response["input"][104:], u[104:])
    assert "4 frames missing" in " ".join(sanity(response)["sentence"])
    with pytest.raises(ValueError, match=r"no frame from 1\.98 s to 2\.08 s \(row 102\), longer"):
        read_recording(path, quiet=True, max_gap=0.05)


def test_what_is_not_seen_at_the_ends_is_cut(tmp_path, made):
    time, u, positions = made
    positions = positions.copy()
    positions[:2, 0], positions[-3:, 1] = np.nan, np.nan
    response = read_recording(files.wide(tmp_path / "a.csv", time, u, positions), quiet=True)
    assert response.sizes["time"] == 395
    np.testing.assert_allclose(response["input"], u[2:-3])


@pytest.mark.parametrize(
    ("change", "name", "sentence"),
    [
        (lambda p: p[:, 1].fill(7.0), "constant", "marker 'b' does not move"),
        (lambda p: p.__setitem__(np.s_[:, 2], p[:, 0]), "duplicated", "'a' and 'c' are the same"),
        (lambda p: p.__setitem__(np.s_[200:, 1, 0], p[200:, 1, 0] + 900), "jumps", "b.x jumps by"),
        (lambda p: np.add(p[:, 0, 1], np.linspace(0, 80, 400), out=p[:, 0, 1]), "drift", "a.y dri"),
        (lambda p: np.minimum(p[:, 0, 0], 102.0, out=p[:, 0, 0]), "clipping", "a.x stays at"),
    ],
    ids=["constant", "duplicated", "jump", "drift", "clipping"],
)  # fmt: skip
def test_what_the_sanity_list_finds(tmp_path, made, change, name, sentence):
    time, u, positions = made
    positions = positions.copy()
    change(positions)
    response = read_recording(files.wide(tmp_path / "a.csv", time, u, positions), quiet=True)
    found = sanity(response).set_index("name").loc[[name]]
    assert (found["severity"] == "warning").all() and sentence in " ".join(found["sentence"])


def test_the_format_of_the_page_on_extending(tmp_path, made, monkeypatch):
    page = Path(__file__).parents[2] / "docs" / "extending.md"
    section = page.read_text().split("\n## A recording format\n")[1]
    (code,) = re.findall(r"```python\n(.*?)```", section, re.DOTALL)
    (tmp_path / "npz_format.py").write_text(code)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setitem(READERS, "npz", Reader("npz_format", (".npz",)))
    _, u, positions = made
    np.savez(tmp_path / "film.npz", u=u, points=positions)
    path, options = tmp_path / "film.npz", {"rate": RATE, "input": "u", "markers": "points"}
    assert_same(read_recording(path, quiet=True, **options), made)
    with pytest.raises(ValueError, match="nearest valid path is 'points'"):
        read_recording(path, quiet=True, **options | {"markers": "point"})
