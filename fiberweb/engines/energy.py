"""The energy ledger of both planar kernels.

Kinetic and elastic energy are taken at samples, work at every step; what is dissipated is
summed from its rate at intervals well below a network's periods.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.engines.jit import kernel, summing
from fiberweb.engines.layout import Interleaving, Layout
from fiberweb.model.mesh import Mesh

# s between two looks at what is dissipated: a fortieth of the period of a pinned 50 mm section
# (10 ms), which leaves residuals below 1e-4 (tests/engines/test_energy.py)
LEDGER_INTERVAL = 0.25e-3
WORK, DISSIPATED = 0, 1  # the entries of a ledger's total


class Ledger(NamedTuple):
    """The sums so far, and what they are taken with."""

    total: np.ndarray  # work done and dissipated so far, (2,), J
    mass: np.ndarray  # (n,), kg
    damping: float  # 1/s
    joints: np.ndarray  # nodes of each that gives, (joints, 2)
    joint_stiffness: np.ndarray  # N/m, (joints,)
    joint_damping: np.ndarray  # N s/m, (joints,)


def build_ledger(
    mesh: Mesh, layout: Layout, interleaving: Interleaving, mass: np.ndarray
) -> Ledger:
    """An empty ledger; the mass of the nodes is in the order of the kernels. What a motor carries
    is the motor's, and has none."""
    mass = mass.copy()
    mass[interleaving.place[layout.at[mesh.moved]]] = 0.0
    # unsigned, since Numba looks for negative indices at every access otherwise
    joints = interleaving.place[layout.joints].astype(np.uint64)
    gives = np.isfinite(mesh.joint_stiffness)  # nodes that are one point neither store nor take
    coupling = mesh.joint_stiffness[gives], mesh.joint_damping[gives]
    return Ledger(np.zeros(2), mass, mesh.scene.damping, joints[gives], *coupling)


@kernel
def enter_sample(row, ledger, kinetic, elastic, ramp, pulled):
    """One row of the energies: kinetic, elastic, work done, dissipated; the pull's work is `ramp`
    times that of the whole pull."""
    row[0] = kinetic
    row[1] = elastic
    row[2] = ledger.total[WORK] + ramp * pulled
    row[3] = ledger.total[DISSIPATED]


@kernel
def enter_ramp(ledger, let_go, pulled):
    """The pull is a potential while it is constant; when it grows, what it holds changes: by
    minus `let_go` times the work of the whole pull."""
    ledger.total[WORK] += let_go * pulled


@kernel
def enter_drive(ledger, forcing, half_impulse, vx, vy):
    """Work of the drive in half a step, half_impulse = h u / 2, at given velocities."""
    nodes, load_x, load_y = forcing.nodes, forcing.load_x, forcing.load_y
    for i in range(nodes.shape[0]):
        m = nodes[i]
        ledger.total[WORK] += half_impulse * (load_x[i] * vx[m] + load_y[i] * vy[m])


@kernel
def enter_work(ledger, work):
    """Work that was done (J)."""
    ledger.total[WORK] += work


@kernel
def enter_dissipation(ledger, span, power):
    """What is dissipated at a rate (W) in a span of time (s)."""
    ledger.total[DISSIPATED] += span * power


@kernel
def enter_lag(row, ledger, step):
    """What an exact damper has taken beyond rate m v^2 at the mean velocity v of every step.

    From kinetic energy K0 to K1 a step dissipates, with `stepping.damped_kick` and work at the mean
    velocity, rate step m v^2 + (x coth x - 1) (K1 - K0), x = rate step / 2.
    """
    x = 0.5 * ledger.damping * step
    if x > 0.0:
        row[3] += (x / np.tanh(x) - 1.0) * row[0]


@kernel
def interval_steps(step):
    """Steps between two looks at what is dissipated: odd, so that one of them is the middle."""
    return 2 * int(0.5 * (LEDGER_INTERVAL / step - 1.0)) + 1


@kernel
def steps_due(taken, every, per_sample):
    """How many steps are to be entered in this one: those of an interval in its middle, else 0.

    `taken` steps lie between it and the sample before.
    """
    begun = taken // every * every
    count = min(every, per_sample - begun)
    return count if taken == begun + count // 2 else 0


@kernel
def pull_work(x, y, readouts, forcing):
    """Work of the whole pull from rest to given positions (J)."""
    return outer_work(x - readouts.rest_x, y - readouts.rest_y, forcing.pull_x, forcing.pull_y)


@kernel
def outer_work(ux, uy, fx, fy):
    """Work of constant forces over displacements (J)."""
    total = 0.0
    for i in range(ux.shape[0]):
        total += fx[i] * ux[i] + fy[i] * uy[i]
    return total


@summing
def squared_speed(vx, vy, mass):
    """Sum of m v^2 over all nodes (J)."""
    total = 0.0
    for i in range(vx.shape[0]):
        total += mass[i] * (vx[i] * vx[i] + vy[i] * vy[i])
    return total


@kernel
def keep(vx, vy, kept_x, kept_y):
    """Copy velocities; a slice of an array would be looked at for overlaps first."""
    for i in range(vx.shape[0]):
        kept_x[i] = vx[i]
        kept_y[i] = vy[i]


@summing
def average(mean_x, mean_y, vx, vy, mass):
    """Make kept velocities the mean of them and of these; sum of m v^2 of the mean (J)."""
    total = 0.0
    for i in range(vx.shape[0]):
        mean_x[i] = 0.5 * (mean_x[i] + vx[i])
        mean_y[i] = 0.5 * (mean_y[i] + vy[i])
        total += mass[i] * (mean_x[i] * mean_x[i] + mean_y[i] * mean_y[i])
    return total


@kernel
def joint_power(ledger, vx, vy):
    """Power that the crossings' dampers take (W)."""
    joints, damping = ledger.joints, ledger.joint_damping
    total = 0.0
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        total += damping[j] * ((vx[b] - vx[a]) ** 2 + (vy[b] - vy[a]) ** 2)
    return total


@kernel
def joint_energy(ledger, x, y):
    """Energy of the crossings' springs (J)."""
    joints, stiffness = ledger.joints, ledger.joint_stiffness
    total = 0.0
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        total += 0.5 * stiffness[j] * ((x[b] - x[a]) ** 2 + (y[b] - y[a]) ** 2)
    return total
