"""Capacities against sklearn, against known answers, and what happens when the input is wrong."""

import math

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import eval_legendre
from sklearn.linear_model import Ridge
from sklearn.model_selection import train_test_split
from sklearn.preprocessing import StandardScaler

from fiberweb.scoring import capacity
from fiberweb.scoring import regression as ridge
from tests.scoring.reservoirs import RATE, drive, reservoir

LAGS = np.arange(51)


# --- the oracle: both scorings written out with sklearn ---------------------------------------


def min_max(u):
    return 2 * (u - u.min()) / (u.max() - u.min()) - 1


def c_of(z, estimate):
    return 1 - np.sum((estimate - z) ** 2) / np.sum((z - z.mean()) ** 2)


def all_targets(u):
    """(first frame, target from there on) of P_1..P_10 and every lag."""
    nonlinear = [(0, eval_legendre(k, u)) for k in range(1, 11)]
    return nonlinear + [(k, u[: len(u) - k]) for k in LAGS]


def oracle_clean(u, x, alpha):
    """[test c, train c], each over the 61 targets."""
    u, first = min_max(u), round(RATE)
    rows = np.arange(first, len(u))
    train, test = train_test_split(rows, test_size=0.25, shuffle=False)
    scaler = StandardScaler().fit(x[train])
    result = []
    for start, z in all_targets(u):
        z = np.concatenate([np.full(start, np.nan), z])
        ridge = Ridge(alpha=alpha, solver="svd").fit(scaler.transform(x[train]), z[train])
        result.append(
            [c_of(z[part], ridge.predict(scaler.transform(x[part]))) for part in (test, train)]
        )
    return np.transpose(result)


def oracle_published(u, x, alpha, shuffle=False, most=(1.0, 1.0)):
    """[test c, train c, raw test c], each over the 61 targets; most: of 10 polynomials, of lags."""
    u, x = min_max(u), StandardScaler().fit_transform(x)
    result = []
    for index, (start, z) in enumerate(all_targets(u)):
        at_random = {"random_state": 42} if shuffle and index < 10 else {"shuffle": False}
        x_train, x_test, z_train, z_test = train_test_split(
            x[start:], z, test_size=0.25, **at_random
        )
        ridge = Ridge(alpha=alpha, solver="svd").fit(x_train, z_train)
        numbers = []
        for x_part, z_part in ((x_test, z_test), (x_train, z_train)):
            estimate, replaced = ridge.predict(x_part), z_part.copy()
            limit = most[index >= 10]
            outside = (estimate > limit) | (estimate < -limit)
            estimate[outside] = replaced[outside] = z_part.mean()
            numbers.append(max(c_of(replaced, estimate), 0.0))
        result.append([*numbers, c_of(z_test, ridge.predict(x_test))])
    return np.transpose(result)


@pytest.mark.parametrize("case", ["well_posed", "collinear"])
@pytest.mark.parametrize("alpha", [0.01, 1.0])
def test_clean_scoring_equals_sklearn(case, alpha, request):
    u, x = request.getfixturevalue(case)
    ours = capacity.score_arrays(u, x, RATE, alpha=alpha)
    test, train = oracle_clean(u, x, alpha)
    np.testing.assert_allclose(np.r_[ours.nonlinear, ours.memory], test, rtol=0, atol=1e-8)
    np.testing.assert_allclose(np.r_[ours.nonlinear_train, ours.memory_train], train, atol=1e-8)
    assert ours.c_nl == pytest.approx(np.clip(test[:10], 0, None).mean(), abs=1e-8)
    assert ours.c_m_raw == pytest.approx(test[10:].mean(), abs=1e-8)


@pytest.mark.parametrize("shuffle", [False, True])
@pytest.mark.parametrize("case", ["well_posed", "collinear"])
def test_published_scoring_equals_sklearn(case, shuffle, request):
    u, x = request.getfixturevalue(case)
    ours = capacity.score_arrays(u, x, RATE, scoring="published", shuffle=shuffle)
    test, train, raw = oracle_published(u, x, 0.01, shuffle)
    assert np.any(np.abs(test - raw) > 1e-3), "no estimate overshoots: the rule is not tested"
    np.testing.assert_allclose(np.r_[ours.nonlinear, ours.memory], test, rtol=0, atol=1e-8)
    np.testing.assert_allclose(np.r_[ours.nonlinear_train, ours.memory_train], train, atol=1e-8)
    np.testing.assert_allclose(np.r_[ours.nonlinear_raw, ours.memory_raw], raw, atol=1e-8)
    assert ours.c_m == pytest.approx(test[10:].mean(), abs=1e-8)


def test_overshoot_is_of_polynomials_and_of_lags(collinear):
    """As the scripts of the experiment have it: other limits than those of the simulations."""
    u, x = collinear
    of_each = []
    for most in ((1.0, 1.0), (0.9, 1.2), (2.0, 1.5)):
        ours = capacity.score_arrays(u, x, RATE, scoring="published", overshoot=most)
        test, *_ = oracle_published(u, x, 0.01, most=most)
        np.testing.assert_allclose(np.r_[ours.nonlinear, ours.memory], test, rtol=0, atol=1e-8)
        of_each.append(ours.c_nl + ours.c_m)
    assert len(set(of_each)) == 3
    for bad, words in ((1.0, "overshoot = 1.0 is no pair"), ((0.0, 1.0), "overshoot = 0.0 is not")):
        with pytest.raises(ValueError, match=words):
            capacity.score_arrays(u, x, RATE, scoring="published", overshoot=bad)


def test_skip_drops_first_frames(well_posed):
    u, x = well_posed
    skipped = capacity.score_arrays(u, x, RATE, scoring="published", skip=300)
    cut = capacity.score_arrays(u[300:], x[300:], RATE, scoring="published")
    np.testing.assert_array_equal(skipped.memory, cut.memory)


# --- known answers ----------------------------------------------------------------------------


@pytest.mark.parametrize("scoring", ridge.SCORINGS)
def test_delayed_copies_of_the_input_are_recalled(scoring):
    u = drive(60.0)
    delays = [0, 10, 35]
    x = np.column_stack([np.concatenate([np.zeros(k), u[: len(u) - k]]) for k in delays])
    memory = capacity.score_arrays(u, x, RATE, scoring=scoring, alpha=1e-6).memory
    assert memory[delays] == pytest.approx(1, abs=1e-6)
    assert memory[22] < 0.9 and memory[50] < 0.9


@pytest.mark.parametrize("scoring", ridge.SCORINGS)
def test_legendre_polynomials_as_readouts_are_nonlinear_capacity(scoring):
    u = drive(60.0)
    x = np.column_stack([eval_legendre(k, min_max(u)) for k in range(1, 11)])
    result = capacity.score_arrays(u, x, RATE, scoring=scoring, alpha=1e-6)
    assert result.nonlinear == pytest.approx(1, abs=1e-6)
    assert result.c_nl == pytest.approx(1, abs=1e-6)
    odd_only = capacity.score_arrays(u, x[:, ::2], RATE, scoring=scoring).nonlinear
    assert odd_only[::2] == pytest.approx(1, abs=1e-4)
    assert np.all(odd_only[1::2] < 0.5)


@pytest.mark.parametrize(
    "name, c_nl, c_m",
    [("u", 0.141, 0.094), ("derivatives", 0.140, 0.280), ("powers", 0.410, 0.094)],
)
def test_input_baselines(name, c_nl, c_m):
    """The input itself, at the paper's duration and rate; numbers of a separate prototype."""
    u = drive(100.0, 250.0)
    x = capacity.trivial_readouts(u, 250.0)[name]
    for scoring, tolerance in (("published", 0.002), ("clean", 0.012)):
        result = capacity.score_arrays(u, x, 250.0, scoring=scoring)
        assert result.c_nl == pytest.approx(c_nl, abs=tolerance)
        assert result.c_m == pytest.approx(c_m, abs=tolerance)


def test_trivial_readouts_differentiate_a_sine():
    t = np.arange(2000) / 250.0
    x = capacity.trivial_readouts(np.sin(t), 250.0)
    truth = np.column_stack([np.sin(t), np.cos(t), -np.sin(t), -np.cos(t)])
    np.testing.assert_allclose(x["derivatives"][5:-5], truth[5:-5], atol=5e-3)
    np.testing.assert_allclose(x["powers"], np.sin(t)[:, None] ** [1, 2, 3])
    assert x["u"].shape == (2000, 1)


# --- clipping, degenerate readouts, invariance ------------------------------------------------


def test_raw_keeps_what_the_totals_clip():
    u = drive(30.0)
    noise = np.random.default_rng(0).standard_normal((len(u), 300))  # fits noise: c < 0 on test
    clean = capacity.score_arrays(u, noise, RATE)
    assert clean.memory.min() < 0 and clean.c_m_raw < 0
    assert clean.c_m == pytest.approx(np.maximum(clean.memory, 0).mean())
    np.testing.assert_array_equal(clean.memory, clean.memory_raw)
    published = capacity.score_arrays(u, noise, RATE, scoring="published")
    assert published.memory.min() == 0 and published.memory_raw.min() < 0


@pytest.mark.parametrize("scoring", ridge.SCORINGS)
def test_still_readouts_change_nothing(scoring, well_posed):
    u, x = well_posed
    still = np.column_stack([np.zeros(len(u)), np.full(len(u), 0.1)])
    with_still = capacity.score_arrays(u, np.hstack([still, x]), RATE, scoring=scoring)
    alone = capacity.score_arrays(u, x, RATE, scoring=scoring)
    np.testing.assert_allclose(with_still.memory, alone.memory, atol=1e-9)
    only_still = capacity.score_arrays(u, still, RATE, scoring=scoring)
    assert only_still.c_nl == only_still.c_m == 0


@settings(max_examples=8, deadline=None)
@given(
    scale=st.floats(-9, 3).map(lambda power: 10.0**power),
    shift=st.floats(-1, 1),
    scoring=st.sampled_from(ridge.SCORINGS),
)
def test_units_and_offset_of_readouts_do_not_matter(scale, shift, scoring):
    u = drive(8.0)
    x = reservoir(u, 6, np.random.default_rng(5))
    before = capacity.score_arrays(u, x, RATE, scoring=scoring)
    after = capacity.score_arrays(3 * u + 1, scale * (x + shift), RATE, scoring=scoring)
    np.testing.assert_allclose(after.nonlinear_raw, before.nonlinear_raw, atol=1e-6)
    np.testing.assert_allclose(after.memory_raw, before.memory_raw, atol=1e-6)


# --- standard errors --------------------------------------------------------------------------


@pytest.mark.parametrize("scoring", ridge.SCORINGS)
@pytest.mark.parametrize("total", ["c_nl", "c_m"])
def test_standard_error_is_the_scatter_of_recordings(scoring, total):
    """Eight recordings scatter by about their errors; eight times the length has a smaller one."""
    u = drive(800.0)
    x = reservoir(u, 5, np.random.default_rng(6))
    parts = [
        capacity.score_arrays(*part, RATE, scoring=scoring)
        for part in zip(np.split(u, 8), np.split(x, 8), strict=True)
    ]
    error = np.mean([getattr(part, f"{total}_se") for part in parts])
    scatter = np.std([getattr(part, total) for part in parts], ddof=1)
    whole = getattr(capacity.score_arrays(u, x, RATE, scoring=scoring), f"{total}_se")
    assert error == pytest.approx(scatter, rel=0.5)
    assert 0 < whole == pytest.approx(error / np.sqrt(8), rel=0.5)


def test_standard_error_is_repeatable_and_unknown_for_a_short_test_part(well_posed):
    u, x = well_posed
    first, second = (capacity.score_arrays(u, x, RATE) for _ in range(2))
    assert first.c_m_se == second.c_m_se
    assert math.isnan(capacity.score_arrays(u[:100], x[:100], RATE).c_nl_se)


# --- traces -----------------------------------------------------------------------------------


@pytest.mark.parametrize("scoring", ridge.SCORINGS)
def test_traces_have_the_capacities_that_were_scored(scoring, well_posed):
    u, x = well_posed
    traces = capacity.predict(u, x, RATE, orders=(4, 7), lags=(0.4, 0.2), scoring=scoring)
    scored = capacity.score_arrays(u, x, RATE, scoring=scoring)
    for column, frames in enumerate((20, 10)):
        z, estimate = traces.memory_target[:, column], traces.memory[:, column]
        known = np.isfinite(z)
        assert c_of(z[known], estimate[known]) == pytest.approx(scored.memory_raw[frames], abs=1e-9)
        frame = np.rint(traces.time[known] * RATE).astype(int)
        np.testing.assert_allclose(z[known], min_max(u)[frame - frames])
    for column, order in enumerate((4, 7)):
        c = c_of(traces.nonlinear_target[:, column], traces.nonlinear[:, column])
        assert c == pytest.approx(scored.nonlinear_raw[order - 1], abs=1e-9)


# --- datasets ---------------------------------------------------------------------------------


def response(u, x, **attrs):
    displacement = np.stack(np.split(x, 2, axis=1), axis=-1)  # x of all readouts, then y of all
    return xr.Dataset(
        {"input": ("time", u), "displacement": (("time", "readout", "axis"), displacement)},
        {"time": np.arange(len(u)) / RATE, "axis": ["x", "y"]},
        {"status": "ok", "setup": "described", "sample_rate": RATE, **attrs},
    )


@pytest.mark.parametrize("setup, scoring", [("described", "clean"), ("published", "published")])
def test_score_of_a_response(setup, scoring, well_posed):
    u, x = well_posed
    scored = capacity.score(response(u, x, setup=setup), alpha=0.1)
    arrays = capacity.score_arrays(u, x, RATE, scoring=scoring, alpha=0.1)
    for name, variable in scored.items():
        np.testing.assert_array_equal(variable, getattr(arrays, name))
        assert variable.attrs["units"] == "1" and variable.attrs["long_name"]
    assert set(scored) == {
        *("nonlinear", "nonlinear_train", "nonlinear_raw", "memory", "memory_train", "memory_raw"),
        *("c_nl", "c_nl_train", "c_nl_raw", "c_nl_se", "c_m", "c_m_train", "c_m_raw", "c_m_se"),
    }
    assert scored.order.values.tolist() == list(range(1, 11))
    np.testing.assert_allclose(scored.lag, LAGS / RATE)
    assert scored.lag.attrs["units"] == "s"
    expected = {"scoring": scoring, "alpha": 0.1, "n_signals": 30, "split": 0.75, "status": "ok"}
    assert expected.items() <= scored.attrs.items()


def test_score_does_not_depend_on_the_order_of_dimensions(well_posed):
    turned = response(*well_posed).transpose("axis", "readout", "time").sel(axis=["y", "x"])
    assert capacity.score(turned).identical(capacity.score(response(*well_posed)))


def test_an_unstable_response_is_a_result(well_posed):
    u, x = well_posed
    broken = response(u, x * np.nan, status="unstable")
    scored, ok = capacity.score(broken), capacity.score(response(u, x))
    assert scored.attrs["status"] == "unstable" and scored.attrs["n_signals"] == 30
    assert {k: v.dims for k, v in scored.items()} == {k: v.dims for k, v in ok.items()}
    assert scored.sizes == ok.sizes
    assert all(bool(variable.isnull().all()) for variable in scored.values())
    with pytest.raises(ValueError, match="scoring = 'papers'"):
        capacity.score(broken, scoring="papers")
    with pytest.raises(ValueError, match="an unstable run has no capacity"):
        capacity.score(response(u, x * np.nan))
