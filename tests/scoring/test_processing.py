"""Information-processing capacity of bodies whose capacity is known, and ranks."""

import numpy as np
import pytest

from fiberweb.scoring import esn, processing, rank
from fiberweb.scoring.blocks import capacity_of
from fiberweb.scoring.regression import estimated

HORIZON = 10  # frames


@pytest.fixture(scope="module")
def u():
    return np.random.default_rng(8).uniform(-1.0, 1.0, 1500)


def taps(u, count):
    return np.stack([np.r_[np.zeros(k), u[: len(u) - k]] for k in range(count)], axis=1)


def scored(u, x, alpha=0.01):
    """(capacity of each function, those that count, the functions)"""
    fitted = slice(HORIZON, HORIZON + 3 * (len(u) - HORIZON) // 4)
    functions = processing.basis(u, fitted, HORIZON)
    sums, threshold = processing.processing(x, functions, fitted, alpha, HORIZON)
    c = capacity_of(sums.sum(axis=1))
    return c, c > threshold, functions


def test_a_delay_line_has_one_of_each_tap_and_nothing_nonlinear(u):
    count = 5
    c, counted, functions = scored(u, taps(u, count))
    assert processing.total(c, counted) == pytest.approx(count, abs=1e-6)
    assert (functions.degree[counted] == 1).all()
    assert functions.delay[counted].tolist() == list(range(count))


def test_powers_have_one_of_each_degree(u):
    c, counted, functions = scored(u, np.stack([u, u**2, u**3], axis=1))
    for degree in (1, 2, 3):
        mine = counted & (functions.degree == degree)
        mixed = len(c) / 1117  # functions a training row, see the module
        assert 1.0 - mixed < processing.total(c, mine) <= 1.0
    assert (functions.delay[counted] == 0).all()


@pytest.mark.parametrize("still", [False, True])
def test_the_threshold_is_that_of_fits_from_scratch(u, still):
    x = np.hstack([esn.states(u, 12), u[:, None] ** 2])
    if still:
        x[:700, 3] = x[710:, 3] = 0.2  # in some surrogates it moves in the test rows alone
    fitted, alpha = slice(HORIZON, 1127), 0.01
    functions = processing.basis(u, fitted, HORIZON)
    _, threshold = processing.processing(x, functions, fitted, alpha, HORIZON)
    random, z = np.random.default_rng(0), functions.values
    highest = 0.0
    for _ in range(processing.SURROGATES):
        order = processing._in_blocks(HORIZON, len(x), HORIZON, random)
        guess = estimated(x[order], z, fitted, alpha, slice(fitted.stop, None))
        rest = z[fitted.stop :]
        error = ((guess - rest) ** 2).sum(axis=0) / ((rest - rest.mean(axis=0)) ** 2).sum(axis=0)
        highest = max(highest, 1.0 - error.min())
    assert threshold == pytest.approx(highest, rel=1e-10)


def test_of_a_product_of_two_inputs_only_their_product_is_found(u):
    c, counted, functions = scored(u, taps(u, 4)[:, [1]] * taps(u, 4)[:, [3]])
    assert functions.degree[counted].tolist() == [2] and functions.delay[counted].tolist() == [3]
    assert 1.0 - len(c) / 1117 < c[counted][0] <= 1.0


def test_noise_has_none_in_95_of_100_draws():
    rng, nothing = np.random.default_rng(11), 0
    for _ in range(100):
        u = rng.uniform(-1.0, 1.0, 300)
        c, counted, _ = scored(u, rng.standard_normal((300, 4)))
        nothing += processing.total(c, counted) == 0.0
    assert nothing >= 95


@pytest.mark.parametrize("nodes", [4, 12])
def test_an_echo_state_network_stays_under_its_rank_and_its_size(u, nodes):
    x = esn.states(u, nodes)
    c, counted, _ = scored(u, x, alpha=1e-6)
    ranks = rank.ranks(x, u, slice(HORIZON, 900), HORIZON, 1)
    assert 0.5 * nodes < processing.total(c, counted) <= ranks["rank"] <= nodes


def test_functions_are_orthogonal_on_the_training_rows_alone(u):
    smooth = np.convolve(u, np.ones(4) / 4, "same")
    fitted = slice(HORIZON, 900)
    values = processing.basis(smooth, fitted, HORIZON).values
    gram = values[fitted].T @ values[fitted] / 890
    np.testing.assert_allclose(gram, np.eye(values.shape[1]), atol=1e-8)
    later = smooth.copy()
    later[900:] = 0.3
    np.testing.assert_array_equal(processing.basis(later, fitted, HORIZON).values[:900],
                                  values[:900])  # fmt: skip


def test_a_binary_input_has_no_powers():
    u = np.sign(np.random.default_rng(3).uniform(-1, 1, 2000))
    fitted = slice(HORIZON, 1500)
    functions = processing.basis(u, fitted, 3)
    # products of different delays are all there is: 4 of degree 1, 6 of 2 and 4 of 3
    assert np.bincount(functions.degree).tolist() == [0, 4, 6, 4]


def test_ranks_tell_inputs_apart_and_not_noise(u):
    fitted = slice(HORIZON, 900)
    remembers = rank.ranks(taps(u, 6), u, fitted, 5, 1)
    assert remembers["n_signals"] == remembers["rank"] == remembers["kernel_rank"] == 6
    assert remembers["effective_rank"] == pytest.approx(6.0, abs=0.05)
    # one state after all inputs that are alike, whatever is behind the last digits
    one = rank.ranks(np.tile(u[:, None] > 0, 6) * 1.0, u, fitted, 0, 1)
    assert one["rank"] == one["kernel_rank"] == one["generalisation_rank"] == 1
    assert one["effective_rank"] == pytest.approx(1.0)


def test_a_recording_too_short_for_ranks_has_none(u):
    ranks = rank.ranks(taps(u, 6)[:30], u[:30], slice(10, 20), 5, 1)
    assert np.isnan(ranks["kernel_rank"]) and ranks["n_signals"] == 6


def test_effective_rank_counts_equal_directions_and_not_copies():
    waves = np.linalg.qr(np.random.default_rng(1).normal(size=(200, 4)))[0]
    waves -= waves.mean(axis=0)
    waves = np.linalg.qr(waves)[0]
    assert rank.effective_rank(waves) == pytest.approx(4)
    assert rank.effective_rank(waves * [1, 1e3, 1e-3, 7] + 5) == pytest.approx(4)
    assert rank.effective_rank(np.repeat(waves[:, :1], 3, axis=1)) == pytest.approx(1)
    still = np.column_stack([waves[:, :2], np.zeros(200)])
    assert rank.effective_rank(still) == pytest.approx(2)


def test_effective_rank_of_two_correlated_signals_is_the_formula():
    a, b = np.linalg.qr(np.column_stack([np.ones(100), np.eye(100)[:, :2]]))[0][:, 1:].T
    share = np.sqrt([1.6, 0.4]) / np.sqrt([1.6, 0.4]).sum()  # correlation 0.6
    expected = np.exp(-(share * np.log(share)).sum())
    found = rank.effective_rank(np.column_stack([a, 0.6 * a + 0.8 * b]))
    assert found == pytest.approx(expected)


def test_effective_rank_of_nothing_is_refused():
    with pytest.raises(ValueError, match="no signal moves"):
        rank.effective_rank(np.ones((10, 2)))
