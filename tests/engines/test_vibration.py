"""Natural frequencies against closed forms."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, score, simulate
from tests.engines.fibres import (
    ENGINES,
    fibre,
    first_frequency,
    frequencies,
    largest_step,
    pulled,
    run,
    side_by_side,
    struck,
)

CLAMPED_FREE = np.array([0.596864, 1.49418, 2.50025, 3.49999])  # beta L / pi of four modes
PINNED, BUCKLING = 24.84, 0.0775  # Hz and N, of 100 mm at d = 2 mm


@pytest.mark.parametrize("engine", ENGINES)
def test_clamped_free_frequencies(engine):
    """Within 1 %, undamped, after a pulse on the tip. At 70 diameters and 64 elements the fourth
    mode loses 0.35 % to rotary inertia and shear and 0.4 % to a second-order chain."""
    length = 0.05
    mesh = fibre(64, length, diameter=0.7e-3, damping=0.0)
    first = first_frequency(mesh.scene)
    expected = first / (2 * np.pi) * (CLAMPED_FREE / CLAMPED_FREE[0]) ** 2
    period = 2 * np.pi / first
    force = 0.02 * mesh.scene.bending_stiffness / length**2  # moves the tip by under 1 %
    mesh = struck(mesh, -1, (0.0, force), 0.0, period / 24)
    step = 0.9 * largest_step(mesh, engine)
    every = round(1 / (8 * expected[-1] * step))
    tip = run(mesh, engine, step, round(1.1 * period / (every * step)), every)[:, -1, 1]
    after = int(period / 24 / (every * step)) + 2
    found = frequencies(tip[after:], 1 / (every * step), 4)
    np.testing.assert_allclose(found, expected, rtol=1e-2)


# tension in units of the buckling load; the last strings' bending is 6 % and 2.5 % of f^2
TENSIONS = (-0.5, 0.0, 1.0, 4.0, 16.0, 40.0)


@cache
def pinned_frequencies(engine):
    """First frequency (Hz) of fibres of 100 mm, pinned and sliding, under TENSIONS."""
    length, elements = 0.1, 32
    one = fibre(elements, length, damping=0.0, ends="sliding", tension_ramp=0.01)
    force = 0.02 * one.scene.bending_stiffness / length**2  # moves the middle by 0.04 %
    buckling = np.pi**2 * one.scene.bending_stiffness / length**2
    mesh = side_by_side(
        *[struck(pulled(one, t * buckling, 0.0), elements // 2, (0.0, force), 0.01, 0.01)
          for t in TENSIONS]
    )  # fmt: skip
    step = 0.9 * largest_step(mesh, engine)
    every = round(5e-4 / step)
    rate = 1 / (every * step)
    moved = run(mesh, engine, step, round(0.1 * rate), every)[int(0.021 * rate) :]
    middles = mesh.first[:-1] + elements // 2
    return np.array([frequencies(moved[:, middle, 1], rate, 1)[0] for middle in middles])


@pytest.mark.parametrize("engine", ENGINES)
def test_pinned_fibre_frequency(engine):
    """f1 = (pi / 2) sqrt(EI / rho A) / L^2 = 24.84 Hz for a section of 100 mm, within 1 %."""
    found = pinned_frequencies(engine)[TENSIONS.index(0.0)]
    assert found == pytest.approx(PINNED, rel=1e-2)


@pytest.mark.parametrize("engine", ENGINES)
def test_critical_load_from_the_frequency_under_half_of_it(engine):
    """f^2 = f1^2 (1 - P / P_cr) under compression, P_cr = 77.5 mN, within 1 %."""
    found = pinned_frequencies(engine)
    half, none = found[TENSIONS.index(-0.5)], found[TENSIONS.index(0.0)]
    assert 0.5 * BUCKLING / (1 - (half / none) ** 2) == pytest.approx(BUCKLING, rel=1e-2)


@pytest.mark.parametrize("engine", ENGINES)
def test_string_frequency_against_tension(engine):
    """f^2 = f1^2 (1 + T / P_cr), a beam at small tension and a string at large, within 1 %; the
    stretch of 1 % at the largest takes 0.5 % off the frequency."""
    expected = PINNED * np.sqrt(1 + np.array(TENSIONS))
    np.testing.assert_allclose(pinned_frequencies(engine), expected, rtol=1e-2)


HALF_WAVE = {"kirchhoff": 4, "cosserat": 16, "elastica": 16}  # elements


@pytest.mark.parametrize("damping", [3e4, 6e4, 1e5])
@pytest.mark.parametrize("engine", ENGINES)
def test_decay_rate_under_strong_damping(engine, damping):
    """A bow of a pinned fibre creeps back at damping / 2 - sqrt(damping^2 / 4 - w^2), within the
    1 % that its mesh is off in w^2, whatever damping * step is. In x / sinh x of it, half of that
    product, kirchhoff crept at 0.94, 0.78 and 0.52; in 1 - x, cosserat at 0.92, 0.85 and 0.76."""
    waves, length = 5, 0.5
    mesh = fibre(waves * HALF_WAVE[engine], length, damping=damping, ends="sliding")
    bow = 1e-5 * np.sin(waves * np.pi * mesh.position[:, 0] / length)
    mesh = replace(mesh, start=np.column_stack([0.0 * bow, bow]))
    step = 0.9 * largest_step(mesh, engine)
    every = round(1e-3 / step)
    moved = run(mesh, engine, step, 41, every)[:, :, 1] @ bow
    found = -np.log(moved[40] / moved[20]) / (20 * every * step)
    expected = damping / 2 - np.sqrt(damping**2 / 4 - (2 * np.pi * PINNED) ** 2)
    assert found == pytest.approx(expected, rel=0.01)


def test_capacities_under_strong_damping_do_not_hang_on_the_step():
    """At 1e5 /s, seven decay times in half a step: C_m .087 where a step 32 times shorter gave
    .471."""
    scene = Scene(crosshatch(4, length=0.5), setup="compliant", duration=20.0, damping=1e5)
    coarse = simulate(scene, "draft")
    step = coarse.attrs["time_step"] / 32
    fine = simulate(scene, elements_per_section=2, time_step=step)
    for name in ("c_nl", "c_m"):
        assert float(score(coarse)[name]) == pytest.approx(float(score(fine)[name]), abs=2e-3), name
