"""The echo-state network follows its equation, forgets where it started, and repeats itself."""

import numpy as np
import pytest

from fiberweb.scoring import esn

U = np.sin(0.7 * np.arange(300.0)) * np.cos(0.11 * np.arange(300.0))


def drawn(nodes):
    """W, w and b as the module draws them."""
    random = np.random.default_rng(esn.SEED)
    recurrent = random.uniform(-1, 1, (nodes, nodes))
    recurrent *= esn.SPECTRAL_RADIUS / max(abs(np.linalg.eigvals(recurrent)))
    return recurrent, random.uniform(-0.5, 0.5, nodes), random.uniform(-0.5, 0.5, nodes)


def test_states_follow_the_equation_from_rest():
    x = esn.states(U, 20)
    recurrent, entry, bias = drawn(20)
    before = np.vstack([np.zeros(20), x[:-1]])
    expected = 0.5 * before + 0.5 * np.tanh(before @ recurrent.T + np.outer(U, entry) + bias)
    np.testing.assert_allclose(x, expected, atol=1e-13)


def test_states_are_the_same_again():
    np.testing.assert_array_equal(esn.states(U, 12), esn.states(U, 12))


def test_the_start_is_forgotten_and_the_present_is_not():
    other = U.copy()
    other[:100] += 0.5
    difference = np.abs(esn.states(other, 30) - esn.states(U, 30)).max(axis=1)
    assert difference[0] > 0.01  # the input of a sample is in the state of that sample
    assert difference[-1] < 1e-3 * difference[99]


def test_a_network_without_nodes_is_refused():
    with pytest.raises(ValueError, match="nodes = 0 makes no network; give 1 or more"):
        esn.states(U, 0)
