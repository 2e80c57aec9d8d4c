"""What a fibre without damping has to keep: momentum, angular momentum, energy."""

from dataclasses import replace

import numpy as np
import pytest
from elastica import PositionVerlet

from fiberweb.engines import elastica, kirchhoff
from fiberweb.engines.base import Numerics
from fiberweb.model.buckling import second_moment
from fiberweb.model.mesh import build
from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.scene import Scene
from tests.engines.fibres import (
    ENGINES,
    every_node,
    fibre,
    first_frequency,
    free,
    largest_step,
    run,
    sampled,
    struck,
    velocities,
)
from tests.engines.oracle import kirchhoff_energy, kirchhoff_masses

LENGTH = 0.05


def thrown(engine):
    """A free fibre after a pulse off its middle that bends, turns and throws it.

    Returns:
        Mesh, step (s), and positions and velocities at every step after the pulse.
    """
    mesh = free(fibre(32, LENGTH, damping=0.0))
    force = 6 * mesh.scene.bending_stiffness / LENGTH**2
    pulse = 2 * np.pi / first_frequency(mesh.scene) / 6
    mesh = struck(mesh, 8, (0.1 * force, force), 0.0, pulse)
    step = 0.9 * largest_step(mesh, engine)
    after = int(pulse / step) + 2
    moved = run(mesh, engine, step, after + 3000)
    velocity = velocities(moved, step)
    return mesh, step, mesh.position + moved[after:], velocity[after:]


def masses(mesh, engine):
    """Mass of each node as the engine lumps it (kg)."""
    return kirchhoff_masses(mesh) if engine == "kirchhoff" else mesh.masses()


@pytest.mark.parametrize("engine", ENGINES)
def test_momentum_of_a_free_fibre(engine):
    """Constant to 1e-9, and equal to the pulse's impulse: the B-spline's integral is a quarter of
    its length, and equal steps sum it to better than 1e-9."""
    mesh, _, _, velocity = thrown(engine)
    momentum = np.einsum("n,tnc->tc", masses(mesh, engine), velocity)
    size = np.linalg.norm(momentum[0])
    assert np.abs(momentum - momentum[0]).max() < 1e-9 * size
    impulse = mesh.load.sum(axis=0) / mesh.drive_rate
    np.testing.assert_allclose(momentum[0], impulse, rtol=1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_angular_momentum_of_a_free_fibre(engine):
    """Constant to 1e-9 in the kirchhoff engine, where x cross m v is all there is.

    Elements of the Cosserat engines spin on their own, with 5e-5 of the whole. Edges show that
    spin up to the rate of shear, smaller by (d / wavelength)^2; with it the sum is constant to
    1e-6.
    """
    mesh, step, position, velocity = thrown(engine)
    cross = position[..., 0] * velocity[..., 1] - position[..., 1] * velocity[..., 0]
    whole = cross @ masses(mesh, engine)
    tolerance = 1e-9
    if engine != "kirchhoff":
        edges = np.diff(position, axis=1)
        stretch = np.linalg.norm(edges, axis=2) / mesh.edges(0)
        angle = np.unwrap(np.arctan2(edges[..., 1], edges[..., 0]), axis=0)
        inertia = mesh.scene.density * second_moment(mesh.scene.diameter) * mesh.edges(0)
        spin = (inertia * np.gradient(angle, step, axis=0) / stretch).sum(axis=1)
        whole = (whole + spin)[1:-1]
        tolerance = 1e-6
    assert np.abs(whole - whole[0]).max() < tolerance * np.abs(whole[0])


@pytest.mark.parametrize("order", [2, 4])
def test_energy_of_an_undamped_kirchhoff_fibre(order):
    """Over 1e5 steps, 30 periods with a tip that swings by 60 % of the length.

    Leapfrog keeps a neighbouring energy, so that the true one wavers by (omega h)^2 of the modes
    that move, here 1e-6, and does not drift: less than 1e-7 of it over the run. Kinetic and
    elastic energy are computed anew from the recorded nodes.
    """
    mesh = fibre(16, LENGTH, damping=0.0)
    period = 2 * np.pi / first_frequency(mesh.scene)
    force = 3 * mesh.scene.bending_stiffness / LENGTH**2
    mesh = struck(mesh, -1, (0.0, force), 0.0, period / 2)
    step = 0.9 * largest_step(mesh, "kirchhoff")
    after, steps = int(period / 2 / step) + 2, 100_000
    recording = kirchhoff.integrate(
        sampled(mesh, step, after + steps), Numerics("kirchhoff", None, step), order=order
    )
    moved = recording.displacement
    speed = (velocities(moved, step)[after:] ** 2).sum(axis=2)
    kinetic = 0.5 * speed @ kirchhoff_masses(mesh, order)
    stiffness = mesh.scene.axial_stiffness, mesh.scene.bending_stiffness
    elastic = kirchhoff_energy(mesh.position + moved[after:], mesh.position, stiffness, True, order)
    energy = kinetic + elastic
    assert np.ptp(energy) < 5e-6 * energy.mean()
    drift = np.polyfit(np.linspace(0.0, 1.0, steps), energy, 1)[0]
    assert abs(drift) < 1e-7 * energy.mean()
    # the engine's own ledger says the same
    np.testing.assert_allclose(recording.energy[after:, 0], kinetic, atol=1e-8 * energy.mean())
    np.testing.assert_allclose(recording.energy[after:, 1], elastic, atol=1e-8 * energy.mean())


def test_energy_of_an_undamped_elastica_fibre():
    """PyElastica's own energies of a free fibre that vibrates but does not turn, over 2e4 steps.

    Its forces are no gradient of its energies: factors of dilatation differ, and the rate of
    dilatation is taken with the velocity of half a step ago, which feeds energy into turning
    fibres at first order in the step. At strains of 1e-6 that leaves a waver below 2e-5 and a
    drift below 1e-6 of the vibration's energy.
    """
    mesh = free(fibre(16, LENGTH, damping=0.0))
    period = 2 * np.pi / first_frequency(mesh.scene) / 6.36  # of the first free-free mode
    mesh = struck(mesh, 8, (0.0, mesh.scene.bending_stiffness / LENGTH**2), 0.0, period / 2)
    limit = largest_step(mesh, "elastica")
    simulator, (rod,), step, _ = elastica.assemble(
        sampled(mesh, 0.9 * limit, 2), Numerics("elastica", None, 0.9 * limit)
    )
    stepper, energies = PositionVerlet(), []
    time = elastica.run_steps(simulator, stepper, 0.0, step, int(period / 2 / step) + 2)
    for _ in range(2000):
        time = elastica.run_steps(simulator, stepper, time, step, 10)
        rod.compute_internal_forces_and_torques(time)  # strains are left at the half step
        drifting = 0.5 * rod.mass.sum() * (rod.compute_velocity_center_of_mass() ** 2).sum()
        energies.append(
            rod.compute_translational_energy() - drifting + rod.compute_rotational_energy()
            + rod.compute_bending_energy() + rod.compute_shear_energy()
        )  # fmt: skip
    energies = np.array(energies)
    assert np.ptp(energies) < 2e-5 * energies.mean()
    drift = np.polyfit(np.linspace(0.0, 1.0, len(energies)), energies, 1)[0]
    assert abs(drift) < 1e-6 * energies.mean()


@pytest.mark.parametrize("network", [crosshatch(2, spacing=0.1), polygon(6)])
def test_joined_nodes_stay_one_point(network):
    """Within 6e-16 m over 4 s. No force pulls them together: round-off left to itself walks them
    8e-15 m apart by then, and further."""
    mesh = build(Scene(network, duration=4.0), 4)
    mesh = replace(mesh, readouts=every_node(mesh))
    step = 0.9 * largest_step(mesh, "kirchhoff")
    moved = kirchhoff.integrate(mesh, Numerics("kirchhoff", 4, step)).displacement
    assert np.abs(moved).max() > 1e-3
    a, b = mesh.joints.T
    apart = mesh.position[a] - mesh.position[b] + moved[:, a] - moved[:, b]
    assert np.abs(apart).max() < 2e-15
