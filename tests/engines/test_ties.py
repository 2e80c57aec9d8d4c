"""Springs at ends, bonds at crossings, points carried by a motor and fibres of different materials
against closed forms. PyElastica's are held against cosserat's in tests/engines/test_equality.py."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq

from fiberweb import Scene, crosshatch, engines, simulate
from fiberweb.engines.base import Numerics
from fiberweb.model.mesh import build
from fiberweb.model.network import Network
from tests.engines.fibres import (
    ENGINES,
    PLANAR,
    every_node,
    fibre,
    frequencies,
    largest_step,
    run,
    sampled,
    settle,
    side_by_side,
    slope,
    struck,
)

SPRING = dict(ends="sprung", end_stiffness=300.0)


def held(length: float, elements: int, **scene):
    """A fibre pinned at its near end and held by a spring at its far one, under the tension that
    the scene gives (`fibres.fibre` takes that away)."""
    return build(replace(fibre(elements, length).scene, **scene), elements)


@pytest.mark.parametrize("engine", PLANAR)
def test_springs_hold_their_tension_at_rest(engine):
    """EA (1 - L / l) = T: the fibre of 0.5 m gives way by L T / (EA - T) = 8.0 mm at 5 N, and the
    spring's pull is then T and not less."""
    mesh = held(0.5, 8, tension=5.0, tension_ramp=0.05, damping=300.0, **SPRING)
    mesh = replace(mesh, load=0.0 * mesh.load, readouts=every_node(mesh))
    step = 0.9 * largest_step(mesh, engine)
    moved = settle(mesh, engine, step, 0.25)
    stiffness = mesh.scene.axial_stiffness
    assert moved[-1, 0] == pytest.approx(0.5 * 5.0 / (stiffness - 5.0), rel=1e-4)


@pytest.mark.parametrize("engine", ENGINES)
def test_axial_frequencies_of_a_fibre_on_a_spring(engine):
    """tan(q) = -EA q / (k L), f = c q / 2 pi L: two modes within 1 %."""
    length, elements, scene = 0.1, 40, dict(tension=0.0, damping=0.0) | SPRING
    mesh = held(length, elements, **scene)
    ratio = mesh.scene.axial_stiffness / (SPRING["end_stiffness"] * length)
    roots = [
        brentq(lambda q: np.sin(q) + ratio * q * np.cos(q), (n + 0.5) * np.pi, (n + 1) * np.pi)
        for n in range(2)
    ]
    expected = np.array(roots) * mesh.scene.wave_speed / (2 * np.pi * length)
    mesh = struck(mesh, -1, (0.01, 0.0), 0.0, 0.25 / expected[0])
    mesh = replace(mesh, readouts=every_node(mesh))
    step = 0.5 * largest_step(mesh, engine)
    every = round(1 / (8 * expected[-1] * step))
    end = run(mesh, engine, step, round(6 / (expected[0] * every * step)), every)[:, -1, 0]
    after = int(0.3 / expected[0] / (every * step)) + 2
    np.testing.assert_allclose(frequencies(end[after:], 1 / (every * step), 2), expected, rtol=1e-2)


def carried(length: float, elements: int, stroke: float, u: CubicSpline, **scene):
    """A pinned, sliding fibre whose middle goes where a spline of u carries it."""
    mesh = held(length, elements, ends="sliding", force=None, stroke=stroke, **scene)
    drive = np.ascontiguousarray(u.c.T)
    return replace(mesh, drive=drive, drive_rate=1.0 / (u.x[1] - u.x[0]), readouts=every_node(mesh))


@pytest.mark.parametrize("engine", ENGINES)
def test_shape_of_a_beam_that_is_carried_at_its_middle(engine):
    """w = d (3 x L^2 - 4 x^3) / L^3 up to the middle, within 0.5 % of d."""
    length, stroke, elements = 0.1, 1e-4, 32
    times = np.linspace(0.0, 0.4, 41)
    share = np.minimum(1.0, times / 0.1)
    rising = CubicSpline(times, share**2 * (3 - 2 * share))
    mesh = carried(length, elements, stroke, rising, tension=0.0, damping=100.0)
    moved = settle(mesh, engine, 0.9 * largest_step(mesh, engine), 0.35)
    x = mesh.position[: elements // 2 + 1, 0]
    shape = stroke * (3 * x * length**2 - 4 * x**3) / length**3
    assert moved[elements // 2, 1] == pytest.approx(stroke, rel=1e-9)
    np.testing.assert_allclose(moved[: elements // 2 + 1, 1], shape, rtol=0, atol=0.005 * stroke)


@pytest.mark.parametrize("engine", PLANAR)
@pytest.mark.parametrize("ratio", [0.6, 1.7, 4.0])
def test_motion_of_a_beam_that_is_shaken_at_its_middle(engine, ratio):
    """At a frequency below and above the first, 24.84 Hz: w = A sin(b x) + B sinh(b x) with w = d
    and w' = 0 in the middle and b^4 = rho A (w^2 - i g w) / EI; amplitude and phase a quarter
    along, within 1 % of the larger of either and d; 1.5 % with shear and rotary inertia."""
    length, stroke, damping = 0.1, 1e-5, 60.0
    elements = {"kirchhoff": 32, "cosserat": 64}[engine]
    frequency = ratio * 24.84
    times = np.arange(round(20 * 0.25 * frequency) + 1) / (20 * frequency)
    u = CubicSpline(times, np.sin(2 * np.pi * frequency * times))
    mesh = carried(length, elements, stroke, u, tension=0.0, damping=damping)
    step = 0.9 * largest_step(mesh, engine)
    every = max(1, round(1 / (40 * frequency * step)))
    count = int(times[-1] / (every * step)) - 1
    quarter = run(mesh, engine, step, count, every)[:, elements // 4, 1]
    time = every * step * np.arange(count)
    late = time > time[-1] - 3 / frequency
    angle = 2 * np.pi * frequency
    basis = np.column_stack([np.sin(angle * time), np.cos(angle * time)])[late]
    found = complex(*np.linalg.lstsq(basis, quarter[late], rcond=None)[0])
    scene = mesh.scene
    line_density = scene.density * scene.area
    b = (line_density * (angle**2 - 1j * damping * angle) / scene.bending_stiffness) ** 0.25
    half = b * length / 2
    system = np.array([[np.sin(half), np.sinh(half)], [np.cos(half), np.cosh(half)]])
    expected = np.linalg.solve(system, [stroke, 0]) @ [np.sin(half / 2), np.sinh(half / 2)]
    bound = {"kirchhoff": 0.01, "cosserat": 0.015}[engine]
    assert abs(found - expected) < bound * max(abs(expected), stroke)


def cross(length: float) -> Network:
    """Two fibres that cross in their middles."""
    half = length / 2
    fibres = np.array([[[0.0, half], [length, half]], [[half, 0.0], [half, length]]])
    stations = (((0, half),), ((0, half),))
    return Network(
        "crosshatch", 1, length, half, "", fibres, stations, np.array([[half, half]]), 0, half / 2
    )


def bonded(engine: str, elements: int, bond: float, loads=(1.0, -1.0)) -> np.ndarray:
    """Where a quarter along the unloaded fibre of a cross comes to rest (m, across it), if the
    other is pushed to opposite sides at its quarters."""
    scene = Scene(
        cross(0.1), tension=0.0, force=1e-4, bond_stiffness=bond, damping=150.0, duration=1.0,
        crossing_stiffness=np.inf if engine == "kirchhoff" else 2e3,
    )  # fmt: skip
    mesh = build(scene, elements)
    load = np.zeros_like(mesh.load)
    load[[elements // 2, 3 * elements // 2], 1] = 1e-4 * np.array(loads)
    mesh = replace(
        mesh, load=load, drive=np.array([[0.0, 0.0, 0.0, 1.0]]), readouts=every_node(mesh)
    )
    moved = settle(mesh, engine, 0.9 * largest_step(mesh, engine), 0.4)
    return moved[mesh.first[1] + elements // 2, 0]


def quarter_of_bonded(bond: float, half: float = 0.05) -> float:
    """The same by beam theory, magnitude: a couple M = K F l^2 / 16 EI / (1 + K l / 6 EI), with
    1 / K = 1 / bond + l / 6 EI, turns the other fibre, which is M l^2 / 32 EI out."""
    bending = Scene(crosshatch(2, spacing=0.1)).bending_stiffness
    stiffness = 1.0 / (1.0 / bond + half / (6 * bending))
    turn = 1e-4 * half**2 / (16 * bending)
    couple = stiffness * turn / (1.0 + stiffness * half / (6 * bending))
    return couple * half**2 / (32 * bending)


@pytest.mark.parametrize("engine", PLANAR)
@pytest.mark.parametrize("relative", [0.3, 10.0, np.inf])
def test_a_bond_carries_a_couple(engine, relative):
    """A bond softer than the fibres, EI / l, a stiffer one and a rigid one, within 1 %."""
    bond = relative * Scene(crosshatch(2, spacing=0.1)).bending_stiffness / 0.05
    found, expected = abs(bonded(engine, 24, bond)), quarter_of_bonded(bond)
    assert found == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("engine", PLANAR)
def test_a_bond_is_second_order_in_the_elements(engine):
    bond = 2.0 * Scene(crosshatch(2, spacing=0.1)).bending_stiffness / 0.05
    counts = np.array([4, 8, 16])
    expected = quarter_of_bonded(bond)
    errors = [abs(abs(bonded(engine, n, bond)) - expected) / expected for n in counts]
    print(errors)
    assert slope(1.0 / counts, errors) > 1.7
    assert errors[-1] < 0.02


@pytest.mark.parametrize("engine", PLANAR)
def test_a_rigid_turn_of_all_fibres_strains_no_bond(engine):
    """Equal loads on both sides of the crossing turn neither fibre there: the other stays, but for
    what round-off makes of it."""
    turned = abs(bonded(engine, 16, 1e-2))
    assert abs(bonded(engine, 16, 1e-2, loads=(1.0, 1.0))) < 0.03 * turned


@pytest.mark.parametrize("engine", PLANAR)
def test_fibres_of_different_materials_each_ring_as_they_would_alone(engine):
    """f1 = (pi / 2) sqrt(EI / rho A) / L^2 of three fibres in one run, within 1 %."""
    length, elements = 0.1, 32
    diameters, moduli, densities = (2e-3, 1e-3, 1.5e-3), (1e8, 4e8, 2e8), (1000.0, 1140.0, 2000.0)
    one = fibre(elements, length, damping=0.0, ends="sliding")
    mesh = side_by_side(*[struck(one, elements // 2, (0.0, 2e-4), 0.0, 0.01) for _ in diameters])
    fibres = mesh.position[np.r_[mesh.first[:-1], mesh.first[1:] - 1]].reshape(2, -1, 2)
    network = replace(
        one.scene.network, fibres=fibres.swapaxes(0, 1).copy(), stations=((),) * len(diameters)
    )
    scene = replace(
        mesh.scene, network=network, diameter=diameters, youngs_modulus=moduli, density=densities
    )
    mesh = replace(mesh, scene=scene)
    expected = np.pi / 2 * np.sqrt(scene.fibres.bending_stiffness / scene.fibres.line_density)
    step = 0.9 * largest_step(mesh, engine)
    every = round(5e-4 / step)
    rate = 1 / (every * step)
    moved = run(mesh, engine, step, round(0.12 * rate), every)[int(0.011 * rate) :]
    middles = mesh.first[:-1] + elements // 2
    found = [frequencies(moved[:, middle, 1], rate, 1)[0] for middle in middles]
    np.testing.assert_allclose(found, expected / length**2, rtol=1e-2)


TIED = dict(crossing_stiffness=1e3)
EVERYTHING = dict(
    ends="sprung", end_stiffness=50.0, tension=0.2, bond_stiffness=5e-3, loss_factor=0.2,
    diameter=(2e-3, 2e-3, 1.5e-3, 1.5e-3),
)  # fmt: skip


def test_engines_agree_to_the_meshs_error():
    """All features at once, 1 s: halving the elements of either brings kirchhoff and cosserat at
    least 2.5 times closer."""
    apart = []
    for elements in (8, 16):
        scene = Scene(crosshatch(2, spacing=0.1), stroke=2e-3, duration=1.0, **TIED | EVERYTHING)
        one, other = (
            simulate(scene, engine=engine, elements_per_section=elements).displacement.values
            for engine in PLANAR
        )
        apart.append(np.sqrt(np.mean((one - other) ** 2) / np.mean(one**2)))
    print(f"rms difference over rms: {apart[0]:.3g} at 8 elements, {apart[1]:.3g} at 16")
    assert apart[1] < 0.4 * apart[0] and apart[1] < 0.03


@pytest.mark.parametrize("engine", PLANAR)
def test_the_ledger_closes_with_springs_bonds_motor_and_viscosity(engine):
    scene = Scene(crosshatch(2, spacing=0.1), stroke=5e-3, duration=1.0, **TIED | EVERYTHING)
    response = simulate(scene, engine=engine, elements_per_section=4)
    kinetic, elastic, work, dissipated = response.energy.values.T
    assert (kinetic >= 0).all() and (elastic >= 0).all() and dissipated[-1] > 0.01 * work[-1]
    assert response.attrs["energy_residual"] < 2e-3


@pytest.mark.parametrize("bond", [1e-3, np.inf])
def test_the_limit_of_the_step_knows_bonds(bond):
    """Just below it a run stays finite, just above it does not; a rigid bond costs no step."""
    scene = Scene(crosshatch(2, spacing=0.1), bond_stiffness=bond, duration=0.2)
    mesh = build(scene, 4)
    limit = largest_step(mesh, "kirchhoff")
    assert limit > 0.95 * largest_step(build(replace(scene, bond_stiffness=0.0), 4), "kirchhoff")
    kirchhoff = engines.load("kirchhoff")
    for factor, stable in ((0.99, True), (1.03, False)):
        timed = sampled(mesh, factor * limit, 200, 20)
        recording = kirchhoff.integrate(timed, Numerics("kirchhoff", 4, factor * limit))
        assert (recording.unstable_at is None) == stable


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        (dict(stroke=0.01, force=0.1), "force = 0.1 beside stroke"),
        (dict(stroke=0.01, disturbance=1e-9), "disturbance"),
        (dict(stroke=0.08, lever=0.07), "lever = 0.07"),
        (dict(stroke=-0.08, lever=0.07), "lever = 0.07"),
        (dict(lever=0.07), "lever = 0.07"),
        (dict(stroke=0.0), "stroke = 0 moves nothing"),
        (dict(ends="sprung"), "end_stiffness"),
        (dict(end_stiffness=50.0), "ends = 'sprung'"),
        (dict(diameter=(1e-3, 2e-3)), "diameter has 2 values for 8 fibres"),
        (dict(stroke=0.01, setup="published"), "layout = 'authors'"),
    ],
)
def test_contradictions_are_one_sentence(fields, words):
    with pytest.raises(ValueError, match=words) as refused:
        Scene(crosshatch(4, length=0.5), **fields)
    assert "\n" not in str(refused.value)


def test_a_stroke_does_not_carry_what_is_one_point():
    """The middle fibre of three is driven in its middle, where another one crosses it."""
    with pytest.raises(ValueError, match="carries a crossing whose fibres are one point"):
        Scene(crosshatch(3, spacing=0.1), stroke=0.01)
    assert Scene(crosshatch(3, spacing=0.1), stroke=0.01, crossing_stiffness=1e3).stroke == 0.01


def test_a_stroke_needs_a_node():
    with pytest.raises(ValueError, match="even number of elements_per_section"):
        build(Scene(crosshatch(4, length=0.5), stroke=0.01), 3)


def test_a_lever_turns_the_input():
    """At u = 1 the end of the lever is where the stroke says; at other u it follows the sine."""
    from fiberweb.model import drive

    straight = Scene(crosshatch(2, spacing=0.1), stroke=0.05, lowest_knot=0, drive_rate=2.0)
    turned = replace(straight, lever=0.07)
    times = np.arange(100) / drive.TABLE_RATE
    u = drive.of_scene(straight)(times)
    most = np.arcsin(0.05 / 0.07)
    np.testing.assert_allclose(
        turned.stroke * drive.of_scene(turned)(times), 0.07 * np.sin(most * u), atol=1e-12
    )
    assert drive.rate(turned) == 100.0 and drive.rate(straight) == 2.0


def test_a_stroke_may_point_the_other_way():
    """The driven point goes there; a net without a near and a far end would be the mirror image."""
    there = Scene(crosshatch(2, spacing=0.1), stroke=0.05, lever=0.07, duration=0.5, **TIED)
    back = replace(there, stroke=-0.05)
    assert there.motor_angle == back.motor_angle == pytest.approx(np.degrees(np.arcsin(5 / 7)))
    assert np.isnan(replace(there, lever=None).motor_angle)
    driven = []
    for scene in (there, back):
        moved = simulate(scene, "draft")["displacement"]
        away = np.hypot(
            *(moved[f"rest_{c}"] - at for c, at in zip("xy", scene.network.driven_point))
        )
        driven.append(moved.isel(readout=int(away.argmin())).sel(axis="y").values)
    np.testing.assert_allclose(driven[0], -driven[1], rtol=0, atol=1e-9)
    assert np.ptp(driven[0]) > 0.01


def test_slanted_ends_slide_on_springs():
    """A fibre at an angle of 30 degrees is held as one along x is."""
    length, turn = 0.5, np.deg2rad(30.0)
    flat = fibre(8, length).scene.network
    network = replace(
        flat, fibres=np.array([[[0.0, 0.0], [length * np.cos(turn), length * np.sin(turn)]]])
    )
    scene = Scene(network, tension=5.0, tension_ramp=0.05, damping=300.0, **SPRING)
    mesh = build(scene, 8)
    assert len(mesh.guided) == 1
    mesh = replace(mesh, load=0.0 * mesh.load, readouts=every_node(mesh))
    moved = settle(mesh, "kirchhoff", 0.9 * largest_step(mesh, "kirchhoff"), 0.25)
    stretched = length * 5.0 / (scene.axial_stiffness - 5.0)
    np.testing.assert_allclose(
        moved[-1], stretched * np.array([np.cos(turn), np.sin(turn)]), rtol=1e-4
    )
