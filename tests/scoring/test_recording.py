"""What a response's time says, and what a long recording takes of memory."""

import subprocess
import sys

import numpy as np
import pytest
import xarray as xr

from fiberweb import baselines, score
from fiberweb.scoring import capacity, recording, regression
from tests.scoring.reservoirs import RATE, drive, reservoir


@pytest.fixture(scope="module")
def response():
    u = drive(40.0)
    moved = reservoir(u, 10, np.random.default_rng(0)).reshape(len(u), 5, 2)
    return xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), moved)},
        {"time": np.arange(len(u)) / RATE, "axis": ["x", "y"]},
        {"status": "ok", "setup": "described", "sample_rate": RATE},
    )


def same(scored, expected):
    for name in ("c_nl", "c_m", "c_m_se"):
        assert float(scored[name]) == getattr(expected, name), name
    np.testing.assert_array_equal(scored["lag"], expected.lags)


def test_a_thinned_response_is_scored_at_its_own_rate(response):
    thinned = response.isel(time=slice(None, None, 5))
    u, moved = thinned["input"].values, recording.signals(thinned)
    same(score(thinned), capacity.score_arrays(u, moved, RATE / 5))
    assert score(thinned).attrs["sample_rate"] == pytest.approx(RATE / 5)


def test_a_coarsened_or_interpolated_response_is_scored_at_its_own_rate(response):
    coarse = response.coarsen(time=4, boundary="trim").mean()
    assert recording.sample_rate(coarse) == pytest.approx(RATE / 4)
    fine = response.interp(time=np.arange(0.0, 39.0, 0.5 / RATE))
    assert recording.sample_rate(fine) == pytest.approx(2 * RATE)
    memory = [float(score(each)["c_m"]) for each in (response, fine)]
    assert memory[1] == pytest.approx(memory[0], abs=0.01)


@pytest.mark.parametrize("unit", [np.float32, "timedelta64[ns]"])
def test_time_in_single_precision_or_as_xarray_decodes_it_is_the_same_time(response, unit):
    time = response["time"].values
    time = time.astype(unit) if unit is np.float32 else (time * 1e9).round().astype(unit)
    same(
        score(response.assign_coords(time=time)),
        capacity.score_arrays(response["input"].values, recording.signals(response), RATE),
    )


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda r: r.isel(time=[*range(900), *range(950, 2000)]), "from frame 899 to the next"),
        (
            lambda r: r.isel(time=[*range(900), *range(901, 2000)]),
            r"uneven time: 0\.04 s from frame",
        ),
        (lambda r: r.isel(time=slice(None, None, -1)), r"response\.sortby"),
        (lambda r: r.assign_coords(time=np.zeros(r.sizes["time"])), r"response\.sortby"),
        (lambda r: r.drop_vars("time"), "no coordinate 'time'"),
        (lambda r: r.assign_coords(time=list(map(str, r["time"].values))), "numbers of seconds"),
        (lambda r: r.isel(time=[0]), "response has 1 frames"),
        (
            lambda r: r.assign_coords(time=("time", 1e3 * r["time"].values, {"units": "ms"})),
            "time in 'ms'; give it in s",
        ),
    ],
    ids=["gap", "one lost", "reversed", "still", "none", "text", "one", "units"],
)
def test_time_that_cannot_be_counted_in_frames_is_refused(response, change, sentence):
    with pytest.raises(ValueError, match=sentence):
        score(change(response))


def test_masked_and_complex_values_are_refused(response):
    u, moved = response["input"].values, recording.signals(response)
    masked = np.ma.masked_array(moved, np.arange(moved.size).reshape(moved.shape) == 100)
    with pytest.raises(ValueError, match=r"^readouts has masked values"):
        capacity.score_arrays(u, masked, RATE)
    with pytest.raises(ValueError, match=r"^readouts has masked values"):
        capacity.score_arrays(u, list(masked), RATE)
    with pytest.raises(ValueError, match=r"^readouts is complex"):
        capacity.score_arrays(u, moved + 0j, RATE)
    for kind in (object, str, "timedelta64[s]"):
        with pytest.raises(ValueError, match=r"^readouts has values of type"):
            capacity.score_arrays(u, moved.astype(kind), RATE)
    with pytest.raises(ValueError, match=r"^readouts is complex"):
        score(response.assign(displacement=response["displacement"] * (1 + 1j)))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda r: score(r, split=0.9999), r"^split = 0\.9999 of 40 s leaves 1 frames to test on"),
        (lambda r: score(r.assign_attrs(status="OK")), "status = 'OK'; set it to 'ok' or"),
        (lambda r: score(r.assign_attrs(setup="mine")), "setup = 'mine'; set it to one of"),
        (lambda r: baselines(r.where(r["time"] > 1.0)), "^u holds values that are not finite"),
    ],
)
def test_what_was_scored_without_a_word_is_refused(response, change, sentence):
    with pytest.raises(ValueError, match=sentence):
        change(response)


@pytest.mark.parametrize(
    "options", [{}, {"scoring": "published"}, {"scoring": "published", "shuffle": True}]
)
def test_blocks_of_targets_change_no_number(response, options, monkeypatch):
    u, moved = response["input"].values, recording.signals(response)
    whole = capacity.score_arrays(u, moved, RATE, **options)
    monkeypatch.setattr(regression, "BLOCK", 3 * len(u))
    blocks = capacity.score_arrays(u, moved, RATE, **options)
    for name in vars(whole):
        np.testing.assert_allclose(getattr(blocks, name), getattr(whole, name), rtol=0, atol=1e-12)


@pytest.mark.parametrize("scoring", regression.SCORINGS)
def test_more_signals_than_frames_score_as_they_do_unrotated(response, scoring, monkeypatch):
    u, rng = response["input"].values[:200], np.random.default_rng(1)
    moved = recording.signals(response)[:200] @ rng.standard_normal((10, 300))
    moved += rng.standard_normal(moved.shape)
    scored = capacity.score_arrays(u, moved, RATE, scoring=scoring, alpha=1.0)
    monkeypatch.setattr(regression, "narrowed", lambda x: x)
    unrotated = capacity.score_arrays(u, moved, RATE, scoring=scoring, alpha=1.0)
    for name in vars(scored):
        np.testing.assert_allclose(
            getattr(scored, name), getattr(unrotated, name), rtol=0, atol=1e-12
        )


MEASURE = """
import resource, sys
import numpy as np
from fiberweb.scoring import capacity

def peak():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024

frames, signals, rate = map(int, sys.argv[1:])
rng = np.random.default_rng(0)
capacity.score_arrays(rng.standard_normal(99), rng.standard_normal((99, 2)), 10.0)
before = peak()
u, moved = rng.standard_normal(frames), rng.standard_normal((frames, signals))
capacity.score_arrays(u, moved, rate)
print(peak() - before, moved.nbytes / 2**20)
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("frames", "signals", "rate"), [(100_000, 112, 1000), (1000, 15_200, 250)], ids=["long", "wide"]
)
def test_memory_of_scoring(frames, signals, rate):
    """A 4x4 over 100 s at 1 kHz, which took 5.1 GB, and a 50x50 over 4 s, which took 6.2 GB."""
    argv = [sys.executable, "-c", MEASURE, *map(str, (frames, signals, rate))]
    used, data = map(float, subprocess.check_output(argv, text=True).split())
    assert used < 3 * data + 300
