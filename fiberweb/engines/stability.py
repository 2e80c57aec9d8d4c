"""The largest stable step of an engine on a mesh, from the linearised straight network.

Leapfrog is stable while h^2 K + 2 h C <= 4 M, with K the stiffness, M the lumped mass and C
the dampers that are taken with the velocity of half a step ago (PyElastica's joints do; the
kirchhoff engine's dampers are exact and set no limit). Reference: Hairer, Lubich and Wanner,
Geometric Numerical Integration (2006), I.5, extended by the dampers: at the limit the mode of
alternating sign, v' = -v, is neither damped nor amplified.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import csr_array, diags_array, eye_array, vstack
from scipy.sparse.linalg import eigsh

from fiberweb.engines.cosserat import SHEAR_FACTOR
from fiberweb.engines.crossings import joint_groups
from fiberweb.engines.kirchhoff import fourth_order_layout, spline_matrix
from fiberweb.engines.layout import Layout, lay_out
from fiberweb.model.mesh import Mesh

CAUTION = 1.0 - 3e-4  # the eigenvalue is found to 1e-4, from below


def largest_step(mesh: Mesh, engine: str) -> float:
    """The largest stable step (s) of "kirchhoff", "cosserat" or "elastica" on a mesh, without
    the Laplace filter (which lets larger steps through by wiping out the modes they excite)."""
    kirchhoff = engine == "kirchhoff"
    layout = fourth_order_layout(mesh) if kirchhoff else lay_out(mesh)
    stiffness, mass = (_kirchhoff if kirchhoff else _cosserat)(mesh, layout)
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
    if not kirchhoff:
        damper = between_joints(mesh.joint_damping)
        return CAUTION * _crossing(
            lambda h: _largest(h * h * whole + 2 * h * damper) - 4.0, 1e-3 * highest, highest
        )
    loose = 2.0 / np.sqrt(_largest(fibres))
    if highest > 0.98 * loose:  # springs that set no limit are none the dampers could lift
        return CAUTION * highest
    return CAUTION * _crossing(
        lambda h: _largest(h * h * whole - 4.0 * _damped_mass(mesh, layout, h)),
        highest,
        1.1 * loose,
    )


def _crossing(excess, low: float, high: float) -> float:
    """The step between two at which `excess` turns positive; an end if it does not."""
    if excess(low) > 0.0:
        return low
    return high if excess(high) < 0.0 else brentq(excess, low, high, rtol=1e-3)


def _damped_mass(mesh: Mesh, layout: Layout, step: float) -> csr_array:
    """What the mass matrix, scaled to 1, becomes for a mode of alternating sign under dampers
    that are stepped exactly: (z / 2) coth(z / 2) with z = h M^-1 N at crossings."""
    size = len(layout.x)
    matrix = eye_array(2 * size, format="lil")
    for nodes, _, damper in joint_groups(mesh, layout):
        over_root = 1.0 / np.sqrt(layout.mass[nodes])
        z, modes = np.linalg.eigh(step * damper * np.outer(over_root, over_root))
        half = 0.5 * np.maximum(z, 1e-9)
        block = (modes * (half / np.tanh(half))) @ modes.T
        for offset in (0, size):
            at = offset + np.array(nodes)
            matrix[np.ix_(at, at)] = block
    return csr_array(matrix)


def _largest(matrix) -> float:
    """Largest eigenvalue of a symmetric matrix, to 1e-4: many equal fibres crowd its end."""
    start = np.random.RandomState(0).standard_normal(matrix.shape[0])
    return float(eigsh(matrix, k=1, which="LA", v0=start, tol=1e-4, return_eigenvectors=False)[0])


def _directions(layout: Layout):
    """Elements (padded edge indices) with the cosine and sine of their direction."""
    solid = np.flatnonzero(layout.solid)
    dx, dy = np.diff(layout.x)[solid], np.diff(layout.y)[solid]
    length = np.hypot(dx, dy)
    return solid, dx / length, dy / length


def _differences(layout: Layout, columns: int):
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


def _kirchhoff(mesh: Mesh, layout: Layout):
    """Stiffness matrix over displacements, and the masses."""
    size = len(layout.x)
    solid = np.flatnonzero(layout.solid)
    axial, lateral = _differences(layout, 2 * size)
    slope = _rows(diags_array(1.0 / layout.edge[solid]) @ lateral, solid, size - 1)
    after = _rows(slope, np.arange(size - 1), size)
    before = _rows(slope, np.arange(1, size), size)
    curvature = diags_array(layout.bends / layout.span) @ (after - before)
    spline = diags_array(layout.span * layout.bends) + spline_matrix(layout)
    scene = mesh.scene
    stretching = axial.T @ diags_array(scene.axial_stiffness / layout.edge[solid]) @ axial
    bending = scene.bending_stiffness * (curvature.T @ spline @ curvature)
    return stretching + bending, np.tile(layout.mass, 2)


def _rows(matrix, at: np.ndarray, rows: int) -> csr_array:
    """The rows of a matrix put at given places of one with more rows."""
    place = csr_array((np.ones(len(at)), (at, np.arange(len(at)))), shape=(rows, len(at)))
    return csr_array(place @ matrix)


def _cosserat(mesh: Mesh, layout: Layout):
    """The same with an angle per element after the displacements."""
    size = len(layout.x)
    solid = np.flatnonzero(layout.solid)
    columns = 2 * size + size - 1
    axial, lateral = _differences(layout, columns)
    edge, rows = layout.edge[solid], np.arange(len(solid))
    angle = csr_array((edge, (rows, 2 * size + solid)), shape=(len(solid), columns))
    bent = np.flatnonzero(layout.bends)
    rows = np.tile(np.arange(len(bent)), 2)
    turn = csr_array(
        (np.r_[np.ones(len(bent)), -layout.solid[bent - 1]],  # a wall does not turn
         (rows, np.r_[2 * size + bent, 2 * size + bent - 1])),
        shape=(len(bent), columns),
    )  # fmt: skip
    scene = mesh.scene
    shear = scene.axial_stiffness / 3.0 * SHEAR_FACTOR
    strains = vstack([axial, lateral - angle, turn])
    moduli = np.r_[
        scene.axial_stiffness / edge, shear / edge, scene.bending_stiffness / layout.span[bent]
    ]
    inertia = scene.density * np.pi * scene.diameter**4 / 64 * layout.edge
    return strains.T @ diags_array(moduli) @ strains, np.r_[np.tile(layout.mass, 2), inertia]


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
