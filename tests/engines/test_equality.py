"""Engines against each other, and kernels against their plain counterparts."""

from dataclasses import replace

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, engines, polygon, score, simulate
from fiberweb.engines import kirchhoff, viscosity_mild
from fiberweb.engines.base import Numerics
from fiberweb.model.mesh import build
from tests.engines import oracle
from tests.engines.fibres import every_node, largest_step, sampled

COMPLIANT = dict(setup="compliant")
# their order of operations; the dead band follows round-off, see tests/engines/test_dead_band.py
AUTHORS = dict(setup="published", dead_band=False)
EVEN = dict(layout="exact")
SPRUNG = dict(ends="sprung", end_stiffness=40.0)
TIED = dict(crossing_stiffness=1e4)
STROKE = dict(force=None, stroke=5e-3)
# as stiff as the rods that PyElastica is stable with at the authors' step
STOUT = dict(diameter=(2e-3, 2e-3, 1.5e-3, 1.5e-3), density=(1.6e3, 1.75e3) * 2)
MIXED = dict(diameter=(2e-3, 2e-3, 1.5e-3, 1e-3), density=(1e3, 1.2e3, 1e3, 9e2),
             youngs_modulus=(1e8, 1e8, 2e8, 3e8))  # fmt: skip


def moved(mesh, engine, step, **kwargs):
    """Displacement of the readouts."""
    recording = engines.load(engine).integrate(mesh, Numerics(engine, None, step), **kwargs)
    assert recording.unstable_at is None
    return recording.displacement


def rms(a):
    return np.sqrt(np.mean(a**2))


def assert_follows_oracle(scene, elements_per_section, engine, step=None, mild=None, **kwargs):
    """Every node over 200 steps, to 1e-9 of the largest displacement: round-off, which large
    rotations and stretches multiply."""
    steps = 200
    mesh = build(scene, elements_per_section)
    step = step or 0.8 * largest_step(mesh, engine)
    change = 1.0 / (steps * step) ** 3
    drive = [change, 0.0, 0.0, 0.0] if scene.stroke else [-change, 0.0, 0.0, 1.0]  # from 1 to 0
    mesh = replace(mesh, drive=np.array([drive]), readouts=every_node(mesh))
    plainly = kwargs if mild is None else kwargs | dict(mild=mild)
    expected = getattr(oracle, engine)(mesh, step, steps, **plainly)
    largest = np.abs(expected).max()
    assert largest > 2e-3  # m, a diameter: far beyond the linear
    found = moved(sampled(mesh, step, steps + 1), engine, step, **kwargs)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * largest)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("network", "elements_per_section", "fields"),
    [
        (crosshatch(4, length=0.5), 10, COMPLIANT),
        (polygon(6), 10, COMPLIANT | dict(ends="sliding")),
        (crosshatch(4, length=0.5), None, AUTHORS),
        (polygon(6, diagonals="skip-one"), None, AUTHORS),
        (crosshatch(2, length=0.5), 10, TIED | SPRUNG | STOUT | STROKE | dict(bond_stiffness=5e-3)),
    ],
    ids=["compliant", "guided-hexagon", "published", "hexagon", "carried"],
)
def test_cosserat_against_pyelastica(network, elements_per_section, fields):
    """The authors' scenes for 2e4 steps of 5 us. Round-off, which PyElastica's angle from an arc
    cosine leads: under 1e-8 of the largest displacement."""
    step, steps = 5e-6, 20_000
    mesh = build(Scene(network, **fields), elements_per_section)
    mesh = sampled(mesh, step, 21, steps // 20)
    expected = moved(mesh, "elastica", step)
    found = moved(mesh, "cosserat", step)
    assert np.abs(found - expected).max() < 1e-8 * np.abs(expected).max()


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize(
    ("network", "fields"),
    [
        (crosshatch(2, spacing=0.05), COMPLIANT | dict(tension=2.0)),
        (crosshatch(2, spacing=0.05), COMPLIANT | dict(ends="sliding")),
        (crosshatch(2, spacing=0.05), dict()),
        (polygon(6, diameter=0.2), COMPLIANT),
        (polygon(6, diameter=0.2), COMPLIANT | dict(ends="sliding", tension=5.0)),
        (polygon(6, diameter=0.2), dict()),
        (crosshatch(2, spacing=0.05), COMPLIANT | dict(damping=5e3)),
        (polygon(6, diameter=0.2), COMPLIANT | dict(damping=5e3)),
        (polygon(6, diameter=0.2), dict(damping=5e3)),
        (crosshatch(2, spacing=0.05), SPRUNG | dict(tension=2.0)),
        (polygon(6, diameter=0.2), SPRUNG | dict(tension=2.0)),
        (crosshatch(2, spacing=0.05), dict(bond_stiffness=5e-3)),
        (polygon(6, diameter=0.2), COMPLIANT | dict(bond_stiffness=5e-3)),
        (crosshatch(2, spacing=0.05), STROKE | dict(loss_factor=0.3)),
        (crosshatch(2, spacing=0.05), dict(loss_factor=0.3)),
        (polygon(6, diameter=0.2), dict(loss_factor=10.0)),
        (crosshatch(2, spacing=0.05), COMPLIANT | dict(loss_factor=0.3)),
        (polygon(6, diameter=0.2), COMPLIANT | dict(loss_factor=10.0)),
        (crosshatch(2, spacing=0.05), MIXED | dict(loss_factor=0.3, bond_stiffness=5e-3)),
    ],
    ids=[
        "clamped",
        "sliding",
        "described",
        "polygon",
        "guided-polygon",
        "described-polygon",
        "damped",
        "damped-polygon",
        "damped-described",
        "sprung",
        "sprung-polygon",
        "bonded",
        "bonded-polygon",
        "carried-viscous",
        "viscous",
        "viscous-polygon",
        "viscous-compliant",
        "viscous-compliant-polygon",
        "mixed",
    ],
)
def test_kirchhoff_kernel_against_oracle(network, fields, order):
    """Pairs at the crossings of a crosshatch; three diameters meet at the hexagon's centre."""
    scene = Scene(network, **dict(force=5.0, tension_ramp=0.0) | fields)
    assert_follows_oracle(scene, 4, "kirchhoff", order=order)


@pytest.mark.parametrize("order", [2, 4])
@pytest.mark.parametrize(
    ("network", "fields"),
    [
        (crosshatch(2, spacing=0.05), STROKE),
        (polygon(6, diameter=0.2), dict()),
        (polygon(6, diameter=0.2), COMPLIANT | dict(ends="sliding", tension=5.0)),
        (crosshatch(2, spacing=0.05), MIXED | dict(bond_stiffness=5e-3)),
    ],
    ids=["carried", "polygon", "guided-polygon", "mixed"],
)
def test_explicit_viscous_moments_against_oracle(network, fields, order, monkeypatch):
    monkeypatch.setattr(viscosity_mild, "MILD", np.inf)
    scene = Scene(network, **dict(force=5.0, tension_ramp=0.0, loss_factor=0.02) | fields)
    assert_follows_oracle(scene, 4, "kirchhoff", order=order, mild=True)


@pytest.mark.parametrize(
    ("network", "elements_per_section", "fields"),
    [
        (crosshatch(2, length=0.5), None, AUTHORS),
        (crosshatch(2, spacing=0.05), 4, AUTHORS | EVEN),  # both ends in the stencil
        (crosshatch(2, spacing=0.05), 4, AUTHORS | EVEN | dict(filter_order=3)),
        (crosshatch(2, spacing=0.05), 4, COMPLIANT | dict(tension=2.0)),
        (polygon(6, diameter=0.2), 4, COMPLIANT | dict(ends="sliding", tension=5.0)),
        (polygon(6), None, AUTHORS),
        (crosshatch(2, spacing=0.05), 4, COMPLIANT | dict(damping=5e3)),
    ],
    ids=["published", "short", "third-order", "compliant", "guided-polygon", "polygon", "damped"],
)
def test_cosserat_kernel_against_oracle(network, elements_per_section, fields):
    """Filters, dampers, clamps and joints of PyElastica in the plane, at the authors' step."""
    scene = Scene(network, force=5.0, tension_ramp=5e-4, **fields)
    assert_follows_oracle(scene, elements_per_section, "cosserat", 5e-6)


def test_kirchhoff_against_cosserat():
    """Equal chains on an equal mesh before buckling (B = 0.32): shear and rotary inertia change
    4 s of trajectories by less than 2 % rms."""
    scene = Scene(crosshatch(4, spacing=0.1), duration=4.0, **COMPLIANT)
    assert scene.buckling_number < 0.5
    mesh = build(scene, 8)
    chain = moved(mesh, "kirchhoff", 0.9 * largest_step(mesh, "kirchhoff"), order=2)
    rods = moved(mesh, "cosserat", 0.9 * largest_step(mesh, "cosserat"))
    assert rms(chain - rods) < 0.02 * rms(rods)


@pytest.mark.slow
def test_capacities_of_kirchhoff_and_cosserat():
    """What the engines are for: C_nl and C_m of the whole 100 s within 0.02, the fourth-order
    Kirchhoff rod against the second-order Cosserat rod at 8 elements a section."""
    scene = Scene(crosshatch(4, spacing=0.1), **COMPLIANT)
    ours, theirs = (
        score(simulate(scene, engine=engine, elements_per_section=8))
        for engine in ("kirchhoff", "cosserat")
    )
    assert float(ours.c_nl) == pytest.approx(float(theirs.c_nl), abs=0.02)
    assert float(ours.c_m) == pytest.approx(float(theirs.c_m), abs=0.02)


def test_merged_crossings_are_the_limit_of_stiff_springs():
    """Crossings as one point against springs of 1e5 N/m, which yield a thousandth of what a
    section of 100 mm does (48 EI / s^3 = 3.8 N/m): trajectories within 1 % rms, and ten times
    softer springs are ten times further off."""
    off = []
    for stiffness in (np.inf, 1e5, 1e4):
        scene = Scene(
            crosshatch(4, spacing=0.1), duration=2.0, crossing_stiffness=stiffness,
            crossing_damping=0.0, damping=10.0,
        )  # fmt: skip
        mesh = build(scene, 4)
        result = kirchhoff.integrate(
            mesh, Numerics("kirchhoff", 4, 0.9 * largest_step(mesh, "kirchhoff"))
        ).displacement
        off.append(result)
    merged, stiff, softer = off
    assert rms(stiff - merged) < 0.01 * rms(merged)
    assert rms(softer - merged) / rms(stiff - merged) == pytest.approx(10.0, rel=0.2)
