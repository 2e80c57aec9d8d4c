"""What the cosserat engine's fibres are to small displacements and turns, and the stiffness that
the step is limited by."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack

from fiberweb.engines.layout import Layout, lay_out
from fiberweb.engines.stability import differences, leapfrog_limit
from fiberweb.engines.ties import turn_stiffness
from fiberweb.model.mesh import Mesh

SHEAR_FACTOR = 27.0 / 28.0  # alpha_c of a round section at Poisson's ratio 1/2, as PyElastica's


def largest_step(mesh: Mesh) -> float:
    """The largest stable step (s); the dampers of crossings are explicit, as PyElastica's."""
    layout = lay_out(mesh)
    return leapfrog_limit(mesh, layout, *stiffness_and_mass(mesh, layout), exact_dampers=False)


def shear_stiffness(mesh: Mesh) -> np.ndarray:
    """alpha_c G A of each fibre (N), with G = E / 3, over the stoutness."""
    return mesh.scene.fibres.axial_stiffness / 3.0 * SHEAR_FACTOR / mesh.stoutness


def rotary_inertia(mesh: Mesh) -> np.ndarray:
    """Of each fibre about its cross-section's diameter, per length (kg m), times the stoutness."""
    return mesh.scene.fibres.rotary_inertia * mesh.stoutness


def stiffness_and_mass(mesh: Mesh, layout: Layout):
    """Stiffness matrix of the straight fibres over displacements and then an angle per element,
    and the masses and moments of inertia."""
    size = len(layout.x)
    solid = np.flatnonzero(layout.solid)
    columns = 2 * size + size - 1
    axial, lateral = differences(layout, columns)
    edge, rows = layout.edge[solid], np.arange(len(solid))
    angle = csr_array((edge, (rows, 2 * size + solid)), shape=(len(solid), columns))
    bent = np.flatnonzero(layout.bends)
    rows = np.tile(np.arange(len(bent)), 2)
    turn = csr_array(
        (np.r_[np.ones(len(bent)), -layout.solid[bent - 1]],  # a wall does not turn
         (rows, np.r_[2 * size + bent, 2 * size + bent - 1])),
        shape=(len(bent), columns),
    )  # fmt: skip
    fibres, of_edge = mesh.scene.fibres, layout.fibre[solid]
    strains = vstack([axial, lateral - angle, turn])
    moduli = np.r_[
        fibres.axial_stiffness[of_edge] / edge, shear_stiffness(mesh)[of_edge] / edge,
        fibres.bending_stiffness[layout.fibre[bent]] / layout.span[bent],
    ]  # fmt: skip
    inertia = rotary_inertia(mesh)[layout.fibre[:-1]] * layout.edge
    stiffness = strains.T @ diags_array(moduli) @ strains
    return stiffness + turn_stiffness(mesh, layout, columns), np.r_[
        np.tile(layout.mass, 2), inertia
    ]
