"""The energy ledger of the planar engines: what a run's drive and pull give is what it holds or
has lost.

Bounds are several times what was measured. What remains of the residual: what is dissipated is
sampled every 0.25 ms, kinetic and elastic energy are half a step apart, and PyElastica's
equations have no exact potential where a fibre stretches and bends or shears at once.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fiberweb import engines, simulate
from fiberweb.engines.base import Numerics
from fiberweb.model.mesh import build
from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.scene import Scene
from tests.engines.fibres import largest_step

SMALL = crosshatch(2, spacing=0.1)
GRID = crosshatch(4, length=0.5)
HEXAGON = polygon(6)
AUTHORS_HEXAGON = polygon(6, diagonals="skip-one")

DRIVEN = [  # network, setup, engine, elements per section, bound on the residual
    pytest.param(SMALL, "described", "kirchhoff", 8, 1e-4, id="2x2"),
    pytest.param(GRID, "described", "kirchhoff", 4, 1e-4, id="4x4"),
    pytest.param(HEXAGON, "described", "kirchhoff", 4, 1e-4, id="polygon"),
    pytest.param(SMALL, "compliant", "kirchhoff", 8, 1e-4, id="2x2-compliant"),
    pytest.param(GRID, "compliant", "kirchhoff", 4, 1e-4, id="4x4-compliant"),
    pytest.param(HEXAGON, "compliant", "kirchhoff", 4, 1e-4, id="polygon-compliant"),
    pytest.param(SMALL, "compliant", "cosserat", 4, 2e-4, id="2x2-cosserat"),
    pytest.param(GRID, "compliant", "cosserat", 4, 2e-4, id="4x4-cosserat"),
    pytest.param(HEXAGON, "compliant", "cosserat", 4, 2e-4, id="polygon-cosserat"),
    pytest.param(crosshatch(2, length=0.5), "published", "cosserat", None, 2e-4, id="2x2-filter"),
    pytest.param(GRID, "published", "cosserat", None, 2e-4, id="4x4-filter"),
    pytest.param(AUTHORS_HEXAGON, "published", "cosserat", None, 1e-3, id="polygon-published"),
]


@pytest.mark.parametrize("network, setup, engine, elements, bound", DRIVEN)
def test_ledger_of_a_driven_run_closes(network, setup, engine, elements, bound):
    # without gaps, the springs across which bring far more than the force
    layout = "exact" if network is AUTHORS_HEXAGON else None
    scene = Scene(network, setup=setup, duration=1.0, layout=layout)
    response = simulate(scene, engine=engine, elements_per_section=elements)
    assert response.attrs["status"] == "ok"
    kinetic, elastic, work, dissipated = response.energy.values.T
    residual = abs(kinetic + elastic + dissipated - work).max() / abs(work).max()
    print(f"{setup} {network.topology} {network.n} {engine}: residual {residual:.1e}")
    assert residual < bound
    assert response.attrs["energy_residual"] == pytest.approx(residual)
    assert (kinetic >= 0).all() and (elastic >= 0).all()
    assert work[-1] > 0
    assert (np.diff(dissipated) >= 0).all() and dissipated[-1] > 0.01 * work[-1]


def test_the_ledger_knows_what_springs_hold_at_first():
    """The authors' polygon starts with gaps that its springs pull shut, in milliseconds and with
    thousands of times the energy that the force brings; all of it is dissipated."""
    response = simulate(Scene(AUTHORS_HEXAGON, setup="published", duration=1.0))
    kinetic, elastic, work, dissipated = response.energy.values.T
    assert kinetic[0] == 0.0 and elastic[0] > 100 * abs(work).max()
    residual = abs(kinetic + elastic + dissipated - work - elastic[0]).max() / elastic[0]
    assert response.attrs["energy_residual"] == pytest.approx(residual) and residual < 0.01


@pytest.mark.parametrize("setup", ["described", "compliant"])
@pytest.mark.parametrize("damping", [3e4, 1e5])
def test_the_ledger_closes_under_strong_damping(damping, setup):
    """What the damper takes is exact in the terminal velocity, several decay times a step."""
    scene = Scene(SMALL, setup=setup, duration=1.0, damping=damping)
    response = simulate(scene, elements_per_section=2)
    assert damping * response.attrs["time_step"] > 2.0
    assert response.attrs["energy_residual"] < 1e-4


@pytest.mark.parametrize(
    "engine, setup",
    [("kirchhoff", "described"), ("kirchhoff", "compliant"), ("cosserat", "compliant")],
)
@pytest.mark.parametrize("tension, bound", [(0.01, 2e-4), (0.5, 3e-3)])
def test_the_ramp_of_the_tension_is_entered(engine, setup, tension, bound):
    """Until the ramp ends the pull does work that is no difference of potential. A strong one
    starts axial waves, which leapfrog's half step between the two energies shows."""
    scene = Scene(SMALL, setup=setup, duration=0.3, tension=tension, tension_ramp=0.2)
    response = simulate(scene, engine=engine, elements_per_section=8)
    print(f"{engine} {tension} N: residual {response.attrs['energy_residual']:.1e}")
    assert response.attrs["energy_residual"] < bound


def pulsed(scene: Scene, elements: int):
    """A mesh whose input is one parabola over the first knot interval, and nothing after."""
    mesh = build(scene, elements)
    drive = np.zeros_like(mesh.drive)
    interval = 1.0 / scene.drive_rate
    drive[0, 1:3] = np.array([-1.0, interval]) * 4.0 / interval**2
    return replace(mesh, drive=drive)


def free_run(scene: Scene, engine: str, elements: int, step: float | None = None):
    """Times and energy less the pull's work, once pulse and ramp are over; and the largest
    kinetic + elastic energy."""
    mesh = pulsed(scene, elements)
    step = step or 0.9 * largest_step(mesh, engine)
    recording = engines.load(engine).integrate(mesh, Numerics(engine, elements, step))
    assert recording.unstable_at is None
    kinetic, elastic, work, dissipated = recording.energy.T
    assert (dissipated == 0).all()
    after = scene.times > 0.3
    return scene.times[after], (kinetic + elastic - work)[after], (kinetic + elastic).max()


@pytest.mark.parametrize(
    "engine, setup, network, bound",
    [
        ("kirchhoff", "described", SMALL, 1e-4),
        ("kirchhoff", "described", HEXAGON, 1e-4),
        ("kirchhoff", "compliant", SMALL, 1e-4),
        ("kirchhoff", "compliant", HEXAGON, 1e-4),
        ("cosserat", "compliant", SMALL, 3e-4),
        ("cosserat", "compliant", HEXAGON, 3e-4),
    ],
)
def test_without_drive_and_damping_energy_is_kept(engine, setup, network, bound):
    scene = Scene(network, setup=setup, duration=2.0, damping=0.0, crossing_damping=0.0)
    _, energy, scale = free_run(scene, engine, 4)
    print(f"{engine} {setup} {network.topology}: {np.ptp(energy) / scale:.1e} of the energy")
    assert np.ptp(energy) < bound * scale


def test_a_million_steps_do_not_drift():
    """Leapfrog's energy oscillates, with no trend: the halves of the run have the same mean."""
    scene = Scene(SMALL, duration=72.0, damping=0.0, crossing_damping=0.0)
    step = 0.9 * largest_step(build(scene, 4), "kirchhoff")
    time, energy, scale = free_run(scene, "kirchhoff", 4, step)
    assert (time[-1] - time[0]) / step > 1e6
    drift = np.polyfit(time / (1e6 * step), energy / scale, 1)[0]
    noise = energy.std() / scale
    print(f"drift {drift:.1e} per 1e6 steps, rms oscillation {noise:.1e}")
    assert abs(drift) < 1e-6
    assert noise < 1e-5


def test_an_unstable_run_has_a_residual_of_its_sound_part():
    scene = Scene(SMALL, duration=0.2)
    limit = largest_step(build(scene, 4), "kirchhoff")
    response = simulate(
        scene, engine="kirchhoff", elements_per_section=4, time_step=1.1 * limit,
        force_time_step=True,
    )  # fmt: skip
    assert response.attrs["status"] == "unstable"
    gone = scene.times >= response.attrs["unstable_at"]
    assert np.isnan(response.energy.values[gone]).all()
    assert np.isfinite(response.energy.values[~gone]).all()
    residual = response.attrs.get("energy_residual", 0.0)
    assert np.isfinite(residual) and residual >= 0
