"""The authors' rotations: against plain three-dimensional matrices, and what they do to a fibre."""

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, score, simulate
from fiberweb.engines import authors_rotations as authors
from fiberweb.engines import cosserat
from fiberweb.engines.base import Numerics
from fiberweb.model.mesh import build


def turned(q, omega, time):
    """Directors (3, 3) after a turn about their first axis: Rodrigues' matrix."""
    speed = np.sqrt(omega**2)
    axis = omega / (speed + 1e-14)
    sine, versine = np.sin(speed * time), 1.0 - np.cos(speed * time)
    along, across = 1.0 - versine * axis**2, sine * axis
    return np.array([[1.0, 0.0, 0.0], [0.0, along, across], [0.0, -across, along]]) @ q


def rotation(q0, q1):
    """Their rotation vector between two directors, its component about the first axis."""
    trace = min(np.trace(q1 @ q0.T), 3.0)
    theta = np.arccos(0.5 * trace - 0.5)
    relative = q1 @ q0.T
    return -0.5 * theta / np.sin(theta + 1e-14) * (relative[2, 1] - relative[1, 2])


def directors(cosine, sine):
    """Normal of the plane, and the tangent (cosine, sine) as the third."""
    return np.array([[0.0, 0.0, 1.0], [sine, -cosine, 0.0], [cosine, sine, 0.0]])


def couple(c0, s0, c1, s1):
    """Of one node with unit stiffness between elements at rest length."""
    one, out = np.ones(1), np.zeros(1)
    columns = (np.array([value], dtype=float) for value in (c0, s0, c1, s1))
    authors.couple_pass(*columns, one, one, one, 0.5 * one, out)
    return out[0]


def test_turning_is_a_product_of_matrices():
    rng = np.random.default_rng(1)
    angle, omega, step = rng.uniform(-np.pi, np.pi, 64), rng.normal(0.0, 3e3, 64), 5e-6
    omega[0] = 0.0
    c, s = np.cos(angle), np.sin(angle)
    expected = [
        turned(turned(directors(*cs), w, step / 2), w, step / 2)[2, :2]
        for cs, w in zip(zip(c, s), omega)
    ]
    after = angle.copy()
    authors.rotate_pass(after, omega, c, s, step)
    np.testing.assert_allclose(np.column_stack([c, s]), expected, rtol=0, atol=4e-16)
    np.testing.assert_allclose(after, angle + step * omega, rtol=1e-15)


def test_couple_is_their_rotation_vector():
    """Also for turns that a bent fibre has. The series leaves out .012 of the fifth power of
    1 - cos(theta), which is 2e-9 at 0.3 rad."""
    for turn in (1e-4, -3e-3, 0.05, -0.3):
        q0, q1 = (
            directors(np.cos(0.7), np.sin(0.7)),
            directors(np.cos(0.7 + turn), np.sin(0.7 + turn)),
        )
        found = couple(np.cos(0.7), np.sin(0.7), np.cos(0.7 + turn), np.sin(0.7 + turn))
        assert found == pytest.approx(rotation(q0, q1), rel=3e-9)
        assert found == pytest.approx(turn, rel=1e-5)


def test_directors_that_have_grown_feel_no_small_turn():
    """Lengths squared of 1 + e each: nothing below an angle of sqrt(2 e), all of it beyond."""
    grown = np.sqrt(1.0 + 1e-11)
    band = np.sqrt(2e-11)
    below, beyond = 0.9 * band, 1.2 * band
    assert couple(grown, 0.0, grown * np.cos(below), grown * np.sin(below)) == 0.0
    assert couple(grown, 0.0, grown * np.cos(beyond), grown * np.sin(beyond)) == pytest.approx(
        beyond, rel=1e-5
    )
    assert couple(1.0, 0.0, np.cos(below), np.sin(below)) == pytest.approx(below, rel=1e-3)


@pytest.mark.parametrize("name, count", [("couple_pass", 9), ("rotate_pass", 4)])
def test_rounding_is_that_of_the_authors(name, count):
    """The same bits as in Python, which fuses no multiply-add outside of series: that would change
    how lengths drift, and so the band."""
    compiled = getattr(authors, name)
    fast = list(np.random.default_rng(2).normal(1.0, 0.1, (count, 999)))
    plain = [values.copy() for values in fast]
    step = [5e-6] if name == "rotate_pass" else []
    compiled(*fast, *step)
    compiled.py_func(*plain, *step)
    np.testing.assert_array_equal(fast, plain)


def test_lengths_of_directors_drift_as_round_off_does(monkeypatch):
    """What the band is made of, after a second of the 2x2: some 1e-12, and never reset."""
    states = []
    rest = cosserat._rest
    monkeypatch.setattr(cosserat, "_rest", lambda *a: states.append(rest(*a)) or states[-1])
    mesh = build(Scene(crosshatch(2, length=0.5), setup="published", duration=1.0))
    cosserat.integrate(mesh, Numerics("cosserat", None, 5e-6))
    (state,) = states
    drift = abs(state.cosine**2 + state.sine**2 - 1.0)
    turning = state.omega != 0.0
    assert 1e-14 < np.median(drift[turning]) < 1e-11
    assert np.abs(np.arctan2(state.sine, state.cosine) - state.angle)[turning].max() < 1e-9


@pytest.mark.slow
def test_the_authors_2x2_to_the_third_digit():
    """density_500mm.csv of the authors: N = 2 has C_nl .5349 and C_m .1653; rounding alone moves
    both by .001. Without the band C_nl is .542."""
    capacity = score(simulate(Scene(crosshatch(2, length=0.5), setup="published")))
    assert float(capacity.c_nl) == pytest.approx(0.5349, abs=0.002)
    assert float(capacity.c_m) == pytest.approx(0.1653, abs=0.002)
