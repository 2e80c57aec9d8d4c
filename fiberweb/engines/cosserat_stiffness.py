"""What the cosserat engine's fibres are to small displacements and turns, and the stiffness that
the step is limited by."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, diags_array, vstack

from fiberweb.engines.layout import Layout, lay_out
from fiberweb.engines.stability import differences, leapfrog_limit
from fiberweb.model.mesh import Mesh

SHEAR_FACTOR = 27.0 / 28.0  # alpha_c of a round section at Poisson's ratio 1/2, as PyElastica's


def largest_step(mesh: Mesh) -> float:
    """The largest stable step (s); the dampers of crossings are explicit, as PyElastica's."""
    layout = lay_out(mesh)
    return leapfrog_limit(mesh, layout, *stiffness_and_mass(mesh, layout), exact_dampers=False)


def shear_stiffness(mesh: Mesh) -> float:
    """alpha_c G A (N), with G = E / 3, over the stoutness."""
    return mesh.scene.axial_stiffness / 3.0 * SHEAR_FACTOR / mesh.stoutness


def rotary_inertia(mesh: Mesh) -> float:
    """Of a fibre about its cross-section's diameter, per length (kg m): density times
    `fiberweb.model.buckling.second_moment`, multiplied in the order that keeps earlier runs'
    last bits, times the stoutness."""
    scene = mesh.scene
    return scene.density * np.pi * scene.diameter**4 / 64 * mesh.stoutness


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
    scene = mesh.scene
    strains = vstack([axial, lateral - angle, turn])
    moduli = np.r_[
        scene.axial_stiffness / edge, shear_stiffness(mesh) / edge,
        scene.bending_stiffness / layout.span[bent],
    ]  # fmt: skip
    inertia = rotary_inertia(mesh) * layout.edge
    return strains.T @ diags_array(moduli) @ strains, np.r_[np.tile(layout.mass, 2), inertia]
