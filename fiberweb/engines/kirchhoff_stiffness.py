"""What the kirchhoff engine's fibres are to small displacements: masses, the spline's energy, and
the stiffness that the step is limited by."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array, diags_array

from fiberweb.engines import ties
from fiberweb.engines.layout import Layout, lay_out
from fiberweb.engines.stability import differences, leapfrog_limit
from fiberweb.model.mesh import Mesh

GAP = 2  # ghosts between fibres: the moment reaches two nodes beyond its own


def largest_step(mesh: Mesh) -> float:
    """The largest stable step (s); the engine's dampers are exact and set no limit."""
    layout = fourth_order_layout(mesh)
    return leapfrog_limit(mesh, layout, *stiffness_and_mass(mesh, layout), exact_dampers=True)


def fourth_order_layout(mesh: Mesh) -> Layout:
    """The layout with mass lumped to fourth order at free ends.

    Halves at the ends of a fibre are a trapezoid rule. Its error is second order where the
    motion has a slope, at a free end; Gregory's weights of the last three nodes remove it.
    """
    layout = lay_out(mesh, GAP)
    mass = layout.mass.copy()
    for fibre, last in enumerate(layout.at[mesh.first[1:] - 1]):
        edges = mesh.edges(fibre)
        even = len(edges) > 3 and np.allclose(edges[-3:], edges[-1], rtol=1e-6)
        end = mesh.first[fibre + 1] - 1
        if even and not mesh.held[end].any() and end not in mesh.guided:
            element = mesh.scene.fibres.line_density[fibre] * edges[-1]
            mass[last - 2 : last + 1] += element * np.array([-1 / 24, 1 / 6, -1 / 8])
    return replace(layout, mass=mass)


def spline_matrix(layout: Layout) -> csr_array:
    """What the spline's energy adds to the lumped one as a quadratic form in curvatures, X +
    X S^-1 X, shape (n, n), m."""
    length = layout.edge * layout.solid
    beside = np.r_[0.0, length] + np.r_[length, 0.0]
    both = layout.bends[1:] * layout.bends[:-1]
    excess = layout.bends * (layout.span - beside / 3.0)
    x = csr_array(
        diags_array([excess, -both * length / 6.0, -both * length / 6.0], offsets=[0, 1, -1])
    )
    matrix = (x + x @ diags_array(1.0 / layout.span) @ x).tolil()
    # At a wall the expansion does not converge with the mesh; this makes statics exact there.
    wall = np.outer([3.0, -4.0, 1.0], [3.0, -4.0, 1.0]) / 108.0
    clamps = np.flatnonzero((layout.bends[1:-1] > 0) & (layout.solid[:-1] == 0)) + 1
    for i in clamps:
        if layout.bends[i : i + 3].all() and np.allclose(length[i : i + 3], length[i], rtol=1e-6):
            matrix[i : i + 3, i : i + 3] += length[i] * wall
    return csr_array(matrix)


def stiffness_and_mass(mesh: Mesh, layout: Layout):
    """Stiffness matrix of the straight fibres over displacements, and the masses."""
    size = len(layout.x)
    solid = np.flatnonzero(layout.solid)
    axial, lateral = differences(layout, 2 * size)
    slope = _rows(diags_array(1.0 / layout.edge[solid]) @ lateral, solid, size - 1)
    after = _rows(slope, np.arange(size - 1), size)
    before = _rows(slope, np.arange(1, size), size)
    curvature = diags_array(layout.bends / layout.span) @ (after - before)
    spline = diags_array(layout.span * layout.bends) + spline_matrix(layout)
    fibres, of_node = mesh.scene.fibres, layout.fibre
    stretching = fibres.axial_stiffness[of_node[solid]] / layout.edge[solid]
    bending = diags_array(fibres.bending_stiffness[of_node]) @ spline
    stiffness = axial.T @ diags_array(stretching) @ axial + curvature.T @ bending @ curvature
    return stiffness + ties.stiffness(mesh, layout, lateral), np.tile(layout.mass, 2)


def _rows(matrix, at: np.ndarray, rows: int) -> csr_array:
    """The rows of a matrix put at given places of one with more rows."""
    place = csr_array((np.ones(len(at)), (at, np.arange(len(at)))), shape=(rows, len(at)))
    return csr_array(place @ matrix)
