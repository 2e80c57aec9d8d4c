"""PyElastica's Laplace filter, as one stencil.

Reference: Jeanmart and Winckelmans, Phys. Fluids 19, 055110 (2007).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.engines.jit import kernel
from fiberweb.engines.layout import Interleaving, Layout, packed
from fiberweb.model.mesh import Mesh

REACH = 5  # of the stencil on either side: one less than the highest order
GAP = 2 * REACH  # ghosts between fibres: room for the continuation beyond the ends of both


class Filtering(NamedTuple):
    """What the filter acts with, and where."""

    order: int  # 0 for none
    stencil: np.ndarray  # four times the weights of `filter_stencil`, (6,)
    inner_nodes: np.ndarray  # 1/4 on inner nodes of fibres and 0 elsewhere, (n,)
    inner_elements: np.ndarray  # the same of elements, (n - stride,)
    first_nodes: np.ndarray  # where rows of first nodes of fibres begin
    last_nodes: np.ndarray
    last_elements: np.ndarray


def build_filtering(mesh: Mesh, layout: Layout, interleaving: Interleaving) -> Filtering:
    """The filter of a scene in the order of the kernels."""
    order, stride = mesh.scene.filter_order, interleaving.stride
    nodes, elements = filtered_points(layout)
    inner = packed(0.25 * nodes[interleaving.nodes], 0.25 * elements[interleaving.edges])
    ends = (interleaving.place[layout.at[at]] for at in (mesh.first[:-1], mesh.first[1:] - 1))
    # unsigned for the same reason as those of crossings
    first, last = (rows[::stride].astype(np.uint64) for rows in ends)
    return Filtering(
        order, 4.0 * filter_stencil(order), *inner, first, last, last - np.uint64(stride)
    )


def filtered_points(layout: Layout):
    """1 at inner nodes and at inner elements of fibres, 0 elsewhere, (n,) and (n - 1,)."""
    fibre = layout.solid > 0
    node, element = np.zeros(len(layout.x)), np.zeros(len(fibre))
    node[1:-1] = fibre[1:] & fibre[:-1]
    element[1:-1] = fibre[1:-1] & fibre[2:] & fibre[:-2]
    return node, element


def filter_stencil(order: int) -> np.ndarray:
    """Weights of order - 1 applications of minus a quarter of the second difference, from the
    centre outwards, shape (6,)."""
    weights = np.ones(1)
    for _ in range(order - 1):
        weights = np.convolve(weights, [-0.25, 0.5, -0.25])
    return np.r_[weights[order - 1 :], np.zeros(REACH + 1 - order)]


@kernel
def difference_pass(left, middle, right, inside, out):
    """Minus a quarter of the second difference; zero outside and at the ends of fibres."""
    for i in range(out.shape[0]):
        out[i] = inside[i] * (2.0 * middle[i] - left[i] - right[i])


@kernel
def stencil_pass(rate, inside, f, l1, r1, l2, r2, l3, r3, l4, r4, l5, r5, w0, w1, w2, w3, w4, w5):
    """Take the 11-point sum of f from the rate."""
    for i in range(rate.shape[0]):
        near = w0 * f[i] + w1 * (l1[i] + r1[i]) + w2 * (l2[i] + r2[i])
        far = w3 * (l3[i] + r3[i]) + w4 * (l4[i] + r4[i]) + w5 * (l5[i] + r5[i])
        rate[i] -= inside[i] * (near + far)


@kernel
def filter_views(rate, inside, f, s):
    """The shifted parts of its arrays that the filter's passes run over; neighbours are s apart."""
    n, g = rate.shape[0], REACH * s
    m = n - g
    return (
        (rate[g - s : m - s], rate[g:m], rate[g + s : m + s], inside[g:m], f[g:m]),
        (
            rate[g:m], inside[g:m], f[g:m], f[g - s : m - s], f[g + s : m + s],
            f[g - 2 * s : m - 2 * s], f[g + 2 * s : m + 2 * s],
            f[g - 3 * s : m - 3 * s], f[g + 3 * s : m + 3 * s],
            f[g - 4 * s : m - 4 * s], f[g + 4 * s : m + 4 * s],
            f[g - 5 * s : m - 5 * s], f[g + 5 * s : m + 5 * s],
        ),
    )  # fmt: skip


@kernel
def filter_rate(views, firsts, lasts, w, f, s):
    """Jeanmart-Winckelmans filter: what is left of `rate` after six second differences is
    taken away.

    PyElastica sets each difference to zero at a fibre's ends. So the first difference,
    continued beyond them as an odd function, has its further differences everywhere, and those
    are one stencil; the gaps between fibres hold the continuation. `firsts` and
    `lasts` are where ends of fibres stand, s of them in a row from each index on; w is the stencil.
    """
    difference_pass(*views[0])
    width = np.uint64(s)
    for k in range(firsts.shape[0]):
        a, b = firsts[k], lasts[k]
        for j in range(REACH):
            shift = np.uint64(j + 1) * width
            for i in range(width):
                f[a - shift + i] = -f[a + shift + i]
                f[b + shift + i] = -f[b - shift + i]
    stencil_pass(*views[1], w[0], w[1], w[2], w[3], w[4], w[5])


@kernel
def velocity_views(state, filtering, scratch, stride):
    """The views of x, y and angular velocity."""
    over_elements = scratch[:-stride]
    return (
        filter_views(state.vx, filtering.inner_nodes, scratch, stride),
        filter_views(state.vy, filtering.inner_nodes, scratch, stride),
        filter_views(state.omega, filtering.inner_elements, over_elements, stride),
    )


@kernel
def filter_velocities(views, filtering, scratch, stride):
    """Filter x, y and angular velocities."""
    w, first, last = filtering.stencil, filtering.first_nodes, filtering.last_nodes
    filter_rate(views[0], first, last, w, scratch, stride)
    filter_rate(views[1], first, last, w, scratch, stride)
    filter_rate(views[2], first, filtering.last_elements, w, scratch[:-stride], stride)
