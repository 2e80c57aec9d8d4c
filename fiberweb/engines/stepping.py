"""What the planar kernels share beside energy: the step, outer forces, and what is recorded."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.engines.base import RUNAWAY, Numerics, fitted_step, readout_arrays
from fiberweb.engines.jit import both, kernel
from fiberweb.engines.layout import Interleaving, Layout, packed
from fiberweb.model.mesh import Mesh


class Stepping(NamedTuple):
    """How the kernels step; neighbours in their arrays are `stride` apart."""

    step: float  # s
    per_sample: int  # steps between samples
    speed_limit: float  # m/s: a faster node has left the physics
    stride: int


class Forcing(NamedTuple):
    """Drive and tension."""

    drive: np.ndarray  # spline coefficients of u, (intervals, 4)
    drive_rate: float  # Hz
    ramp_time: float  # s, in which the pull grows
    touched: np.ndarray  # nodes on which ties exert forces, (touched,)
    nodes: np.ndarray  # those that are driven, (driven,)
    load_x: np.ndarray  # N, on them for u = 1
    load_y: np.ndarray
    pull_x: np.ndarray  # N, (n,)
    pull_y: np.ndarray


class Guides(NamedTuple):
    """Nodes that slide along a slanted line, and its direction."""

    nodes: np.ndarray  # (guided,)
    along_x: np.ndarray
    along_y: np.ndarray


class Readouts(NamedTuple):
    """What is recorded, and from where."""

    nodes: np.ndarray  # (readouts, 4)
    weights: np.ndarray
    rest_x: np.ndarray  # m, (n,)
    rest_y: np.ndarray


def build_stepping(mesh: Mesh, numerics: Numerics, interleaving: Interleaving) -> Stepping:
    """The step of a run, shortened to divide a sample."""
    step, per_sample = fitted_step(mesh.scene, numerics.time_step)
    return Stepping(step, per_sample, RUNAWAY * mesh.scene.wave_speed, interleaving.stride)


def build_forcing(
    mesh: Mesh, layout: Layout, interleaving: Interleaving, touched: np.ndarray
) -> Forcing:
    """Outer forces in the order of the kernels; touched: see `fiberweb.engines.ties`."""
    load_x, load_y = layout.load_x[interleaving.nodes], layout.load_y[interleaving.nodes]
    driven = np.flatnonzero(load_x**2 + load_y**2)
    pull = packed(layout.pull_x[interleaving.nodes], layout.pull_y[interleaving.nodes])
    return Forcing(
        mesh.drive, mesh.drive_rate, mesh.scene.tension_ramp, touched, driven, load_x[driven],
        load_y[driven], *pull,
    )  # fmt: skip


def build_guides(mesh: Mesh, layout: Layout, interleaving: Interleaving) -> Guides:
    """The guided nodes in the order of the kernels."""
    # unsigned, since Numba looks for negative indices at every access otherwise
    nodes = interleaving.place[layout.guided].astype(np.uint64)
    return Guides(nodes, *np.ascontiguousarray(mesh.guides.T))


def build_readouts(mesh: Mesh, layout: Layout, interleaving: Interleaving) -> Readouts:
    """What is read, in the order of the kernels."""
    nodes, weights = readout_arrays(mesh)
    rest = packed(layout.x[interleaving.nodes], layout.y[interleaving.nodes])
    return Readouts(interleaving.place[layout.at[nodes]], weights, *rest)


def displace(state, mesh: Mesh, layout: Layout, interleaving: Interleaving) -> None:
    """Add what a run starts with to the positions of a state."""
    at = interleaving.place[layout.at]
    state.x[at] += mesh.start[:, 0]
    state.y[at] += mesh.start[:, 1]


def damped_kick(rate: float, step: float) -> float:
    """What a step makes of a constant force over mass, (1 - exp(-rate step)) / rate, in s.

    With v' = exp(-rate step) v + damped_kick a, the flow of dv/dt = a - rate v over a step, between
    the two halves of a drift, leapfrog stays of second order and time-reversible, a force gives
    the right terminal velocity a / rate at any step, and so a slow mode of frequency w the right
    rate of decay w^2 / rate. A kick of step exp(-rate step / 2), which undamped leapfrog between
    two half decays comes to, has x / sinh x of both, x = rate step / 2. The step stays stable: its
    limit grows by x coth x in h^2. Reference: Hochbruck and Ostermann, Acta Numerica 19 (2010).
    """
    return -np.expm1(-rate * step) / rate if rate > 0.0 else step


@both
def drive_value(coefficients, rate, time):
    """The input's spline at one time."""
    i = min(int(time * rate), coefficients.shape[0] - 1)
    s = time - i / rate
    c = coefficients[i]
    return ((c[0] * s + c[1]) * s + c[2]) * s + c[3]


@kernel
def ramp_at(time, ramp_time):
    """Share of the pull that acts at one time."""
    return min(1.0, time / ramp_time) if ramp_time > 0.0 else 1.0


@kernel
def apply_pull(forcing, ramp, outer_x, outer_y):
    """Set the outer force of every node to a share of its pull."""
    for i in range(outer_x.shape[0]):
        outer_x[i] = ramp * forcing.pull_x[i]
        outer_y[i] = ramp * forcing.pull_y[i]


@kernel
def apply_forces(forcing, ramp, u, outer_x, outer_y):
    """Set the outer force of driven nodes and of those that ties are to push: a share of the pull,
    and the drive."""
    for i in range(forcing.touched.shape[0]):
        m = forcing.touched[i]
        outer_x[m] = ramp * forcing.pull_x[m]
        outer_y[m] = ramp * forcing.pull_y[m]
    for i in range(forcing.nodes.shape[0]):
        m = forcing.nodes[i]
        outer_x[m] = ramp * forcing.pull_x[m] + u * forcing.load_x[i]
        outer_y[m] = ramp * forcing.pull_y[m] + u * forcing.load_y[i]


@kernel
def guide(guides, x, y, vx, vy, moved):
    """Leave guided nodes the part of their velocity along the line, and take back what the rest
    did to their positions in `moved` seconds."""
    for i in range(guides.nodes.shape[0]):
        n = guides.nodes[i]
        tx, ty = guides.along_x[i], guides.along_y[i]
        across = tx * vy[n] - ty * vx[n]
        vx[n] += ty * across
        vy[n] -= tx * across
        x[n] += moved * ty * across
        y[n] -= moved * tx * across


@kernel
def record(state, readouts, half, out):
    """Displacement of the readouts at a whole step, from positions half a step ahead."""
    x, y, vx, vy = state.x, state.y, state.vx, state.vy
    nodes, weights, rest_x, rest_y = readouts
    for r in range(nodes.shape[0]):
        ux = 0.0
        uy = 0.0
        for k in range(nodes.shape[1]):
            i = nodes[r, k]
            ux += weights[r, k] * (x[i] - half * vx[i] - rest_x[i])
            uy += weights[r, k] * (y[i] - half * vy[i] - rest_y[i])
        out[r, 0] = ux
        out[r, 1] = uy


@kernel
def in_bounds(vx, vy, limit):
    """Whether every velocity is finite and below the limit."""
    for i in range(vx.shape[0]):
        if not (abs(vx[i]) < limit and abs(vy[i]) < limit):
            return False
    return True
