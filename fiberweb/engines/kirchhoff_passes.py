"""The loops of the kirchhoff engine over nodes and edges, and the energy they derive from."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.engines.energy import enter_lag, enter_sample, joint_energy, pull_work, squared_speed
from fiberweb.engines.jit import kernel
from fiberweb.engines.ties import chord_bonds, spring_energy


class State(NamedTuple):
    """What moves: positions half a step ahead of the velocities' time, each (n,)."""

    x: np.ndarray  # m
    y: np.ndarray
    vx: np.ndarray  # m/s
    vy: np.ndarray


class Rods(NamedTuple):
    """What the passes multiply with: over edges (n - stride,), then over nodes (n,)."""

    axial: np.ndarray  # EA on elements, 0 on gaps, N
    edge: np.ndarray  # rest length, m
    over_span: np.ndarray  # 1/m where a moment is carried, else 0
    bend: np.ndarray  # bands of EI times the spline's matrix, N m^3
    bend_up: np.ndarray
    bend_up2: np.ndarray
    kick_x: np.ndarray  # velocity that a force gives in a step, damped, s/kg
    kick_y: np.ndarray
    half: float  # 1/2, or 0 in the usual chain, which has no bow
    decay: float  # of a free velocity over a step


class Scratch(NamedTuple):
    """What the passes hand on: over edges, of which edge i lies between nodes i and i + stride,
    then over nodes."""

    tangent_x: np.ndarray
    tangent_y: np.ndarray
    inverse: np.ndarray  # of the length; has to hold that of a moment ago at the start
    length: np.ndarray  # and later the y force
    tension: np.ndarray  # and later the x force
    bowing: np.ndarray  # what the bow adds to the moments
    curvature: np.ndarray
    moment: np.ndarray
    outer_x: np.ndarray  # pull and drive
    outer_y: np.ndarray


@kernel
def pass_views(state, scratch, rods, s):
    """The shifted parts of the arrays that each pass runs over, in the order of its arguments.

    Made once a call: within the loop over steps they would cost as much as a pass.
    """
    x, y, vx, vy = state
    tx, ty, inverse, fy, fx, bowing, k, moment, outer_x, outer_y = scratch
    axial, edge, over_span, c, c_up, c_up2, kick_x, kick_y = rods[:8]
    n = x.shape[0]
    inner, two = slice(s, n - s), slice(2 * s, n - 2 * s)
    return (
        (x[:-s], x[s:], y[:-s], y[s:], tx, ty, inverse, fy),
        (tx[:-s], tx[s:], ty[:-s], ty[s:], over_span[inner], k[inner], moment[inner]),
        (k[:-s], k[s:], inverse, fy, axial, edge, fx, bowing),
        (moment[two], c[two], c_up[two], c_up2[two], c_up[s : n - 3 * s],
         c_up2[: n - 4 * s], k[two], k[3 * s : n - s], k[4 * s :], k[s : n - 3 * s],
         k[: n - 4 * s], bowing[s : n - 3 * s], bowing[2 * s : n - 2 * s]),
        (tx, ty, inverse, moment[:-s], moment[s:], fx, fy),
        (x[inner], vx[inner], fx[:-s], fx[s:], outer_x[inner], kick_x[inner]),
        (y[inner], vy[inner], fy[:-s], fy[s:], outer_y[inner], kick_y[inner]),
    )  # fmt: skip


@kernel
def stretch_pass(x0, x1, y0, y1, tx, ty, inverse, length):
    """Unit tangents, inverse lengths and lengths of the edges.

    Two steps from the inverse length of a moment ago, Halley's and Newton's, leave 10 e^6 of an
    error e: round-off while strains change by less than 0.3 % a step. A square root and a division
    cost three times as much.
    """
    for i in range(tx.shape[0]):
        dx = x1[i] - x0[i]
        dy = y1[i] - y0[i]
        q = dx * dx + dy * dy
        r = inverse[i]
        error = 1.0 - q * r * r
        r *= 1.0 + error * (0.5 + 0.375 * error)
        r *= 1.5 - 0.5 * q * r * r
        tx[i] = dx * r
        ty[i] = dy * r
        inverse[i] = r
        length[i] = q * r


@kernel
def turn_pass(tx0, tx1, ty0, ty1, over_span, curvature, slope):
    """Curvature at inner nodes, and its derivative by the angle."""
    for i in range(curvature.shape[0]):
        sine = tx0[i] * ty1[i] - ty0[i] * tx1[i]
        cosine = tx0[i] * tx1[i] + ty0[i] * ty1[i]
        w = 1.0 - cosine
        curvature[i] = over_span[i] * sine * (1.0 + w * (1.0 / 3.0 + w * (2.0 / 15.0)))
        slope[i] = over_span[i] * (1.0 - 0.4 * w * w * w)


@kernel
def tension_pass(curvature0, curvature1, inverse, length, axial, edge, tension, bowing, half):
    """Tension of each edge with its bow, and the derivative of its energy by curvature.

    The energy of an edge of length l = l0 / g is EA l0 (1/g - 1 + log g + (1/g - 1) B + B^2 / 2),
    with B = b^2 / 24 what its bow adds to its length: that of the stress law at l + l0 B to the
    order that matters, and bounded below however far the edge is compressed.
    """
    for i in range(tension.shape[0]):
        reach = half * edge[i]
        b = reach * (curvature0[i] + curvature1[i])
        longer = b * b * (1.0 / 24.0)
        tension[i] = axial[i] * (1.0 - edge[i] * inverse[i] + longer)
        bowing[i] = axial[i] * reach * b * (length[i] - edge[i] * (1.0 - longer)) * (1.0 / 12.0)


@kernel
def moment_pass(
    slope, c, c_up, c_up2, c_down, c_down2, s, s_up, s_up2, s_down, s_down2,
    bowing0, bowing1,
):  # fmt: skip
    """Moment at inner nodes, of the spline through five of them and of the bows, in place of the
    slope of their curvature."""
    for i in range(slope.shape[0]):
        near = c[i] * s[i] + c_up[i] * s_up[i] + c_down[i] * s_down[i]
        far = c_up2[i] * s_up2[i] + c_down2[i] * s_down2[i]
        slope[i] *= near + far + bowing0[i] + bowing1[i]


@kernel
def force_pass(tx, ty, inverse, moment0, moment1, tension, fy):
    """Force in each edge: tension along it, moment difference across it; the x component takes
    the tension's place."""
    for i in range(fy.shape[0]):
        shear = (moment0[i] - moment1[i]) * inverse[i]
        along = tension[i]
        tension[i] = along * tx[i] - shear * ty[i]
        fy[i] = along * ty[i] + shear * tx[i]


@kernel
def kick_pass(x, v, f0, f1, outer, kick, decay, step):
    """Velocity by the net force, then position by the velocity (one direction)."""
    for i in range(v.shape[0]):
        new = decay * v[i] + kick[i] * (f1[i] - f0[i] + outer[i])
        v[i] = new
        x[i] += step * new


@kernel
def strain_energy(x, y, rods, scratch, s):
    """Elastic energy of the fibres at given positions (J); the potential of the passes, whose
    scratch it uses."""
    axial, edge, over_span, c, c_up, c_up2 = rods[:6]
    half = rods.half
    tx, ty, inverse, length = scratch[:4]
    k, slope = scratch.curvature, scratch.moment
    stretch_pass(x[:-s], x[s:], y[:-s], y[s:], tx, ty, inverse, length)
    turn_pass(tx[:-s], tx[s:], ty[:-s], ty[s:], over_span[s:-s], k[s:-s], slope[s:-s])
    total = 0.0
    for i in range(k.shape[0] - 2 * s):
        total += k[i] * (0.5 * c[i] * k[i] + c_up[i] * k[i + s] + c_up2[i] * k[i + 2 * s])
    for i in range(edge.shape[0]):
        g = edge[i] * inverse[i]
        longer = (half * edge[i] * (k[i] + k[i + s])) ** 2 / 24.0
        e = 1.0 / g - 1.0
        if axial[i] > 0.0:
            total += axial[i] * edge[i] * (e + np.log(g) + (e + 0.5 * longer) * longer)
    return total


@kernel
def record_energy(row, state, scratch, rods, ties, forcing, readouts, ledger, stepping, ramp):
    """Fill one row of the energies at a whole step; returns the work of the whole pull (J). Outer
    forces are to be set again after it."""
    vx, vy, half = state.vx, state.vy, 0.5 * stepping.step
    x, y = state.x - half * vx, state.y - half * vy
    elastic = strain_energy(x, y, rods, scratch, stepping.stride) + joint_energy(ledger, x, y)
    elastic += spring_energy(ties.springs, x, y)
    elastic += chord_bonds(ties.bonds, x, y, scratch.outer_x, scratch.outer_y, stepping.stride)
    pulled = pull_work(x, y, readouts, forcing)
    enter_sample(row, ledger, 0.5 * squared_speed(vx, vy, ledger.mass), elastic, ramp, pulled)
    enter_lag(row, ledger, stepping.step)
    return pulled
