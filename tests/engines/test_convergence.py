"""The order of accuracy, by regression of the error on log axes."""

from dataclasses import replace

import numpy as np
import pytest

from fiberweb import engines
from fiberweb.engines.base import Numerics
from fiberweb.model.mesh import build
from fiberweb.model.network import crosshatch
from fiberweb.model.scene import Scene
from fiberweb.validation.accuracy import Case, difference, extrapolate
from tests.engines.fibres import (
    ENGINES,
    PLANAR,
    cantilever,
    every_node,
    fibre,
    first_frequency,
    largest_step,
    pulled,
    run,
    sampled,
    settle,
    side_by_side,
    slope,
    struck,
)

SPATIAL_ORDER = {"kirchhoff": 4, "cosserat": 2, "elastica": 2}


@pytest.mark.parametrize("engine", ENGINES)
def test_order_in_element_length(engine):
    """Tip of a cantilever bent by 16 % of its length, PL^2/EI = 0.5, against the continuum of
    the engine's own law, 4 to 32 elements: what is left is the mesh's error alone."""
    length, elements = 0.06, [4, 8, 16, 32]
    frequency = first_frequency(fibre(4, length).scene)
    meshes = [fibre(n, length, damping=2 * frequency, tension_ramp=3 / frequency) for n in elements]
    load = 0.5 * meshes[0].scene.bending_stiffness / length**2
    mesh = side_by_side(*[pulled(one, 0.0, load) for one in meshes])
    order = SPATIAL_ORDER[engine]
    seconds = (10 + 5 * order) / frequency  # what still moves is below a thousandth of all errors
    moved = settle(mesh, engine, 0.9 * largest_step(mesh, engine), seconds)
    exact = cantilever(mesh.scene, load, engine)
    errors = np.linalg.norm(moved[mesh.first[1:] - 1] - exact, axis=1)
    assert slope(elements, errors) == pytest.approx(-order, abs=0.2)


def order_in_time(errors_of):
    """Regression of the error against the step, over 1, 1/2, 1/4, 1/8 of a base step."""
    halvings = np.array([1, 2, 4, 8])
    reference = errors_of(64)
    errors = [np.sqrt(np.mean((errors_of(k) - reference) ** 2)) for k in halvings]
    return slope(1 / halvings, errors)


@pytest.mark.parametrize("damping", [0.0, 300.0, 1e4])
@pytest.mark.parametrize("engine", PLANAR)
def test_order_in_time_step(engine, damping):
    """One struck fibre over half a period at 16 elements: second order, damped or not."""
    length = 0.05
    mesh = fibre(16, length, damping=damping)
    period = 2 * np.pi / first_frequency(mesh.scene)
    force = mesh.scene.bending_stiffness / length**2
    mesh = struck(mesh, -1, (0.0, force), 0.0, period / 4)
    every = int(np.ceil(period / 2 / (0.5 * largest_step(mesh, engine)) / 20))

    def moved(k):
        return run(mesh, engine, period / 2 / (20 * every * k), 21, every * k)

    assert order_in_time(moved) == pytest.approx(2, abs=0.2)


@pytest.mark.parametrize("setup", ["compliant", "described"])
def test_order_in_time_step_of_a_kirchhoff_network(setup):
    """Second order also with crossings: their damper is exact, and merging nodes projects the
    velocities. The load is smooth, since a jump costs an order."""
    scene = Scene(crosshatch(2, spacing=0.05), setup=setup, tension_ramp=0.0, tension=0.0)
    mesh = build(scene, 4)
    duration = 0.02
    pulse = struck(mesh, 0, (0.0, 0.0), 0.0, duration / 2)
    mesh = replace(pulse, load=mesh.load, readouts=every_node(mesh))
    every = int(np.ceil(duration / (0.5 * largest_step(mesh, "kirchhoff")) / 20))

    def moved(k):
        step = duration / (20 * every * k)
        numerics = Numerics("kirchhoff", None, step)
        recording = engines.load("kirchhoff").integrate(
            sampled(mesh, step, 21, every * k), numerics
        )
        return recording.displacement

    assert order_in_time(moved) == pytest.approx(2, abs=0.2)


@pytest.mark.slow
def test_four_elements_a_section_are_enough_before_buckling():
    """B = 0.8, 4x4: within 2 % of the trajectories and 0.01 in both capacities of the answer
    extrapolated from 8 and 16 elements. A run of 30 s scores every capacity the same way."""
    about = {"n": 4, "buckling": 0.8}
    runs = [Case("kirchhoff", elements=e, **about) for e in (4, 8, 16)]
    moved = [case.trajectory(1.0) for case in runs]
    assert difference(moved[0], extrapolate(*moved[1:])) < 0.02
    scored = [case.capacities(30.0) for case in runs]
    assert np.abs(scored[0] - extrapolate(*scored[1:])).max() < 0.01
