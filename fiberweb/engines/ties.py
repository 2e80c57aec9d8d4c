"""What holds a network beside its fibres and the springs of its crossings: springs at the ends,
bonds that keep the angle of fibres where they cross, and the motor that carries a point.

A bond is a spring between the directions of two fibres at their crossing. Without elements that
turn by themselves, a fibre's direction there is that of the chord between the two nodes beside the
crossing. Of turning elements it is bonded twice, half as stiff: the two before the crossing, and
the two behind it (PyElastica's `FixedJoint` does one). Either spreads the bond's couple over two
elements, within which the fibre then bends less than under a couple at a point: by `SPREAD` l / EI
of compliance, which the spring is given back. What is left is second order in the element length l,
and a rigid bond is a spring of that compliance alone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.sparse import csr_array, diags_array

from fiberweb.engines.jit import kernel, summing
from fiberweb.engines.layout import Interleaving, Layout, packed
from fiberweb.engines.stepping import drive_value
from fiberweb.model.mesh import Mesh

# The bending energy that a couple M has in two elements is (M / 2)^2 l / EI at a point. Spread as
# two forces it is a third of that (moments of a cubic spline), or nothing (those of a chain, at
# nodes), of which a compliance of 1/3 or 1/4 l / EI is missing.
SPREAD = {"spline": 1 / 3, "chain": 1 / 4}


class Springs(NamedTuple):
    """Nodes on springs to where they rest, each (sprung,)."""

    nodes: np.ndarray
    rest_x: np.ndarray  # m
    rest_y: np.ndarray
    root_x: np.ndarray  # direction times the root of the stiffness, (N/m)^(1/2)
    root_y: np.ndarray


class Bonds(NamedTuple):
    """Crossings whose angle is kept, each (bonds,)."""

    a: np.ndarray  # nodes
    b: np.ndarray
    stiffness: np.ndarray  # N m
    rest: np.ndarray  # angle from a's fibre to b's
    rest_cosine: np.ndarray
    rest_sine: np.ndarray
    chord_ax: np.ndarray  # across a, m, and then the force on its ends, N
    chord_ay: np.ndarray
    chord_bx: np.ndarray  # across b
    chord_by: np.ndarray


class Motor(NamedTuple):
    """Nodes whose motion is given, each (moved,)."""

    nodes: np.ndarray
    rest_x: np.ndarray  # m
    rest_y: np.ndarray
    path_x: np.ndarray  # displacement for u = 1, m
    path_y: np.ndarray


class Ties(NamedTuple):
    """All of them."""

    springs: Springs
    bonds: Bonds
    motor: Motor
    merged: bool  # whether nodes that meet at crossings are one point


def build_ties(mesh: Mesh, layout: Layout, interleaving: Interleaving, moments: str) -> Ties:
    """The ties in the order of the kernels; moments: "spline" or "chain", see `SPREAD`."""

    def place(nodes):
        # unsigned, since Numba looks for negative indices at every access otherwise
        return interleaving.place[layout.at[nodes]].astype(np.uint64)

    def columns(rows):
        return np.ascontiguousarray(rows.T)

    bonded = mesh.bond_stiffness > 0.0
    a, b = mesh.joints[bonded].T
    angle = np.repeat(angles(mesh), np.diff(mesh.first))
    rest = angle[b] - angle[a]
    turned = rest, np.cos(rest), np.sin(rest)
    return Ties(
        Springs(place(mesh.sprung), *columns(mesh.position[mesh.sprung]), *columns(mesh.springs)),
        Bonds(place(a), place(b), bonds(mesh, moments), *turned, *packed(*np.zeros((4, len(a))))),
        Motor(place(mesh.moved), *columns(mesh.position[mesh.moved]), *columns(mesh.path)),
        bool(np.isinf(mesh.joint_stiffness).any()),
    )


def bonds(mesh: Mesh, moments: str) -> np.ndarray:
    """Stiffness of the springs at the joints that have a bond, shape (bonds,), N m."""
    bonded = mesh.bond_stiffness > 0.0
    fibre = np.repeat(np.arange(len(mesh.first) - 1), np.diff(mesh.first))
    missing = np.zeros(bonded.sum())
    for nodes in mesh.joints[bonded].T:
        beside = mesh.position[nodes + 1] - mesh.position[nodes - 1]
        element = 0.5 * np.linalg.norm(beside, axis=1)
        missing += SPREAD[moments] * element / mesh.scene.fibres.bending_stiffness[fibre[nodes]]
    return 1.0 / (1.0 / mesh.bond_stiffness[bonded] + missing)


def angles(mesh: Mesh) -> np.ndarray:
    """Direction of each fibre at rest, shape (fibres,), rad; along -x it is pi, never -pi."""
    along = mesh.position[mesh.first[1:] - 1] - mesh.position[mesh.first[:-1]]
    angle = np.arctan2(along[:, 1], along[:, 0])
    return np.where(angle < -np.pi + 1e-6, angle + 2 * np.pi, angle)


def touched(ties: Ties, stride: int) -> np.ndarray:
    """Nodes on which springs, or bonds between chords, exert forces."""
    shift = np.uint64(stride)
    beside = [side for at in (ties.bonds.a, ties.bonds.b) for side in (at - shift, at + shift)]
    return np.unique(np.concatenate([ties.springs.nodes, *beside]))


def stiffness(mesh: Mesh, layout: Layout, lateral: csr_array) -> csr_array:
    """Stiffness matrix of springs, and of bonds between chords.

    lateral: lateral displacement differences of the elements, see `stability.differences`.
    """
    columns = lateral.shape[1]
    number = np.cumsum(layout.solid).astype(int) - 1  # of an element by its padded edge
    a, b = layout.joints[mesh.bond_stiffness > 0.0].T

    def turn(nodes):
        chords = layout.edge[nodes - 1] + layout.edge[nodes]
        both = lateral[number[nodes - 1]] + lateral[number[nodes]]
        return diags_array(1.0 / chords) @ both

    bonded = _squared(turn(b) - turn(a), bonds(mesh, "spline"))
    return springs_stiffness(mesh, layout, columns) + bonded


def springs_stiffness(mesh: Mesh, layout: Layout, columns: int) -> csr_array:
    """Stiffness matrix of springs at ends over x of all nodes, y of all nodes, and what follows."""
    at, size = layout.at[mesh.sprung], len(layout.x)
    root = mesh.springs.T.ravel() * np.r_[layout.free_x[at], layout.free_y[at]]
    rows = np.tile(np.arange(len(at)), 2)
    roots = csr_array((root, (rows, np.r_[at, at + size])), shape=(len(at), columns))
    return csr_array(roots.T @ roots)


def turn_stiffness(mesh: Mesh, layout: Layout, columns: int) -> csr_array:
    """Stiffness matrix of springs, and of bonds between elements, whose angles follow x and y."""
    a, b = layout.joints[mesh.bond_stiffness > 0.0].T
    rows, first = np.arange(len(a)), 2 * len(layout.x)
    total = springs_stiffness(mesh, layout, columns)
    for back in (0, 1):
        at = first + np.r_[b - back, a - back]
        sign = np.repeat([1.0, -1.0], len(a))
        relative = csr_array((sign, (np.tile(rows, 2), at)), shape=(len(a), columns))
        total = total + 0.5 * _squared(relative, bonds(mesh, "chain"))
    return csr_array(total)


def _squared(relative: csr_array, stiffness: np.ndarray) -> csr_array:
    """Stiffness matrix of springs from what they are stretched by."""
    return csr_array(relative.T @ diags_array(stiffness) @ relative)


@kernel
def spring_forces(springs, x, y, outer_x, outer_y):
    """Add what the springs exert."""
    for i in range(springs.nodes.shape[0]):
        n = springs.nodes[i]
        px, py = springs.root_x[i], springs.root_y[i]
        along = px * (x[n] - springs.rest_x[i]) + py * (y[n] - springs.rest_y[i])
        outer_x[n] -= px * along
        outer_y[n] -= py * along


@kernel
def chord_bonds(bonds, x, y, outer_x, outer_y, stride):
    """Add what bonds exert on the nodes beside crossings, and return their energy (J).

    In three loops, of which the second, all arithmetic, runs on four bonds at once.
    """
    side = np.uint64(stride)
    for i in range(bonds.a.shape[0]):
        a, b = bonds.a[i], bonds.b[i]
        bonds.chord_ax[i], bonds.chord_ay[i] = x[a + side] - x[a - side], y[a + side] - y[a - side]
        bonds.chord_bx[i], bonds.chord_by[i] = x[b + side] - x[b - side], y[b + side] - y[b - side]
    energy = chord_forces(*bonds[2:])
    for i in range(bonds.a.shape[0]):
        a, b = bonds.a[i], bonds.b[i]
        outer_x[a + side] += bonds.chord_ax[i]
        outer_y[a + side] += bonds.chord_ay[i]
        outer_x[a - side] -= bonds.chord_ax[i]
        outer_y[a - side] -= bonds.chord_ay[i]
        outer_x[b + side] += bonds.chord_bx[i]
        outer_y[b + side] += bonds.chord_by[i]
        outer_x[b - side] -= bonds.chord_bx[i]
        outer_y[b - side] -= bonds.chord_by[i]
    return energy


@summing
def chord_forces(stiffness, _, rest_cosine, rest_sine, chord_ax, chord_ay, chord_bx, chord_by):
    """Make of chords the forces on their far ends, and return the energy (J).

    The moment grows with f(phi) of the kirchhoff engine in place of the angle phi.
    """
    energy = 0.0
    for i in range(stiffness.shape[0]):
        ax, ay, bx, by = chord_ax[i], chord_ay[i], chord_bx[i], chord_by[i]
        squared_a, squared_b = ax * ax + ay * ay, bx * bx + by * by
        over_both = 1.0 / (squared_a * squared_b)
        r = np.sqrt(over_both)
        cosine, sine = (ax * bx + ay * by) * r, (ax * by - ay * bx) * r
        c = cosine * rest_cosine[i] + sine * rest_sine[i]
        s = sine * rest_cosine[i] - cosine * rest_sine[i]
        w = 1.0 - c
        f = s * (1.0 + w * (1.0 / 3.0) + w * w * (2.0 / 15.0))
        slope = c * (1.0 + w * (1.0 / 3.0) + w * w * (2.0 / 15.0))
        slope += s * s * (1.0 / 3.0 + w * (4.0 / 15.0))
        energy += 0.5 * stiffness[i] * f * f
        moment = stiffness[i] * f * slope
        over_a, over_b = moment * squared_b * over_both, moment * squared_a * over_both
        chord_ax[i], chord_ay[i] = -over_a * ay, over_a * ax
        chord_bx[i], chord_by[i] = over_b * by, -over_b * bx
    return energy


@kernel
def turn_bonds(bonds, angle, torque, stride):
    """Add to the torques of elements what bonds exert, and return their energy (J)."""
    energy = 0.0
    for i in range(bonds.a.shape[0]):
        for back in range(2):
            side = np.uint64(back) * np.uint64(stride)
            a, b = bonds.a[i] - side, bonds.b[i] - side
            off = angle[b] - angle[a] - bonds.rest[i]
            moment = 0.5 * bonds.stiffness[i] * off
            energy += 0.5 * moment * off
            torque[a] += moment
            torque[b] -= moment
    return energy


@kernel
def spring_energy(springs, x, y):
    """Energy of the springs (J)."""
    total = 0.0
    for i in range(springs.nodes.shape[0]):
        n = springs.nodes[i]
        along = springs.root_x[i] * (x[n] - springs.rest_x[i])
        along += springs.root_y[i] * (y[n] - springs.rest_y[i])
        total += 0.5 * along * along
    return total


@kernel
def carry(motor, x, y, vx, vy, following, step):
    """Velocities by which the nodes whose motion is given are in a step where u has them then."""
    for i in range(motor.nodes.shape[0]):
        n = motor.nodes[i]
        vx[n] = (motor.rest_x[i] + motor.path_x[i] * following - x[n]) / step
        vy[n] = (motor.rest_y[i] + motor.path_y[i] * following - y[n]) / step


@kernel
def motor_work(motor, force_x, force_y, outer_x, outer_y, grown, stride):
    """Work (J) of the motor against the forces of the edges and the outer ones beside them, while
    u grows by so much."""
    total, side = 0.0, np.uint64(stride)
    for i in range(motor.nodes.shape[0]):
        n = motor.nodes[i]
        total -= motor.path_x[i] * (force_x[n] - force_x[n - side] + outer_x[n])
        total -= motor.path_y[i] * (force_y[n] - force_y[n - side] + outer_y[n])
    return total * grown


@kernel
def grown(forcing, steps, step):
    """By how much u grew over the positions' step before so many whole ones; 0 at the start."""
    if steps == 0:
        return 0.0
    before = drive_value(forcing.drive, forcing.drive_rate, (steps - 0.5) * step)
    return drive_value(forcing.drive, forcing.drive_rate, (steps + 0.5) * step) - before
