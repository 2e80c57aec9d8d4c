"""Material damping (Kelvin-Voigt): tension and moment that grow with the rates of stretch and turn.

Viscous stresses s = D B v, with v the velocities, B v the rates at which elements stretch and nodes
turn, and D the viscosities. Stepped explicitly those of stretch, and in thick fibres those of turn,
would limit the step like a diffusion, to less than a hundredth of what it is. Here they are those
of the mean velocity of a step, from v to

    v' = v* - K B^T s,   (2 D^-1 + B K B^T) s = B (v + v*),

with v* what everything else makes of v and K the step over the masses. That is the midpoint rule:
second order, never a limit of the step, and what is dissipated, s D^-1 s a second, is what the
kinetic energy lacks. A step solves one system a fibre, in the stresses; along the fibre, with the
moment at each node before the tension of the edge behind it, it has four diagonals on each side.
To fourth order the moments of a spline through the nodes are A^-1 times the turns, with the
three-moment matrix A, so that A is in D^-1, banded as it is. Where bending is hardly damped, only
tensions are solved for: `fiberweb.engines.viscosity_mild`.

Reference: Hairer, Lubich and Wanner, Geometric Numerical Integration (2006), VI, for the rule;
Flügge, Viscoelasticity (1975), 1.3, for the material.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.engines import lanes
from fiberweb.engines.jit import kernel, summing
from fiberweb.engines.lanes import inverse, load, store
from fiberweb.engines.layout import Interleaving, Layout, packed
from fiberweb.engines.viscosity_mild import (
    Curvatures,
    build_curvatures,
    eliminate_tension,
    substitute_tension,
)
from fiberweb.model.mesh import Mesh

ENDLESS = 1e200  # compliance where there is nothing to stretch or bend: no stress at any rate


class Compliance(NamedTuple):
    """2 D^-1: over edges (n - stride,), then over nodes (n,)."""

    stretch: np.ndarray  # twice rest length over viscosity, m / (N s); endless in gaps
    turn: np.ndarray  # the same of a node's turn by its own moment, 1 / (N m s)
    turn_up: np.ndarray  # and by the next one's


class Factors(NamedTuple):
    """L and 1 / D of the system's L D L^T, each (n,): row m of the moment at a node, row t of the
    tension of the edge behind it. Columns in the order of the unknowns:"""

    mm: np.ndarray  # 1 / D
    mt1: np.ndarray  # one back: the tension of the edge before
    mm1: np.ndarray  # two back: the moment at the node before
    mt2: np.ndarray  # three back
    mm2: np.ndarray  # four back
    tt: np.ndarray  # 1 / D
    tm: np.ndarray  # one back: the moment at its own node
    tt1: np.ndarray  # two back
    tm1: np.ndarray  # three back


class Viscosity(NamedTuple):
    """Everything a step needs; empty arrays without material damping. The rest is over nodes."""

    compliance: Compliance
    factors: Factors
    before_x: np.ndarray  # velocities at the start of the step
    before_y: np.ndarray
    before_spin: np.ndarray  # of the elements, if they turn by themselves
    moment: np.ndarray
    tension: np.ndarray
    force_x: np.ndarray  # of the edges
    force_y: np.ndarray
    push_x: np.ndarray  # see `foresee`, m/s
    push_y: np.ndarray
    curvatures: Curvatures


def build_viscosity(
    mesh: Mesh, layout: Layout, interleaving: Interleaving, order: int, step: float = np.inf
) -> Viscosity:
    """The material damping of a mesh: of order 2, with the moments of the usual chain, or of 4;
    step: of an engine that may take moments explicitly."""
    time = mesh.scene.loss_time
    count = len(interleaving.nodes) if time > 0.0 else 0
    factors = Factors(*packed(*np.zeros((9, count))))
    curvatures = build_curvatures(mesh, layout, interleaving.nodes, step)
    work = *packed(*np.zeros((9, count))), curvatures
    if not count:
        return Viscosity(Compliance(*packed(*np.zeros((3, 0)))), factors, *work)
    axial = mesh.scene.fibres.axial_stiffness[layout.fibre] * time / 2
    bending = mesh.scene.fibres.bending_stiffness[layout.fibre] * time / 2
    solid, bends = layout.solid, layout.bends
    length = layout.edge * solid
    spans, up = layout.span, np.zeros_like(layout.span)
    if order == 4:
        spans = np.where(bends > 0, (np.r_[0.0, length] + np.r_[length, 0.0]) / 3.0, 1.0)
        up[:-1] = length / 6.0 * bends[1:] * bends[:-1]
    stretch = np.where(solid > 0, layout.edge / axial[:-1], ENDLESS)
    turn = np.where(bends > 0, spans / bending, ENDLESS)
    nodes = interleaving.nodes
    compliance = packed(stretch[interleaving.edges], turn[nodes], (up / bending)[nodes])
    return Viscosity(Compliance(*compliance), factors, *work)


@kernel
def views(viscosity, scratch, rods, state, s):
    """What each pass takes, in the order of its arguments; see `kirchhoff_passes.pass_views`."""
    bx, by, _, moment, tension, fx, fy = viscosity[2:9]
    tx, ty, inverse = scratch[:3]
    kx, ky = rods.kick_x, rods.kick_y
    x, y, vx, vy = state
    n = vx.shape[0]
    inner, one = slice(2 * s, n - 2 * s), slice(s, n - 3 * s)
    edges, behind = slice(s, n - 2 * s), slice(2 * s, n - s)
    return (
        (tx, ty, inverse, kx, ky, vx, vy, bx, by),
        (tx[edges], ty[edges], inverse[edges], moment[edges], moment[behind], tension[edges],
         fx[edges], fy[edges]),
        (x[inner], vx[inner], kx[inner], fx[inner], fx[one]),
        (y[inner], vy[inner], ky[inner], fy[inner], fy[one]),
    )  # fmt: skip


# Crossings and viscous stresses act one after the other in a step. For either to know of the other,
# the first is given what the second did in the step before: without it the order is the first, and
# at a loss factor of .3 trajectories of an 8x8 were a tenth off at nine tenths of the largest step.


@kernel
def foresee(viscosity, vx, vy):
    """Push nodes as they were in the step before, to no effect where nothing ties them ..."""
    for i in range(vx.shape[0]):
        vx[i] += viscosity.push_x[i]
        vy[i] += viscosity.push_y[i]


@kernel
def take_back(viscosity, vx, vy):
    """... take that back, and keep what they move by before a change ..."""
    for i in range(vx.shape[0]):
        vx[i] -= viscosity.push_x[i]
        vy[i] -= viscosity.push_y[i]
        viscosity.push_x[i] = -vx[i]
        viscosity.push_y[i] = -vy[i]


@kernel
def learn(viscosity, vx, vy):
    """... and after it what it made of them."""
    for i in range(vx.shape[0]):
        viscosity.push_x[i] += vx[i]
        viscosity.push_y[i] += vy[i]


@kernel
def damp(viscosity, passes, step, s):
    """Damp the velocities of fibres that bend between edges, after all else in a step, and let
    positions that were drifted by them follow; `passes` are `views`."""
    fibres, edges, along_x, along_y = passes
    if viscosity.curvatures.last.shape[0] > 0:
        solve(eliminate_tension, substitute_tension, viscosity, fibres, s)
    else:
        solve(eliminate, substitute, viscosity, fibres, s)
        edge_pass(*edges)
    node_pass(*along_x, step)
    node_pass(*along_y, step)


@kernel
def solve(eliminate, substitute, viscosity, fibres, s):
    """The stresses, by two functions of a site: all fibres abreast where they are interleaved, four
    at a time and then one by one; `fibres` are the first of the `views`."""
    # unsigned, since Numba looks for negative indices at every access otherwise
    width, four = np.uint64(s), np.uint64(lanes.COUNT)
    start = np.uint64(2) * width
    end = np.uint64(viscosity.tension.shape[0]) - start
    row = start
    while row < end:
        i, after = row, row + width
        while i + four <= after:
            eliminate(lanes.four(), viscosity, fibres, i, width)
            i += four
        while i < after:
            eliminate(0.0, viscosity, fibres, i, width)
            i += np.uint64(1)
        row = after
    while row > start:
        i, after = row - width, row
        while i + four <= after:
            substitute(lanes.four(), viscosity, fibres, i, width)
            i += four
        while i < after:
            substitute(0.0, viscosity, fibres, i, width)
            i += np.uint64(1)
        row -= width


@kernel
def eliminate(zero, viscosity, fibres, i, width):
    """The rows of one site, with their right side, factored; as many sites as `zero` has numbers.

    Letters: t is the unit tangent of the edge behind node i, r that of the one before it and q of
    the one before that; n, m and p are the same over the lengths, turned by a right angle but for
    the sign of x; k are the kicks of node i, of the next (up) and of the one before (j).
    """
    tangent_x, tangent_y, over, kick_x, kick_y, vx, vy, before_x, before_y = fibres
    mm, mt1, mm1, mt2, mm2, tt, tm, tt1, tm1 = viscosity.factors
    moment, tension = viscosity.moment, viscosity.tension
    up, j = i + width, i - width
    k = j - width
    tx, ty, inner = load(zero, tangent_x, i), load(zero, tangent_y, i), load(zero, over, i)
    rx, ry, inner_j = load(zero, tangent_x, j), load(zero, tangent_y, j), load(zero, over, j)
    qx, qy, inner_k = load(zero, tangent_x, k), load(zero, tangent_y, k), load(zero, over, k)
    kx, kx_up, kx_j = load(zero, kick_x, i), load(zero, kick_x, up), load(zero, kick_x, j)
    ky, ky_up, ky_j = load(zero, kick_y, i), load(zero, kick_y, up), load(zero, kick_y, j)
    nx, ny, mx, my = ty * inner, tx * inner, ry * inner_j, rx * inner_j
    px, py = qy * inner_k, qx * inner_k
    cx, cy, ex, ey = nx + mx, ny + my, mx + px, my + py

    # the mean velocities' differences, twice, and the rates of stretch and turn
    wx = load(zero, vx, i) + load(zero, before_x, i)
    wy = load(zero, vy, i) + load(zero, before_y, i)
    ux = load(zero, vx, up) + load(zero, before_x, up) - wx
    uy = load(zero, vy, up) + load(zero, before_y, up) - wy
    wx = wx - load(zero, vx, j) - load(zero, before_x, j)
    wy = wy - load(zero, vy, j) - load(zero, before_y, j)
    stretching = tx * ux + ty * uy
    turning = ny * uy - nx * ux + mx * wx - my * wy

    tm_j, mm_j, tt_j = load(zero, tm, j), load(zero, mm, j), load(zero, tt, j)
    moment_j, tension_j = load(zero, moment, j), load(zero, tension, j)
    c4 = kx_j * mx * px + ky_j * my * py
    c3 = ky_j * my * qy - kx_j * mx * qx - c4 * load(zero, tm, k)
    c2 = load(zero, viscosity.compliance.turn_up, j) - kx_j * mx * ex - ky_j * my * ey
    c2 = c2 - kx * cx * mx - ky * cy * my
    c2 = c2 - c4 * load(zero, mm1, j) - c3 * load(zero, mt1, j)
    c1 = (kx * cx + kx_j * mx) * rx - (ky * cy + ky_j * my) * ry
    c1 = c1 - c4 * load(zero, tm1, j) - c3 * load(zero, tt1, j) - c2 * tm_j
    l4, l3, l2, l1 = c4 * load(zero, mm, k), c3 * load(zero, tt, k), c2 * mm_j, c1 * tt_j
    pivot = load(zero, viscosity.compliance.turn, i) + kx_up * nx * nx + ky_up * ny * ny
    pivot = pivot + kx * cx * cx + ky * cy * cy + kx_j * mx * mx + ky_j * my * my
    pivot = inverse(pivot - c4 * l4 - c3 * l3 - c2 * l2 - c1 * l1)
    turning = turning - l4 * load(zero, moment, k) - l3 * load(zero, tension, k)
    turning = turning - l2 * moment_j - l1 * tension_j
    store(l4, mm2, i)
    store(l3, mt2, i)
    store(l2, mm1, i)
    store(l1, mt1, i)
    store(pivot, mm, i)
    store(turning, moment, i)

    c3 = kx * tx * mx - ky * ty * my
    c2 = zero - kx * tx * rx - ky * ty * ry - c3 * tm_j
    c1 = (ky_up * ny + ky * cy) * ty - (kx_up * nx + kx * cx) * tx - c3 * l2 - c2 * l1
    l3, l2, l1 = c3 * mm_j, c2 * tt_j, c1 * pivot
    pivot = load(zero, viscosity.compliance.stretch, i)
    pivot = pivot + (kx + kx_up) * tx * tx + (ky + ky_up) * ty * ty
    store(inverse(pivot - c3 * l3 - c2 * l2 - c1 * l1), tt, i)
    store(stretching - l3 * moment_j - l2 * tension_j - l1 * turning, tension, i)
    store(l3, tm1, i)
    store(l2, tt1, i)
    store(l1, tm, i)


@kernel
def substitute(zero, viscosity, fibres, i, width):
    """The stresses of one site, or of as many as `zero` has numbers."""
    mm, mt1, mm1, mt2, mm2, tt, tm, tt1, tm1 = viscosity.factors
    moment, tension = viscosity.moment, viscosity.tension
    j = i + width
    k = j + width
    moment_j, moment_k = load(zero, moment, j), load(zero, moment, k)
    tension_j = load(zero, tension, j)
    t = load(zero, tension, i) * load(zero, tt, i) - load(zero, mt1, j) * moment_j
    t = t - load(zero, tt1, j) * tension_j - load(zero, mt2, k) * moment_k
    m = load(zero, moment, i) * load(zero, mm, i) - load(zero, tm, i) * t
    m = m - load(zero, mm1, j) * moment_j - load(zero, tm1, j) * tension_j
    store(m - load(zero, mm2, k) * moment_k, moment, i)
    store(t, tension, i)


@kernel
def edge_pass(tx, ty, inverse, moment0, moment1, tension, fx, fy):
    """Forces of the edges."""
    for i in range(fx.shape[0]):
        across = (moment0[i] - moment1[i]) * inverse[i]
        fx[i] = tension[i] * tx[i] - across * ty[i]
        fy[i] = tension[i] * ty[i] + across * tx[i]


@kernel
def node_pass(x, v, kick, f1, f0, step):
    """What the forces make of velocities and positions (one direction)."""
    for i in range(v.shape[0]):
        change = kick[i] * (f1[i] - f0[i])
        v[i] += change
        x[i] += step * change


@kernel
def power_views(viscosity, vx, vy, s):
    """What `edge_power` takes, in the order of its arguments."""
    n = viscosity.force_x.shape[0]
    edge, behind = slice(0, n - s), slice(s, n)
    forces = viscosity.force_x[edge], viscosity.force_y[edge]
    return (*forces, vx[edge], vx[behind], vy[edge], vy[behind])


@summing
def edge_power(fx, fy, vx0, vx1, vy0, vy1):
    """Power (W) that forces of edges take at the velocities of their ends."""
    total = 0.0
    for i in range(fx.shape[0]):
        total += fx[i] * (vx1[i] - vx0[i]) + fy[i] * (vy1[i] - vy0[i])
    return total
