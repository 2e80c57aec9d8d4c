"""The input: the paper's series, and the same for every run."""

import numpy as np
import pytest

from fiberweb.model.drive import spline


def test_input_starts_at_zero_and_overshoots():
    """The paper's series: knots in [-1, 1] at 5 Hz, the first 0; the spline reaches 1.18."""
    u = spline()
    knots = u(np.arange(501) / 5)
    assert knots[0] == 0.0
    assert np.abs(knots).max() <= 1.0 + 1e-12
    assert np.abs(u(np.linspace(0, 100, 100_001))).max() == pytest.approx(1.18, abs=0.005)


def test_a_shorter_run_sees_the_same_input():
    time = np.linspace(0, 3, 1001)
    np.testing.assert_array_equal(spline(duration=3.0)(time), spline(duration=100.0)(time))
    np.testing.assert_allclose(spline(duration=150.0)(time), spline()(time), atol=1e-12)
    assert spline(duration=150.0).x[-1] >= 150.0


def test_seeds_give_different_inputs_and_the_same_again():
    time = np.linspace(0, 10, 101)
    assert np.abs(spline(1)(time) - spline(2)(time)).max() > 0.5
    np.testing.assert_array_equal(spline(7)(time), spline(7)(time))
