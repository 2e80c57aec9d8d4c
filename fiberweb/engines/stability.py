"""The largest stable step of an engine on a mesh, from the linearised straight network.

Leapfrog is stable while h^2 K + 2 h C <= 4 M, with K the stiffness, M the lumped mass and C
the dampers that are taken with the velocity of half a step ago (PyElastica's joints do; the
kirchhoff engine's dampers are exact and set no limit). Reference: Hairer, Lubich and Wanner,
Geometric Numerical Integration (2006), I.5, extended by the lagged damper: at the limit the
mode of alternating sign, v' = -v, is neither damped nor amplified.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.sparse import csr_array, diags_array, vstack
from scipy.sparse.linalg import eigsh

from fiberweb.engines.cosserat import SHEAR_FACTOR
from fiberweb.engines.layout import Layout, lay_out
from fiberweb.mesh import Mesh


def largest_step(mesh: Mesh, engine: str) -> float:
    """The largest stable step (s) of "kirchhoff", "cosserat" or "elastica" on a mesh, without
    the Laplace filter (which lets larger steps through by wiping out the modes they excite)."""
    layout = lay_out(mesh)
    planar_cosserat = engine != "kirchhoff"
    strains, stiffness, mass = (_cosserat if planar_cosserat else _kirchhoff)(mesh, layout)
    finite = np.isfinite(mesh.joint_stiffness)
    gaps = _joint_gaps(layout, finite, strains.shape[1])
    spring = np.repeat(mesh.joint_stiffness[finite], 2)
    root = diags_array(1.0 / np.sqrt(mass))
    elastic = _scaled(vstack([strains, gaps]), np.r_[stiffness, spring], root)
    if not (planar_cosserat and mesh.joint_damping.any()):
        return 2.0 / np.sqrt(_largest(elastic))
    damper = _scaled(gaps, np.repeat(mesh.joint_damping[finite], 2), root)
    highest = 2.0 / np.sqrt(_largest(elastic))
    return brentq(
        lambda h: _largest(vstack([h * elastic, np.sqrt(2 * h) * damper])) - 4.0,
        1e-3 * highest, highest, rtol=1e-4,
    )  # fmt: skip


def _scaled(rows, weights, root) -> csr_array:
    """A with A^T A = M^-1/2 (rows^T weights rows) M^-1/2."""
    return csr_array(diags_array(np.sqrt(weights)) @ rows @ root)


def _largest(half) -> float:
    """Largest eigenvalue of half^T half."""
    product = half.T @ half
    start = np.random.RandomState(0).standard_normal(product.shape[0])
    return float(eigsh(product, k=1, which="LA", v0=start, return_eigenvectors=False)[0])


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
    """Strains as a matrix over displacements, their stiffness, and the masses."""
    size = len(layout.x)
    solid = np.flatnonzero(layout.solid)
    axial, lateral = _differences(layout, 2 * size)
    number = np.full(size, -1)  # element that starts at a node
    number[solid] = np.arange(len(solid))
    bent = np.flatnonzero(layout.bend)
    after, before = number[bent], number[bent - 1]
    slope = csr_array(diags_array(1.0 / layout.edge[solid]) @ lateral)
    turn = slope[after] - csr_array(diags_array((before >= 0).astype(float)) @ slope[before])
    stiffness = np.r_[mesh.scene.axial_stiffness / layout.edge[solid], layout.bend[bent]]
    return vstack([axial, turn]), stiffness, np.tile(layout.mass, 2)


def _cosserat(mesh: Mesh, layout: Layout):
    """The same with an angle per element after the displacements."""
    size = len(layout.x)
    solid = np.flatnonzero(layout.solid)
    columns = 2 * size + size - 1
    axial, lateral = _differences(layout, columns)
    edge = layout.edge[solid]
    rows = np.arange(len(solid))
    angle = csr_array((edge, (rows, 2 * size + solid)), shape=(len(solid), columns))
    bent = np.flatnonzero(layout.bend)
    inside = layout.solid[bent - 1]
    rows = np.arange(len(bent))
    turn = csr_array(
        (np.r_[np.ones(len(bent)), -inside],
         (np.tile(rows, 2), np.r_[2 * size + bent, 2 * size + bent - 1])),
        shape=(len(bent), columns),
    )  # fmt: skip
    scene = mesh.scene
    shear = scene.axial_stiffness / 3.0 * SHEAR_FACTOR
    stiffness = np.r_[scene.axial_stiffness / edge, shear / edge, layout.bend[bent]]
    inertia = scene.density * np.pi * scene.diameter**4 / 64 * layout.edge
    return (
        vstack([axial, lateral - angle, turn]), stiffness,
        np.r_[np.tile(layout.mass, 2), inertia],
    )  # fmt: skip


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
