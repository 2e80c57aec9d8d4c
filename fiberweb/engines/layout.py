"""The mesh as the planar kernels see it: one long chain of nodes, with gaps.

Ghost nodes stand before each fibre and after the last, so that one loop runs over
everything: the edges next to a ghost have no stiffness and ghosts do not move. The ghost
before a fibre lies one element behind its near end, so that a clamp is an ordinary bending
node: the moment there grows with the angle between ghost edge and first edge over half an
element, which is the half cell that a curvature at the wall spans. Second order, where
holding the first element's direction is first order (it shortens the fibre by half an
element). The other ghosts are so far away that no far end ever meets one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fiberweb.model.mesh import Mesh

LINE = 8  # doubles in a cache line
_AWAY = 1000  # elements


@dataclass(frozen=True)
class Layout:
    """Arrays over the padded chain of n nodes and n - 1 edges."""

    at: np.ndarray  # padded index of each node of the mesh, (nodes of the mesh,)
    x: np.ndarray  # rest positions, (n,), m
    y: np.ndarray
    edge: np.ndarray  # rest length of edges, (n - 1,), m; any positive number at gaps
    solid: np.ndarray  # 1 on elements and 0 on gaps, (n - 1,)
    fibre: np.ndarray  # number of the fibre of each node, and of the edge after it, (n,)
    bends: np.ndarray  # 1 where a moment is carried and 0 where not, (n,)
    # rest length that a node's curvature spans, (n,), m: half of either element beside it, of the
    # one inside at a clamp; 1 where no moment is carried
    span: np.ndarray
    voronoi: np.ndarray  # half the sum of the neighbouring elements' rest lengths, (n,), m
    mass: np.ndarray  # (n,), kg; 1 at ghosts
    free_x: np.ndarray  # 1 where a node may move and 0 where not, (n,)
    free_y: np.ndarray
    pull_x: np.ndarray  # these as in the mesh, (n,), N
    pull_y: np.ndarray
    load_x: np.ndarray
    load_y: np.ndarray
    joints: np.ndarray  # padded indices, (joints, 2)
    guided: np.ndarray  # padded indices of nodes that slide along a slanted line, (guided,)


def lay_out(mesh: Mesh, gap: int = 2) -> Layout:
    """Pad a mesh with `gap` ghosts, two or more, between fibres."""
    fibres = len(mesh.first) - 1
    size = len(mesh.position) + gap * (fibres + 1)
    number = np.repeat(np.arange(fibres), np.diff(mesh.first))
    at = np.arange(len(mesh.position)) + gap * (number + 1)
    fibre_of = number[np.searchsorted(at, np.arange(size)).clip(max=len(at) - 1)]
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
        back = position[near] - position[near + 1]
        position[near - gap : near] = position[near] + _AWAY * np.arange(gap, 0, -1)[:, None] * back
        position[near - 1] = position[near] + back
    position[at[-1] + 1 :] = position[: at[0]]
    mass = _pad(at, size, mesh.masses(), fill=1.0)
    free, pull, load = ((*a.T,) for a in (~mesh.held, mesh.pull, mesh.load))
    x, y = position.T.copy()
    return Layout(
        at, x, y, edge, solid, fibre_of, bends, span, voronoi, mass,
        *(_pad(at, size, values) for values in (*free, *pull, *load)),
        at[mesh.joints].reshape(-1, 2), at[mesh.guided],
    )  # fmt: skip


@dataclass(frozen=True)
class Interleaving:
    """How the kernels store the chain: fibre by fibre, or interleaved node by node.

    Fibres of as many nodes each lie side by side: node j of all of them, then node j + 1. What
    stands `stride` further is the next node, so a loop over all reads neighbours in whole cache
    lines. Other networks stay a chain, with a stride of 1.
    """

    stride: int  # how far apart neighbours are
    nodes: np.ndarray  # padded index in the chain of each node here, (n',)
    edges: np.ndarray  # the same of the edges, edge i lying between nodes i and i + stride
    place: np.ndarray  # index here of each node of the chain, (n,); of a ghost, of one copy


def interleave(mesh: Mesh, layout: Layout, gap: int) -> Interleaving:
    """The order in which the kernels take the nodes of a layout with `gap` ghosts."""
    counts = np.diff(mesh.first)
    stride = len(counts) if (counts == counts[0]).all() else 1
    if stride == 1:
        nodes = np.arange(len(layout.x))
    else:
        rows = np.arange(counts[0] + 2 * gap)[:, None]
        nodes = (rows - gap + layout.at[mesh.first[:-1]]).ravel()
    place = np.zeros(len(layout.x), dtype=np.int64)
    place[nodes] = np.arange(len(nodes))
    return Interleaving(stride, nodes, nodes[:-stride], place)


def packed(*arrays: np.ndarray) -> tuple[np.ndarray, ...]:
    """Copies in one block of memory, each at the start of a cache line."""
    sizes = [-(-array.size // LINE) * LINE + LINE for array in arrays]
    block = np.zeros(sum(sizes) + LINE)
    first = -block.ctypes.data % (8 * LINE) // 8
    starts = first + np.cumsum([0, *sizes[:-1]])
    views = tuple(block[start : start + array.size] for start, array in zip(starts, arrays))
    for view, array in zip(views, arrays):
        view[:] = array
    return views


def _pad(at: np.ndarray, size: int, values: np.ndarray, fill: float = 0.0) -> np.ndarray:
    padded = np.full(size, fill)
    padded[at] = values
    return padded
