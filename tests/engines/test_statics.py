"""Fibres at rest under load, against closed forms."""

import numpy as np
import pytest

from tests.engines.fibres import (
    ENGINES,
    fibre,
    first_frequency,
    largest_step,
    pulled,
    settle,
    side_by_side,
)

# PL^2/EI: tip deflection and tip's approach to the wall over the length, inextensible elastica
# (Mattiasson, Int. J. Numer. Methods Eng. 17, 145 (1981))
ELASTICA = {
    1.0: (0.30172, 0.05643),
    2.0: (0.49346, 0.16064),
    5.0: (0.71379, 0.38763),
    10.0: (0.81061, 0.55500),
}
LENGTH = 0.06  # m, 30 diameters: shear and stretch change the tip's place by less than 0.1 %


def cantilevers(loads, elements):
    """Clamped fibres with dead lateral end loads (PL^2/EI), damped close to critically, and how
    long they need to settle to 1e-7 (s)."""
    frequency = first_frequency(fibre(elements, LENGTH).scene)
    one = fibre(elements, LENGTH, damping=2 * frequency, tension_ramp=3 / frequency)
    unit = one.scene.bending_stiffness / LENGTH**2
    return side_by_side(*[pulled(one, 0.0, load * unit) for load in loads]), 24 / frequency


@pytest.mark.parametrize("engine", ENGINES)
def test_end_loaded_cantilever_follows_the_elastica(engine):
    """Within 0.5 % at 32 elements: 0.1 % each for the chain, for shear and for stretch."""
    mesh, duration = cantilevers(ELASTICA, 32)
    moved = settle(mesh, engine, 0.9 * largest_step(mesh, engine), duration)
    tips = moved[mesh.first[1:] - 1] / LENGTH
    expected = np.array(list(ELASTICA.values()))
    np.testing.assert_allclose(tips[:, 1], expected[:, 0], rtol=5e-3)
    np.testing.assert_allclose(-tips[:, 0], expected[:, 1], rtol=5e-3)


@pytest.mark.parametrize("engine", ENGINES)
def test_equal_fibres_move_alike_wherever_they_stand_in_the_mesh(engine):
    """Three equal fibres side by side: the arrays' first, middle and last. To round-off."""
    mesh, duration = cantilevers([1.0, 1.0, 1.0], 8)
    moved = settle(mesh, engine, 0.9 * largest_step(mesh, engine), 0.2 * duration)
    first, middle, last = moved.reshape(3, -1, 2)
    np.testing.assert_allclose(first, middle, atol=1e-12 * LENGTH)
    np.testing.assert_allclose(last, middle, atol=1e-12 * LENGTH)


@pytest.mark.parametrize("engine", ENGINES)
def test_axial_stretch_follows_pyelasticas_law(engine):
    """Stress EA (e - 1) / e gives the extension F L / (EA - F): 1.6 % at 5 N, 19 % at 50 N. The
    state of rest is uniform, so that any mesh has it exactly; 1e-6 is what is left of the
    motion, damped critically."""
    forces = np.array([5.0, 50.0])
    length = 0.05
    scene = fibre(8, length).scene
    slowest = 0.5 * np.pi * scene.wave_speed / length  # rad/s, of axial waves
    one = fibre(8, length, damping=2 * slowest, tension_ramp=3 / slowest)
    mesh = side_by_side(*[pulled(one, force, 0.0) for force in forces])
    moved = settle(mesh, engine, 0.9 * largest_step(mesh, engine), 40 / slowest)
    extension = moved[mesh.first[1:] - 1, 0]
    np.testing.assert_allclose(
        extension, forces * length / (scene.axial_stiffness - forces), rtol=1e-6
    )
    assert np.abs(moved[:, 1]).max() < 1e-12 * length
