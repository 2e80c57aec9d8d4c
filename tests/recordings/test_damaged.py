"""Damaged files: a stated repair, or one sentence with file, column and row."""

import subprocess
import sys

import numpy as np
import pytest
import scipy.io

from fiberweb import read_recording
from fiberweb.recordings import sanity
from tests.recordings import files
from tests.recordings.files import RATE, body


@pytest.fixture(scope="module")
def made():
    return body()


def csv(folder, made, **options):
    return files.wide(folder / "film.csv", *made, **options)


def edited(path, *changes):
    """A text file with (old, new) replaced once each, or all that a function makes of it."""
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(text)
    return path


def rows(path, change):
    lines = path.read_text().splitlines()
    path.write_text("\n".join(change(lines)) + "\n")
    return path


def cells(path, at, change):
    """The cells of one row changed; at: as in an editor, from 1."""

    def of_all(lines):
        lines[at - 1] = ",".join(change(lines[at - 1].split(",")))
        return lines

    return rows(path, of_all)


REFUSED = {
    "long gap": (
        lambda p: rows(p, lambda s: [row.split(",")[0] + "," * 7 if 50 <= at < 80 else row
                                     for at, row in enumerate(s)]),
        {}, ["'a' is not seen from 0.98 s to 1.56 s (row 51 on", "max_gap = 0.1 s"],
    ),
    "swapped columns": (
        lambda p: edited(p, ("time,input", "input,time")), {}, ["column 'time', row", "time falls"],
    ),
    "text in a cell": (
        lambda p: cells(p, 7, lambda c: [*c[:3], "lost", *c[4:]]), {},
        ["column 'a_y', row 7: 'lost' is no number"],
    ),
    "empty": (lambda p: p.write_text("") or p, {}, ["is empty"]),
    "header alone": (lambda p: rows(p, lambda s: s[:1]), {}, ["no rows of numbers"]),
    "commas for both": (
        lambda p: rows(p, lambda s: s[:1] + [r.replace(".", ",") for r in s[1:]]), {},
        ["row 2 has more cells than the header's 8", "decimal commas"],
    ),
    "negative rate": (lambda p: p, {"rate": -60.0}, ["rate = -60.0", "greater than 0"]),
    "column twice": (
        lambda p: edited(p, ("b_x", "a_x")), {}, ["its header has 2 columns 'a_x', numbers 3, 5"],
    ),
    "header again": (
        lambda p: rows(p, lambda s: [*s[:100], s[0], *s[100:]]), {},
        ["repeats its header in row 101"],
    ),
    "two takes": (
        lambda p: rows(p, lambda s: [*s, *s[1:]]), {},
        ["column 'time', row 402: time falls from 7.98 to 0"],
    ),
    "constant input": (
        lambda p: rows(p, lambda s: s[:1] + [",".join([r.split(",")[0], "1.5", *r.split(",")[2:]])
                                             for r in s[1:]]),
        {}, ["column 'input': the input is 1.5 in every frame (row 2 on)"],
    ),
    "milliseconds": (
        lambda p: rows(p, lambda s: s[:1] + [f"{20 * k}," + r.split(",", 1)[1]
                                             for k, r in enumerate(s[1:])]),
        {}, ["column 'time' steps by 20", "time_unit: ms if this is 50 Hz"],
    ),
    "no such column": (lambda p: p, {"input": "servoo"}, ["input: unknown column 'servoo'"]),
    "input is the time": (
        lambda p: p, {"input": "time"}, ["column 'time' would be the time and the input: give"],
    ),
    "time is the input": (
        lambda p: p, {"time": "input"}, ["column 'input' would be the time and the input: give"],
    ),
    "marker of time": (
        lambda p: p, {"markers": {"b": ["time", "input"]}},
        ["column 'time' would be the time and x of marker 'b': give"],
    ),
    "x and y of one column": (
        lambda p: p, {"markers": {"a": ["a_x", "a_x"]}},
        ["column 'a_x' would be x of marker 'a' and y of marker 'a': give"],
    ),
    "markers by a path": (
        lambda p: p, {"markers": "a[99999999999999]"}, ["markers = 'a[99999999999999]': a table"],
    ),
    "huge input": (
        lambda p: cells(p, 5, lambda c: [c[0], "-1e300", *c[2:]]), {},
        ["column 'input', row 5: -1e+300 is beyond 1e+100 in magnitude"],
    ),
    "huge marker": (
        lambda p: cells(p, 7, lambda c: [*c[:3], "1e101", *c[4:]]), {},
        ["column 'a.y', row 7: 1e+101 is beyond 1e+100 in magnitude"],
    ),
    "another rate": (lambda p: p, {"rate": 60.0}, ["at 50 Hz, but rate = 60 Hz"]),
    "a clock that stops": (
        lambda p: cells(p, 9, lambda c: ["", *c[1:]]), {}, ["column 'time', row 9: the time is mi"],
    ),
    "no bytes of text": (lambda p: p.write_bytes(b"time\0\1\2") and p, {}, ["no text"]),
}  # fmt: skip


@pytest.mark.parametrize(("damage", "options", "words"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_read_is_one_sentence(tmp_path, made, damage, options, words):
    path = damage(csv(tmp_path, made))
    with pytest.raises(ValueError) as caught:
        read_recording(path, quiet=True, **options)
    text = str(caught.value)
    assert "\n" not in text and all(word in text for word in words), text
    if "rate" not in options or options["rate"] > 0:
        assert str(path) in text


@pytest.mark.parametrize("markers", [{}, ""])
def test_no_marker_at_all_is_one_sentence(tmp_path, made, markers):
    with pytest.raises(ValueError, match=f"^markers = {markers!r}: name at least one marker"):
        read_recording(csv(tmp_path, made), quiet=True, markers=markers)


def test_markers_that_a_format_names_itself_are_not_named_again(tmp_path, made):
    path = files.motive(tmp_path / "film.csv", *made)
    with pytest.raises(ValueError, match="markers = 'a': a file of this format names its markers"):
        read_recording(path, quiet=True, input="motor.x", markers="a")


def turned(lines):
    return [lines[0], *lines[:0:-1]]


REPAIRED = {
    "rows of nothing": (
        lambda p: rows(p, lambda s: [s[0], *(r.split(",")[0] + "," * 7 if k in (5, 6) else r
                                             for k, r in enumerate(s[1:]))]),
        "gaps", "8 points not seen",
    ),
    "clock backwards": (lambda p: rows(p, turned), "clock", "rows were turned round"),
    "latin-1": (
        lambda p: p.write_bytes(p.read_bytes().replace(b"time,", "zeit_für,".encode("latin-1")))
        and p, "encoding", "read as Latin-1",
    ),
    "byte-order mark": (
        lambda p: p.write_bytes(b"\xef\xbb\xbf" + p.read_bytes()) and p, "encoding", "byte-order",
    ),
    "windows": (
        lambda p: p.write_bytes(p.read_bytes().replace(b"\n", b"\r\n")) and p, "encoding", "CRLF",
    ),
    "frames twice": (
        lambda p: rows(p, lambda s: [*s[:60], s[59], *s[60:]]), "clock", "1 frames of a time",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("damage", "name", "words"), REPAIRED.values(), ids=REPAIRED)
def test_what_can_be_put_right_is_stated(tmp_path, made, damage, name, words):
    whole = read_recording(csv(tmp_path, made), quiet=True)
    options = {"time": "zeit_für"} if words == "read as Latin-1" else {}
    response = read_recording(damage(csv(tmp_path, made)), quiet=True, **options)
    found = sanity(response).set_index("name").loc[[name], "sentence"]
    assert any(words in each for each in found), found.tolist()
    lost = slice(5, 7) if name == "gaps" else slice(0, 0)
    for variable in ("input", "displacement"):
        same = np.delete(response[variable].values, lost, 0)
        np.testing.assert_allclose(same, np.delete(whole[variable].values, lost, 0), atol=1e-9)


def test_decimal_commas(tmp_path, made):
    whole = read_recording(csv(tmp_path, made), quiet=True)
    response = read_recording(csv(tmp_path, made, sep=";", decimal=","), quiet=True)
    np.testing.assert_allclose(response["displacement"], whole["displacement"])
    assert "decimal commas" in sanity(response).loc[0, "sentence"]


def test_milliseconds_are_known_by_a_stated_rate(tmp_path, made):
    time, u, positions = made
    path = files.wide(tmp_path / "a.csv", 1e3 * time, u, positions)
    for options in ({"rate": RATE}, {"time_unit": "ms"}):
        response = read_recording(path, quiet=True, **options)
        np.testing.assert_allclose(response["time"], time, atol=1e-9)


def test_one_marker_is_enough(tmp_path):
    response = read_recording(files.wide(tmp_path / "a.csv", *body(markers=1)), quiet=True)
    assert response.sizes["readout"] == 1


def test_an_input_that_comes_late_is_said(tmp_path):
    time, u, positions = body(seed=1)
    late = files.wide(tmp_path / "a.csv", time, np.roll(u, 3), positions)
    found = sanity(read_recording(late, quiet=True)).set_index("name").loc["lag"]
    assert found["severity"] == "warning"
    assert "3 frames (60 ms) ahead of the input" in found["sentence"]


def test_markers_exchanged_midway_are_changed_back(tmp_path, made):
    time, u, positions = made
    wrong = positions.copy()
    wrong[150:, [0, 2]] = wrong[150:, [2, 0]]
    response = read_recording(files.wide(tmp_path / "a.csv", time, u, wrong), quiet=True)
    np.testing.assert_allclose(response["displacement"], positions - positions[0], atol=1e-9)
    assert "'a' and 'c' change places at 3 s" in " ".join(sanity(response)["sentence"])


def test_markers_exchanged_while_they_are_not_seen_are_changed_back(tmp_path, made):
    time, u, positions = made
    wrong = positions.copy()
    wrong[150:, [0, 2]] = wrong[150:, [2, 0]]
    wrong[148:151, 0] = wrong[148:150, 2] = np.nan  # seen again one after the other
    response = read_recording(files.wide(tmp_path / "a.csv", time, u, wrong), quiet=True)
    off = np.abs(response["displacement"].values - (positions - positions[0]))
    ordinary = np.abs(np.diff(positions, axis=0)).max()
    assert off.max() < 2 * ordinary  # of the line across the gap
    assert not np.delete(off, [148, 149, 150], axis=0).max() > 1e-9


def test_names_that_go_round_are_warned_of(tmp_path, made):
    time, u, positions = made
    wrong = positions.copy()
    wrong[150:, [0, 1, 2]] = wrong[150:, [1, 2, 0]]
    found = sanity(read_recording(files.wide(tmp_path / "a.csv", time, u, wrong), quiet=True))
    said = found.set_index("name").loc["exchanged"]
    assert said["severity"] == "warning"
    assert "3 markers jump at once at 3 s" in said["sentence"]


def test_noise_follows_nothing(tmp_path):
    time, u, positions = body(seed=1)
    noise = np.random.default_rng(2).normal(size=positions.shape)
    found = sanity(read_recording(files.wide(tmp_path / "a.csv", time, u, noise), quiet=True))
    assert "no lag to tell" in found.set_index("name").loc["lag"]["sentence"]


@pytest.fixture
def mat(tmp_path, made):
    _, u, positions = made
    path = tmp_path / "film.mat"
    scipy.io.savemat(path, {"tracked": {"servo": u, "points": positions, "samplerate": RATE}})
    return path


MAT = {"input": "tracked.servo", "markers": "tracked.points"}


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (MAT | {"input": "tracked.servoPos"}, "nearest valid path is 'tracked.servo'"),
        (MAT | {"markers": "tracked.servo"}, "markers = 'tracked.servo' has shape (400,)"),
        (MAT | {"input": "tracked.points[7]"}, "ends at 1"),
        (MAT | {"time": "tracked.samplerate"}, "time has shape ()"),
        ({"markers": "tracked.points"}, "name the input"),
        ({}, "name one with markers: path"),
    ],
)
def test_a_path_that_is_not_there_is_one_sentence(mat, options, words):
    with pytest.raises(ValueError) as caught:
        read_recording(mat, quiet=True, **options)
    assert words in str(caught.value) and str(mat) in str(caught.value)


@pytest.mark.parametrize("size", [0, 60, 130, 4000])
def test_a_truncated_mat_is_one_sentence(mat, size):
    mat.write_bytes(mat.read_bytes()[:size])
    with pytest.raises(ValueError, match=r"film\.mat (cannot be read as a MATLAB file|is empty)"):
        read_recording(mat, quiet=True, **MAT)


def test_a_rate_in_a_file_that_is_none(tmp_path, made):
    _, u, positions = made
    path = tmp_path / "film.mat"
    scipy.io.savemat(path, {"tracked": {"servo": u, "points": positions, "samplerate": -RATE}})
    with pytest.raises(ValueError, match="rate = -50 Hz: give the frames per second, above 0"):
        read_recording(path, quiet=True, **MAT)


MEASURE = """
import resource, sys
from fiberweb import read_recording

def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024

read_recording(sys.argv[1], quiet=True)
before = peak()
response = read_recording(sys.argv[2], quiet=True)
print(peak() - before, response.sizes["time"])
"""


def test_memory_of_a_long_recording_is_bounded_by_its_rows(tmp_path):
    """Ten million rows of ten markers have 1.8 GB of numbers, and 4 GB to be read in."""
    time, u, positions = body(20_000, markers=10)
    short = files.wide(tmp_path / "short.csv", time, u, positions, float_format="%.3f")
    header, _, block = short.read_text().partition("\n")
    many, lines = 10, [row.split(",", 1)[1] for row in block.splitlines()]
    with (tmp_path / "long.csv").open("w") as file:
        file.write(header + "\n")
        for at in range(many * len(lines)):
            file.write(f"{at / RATE:.3f},{lines[at % len(lines)]}\n")
    argv = [sys.executable, "-c", MEASURE, short, tmp_path / "long.csv"]
    used, count = map(float, subprocess.check_output(argv, text=True).split())
    assert count == many * len(lines)
    fixed = 200e6  # what is held as text at once
    assert used < fixed + 380 * count
