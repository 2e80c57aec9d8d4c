"""Material damping (Kelvin-Voigt) against closed forms: every mode of frequency w decays by
w^2 t / 2, t the viscosity over E, whatever the mesh and the step."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, engines, polygon, simulate
from fiberweb.engines import kirchhoff_stiffness, viscosity_mild
from fiberweb.engines.base import Numerics
from fiberweb.model.mesh import build
from tests.engines.fibres import PLANAR, fibre, largest_step, run, sampled, slope

LENGTH = 0.1
LOSS = dict(loss_frequency=24.84)  # of the first mode, at which Q = 1 / loss factor


def bowed(waves: int, elements: int, axial: bool = False, **scene):
    """A fibre of 100 mm, pinned and free to slide, that starts in one of its modes."""
    mesh = fibre(elements, LENGTH, **dict(damping=0.0, ends="sliding") | scene)
    x = mesh.position[:, 0]
    if axial:
        shape = np.column_stack([np.sin((waves - 0.5) * np.pi * x / LENGTH), 0.0 * x])
    else:
        shape = np.column_stack([0.0 * x, np.sin(waves * np.pi * x / LENGTH)])
    return replace(mesh, start=1e-5 * shape), shape


def poles(mesh, shape, engine: str, step: float, periods: float, frequency: float):
    """Rate of decay (1/s) and angular frequency (1/s) of the motion in a shape, by Prony's method
    for one mode: three equally spaced samples of it follow a recursion of two terms."""
    every = max(1, round(1.0 / (16 * frequency * step)))
    count = max(8, round(16 * periods))
    moved = run(mesh, engine, step, count, every)
    signal = np.einsum("tnc,nc->t", moved, shape)
    history = np.column_stack([signal[1:-1], signal[:-2]])
    pole = np.roots(np.r_[1.0, -np.linalg.lstsq(history, signal[2:], rcond=None)[0]])
    rates = np.log(pole.astype(complex)) / (every * step)
    return -rates.real, abs(rates.imag)


def frequency_of(mesh, waves: int) -> float:
    """Of a mode of the pinned beam (rad/s)."""
    scene = mesh.scene
    return (waves * np.pi / LENGTH) ** 2 * np.sqrt(
        scene.bending_stiffness / (scene.density * scene.area)
    )


ELEMENTS = {"kirchhoff": 6, "cosserat": 32}  # a half wave: second order needs more


@pytest.mark.parametrize("engine", PLANAR)
@pytest.mark.parametrize("waves", [1, 2, 3])
def test_quality_factor_of_several_modes(engine, waves):
    """Q = 1 / (w t): 50, 12.5 and 5.6 for a loss factor of .02 at the first mode; decay rate
    w^2 t / 2. Both within 1.5 %."""
    mesh, shape = bowed(waves, ELEMENTS[engine] * waves, loss_factor=0.02, **LOSS)
    expected = frequency_of(mesh, waves)
    step = 0.9 * largest_step(mesh, engine)
    decay, angular = poles(mesh, shape, engine, step, 3, expected / (2 * np.pi))
    time = mesh.scene.loss_time
    assert decay[0] == pytest.approx(expected**2 * time / 2, rel=0.015)
    assert np.hypot(angular[0], decay[0]) / (2 * decay[0]) == pytest.approx(
        1 / (expected * time), rel=0.015
    )


@pytest.mark.parametrize("engine", PLANAR)
def test_axial_modes_decay_by_the_same_law(engine):
    """Fixed and free ends: w = (n - 1/2) pi c / L; a loss factor of .1 at the first, 790 Hz."""
    for waves in (1, 2):
        mesh, shape = bowed(waves, 64, axial=True, loss_factor=0.1, loss_frequency=790.6)
        expected = (waves - 0.5) * np.pi * mesh.scene.wave_speed / LENGTH
        step = 0.5 * largest_step(mesh, engine)
        decay, _ = poles(mesh, shape, engine, step, 3, expected / (2 * np.pi))
        assert decay[0] == pytest.approx(expected**2 * mesh.scene.loss_time / 2, rel=0.01)


@pytest.mark.parametrize("engine", PLANAR)
def test_an_overdamped_bow_creeps_back(engine):
    """w t = 40: the slow one of the two rates, 1 / t, within 1 %: stiffness and viscosity have the
    same mesh error, and it cancels."""
    mesh, shape = bowed(1, ELEMENTS[engine], loss_factor=40.0, **LOSS)
    w, time = frequency_of(mesh, 1), mesh.scene.loss_time
    step = 0.9 * largest_step(mesh, engine)
    every = round(0.1 * time / step)
    moved = np.einsum("tnc,nc->t", run(mesh, engine, step, 21, every), shape)
    found = -np.log(moved[20] / moved[10]) / (10 * every * step)
    expected = (w**2 * time - np.sqrt((w**2 * time) ** 2 - 4 * w**2)) / 2
    assert found == pytest.approx(expected, rel=0.01)


@cache
def decay_of(engine: str, elements: int, share: float) -> float:
    """Rate (1/s) of the second mode over the closed form's, at a share of the step's limit."""
    mesh, shape = bowed(2, elements, loss_factor=0.05, **LOSS)
    w = frequency_of(mesh, 2)
    step = share * largest_step(mesh, engine)
    decay, _ = poles(mesh, shape, engine, step, 3, w / (2 * np.pi))
    return decay[0] / (w**2 * mesh.scene.loss_time / 2)


def test_the_step_does_not_change_the_damping():
    """A fifth of it and the largest possible: within 0.1 %, although an explicit step would have to
    be 100 times shorter."""
    rates = [decay_of("kirchhoff", 16, share) for share in (0.95, 0.2)]
    assert rates[0] == pytest.approx(rates[1], rel=1e-3)
    assert rates[1] == pytest.approx(1.0, rel=0.01)


def test_the_mesh_does_not_change_the_damping():
    """Fourth order: the error of 8 elements a half wave is under a twelfth of that of 4."""
    errors = [abs(decay_of("kirchhoff", n, 0.2) - 1.0) for n in (8, 16)]
    print(errors)
    assert errors[0] < 0.05 and errors[1] < errors[0] / 10 + 1e-4


@pytest.mark.parametrize("loss", [1.0, 0.2])
@pytest.mark.parametrize("setup", ["described", "compliant"])
def test_the_rule_is_second_order_in_the_step(setup, loss, monkeypatch):
    """Large motion of a viscous hexagon over some ms, against a step of a sixteenth: with crossings
    that are one point or have springs and dampers, which act beside it in turns; with moments that
    are solved for, and explicit ones."""
    monkeypatch.setattr(viscosity_mild, "MILD", np.inf if loss < 1.0 else 0.0)
    scene = Scene(
        polygon(6, diameter=0.2), setup, force=5.0, tension_ramp=0.0, loss_factor=loss, duration=1.0
    )
    mesh = build(scene, 2)
    mesh = replace(mesh, drive=np.array([[0.0, 0.0, 50.0, 0.0]]))
    base = 0.8 * largest_step(mesh, "kirchhoff")
    every, kirchhoff = 64, engines.load("kirchhoff")

    def moved(split):
        step = base / split
        timed = sampled(mesh, step, 5, every * split)
        return kirchhoff.integrate(timed, Numerics("kirchhoff", 2, step)).displacement

    exact, splits = moved(16), np.array([1, 2, 4])
    errors = [np.sqrt(np.mean((moved(split) - exact) ** 2)) for split in splits]
    assert np.sqrt(np.mean(exact**2)) > 1e-3
    assert slope(1.0 / splits, errors) > 1.7


def share(mesh, step):
    """Of the fastest bend's velocity, that a step takes."""
    layout = kirchhoff_stiffness.fourth_order_layout(mesh)
    return mesh.scene.loss_time * step * viscosity_mild.fastest_bend(mesh, layout) ** 2


@pytest.mark.parametrize("waves", [1, 2])
def test_mild_damping_of_bending_is_explicit_and_the_same(waves, monkeypatch):
    """Q = 200: the closed form within 1.5 %, and what is solved for within .2 %."""
    mesh, shape = bowed(waves, 6 * waves, loss_factor=0.005 / waves**2, **LOSS)
    w = frequency_of(mesh, waves)
    step = 0.9 * largest_step(mesh, "kirchhoff")
    assert share(mesh, step) < viscosity_mild.MILD
    rates = {}
    for mild in (0.0, np.inf):
        monkeypatch.setattr(viscosity_mild, "MILD", mild)
        decay, _ = poles(mesh, shape, "kirchhoff", step, 3, w / (2 * np.pi))
        rates[mild] = decay[0] / (w**2 * mesh.scene.loss_time / 2)
    solved, explicit = rates.values()
    assert explicit == pytest.approx(1.0, rel=0.015)
    assert solved != explicit == pytest.approx(solved, rel=2e-3)


@pytest.mark.parametrize("ends", ["clamped", "pinned", "sliding", "sprung"])
def test_no_bend_is_faster_than_the_fastest(ends):
    """Of a fibre along x, whose stiffness in y is that of bending alone."""
    more = dict(end_stiffness=50.0) if ends == "sprung" else {}
    mesh = fibre(12, LENGTH, ends=ends, **more)
    layout = kirchhoff_stiffness.fourth_order_layout(mesh)
    stiffness, mass = kirchhoff_stiffness.stiffness_and_mass(mesh, layout)
    size = len(layout.x)
    lateral = stiffness.toarray()[size:, size:] / np.sqrt(np.outer(mass[size:], mass[size:]))
    fastest = np.sqrt(np.linalg.eigvalsh(lateral)[-1])
    assert 0.4 < fastest / viscosity_mild.fastest_bend(mesh, layout) < 1.0


@pytest.mark.parametrize("setup", ["described", "compliant"])
def test_explicit_moments_are_stable_far_beyond_what_is_called_mild(setup, monkeypatch):
    scene = Scene(crosshatch(4, length=0.5), setup=setup, duration=1.0, loss_factor=0.15, force=0.3)
    mesh = build(scene, 4)
    step = 0.98 * largest_step(mesh, "kirchhoff")
    assert 5 * viscosity_mild.MILD < share(mesh, step) < 1.2
    monkeypatch.setattr(viscosity_mild, "MILD", np.inf)
    response = simulate(scene, engine="kirchhoff", elements_per_section=4, time_step=step)
    assert response.attrs["status"] == "ok" and response.attrs["energy_residual"] < 1e-4


@pytest.mark.parametrize("loss", [5e-3, 0.3, 1e3])
@pytest.mark.parametrize("setup", ["described", "compliant"])
def test_no_loss_factor_costs_the_step(loss, setup):
    """The limit is that without; just below it a run of any viscosity is stable, with crossings
    that are one point and with springs, and its energy book closes, but for what an absurd
    viscosity makes of the crossings' dampers."""
    scene = Scene(crosshatch(4, length=0.5), setup=setup, duration=1.0, loss_factor=loss, force=0.3)
    plain = replace(scene, loss_factor=0.0)
    limit = largest_step(build(scene, 4), "kirchhoff")
    assert limit == largest_step(build(plain, 4), "kirchhoff")
    response = simulate(scene, engine="kirchhoff", elements_per_section=4, time_step=0.98 * limit)
    assert response.attrs["status"] == "ok"
    absurd = loss > 1.0 and setup == "compliant"
    assert response.attrs["energy_residual"] < (1e-2 if absurd else 1e-4)


@pytest.mark.parametrize("engine", PLANAR)
def test_what_is_dissipated_is_entered_by_itself(engine):
    """Without any other damping all that a shaken net loses is the material's."""
    scene = Scene(
        crosshatch(2, spacing=0.1), duration=1.0, damping=0.0, loss_factor=0.3,
        crossing_stiffness=1e3,
    )  # fmt: skip
    response = simulate(scene, engine=engine, elements_per_section=4)
    lost = response.energy.values[:, 3]
    assert (np.diff(lost) >= 0.0).all() and lost[-1] > 0.3 * response.energy.values[-1, 2]
    assert response.attrs["energy_residual"] < 1e-4


def test_what_is_dissipated_beside_the_filter_is_entered_once():
    scene = Scene(crosshatch(2, length=0.2), "published", duration=0.5, loss_factor=0.1)
    plain, damped = (simulate(s) for s in (replace(scene, loss_factor=0.0), scene))
    residual = damped.attrs["energy_residual"]  # 1.4 with velocities from before the filter
    assert residual < 1.5 * plain.attrs["energy_residual"] < 2e-3


def test_a_rigid_turn_is_not_damped():
    """A straight fibre that swings round as a whole keeps its energy: rates are those of elements
    where they are, and not where they rested. 10 turns at 20 /s; a centrifugal stretch is set up
    first."""
    mesh = fibre(8, LENGTH, damping=0.0, ends="pinned", loss_factor=1.0)
    start = np.zeros_like(mesh.start)
    mesh = replace(mesh, start=start, pull=np.zeros_like(mesh.pull))
    load = np.zeros_like(mesh.load)
    load[:, 1] = 0.3 * mesh.masses() * mesh.position[:, 0] / LENGTH  # as a turn needs it
    drive = np.zeros((2, 4))
    drive[0, 3] = 1e3
    mesh = replace(mesh, load=load, drive=drive, drive_rate=5.0)
    step = 0.9 * largest_step(mesh, "kirchhoff")
    timed = sampled(mesh, step, 400, round(2.5e-3 / step))
    energy = engines.load("kirchhoff").integrate(timed, Numerics("kirchhoff", None, step)).energy
    late = energy[200:]
    kinetic = late[:, 0]
    assert kinetic[0] > 1e-6 and np.ptp(kinetic) < 1e-4 * kinetic[0]
    assert late[-1, 3] - late[0, 3] < 1e-4 * kinetic[0]


def test_pyelastica_refuses_what_it_has_not():
    mesh = build(Scene(crosshatch(2, spacing=0.1), "compliant", loss_factor=0.1), 4)
    with pytest.raises(ValueError, match="PyElastica has no material damping"):
        engines.load("elastica").refuse(mesh)
