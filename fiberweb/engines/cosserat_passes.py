"""The loops of the cosserat engine over nodes and elements, one thing each, and its sums."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.engines.energy import (
    enter_sample,
    joint_energy,
    joint_power,
    keep,
    pull_work,
    squared_speed,
)
from fiberweb.engines.jit import kernel, summing
from fiberweb.engines.laplace import REACH
from fiberweb.engines.series import sine_cosine
from fiberweb.engines.ties import spring_energy, turn_bonds


class State(NamedTuple):
    """What moves: over nodes (n,), then over elements (n - stride,)."""

    x: np.ndarray  # m, half a step ahead of the velocities' time; so is the angle
    y: np.ndarray
    vx: np.ndarray  # m/s
    vy: np.ndarray
    angle: np.ndarray
    omega: np.ndarray  # 1/s
    cosine: np.ndarray  # of the angle
    sine: np.ndarray


class Rods(NamedTuple):
    """What the passes multiply with: over nodes, then over elements, then the same everywhere."""

    kick_x: np.ndarray  # velocity that a force gives in a step, before it decays, s/kg
    kick_y: np.ndarray
    bend: np.ndarray  # EI over the span of a node, N m
    half_over_voronoi: np.ndarray  # 1/m
    edge: np.ndarray  # rest length, m
    over_edge: np.ndarray  # 1 / edge, and like the next four 0 in gaps, 1/m
    axial: np.ndarray  # EA, N
    slack: np.ndarray  # EA times edge, N m
    shear: np.ndarray  # alpha_c G A, N
    ease: np.ndarray  # 1 / (rho I edge^2), 1 / (kg m)
    spin_decay: np.ndarray  # of angular velocity over a step, at rest
    stretched: np.ndarray  # minus its logarithm's change by dilatation
    decay: float  # of a free velocity over a step
    spin_kick: float  # what an angular acceleration gives in a step, before it decays, s
    dead_band: bool  # rotations as in `authors_rotations`


class Held(NamedTuple):
    """Nodes whose velocity is set to zero at the end of a step, after damper and filter."""

    x: np.ndarray
    y: np.ndarray


class Spin(NamedTuple):
    """What the ledger needs of the elements' turning."""

    inertia: np.ndarray  # kg m^2, 0 in gaps
    damping: np.ndarray  # rate, 1/s


class Scratch(NamedTuple):
    """What the passes hand on: over elements, then over nodes."""

    force_x: np.ndarray
    force_y: np.ndarray
    length: np.ndarray
    acceleration: np.ndarray  # angular, from shear, stretching and bonds
    torque: np.ndarray  # of the bonds
    couple: np.ndarray
    outer_x: np.ndarray  # pull, drive and crossings
    outer_y: np.ndarray
    difference: np.ndarray  # of the filter


class Velocities(NamedTuple):
    """A copy of all velocities."""

    vx: np.ndarray
    vy: np.ndarray
    omega: np.ndarray


@kernel
def pass_views(state, scratch, rods, s):
    """The parts of the arrays that each pass runs over, in the order of its arguments.

    Made once a call: at a few hundred elements they would cost a fifth of the step. They leave
    out all ghosts before and after the chain but those that an element reaches.
    """
    x, y, vx, vy, angle, omega, c, sine = state
    fx, fy, length, alpha, _, couple, outer_x, outer_y, _ = scratch
    kick_x, kick_y, bend, half_over_voronoi, _, over_edge, axial, slack, shear, ease = rods[:10]
    low, high = (REACH - 1) * s, x.shape[0] - (REACH - 1) * s
    a, b = slice(low, high - s), slice(low + s, high)
    inner, before = slice(b.start, a.stop), slice(low, a.stop - s)
    return (
        (x[a], x[b], y[a], y[b], vx[a], vx[b], vy[a], vy[b], omega[a], c[a], sine[a], axial[a],
         slack[a], shear[a], ease[a], fx[a], fy[a], length[a], alpha[a]),
        (angle[before], angle[inner], length[before], length[inner], bend[inner],
         half_over_voronoi[inner], couple[inner]),
        (c[before], sine[before], c[inner], sine[inner], length[before], length[inner],
         bend[inner], half_over_voronoi[inner], couple[inner]),
        (vx[inner], fx[before], fx[inner], outer_x[inner], kick_x[inner]),
        (vy[inner], fy[before], fy[inner], outer_y[inner], kick_y[inner]),
        (omega[a], alpha[a], couple[a], couple[b], length[a], over_edge[a], ease[a],
         rods.spin_decay[a], rods.stretched[a]),
        (x[inner], vx[inner]),
        (y[inner], vy[inner]),
        (angle[a], omega[a], c[a], sine[a]),
    )  # fmt: skip


@kernel
def stress_pass(
    x0, x1, y0, y1, vx0, vx1, vy0, vy1, omega, c, s, axial, slack, shear, ease, fx, fy, length,
    alpha,
):  # fmt: skip
    """Forces in the elements, and the angular acceleration from shear and stretching."""
    for i in range(fx.shape[0]):
        dx = x1[i] - x0[i]
        dy = y1[i] - y0[i]
        now = np.sqrt(dx * dx + dy * dy)
        r = 1.0 / now
        n3 = axial[i] * (dx * c[i] + dy * s[i]) - slack[i]
        ns = shear[i] * (dy * c[i] - dx * s[i])
        nx = (n3 * c[i] - ns * s[i]) * r
        ny = (n3 * s[i] + ns * c[i]) * r
        fx[i] = nx
        fy[i] = ny
        length[i] = now
        rate = (dx * (vx1[i] - vx0[i]) + dy * (vy1[i] - vy0[i])) * (r * r)
        alpha[i] = (dx * ny - dy * nx) * (now * ease[i]) + omega[i] * rate


@kernel
def couple_pass(angle0, angle1, length0, length1, bend, half_over_voronoi, couple):
    """Bending couple at inner nodes."""
    for i in range(couple.shape[0]):
        e = (length0[i] + length1[i]) * half_over_voronoi[i]
        couple[i] = bend[i] * (angle1[i] - angle0[i]) / (e * e * e)


@kernel
def velocity_pass(v, f0, f1, outer, kick, decay):
    """Kick and damp one direction of the nodes' velocities."""
    for i in range(v.shape[0]):
        v[i] = decay * (v[i] + kick[i] * (f1[i] - f0[i] + outer[i]))


@kernel
def drift_pass(x, v, step):
    """Positions by velocities."""
    for i in range(x.shape[0]):
        x[i] += step * v[i]


@kernel
def spin_pass(omega, alpha, couple0, couple1, length, over_edge, ease, decay, stretched, kick):
    """Kick and damp the angular velocities; the damper's power of dilatation as a series."""
    for i in range(omega.shape[0]):
        bending = (couple1[i] - couple0[i]) * (length[i] * ease[i])
        a = stretched[i] * (length[i] * over_edge[i] - 1.0)
        less = decay[i] * (1.0 - a * (1.0 - a * (0.5 - a * (1.0 / 6.0))))
        omega[i] = (omega[i] + kick * (alpha[i] + bending)) * less


@kernel
def rotate_pass(angle, omega, c, s, step):
    """Turn each element by step times omega."""
    for i in range(angle.shape[0]):
        d = step * omega[i]
        angle[i] += d
        sine, cosine = sine_cosine(d)
        new = c[i] * cosine - s[i] * sine
        s[i] = s[i] * cosine + c[i] * sine
        c[i] = new


@kernel
def aim(angle, c, s):
    """Cosine and sine of each element's angle."""
    for i in range(angle.shape[0]):
        c[i] = np.cos(angle[i])
        s[i] = np.sin(angle[i])


@kernel
def hold(velocities, held):
    """Stop the held nodes."""
    for i in range(held.x.shape[0]):
        velocities.vx[held.x[i]] = 0.0
    for i in range(held.y.shape[0]):
        velocities.vy[held.y[i]] = 0.0


@kernel
def outer_forces(state, forcing, ledger, ramp, u, outer_x, outer_y):
    """Pull, drive, and spring and damper of the crossings, at the nodes that have any."""
    x, y, vx, vy = state.x, state.y, state.vx, state.vy
    joints, stiffness, damping = ledger.joints, ledger.joint_stiffness, ledger.joint_damping
    nodes, pull_x, pull_y = forcing.nodes, forcing.pull_x, forcing.pull_y
    for i in range(forcing.touched.shape[0]):
        m = forcing.touched[i]
        outer_x[m] = ramp * pull_x[m]
        outer_y[m] = ramp * pull_y[m]
    for i in range(nodes.shape[0]):
        m = nodes[i]
        outer_x[m] = ramp * pull_x[m]
        outer_y[m] = ramp * pull_y[m]
    for j in range(joints.shape[0]):
        for k in range(2):
            n = joints[j, k]
            outer_x[n] = ramp * pull_x[n]
            outer_y[n] = ramp * pull_y[n]
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        fx = stiffness[j] * (x[b] - x[a]) + damping[j] * (vx[b] - vx[a])
        fy = stiffness[j] * (y[b] - y[a]) + damping[j] * (vy[b] - vy[a])
        outer_x[a] += fx
        outer_y[a] += fy
        outer_x[b] -= fx
        outer_y[b] -= fy
    for i in range(nodes.shape[0]):
        m = nodes[i]
        outer_x[m] += u * forcing.load_x[i]
        outer_y[m] += u * forcing.load_y[i]


@kernel
def bond_pass(bonds, state, scratch, rods, stride):
    """Add what bonds make of the angular accelerations."""
    torque, alpha = scratch.torque, scratch.acceleration
    if bonds.a.shape[0] > 0:
        torque[:] = 0.0
        turn_bonds(bonds, state.angle, torque, stride)
        for i in range(torque.shape[0]):
            alpha[i] += torque[i] * (scratch.length[i] * rods.ease[i])


@kernel
def strain_energy(x, y, angle, rods, stride):
    """Elastic energy of the fibres (J): the potential of stretch, and of shear and bending to
    leading order in the stretch, whose factors in PyElastica's equations have none."""
    bend, half_over_voronoi, edge, over_edge, axial, _, shear = rods[2:9]
    length = np.sqrt((x[stride:] - x[:-stride]) ** 2 + (y[stride:] - y[:-stride]) ** 2)
    total = 0.0
    for i in range(angle.shape[0]):
        dx, dy = x[i + stride] - x[i], y[i + stride] - y[i]
        c, s = np.cos(angle[i]), np.sin(angle[i])
        along = (dx * c + dy * s) * over_edge[i]
        across = (dy * c - dx * s) * over_edge[i]
        if over_edge[i] > 0.0:
            total += axial[i] * edge[i] * (along - 1.0 - np.log(along))
            total += 0.5 * shear[i] * edge[i] * across * across
        if bend[i] > 0.0:
            e = (length[i - stride] + length[i]) * half_over_voronoi[i]
            total += 0.5 * bend[i] * (angle[i] - angle[i - stride]) ** 2 / (e * e * e)
    return total


@summing
def squared_spin(omega, weight):
    """Sum of weight times omega^2."""
    total = 0.0
    for i in range(omega.shape[0]):
        total += weight[i] * omega[i] * omega[i]
    return total


@summing
def filter_loss(unfiltered, before, filtered, mass):
    """What the filter takes in a step (J): unfiltered and filtered velocities after the kick,
    and those before it."""
    total = 0.0
    for i in range(mass.shape[0]):
        total += 0.5 * mass[i] * (unfiltered[i] - filtered[i]) * (before[i] + filtered[i])
    return total


@kernel
def record_energy(row, state, scratch, rods, spin, ties, forcing, readouts, ledger, stepping, ramp):
    """Fill one row of the energies at a whole step, with the angular accelerations as scratch."""
    vx, vy, omega, half = state.vx, state.vy, state.omega, 0.5 * stepping.step
    x, y, angle = state.x - half * vx, state.y - half * vy, state.angle - half * omega
    kinetic = 0.5 * squared_speed(vx, vy, ledger.mass) + 0.5 * squared_spin(omega, spin.inertia)
    elastic = strain_energy(x, y, angle, rods, stepping.stride) + joint_energy(ledger, x, y)
    elastic += spring_energy(ties.springs, x, y)
    elastic += turn_bonds(ties.bonds, angle, scratch.acceleration, stepping.stride)
    enter_sample(row, ledger, kinetic, elastic, ramp, pull_work(x, y, readouts, forcing))


@kernel
def damper_power(velocities, spin, ledger):
    """Power that all dampers take (W)."""
    vx, vy, omega = velocities
    lost = ledger.damping * squared_speed(vx, vy, ledger.mass)
    for i in range(omega.shape[0]):
        lost += spin.inertia[i] * spin.damping[i] * omega[i] * omega[i]
    return lost + joint_power(ledger, vx, vy)


@kernel
def add_filter_power(lost, before, kicked, state, spin, ledger, step):
    """Add to a power (W) what the filter takes away: of leapfrog's kick, that never became work."""
    lost += filter_loss(kicked.vx, before.vx, state.vx, ledger.mass) / step
    lost += filter_loss(kicked.vy, before.vy, state.vy, ledger.mass) / step
    lost += filter_loss(kicked.omega, before.omega, state.omega, spin.inertia) / step
    return lost


@kernel
def copy_velocities(state, kept):
    """Keep the velocities of this moment."""
    keep(state.vx, state.vy, kept.vx, kept.vy)
    copy(state.omega, kept.omega)


@kernel
def copy(values, kept):
    """Keep values; to assign a slice takes a quarter of the engine's time to compile."""
    for i in range(values.shape[0]):
        kept[i] = values[i]
