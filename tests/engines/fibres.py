"""Straight fibres on their own, built by hand, for tests against closed forms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import hankel
from scipy.optimize import brentq

from fiberweb import engines
from fiberweb.engines.base import Numerics
from fiberweb.engines.cosserat_stiffness import SHEAR_FACTOR
from fiberweb.model.mesh import Mesh, Readout, build
from fiberweb.model.network import Network
from fiberweb.model.scene import Scene

ENGINES = ("kirchhoff", "cosserat", "elastica")
PLANAR = ("kirchhoff", "cosserat")
# a smooth bump: the cubic B-spline over four knot intervals, highest power first
BUMP = np.array([[1, 0, 0, 0], [-3, 3, 3, 1], [3, -6, 0, 4], [-1, 3, -3, 1]]) / 6


def fibre(elements: int, length: float, tension: float = 0.0, **scene) -> Mesh:
    """One straight fibre along x without crossings or load; every node is read.

    Args:
        elements: of equal length.
        length: m.
        tension: pull along the fibre at its far end (N); negative compresses.
        scene: fields of `Scene`; the near end is clamped and the far end free by default.
    """
    network = Network(
        "crosshatch", 1, length, length, "", np.array([[[0.0, 0.0], [length, 0.0]]]), ((),),
        np.zeros((0, 2)), 0, length / 2,
    )  # fmt: skip
    mesh = build(Scene(network, tension=0.0, **{"ends": "clamped"} | scene), elements)
    mesh = replace(mesh, load=np.zeros_like(mesh.load), readouts=every_node(mesh))
    return pulled(mesh, tension, 0.0)


def every_node(mesh: Mesh) -> tuple[Readout, ...]:
    """Readouts that record each node of a mesh."""
    fibre_of = np.repeat(np.arange(len(mesh.first) - 1), np.diff(mesh.first))
    return tuple(
        Readout("section_midpoint", int(f), 0, (i, i), (1.0, 0.0)) for i, f in enumerate(fibre_of)
    )


def side_by_side(*meshes: Mesh) -> Mesh:
    """Fibres that do not touch as one mesh, so that one run serves them all."""
    offset = np.cumsum([0] + [len(mesh.position) for mesh in meshes])
    together = {
        name: np.concatenate([getattr(mesh, name) for mesh in meshes])
        for name in ("position", "held", "clamped", "pull", "load", "start")
    }
    together["first"] = np.r_[0, np.concatenate([m.first[1:] + o for m, o in zip(meshes, offset)])]
    networks = [mesh.scene.network for mesh in meshes]
    network = replace(
        networks[0],
        fibres=np.concatenate([each.fibres for each in networks]),
        stations=sum((each.stations for each in networks), ()),
    )
    mesh = replace(meshes[0], scene=replace(meshes[0].scene, network=network), **together)
    return replace(mesh, readouts=every_node(mesh))


def pulled(mesh: Mesh, x: float, y: float) -> Mesh:
    """A fibre with a constant force (N) on its far end."""
    pull = np.zeros_like(mesh.pull)
    pull[-1] = x, y
    return replace(mesh, pull=pull)


def struck(mesh: Mesh, node: int, force: tuple[float, float], start: float, length: float) -> Mesh:
    """A fibre with a smooth pulse on one node, for `length` seconds from about `start` on.

    The peak force (N) is two thirds of `force`, its spectrum falls off above 2 / length, and
    it is zero after the pulse. The pulse begins on a multiple of length / 4.
    """
    load = np.zeros_like(mesh.load)
    load[node] = force
    rate = 4.0 / length
    rest = np.zeros((max(0, round(start * rate)), 4))
    drive = np.concatenate([rest, BUMP * rate ** np.arange(3, -1, -1), np.zeros((1, 4))])
    return replace(mesh, load=load, drive=drive, drive_rate=rate)


def free(mesh: Mesh) -> Mesh:
    """A fibre that nothing holds."""
    held, clamped = np.zeros_like(mesh.held), np.zeros_like(mesh.clamped)
    return replace(mesh, held=held, clamped=clamped)


def sampled(mesh: Mesh, step: float, samples: int, every: int = 1) -> Mesh:
    """The mesh recorded at t = 0 and each `every` steps of exactly `step` seconds."""
    scene = replace(mesh.scene, sample_rate=1.0 / (every * step), duration=samples * every * step)
    return replace(mesh, scene=scene)


def largest_step(mesh: Mesh, engine: str) -> float:
    """The largest stable step (s) of an engine."""
    return engines.load(engine).largest_step(mesh)


def run(mesh: Mesh, engine: str, step: float, samples: int, every: int = 1) -> np.ndarray:
    """Displacement of every node, shape (samples, nodes, 2), m; see `sampled`."""
    recording = engines.load(engine).integrate(
        sampled(mesh, step, samples, every), Numerics(engine, None, step)
    )
    assert recording.unstable_at is None
    return recording.displacement


def settle(mesh: Mesh, engine: str, step: float, duration: float) -> np.ndarray:
    """Displacement of every node at the end of a run, shape (nodes, 2), m."""
    return run(mesh, engine, step, 101, round(duration / step / 100))[-1]


def velocities(displacement: np.ndarray, step: float) -> np.ndarray:
    """Velocities at every step of a run that starts at rest and is recorded at each step.

    Leapfrog drifts half a step by the old velocity and half by the new, so that
    x[n+1] - x[n] = h (v[n] + v[n+1]) / 2: solved for v from v[0] = 0 on.
    """
    twice_mean = 2.0 * np.diff(displacement, axis=0) / step
    sign = (-1.0) ** np.arange(len(twice_mean)).reshape(-1, *[1] * (displacement.ndim - 1))
    velocity = np.zeros_like(displacement)
    velocity[1:] = sign * np.cumsum(sign * twice_mean, axis=0)
    return velocity


def frequencies(signal: np.ndarray, rate: float, count: int) -> np.ndarray:
    """Frequencies (Hz, ascending) of the `count` strongest tones of a free vibration.

    Matrix pencil of the truncated Hankel matrix (Hua and Sarkar, IEEE Trans. Acoust. 38,
    814 (1990)): a few periods give 0.1 % where a Fourier transform would need a thousand.
    """
    signal = signal - signal.mean()
    half = len(signal) // 2
    left, singular, _ = np.linalg.svd(hankel(signal[:half], signal[half - 1 :]))
    basis = left[:, singular > 1e-7 * singular[0]]
    poles = np.linalg.eigvals(np.linalg.lstsq(basis[:-1], basis[1:], rcond=None)[0])
    poles = poles[(poles.imag > 0) & (abs(np.log(abs(poles))) * half < 1.0)]  # neither die nor grow
    powers = poles ** np.arange(len(signal))[:, None]
    columns = np.hstack([powers.real, powers.imag, np.ones((len(signal), 1))])
    amplitude = np.linalg.lstsq(columns, signal, rcond=None)[0][:-1].reshape(2, -1)
    strongest = np.argsort(-np.hypot(*amplitude))[:count]
    return np.sort(np.angle(poles[strongest])) * rate / (2 * np.pi)


def first_frequency(scene: Scene) -> float:
    """Of a clamped-free fibre without shear or rotary inertia (rad/s)."""
    length = scene.network.length
    line_density = scene.density * scene.area
    return (0.596864 * np.pi / length) ** 2 * np.sqrt(scene.bending_stiffness / line_density)


def cantilever(scene: Scene, load: float, engine: str) -> np.ndarray:
    """Tip displacement (x, y; m) of a clamped fibre under a dead lateral end load (N).

    The continuum limit of the engine's own law: bending, and stretch with stress
    EA (e - 1) / e; for the Cosserat engines shear by the same rule and the moment divided by
    e^3. The force in the fibre is the load everywhere; shooting from the tip for its angle.
    """
    stiffness = np.array([scene.axial_stiffness, scene.axial_stiffness / 3.0 * SHEAR_FACTOR])
    shears = engine != "kirchhoff"

    def rates(_, state):
        angle, moment = state[:2]
        c, s = np.cos(angle), np.sin(angle)
        strain_per_stretch = np.array([s, c]) * load / stiffness * [1.0, shears]
        # e^2 = (1 + a e)^2 + (b e)^2, with a and b the strains per stretch e
        a, b = strain_per_stretch
        square = 1.0 - a * a - b * b
        stretch = (a + np.sqrt(a * a + square)) / square
        along, across = 1.0 + a * stretch, b * stretch
        x, y = along * c - across * s, along * s + across * c
        turn = moment / scene.bending_stiffness * (stretch**3 if shears else 1.0)
        return [turn, -load * x, x, y]

    def from_tip(angle):
        length = scene.network.length
        start = [angle, 0.0, 0.0, 0.0]
        return solve_ivp(rates, (length, 0.0), start, rtol=1e-11, atol=1e-14).y[:, -1]

    angle = brentq(lambda angle: from_tip(angle)[0], 0.0, 0.5 * np.pi, xtol=1e-13)
    _, _, x, y = from_tip(angle)
    return np.array([-x - scene.network.length, -y])


def slope(sizes, errors) -> float:
    """Order of convergence: the slope of the errors by regression on log axes."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])
