"""The largest stable step of leapfrog on a mesh, from the linearised straight network.

Leapfrog is stable while h^2 K + 2 h C <= 4 M, with K the stiffness, M the lumped mass and C
the dampers that are taken with the velocity of half a step ago. Dampers that are stepped
exactly set no limit. Reference: Hairer, Lubich and Wanner, Geometric Numerical Integration
(2006), I.5, extended by the dampers: at the limit the mode of alternating sign, v' = -v, is
neither damped nor amplified.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import csr_array, diags_array, eye_array
from scipy.sparse.linalg import eigsh

from fiberweb.engines.crossings import joint_groups
from fiberweb.engines.layout import Layout
from fiberweb.model.mesh import Mesh

EIGENVALUE = 1e-4  # relative tolerance of the largest; it is found from below
CAUTION = 1.0 - 3e-4  # of the limit, for the eigenvalue's error and that of `STEP`
STEP = 1e-3  # relative tolerance of a limit that dampers shift: automatic steps stay 0.1 below it
# A limit this close to that of the fibres alone is not the springs' of the crossings, and so no
# damper could lift it.
UNTIED = 0.98
BEYOND = 1.1  # of the fibres' own limit, which heavier crossings can lift a little
AT_REST = 1e-9  # a damper's z below which its block is 1 to round-off


def leapfrog_limit(
    mesh: Mesh, layout: Layout, stiffness: csr_array, mass: np.ndarray, exact_dampers: bool
) -> float:
    """The largest stable step (s) without the Laplace filter.

    Args:
        mesh: for its crossings.
        layout: of the mesh.
        stiffness: of the fibres, over x of all nodes, then y, then what else moves.
        mass: of the same.
        exact_dampers: whether the crossings' are stepped exactly, or explicitly.
    """
    root = diags_array(1.0 / np.sqrt(mass))
    finite = np.isfinite(mesh.joint_stiffness)
    gaps = _joint_gaps(layout, finite, len(mass))

    def scaled(matrix):
        return csr_array(root @ matrix @ root)

    def between_joints(values):
        return scaled(gaps.T @ diags_array(np.repeat(values[finite], 2)) @ gaps)

    fibres = scaled(stiffness)
    whole = fibres + between_joints(mesh.joint_stiffness)
    highest = 2.0 / np.sqrt(_largest(whole))
    if not mesh.joint_damping[finite].any():
        return CAUTION * highest
    if not exact_dampers:
        damper = between_joints(mesh.joint_damping)
        return CAUTION * _crossing(
            lambda h: _largest(h * h * whole + 2 * h * damper) - 4.0, 1e-3 * highest, highest
        )
    loose = 2.0 / np.sqrt(_largest(fibres))
    if highest > UNTIED * loose:
        return CAUTION * highest
    return CAUTION * _crossing(
        lambda h: _largest(h * h * whole - 4.0 * _damped_mass(mesh, layout, h)),
        highest,
        BEYOND * loose,
    )


def _crossing(excess, low: float, high: float) -> float:
    """The step between two at which `excess` turns positive; an end if it does not."""
    if excess(low) > 0.0:
        return low
    return high if excess(high) < 0.0 else brentq(excess, low, high, rtol=STEP)


def _damped_mass(mesh: Mesh, layout: Layout, step: float) -> csr_array:
    """What the mass matrix, scaled to 1, becomes for a mode of alternating sign under dampers
    that are stepped exactly: (z / 2) coth(z / 2) with z = h M^-1 N at crossings."""
    size = len(layout.x)
    matrix = eye_array(2 * size, format="lil")
    for nodes, _, damper in joint_groups(mesh, layout):
        over_root = 1.0 / np.sqrt(layout.mass[nodes])
        z, modes = np.linalg.eigh(step * damper * np.outer(over_root, over_root))
        half = 0.5 * np.maximum(z, AT_REST)
        block = (modes * (half / np.tanh(half))) @ modes.T
        for offset in (0, size):
            at = offset + np.array(nodes)
            matrix[np.ix_(at, at)] = block
    return csr_array(matrix)


def _largest(matrix) -> float:
    """Largest eigenvalue of a symmetric matrix: many equal fibres crowd its end."""
    start = np.random.RandomState(0).standard_normal(matrix.shape[0])
    highest = eigsh(matrix, k=1, which="LA", v0=start, tol=EIGENVALUE, return_eigenvectors=False)
    return float(highest[0])


def _directions(layout: Layout):
    """Elements (padded edge indices) with the cosine and sine of their direction."""
    solid = np.flatnonzero(layout.solid)
    dx, dy = np.diff(layout.x)[solid], np.diff(layout.y)[solid]
    length = np.hypot(dx, dy)
    return solid, dx / length, dy / length


def differences(layout: Layout, columns: int):
    """Axial and lateral displacement differences of the elements, two (elements, dofs)
    matrices; degrees of freedom are x of all nodes, then y of all nodes."""
    solid, c, s = _directions(layout)
    size, rows = len(layout.x), np.arange(len(solid))
    free = np.r_[layout.free_x, layout.free_y]

    def matrix(wx, wy):
        column = np.r_[solid + 1, solid, solid + 1 + size, solid + size]
        value = np.r_[wx, -wx, wy, -wy] * free[column]
        return csr_array((value, (np.tile(rows, 4), column)), shape=(len(solid), columns))

    return matrix(c, s), matrix(-s, c)


def _joint_gaps(layout: Layout, finite: np.ndarray, columns: int) -> csr_array:
    """x and y distance of each joint's nodes as a matrix over displacements."""
    joints = layout.joints[finite]
    size, count = len(layout.x), len(joints)
    free = np.r_[layout.free_x, layout.free_y]
    rows = np.arange(2 * count).reshape(count, 2)
    column = np.concatenate([joints[:, 1], joints[:, 0], joints[:, 1] + size, joints[:, 0] + size])
    row = np.concatenate([rows[:, 0], rows[:, 0], rows[:, 1], rows[:, 1]])
    sign = np.tile(np.repeat([1.0, -1.0], count), 2)
    return csr_array((sign * free[column], (row, column)), shape=(2 * count, columns))
