"""The mesh as the planar kernels see it: one long chain of nodes, with gaps.

Ghost nodes stand before each fibre and after the last, so that one loop runs over
everything: the edges next to a ghost have no stiffness and ghosts do not move. The ghost
next to a fibre lies one element behind its near end, so that a clamp is an ordinary bending
node: the moment there grows with the angle between ghost edge and first edge over half an
element, which is the half cell that a curvature at the wall spans. Second order, where
holding the first element's direction is first order (it shortens the fibre by half an
element).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fiberweb.mesh import Mesh


@dataclass(frozen=True)
class Layout:
    """Arrays over the padded chain of n nodes and n - 1 edges.

    Attributes:
        at: padded index of each node of the mesh, shape (nodes of the mesh,).
        x, y: rest positions, shape (n,), m.
        edge: rest length of edges, shape (n - 1,), m; any positive number at gaps.
        solid: 1 on elements and 0 on gaps, shape (n - 1,).
        bends: 1 where a moment is carried and 0 where not, shape (n,).
        span: rest length that a node's curvature spans, shape (n,), m: half of either element
            beside it, of the one inside at a clamp; 1 where no moment is carried.
        voronoi: half the sum of the neighbouring elements' rest lengths, shape (n,), m.
        mass: of each node, shape (n,), kg; 1 at ghosts.
        free_x, free_y: 1 where a node may move and 0 where not, shape (n,).
        pull_x, pull_y, load_x, load_y: as in the mesh, shape (n,), N.
        joints: padded indices, shape (joints, 2).
    """

    at: np.ndarray
    x: np.ndarray
    y: np.ndarray
    edge: np.ndarray
    solid: np.ndarray
    bends: np.ndarray
    span: np.ndarray
    voronoi: np.ndarray
    mass: np.ndarray
    free_x: np.ndarray
    free_y: np.ndarray
    pull_x: np.ndarray
    pull_y: np.ndarray
    load_x: np.ndarray
    load_y: np.ndarray
    joints: np.ndarray


def lay_out(mesh: Mesh, gap: int = 1) -> Layout:
    """Pad a mesh with `gap` ghosts between fibres."""
    fibres = len(mesh.first) - 1
    size = len(mesh.position) + gap * (fibres + 1)
    number = np.repeat(np.arange(fibres), np.diff(mesh.first))
    at = np.arange(len(mesh.position)) + gap * (number + 1)
    position = np.zeros((size, 2))
    position[at] = mesh.position
    edge, solid = np.ones(size - 1), np.zeros(size - 1)
    bends, span, voronoi = np.zeros(size), np.ones(size), np.ones(size)
    for fibre in range(fibres):
        near, far = at[mesh.first[fibre]], at[mesh.first[fibre + 1] - 1]
        lengths = mesh.edges(fibre)
        edge[near:far] = lengths
        solid[near:far] = 1.0
        voronoi[near + 1 : far] = 0.5 * (lengths[1:] + lengths[:-1])
        voronoi[near] = edge[near - 1] = lengths[0]
        bends[near + 1 : far] = 1.0
        span[near + 1 : far] = voronoi[near + 1 : far]
        if mesh.clamped[fibre]:
            bends[near], span[near] = 1.0, 0.5 * lengths[0]
        back = np.arange(1, gap + 1)[:, None] * (position[near] - position[near + 1])
        position[near - back.shape[0] : near] = (position[near] + back)[::-1]
    end = at[-1]
    position[end + 1 :] = position[end] + np.arange(1, gap + 1)[:, None] * (
        position[end] - position[end - 1]
    )
    mass = _pad(at, size, mesh.masses(), fill=1.0)
    free = ~mesh.held
    return Layout(
        at=at,
        x=position[:, 0].copy(),
        y=position[:, 1].copy(),
        edge=edge,
        solid=solid,
        bends=bends,
        span=span,
        voronoi=voronoi,
        mass=mass,
        free_x=_pad(at, size, free[:, 0]),
        free_y=_pad(at, size, free[:, 1]),
        pull_x=_pad(at, size, mesh.pull[:, 0]),
        pull_y=_pad(at, size, mesh.pull[:, 1]),
        load_x=_pad(at, size, mesh.load[:, 0]),
        load_y=_pad(at, size, mesh.load[:, 1]),
        joints=at[mesh.joints].reshape(-1, 2),
    )


def _pad(at: np.ndarray, size: int, values: np.ndarray, fill: float = 0.0) -> np.ndarray:
    padded = np.full(size, fill)
    padded[at] = values
    return padded
