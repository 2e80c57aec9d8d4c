"""The score card of known bodies, what must not change it, and that nothing leaks into it."""

import json
import re

import numpy as np
import pytest
import xarray as xr

from fiberweb import card, score
from fiberweb.scoring import card as cards
from fiberweb.scoring import penalty, processing, regression

RATE = 10.0


def body(u, signals, rate=RATE, **attrs):
    """A response of signals (T, 2m), taken for the x and y of m markers."""
    moved = signals.reshape(len(u), 2, -1).transpose(0, 2, 1)
    return xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), moved)},
        {"time": np.arange(len(u)) / rate, "axis": ["x", "y"]},
        {"status": "ok", "setup": "recording", "sample_rate": rate} | attrs,
    )


def taps(u, count):
    return np.stack([np.r_[np.zeros(k), u[: len(u) - k]] for k in range(count)], axis=1)


@pytest.fixture(scope="module", autouse=True)
def few_surrogates():
    """Enough for what is tested here; `test_processing` has all of them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(processing, "SURROGATES", 19)
        yield


@pytest.fixture(scope="module")
def u():
    return np.random.default_rng(4).uniform(-1.0, 1.0, 1000)


@pytest.fixture(scope="module")
def computing(u):
    """Memory, and products of the input with its past, under a little noise."""
    past = taps(u, 6)
    x = np.hstack([past[:, :3], past[:, :3] * past[:, 1:4]])
    return body(u, x + 1e-2 * np.random.default_rng(5).standard_normal(x.shape))


@pytest.fixture(scope="module")
def made(computing):
    return card(computing)


def value(made, quantity, readout="body"):
    rows = made.scores.set_index(["readout", "quantity"])
    return rows.loc[(readout, quantity), "value"]


def same(one, other, **tolerance):
    np.testing.assert_allclose(
        other.scores[["value", "low", "high"]].to_numpy(float),
        one.scores[["value", "low", "high"]].to_numpy(float), **tolerance,
    )  # fmt: skip


def test_a_delay_line_recalls_its_lags_and_computes_nothing_else(u):
    line = card(body(u, taps(u, 4)))
    assert value(line, "c_m") == pytest.approx(4 / 11, abs=0.01)
    rows = line.scores.set_index(["readout", "quantity"]).loc["body"]
    # the estimate is exact but for the penalty, so that its interval is as narrow as round-off
    assert rows.loc["ipc", "low"] - 1e-6 <= 4.0 <= rows.loc["ipc", "high"] + 1e-6
    assert value(line, "ipc_2") == value(line, "ipc_3") == 0.0
    assert line.facts["taps"] == 4
    assert "the body computes nothing that its input" in line.verdict


def test_products_are_what_input_and_delay_line_do_not_compute(made):
    assert made.verdict.startswith("The body computes more than its input")
    assert "capacity of degree 2" in made.verdict and "C_m" not in made.verdict
    assert value(made, "ipc_2") > 2.5 and value(made, "ipc_2", "delay line") == 0.0
    assert value(made, "ipc") <= value(made, "rank") == 6


def test_capacities_are_those_of_score(computing, made):
    scored = score(computing)
    for name in ("c_nl", "c_m"):
        assert value(made, name) == pytest.approx(float(scored[name]), abs=1e-12)


def test_errors_are_one_error_three_ways(made):
    for readout in ("body", "u", "delay line"):
        rmse, nrmse, nmse = (value(made, f"narma5_{e}", readout) for e in ("rmse", "nrmse", "nmse"))
        assert nmse == pytest.approx(nrmse**2) and rmse < nrmse


def test_intervals_hold_their_values(made):
    rows = made.scores.dropna()
    rows = rows[rows["quantity"].str.contains("narma|c_m")]
    assert len(rows) == 5 * 10
    assert ((rows["low"] <= rows["value"]) & (rows["value"] <= rows["high"])).all()


def test_a_permuted_copy_scores_the_same(computing, made):
    same(made, card(computing.isel(readout=[2, 0, 1])), rtol=1e-8, atol=1e-9)


def test_doubling_every_marker_changes_nothing(computing, made):
    double = card(xr.concat([computing, computing], "readout", data_vars="minimal"))
    same(made, double, rtol=1e-8, atol=1e-9)
    same(made, card(computing.assign(displacement=2.0 * computing["displacement"])), rtol=1e-8)


@pytest.mark.parametrize("alpha", [0.01, "cv"])
def test_test_rows_change_no_weight(computing, alpha, monkeypatch):
    """Neither scale, nor choice of signals, of taps or of the penalty, nor any weight sees them."""
    monkeypatch.setattr(processing, "SURROGATES", 0)  # these have other rows on purpose
    weights = []
    original = regression.solve_windows

    def noted(*args):
        found = original(*args)
        weights.extend(found)
        return found

    monkeypatch.setattr(regression, "solve_windows", noted)
    first = 10 + int(0.75 * 990)
    for change in (lambda x: x, lambda x: 100 * np.random.default_rng(0).standard_normal(x.shape)):
        moved = computing["displacement"].copy()
        moved[first:] = change(moved[first:].values)
        card(computing.assign(displacement=moved), alpha=alpha)
    half = len(weights) // 2
    assert half > 20
    for before, after in zip(weights[:half], weights[half:], strict=True):
        np.testing.assert_array_equal(before, after)


def test_a_row_of_the_training_part_does_change_them(computing, made):
    moved = computing["displacement"].copy()
    moved[500] += 1.0
    assert value(card(computing.assign(displacement=moved)), "c_m") != value(made, "c_m")


def test_the_penalty_is_chosen_in_blocks_of_the_rows_it_is_given():
    """A smooth signal is no use where it was not trained on: shuffled folds would not see that."""
    rng = np.random.default_rng(7)
    walk = np.cumsum(rng.standard_normal((400, 30)), axis=0)
    target = np.cumsum(rng.standard_normal((400, 1)), axis=0)
    assert penalty.best_penalty(walk, target) == penalty.PENALTIES.max()
    assert penalty.best_penalty(walk, walk[:, :1]) == penalty.PENALTIES.min()


def test_a_task_that_diverges_is_left_out_with_the_safe_range(computing):
    given = card(computing, amplitude=0.6, order=[2, 10])
    assert not given.scores["quantity"].str.startswith("narma10").any()
    assert "diverges" in " ".join(given.notes) and "0 to 0.311; it was left out" in given.notes[-1]


def test_a_short_recording_says_that_it_is_short(computing):
    short = card(computing.isel(time=slice(0, 150)))
    assert "3 whole blocks of 1 s: the intervals are wide, and rough themselves" in short.notes[0]
    assert short.verdict.startswith("3 whole blocks of 1 s are too few to tell")


def test_more_taps_than_the_recording_has_are_refused_by_name(computing):
    horizon = round(computing.attrs["sample_rate"])
    most = computing.sizes["time"] - horizon + 1
    assert card(computing, taps=most - 200).facts["taps"] == most - 200
    for taps, split in ((most + 1, 0.75), (most, 0.99), (most, 0.01)):
        with pytest.raises(ValueError, match=f"taps = {taps} leave .*; give fewer"):
            card(computing, taps=taps, split=split)


def test_who_passes_a_bar_is_said(computing):
    passed = card(computing, recipe="phresco")
    assert passed.facts["taps"] == 10 and "recipe 'phresco'" in passed.notes[0]
    # products of the input by 0.5 are most of NARMA-5, and the body has those of other lags
    said = next(note for note in passed.notes if note.startswith("NARMA-2"))
    assert re.search(r"bar of 20% is passed by .*, not by the body \(0\.\d+\)\.$", said)
    easy = card(computing, recipe="phresco", bar=2.0).notes
    assert "bar of 200% is passed by the body" in " ".join(easy)


def test_a_key_that_is_given_wins_over_the_recipe(computing):
    assert card(computing, recipe="phresco", taps=3).facts["taps"] == 3


def test_a_thinned_card_is_that_of_the_thinned_recording(computing, made):
    fine = computing.isel(time=np.repeat(np.arange(1000), 2))
    fine = fine.assign_coords(time=np.arange(2000) / (2 * RATE)).assign_attrs(sample_rate=2 * RATE)
    same(made, card(fine, rate=RATE))


def test_of_a_long_recording_the_last_part_is_scored(computing, monkeypatch):
    monkeypatch.setattr(cards, "LONGEST", 800)
    assert "Only the last 800 frames" in " ".join(card(computing).notes)


def test_a_card_is_json_and_prints(made):
    back = json.loads(json.dumps(made.as_dict(), allow_nan=False))
    assert back["verdict"] == made.verdict and len(back["scores"]) == len(made.scores)
    assert made.verdict in str(made) and "narma10_nmse" in str(made)


@pytest.mark.parametrize(("rows", "part"), [(np.s_[:800], "training"), (np.s_[700:], "test")])
def test_an_input_that_stops_is_refused(computing, rows, part):
    stopped = computing["input"].copy()
    stopped[rows] = 0.3
    with pytest.raises(ValueError, match=f"the input does not change in the {part} part"):
        card(computing.assign(input=stopped))


@pytest.mark.parametrize(
    ("change", "options", "words"),
    [
        (lambda r: r.assign_attrs(status="unstable"), {}, "unstable run has no score card"),
        (lambda r: r.isel(time=slice(0, 15)), {}, "too short for a recall horizon"),
        (lambda r: 0 * r, {}, "no marker moves"),
        (lambda r: r, {"rate": 3.0}, "rate = 3 Hz does not divide the recording's 10 Hz"),
        (lambda r: r, {"alphe": 1.0}, "nearest valid argument is 'alpha'"),
        (lambda r: r, {"split": 1.5}, "split = 1.5: input should be less than 1"),
        (lambda r: r, {"recipe": "mine"}, "recipe = 'mine': input should be 'phresco'"),
    ],
)
def test_what_has_no_card_is_one_sentence(computing, change, options, words):
    with xr.set_options(keep_attrs=True), pytest.raises(ValueError) as caught:
        card(change(computing).assign(input=computing["input"]), **options)
    assert words in str(caught.value) and "\n" not in str(caught.value)
