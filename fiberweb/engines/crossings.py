"""Crossings of the kirchhoff engine: spring and damper, stepped exactly."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import expm
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from fiberweb.engines.jit import kernel
from fiberweb.engines.layout import Interleaving, Layout
from fiberweb.engines.stepping import damped_kick
from fiberweb.model.mesh import Mesh


class Merged(NamedTuple):
    """Crossings of two nodes that are one point, each (merged,)."""

    a: np.ndarray
    b: np.ndarray
    share_b: np.ndarray  # of b in their mass


class Pairs(NamedTuple):
    """Two nodes that spring and damper tie: operators on their relative motion, each (pairs,)."""

    a: np.ndarray
    b: np.ndarray
    p: np.ndarray
    q: np.ndarray
    s: np.ndarray
    share_a: np.ndarray  # of node a in a change of relative velocity
    share_b: np.ndarray


class Groups(NamedTuple):
    """Crossings of more than two nodes."""

    starts: np.ndarray  # of each group in the members, and their end
    members: np.ndarray  # nodes
    offsets: np.ndarray  # of each group in the operators, and their end
    operators: np.ndarray  # P, Q and S of each group, each row by row


class Motion(NamedTuple):
    """Velocities and positions: relative ones of pairs, or those of the members of groups."""

    vx: np.ndarray
    x: np.ndarray
    vy: np.ndarray
    y: np.ndarray


def joint_operators(
    mesh: Mesh, layout: Layout, interleaving: Interleaving, step: float
) -> tuple[Merged, Pairs, Groups]:
    """What a step does to the nodes that meet at a crossing, beyond what it does to all.

    With v the velocities before the kick, v* after the kick of all but the crossing, and x the
    positions, the step gives v' = P v + Q v* + S x, where for the damper matrix N, spring
    matrix K (graph Laplacians), lumped masses M and the damping g of all velocities

        A = g + M^-1 N,   E = exp(-h A),   Phi = A^-1 (1 - E),   phi = (1 - exp(-h g)) / g,
        Q = Phi / phi,   P = E - exp(-h g) Q,   S = -Phi M^-1 K:

    exact for forces constant over the step, of which v* = exp(-h g) v + phi M^-1 f has had its
    share phi (`damped_kick`). Nodes that are one point get the mass-weighted mean of v* and of
    where it took them. Of more than two, S closes within a step what round-off has put between
    them: it would grow like a random walk.
    """
    merged, pairs, others = [], [], []
    for nodes, spring, damper in joint_groups(mesh, layout):
        mass = layout.mass[nodes]
        if len(nodes) == 2 and np.isinf(spring).any():
            merged.append((*interleaving.place[nodes], mass[1] / mass.sum()))
        elif len(nodes) == 2:
            operators = _pair_operators(
                mass, -spring[0, 1], -damper[0, 1], step, mesh.scene.damping
            )
            pairs.append((*interleaving.place[nodes], *operators, *(1.0 - mass / mass.sum())))
        else:
            operators = _group_operators(mass, spring, damper, step, mesh.scene.damping)
            others.append((interleaving.place[nodes], operators))
    return (
        Merged(*_columns(merged, 3)),
        Pairs(*_columns(pairs, 7)),
        Groups(
            np.cumsum([0] + [len(nodes) for nodes, _ in others]),
            np.array([n for nodes, _ in others for n in nodes], dtype=np.int64),
            np.cumsum([0] + [operators.size for _, operators in others]),
            np.concatenate([operators.ravel() for _, operators in others] or [np.zeros(0)]),
        ),
    )


def _columns(rows: list[tuple], count: int) -> tuple[np.ndarray, ...]:
    """Columns of rows that begin with two nodes."""
    a, b, *rest = (np.array(column) for column in zip(*rows)) if rows else np.zeros((count, 0))
    # unsigned, since Numba looks for negative indices at every access otherwise
    return a.astype(np.uint64), b.astype(np.uint64), *rest


def joint_groups(mesh: Mesh, layout: Layout):
    """Nodes that meet at each crossing, with their spring and damper matrices."""
    size = len(layout.mass)
    a, b = layout.joints.T
    _, label = connected_components(
        coo_array((np.ones(len(a)), (a, b)), shape=(size, size)), directed=False
    )
    members: dict[int, list[int]] = {}
    for node in np.unique(layout.joints):
        members.setdefault(label[node], []).append(int(node))
    matrices = {key: np.zeros((2, len(nodes), len(nodes))) for key, nodes in members.items()}
    for (i, j), k, nu in zip(layout.joints, mesh.joint_stiffness, mesh.joint_damping):
        nodes, (spring, damper) = members[label[i]], matrices[label[i]]
        gap = np.zeros(len(nodes))
        gap[nodes.index(i)], gap[nodes.index(j)] = 1.0, -1.0
        at = np.ix_(np.flatnonzero(gap), np.flatnonzero(gap))
        spring[at] += k * np.outer(gap, gap)[at]
        damper += nu * np.outer(gap, gap)
    for key, nodes in members.items():
        yield nodes, *matrices[key]


def _pair_operators(mass, k, nu, step, rate) -> tuple[float, float, float]:
    """P, Q and S of two nodes, as factors of their relative motion."""
    over_mass = (1.0 / mass).sum()
    whole = rate + nu * over_mass
    kick = damped_kick(whole, step)
    share = kick / damped_kick(rate, step)
    return np.exp(-whole * step) - np.exp(-rate * step) * share, share, -kick * k * over_mass


def _group_operators(mass, spring, damper, step, rate) -> np.ndarray:
    """P, Q and S of one group, shape (3, nodes, nodes)."""
    count = len(mass)
    if not np.isfinite(spring).all():
        mean = np.tile(mass / mass.sum(), (count, 1))
        return np.array([np.zeros((count, count)), mean, (mean - np.eye(count)) / step])
    damping = rate * np.eye(count) + damper / mass[:, None]
    # Phi from one exponential of an augmented matrix: no division by zero rates
    augmented = np.block([[-damping, np.eye(count)], [np.zeros((count, 2 * count))]])
    exponential = expm(step * augmented)
    decayed, kick = exponential[:count, :count], exponential[:count, count:]
    share = kick / damped_kick(rate, step)
    return np.array(
        [decayed - np.exp(-rate * step) * share, share, -kick @ (spring / mass[:, None])]
    )


@kernel
def no_motion(count):
    """Room for the motion of so many pairs or members, in one block."""
    rows = np.zeros((4, count))
    return Motion(rows[0], rows[1], rows[2], rows[3])


@kernel
def gather_pairs(pairs, relative, x, y, vx, vy):
    """Relative velocity and position of the nodes of each pair."""
    for j in range(pairs.a.shape[0]):
        a, b = pairs.a[j], pairs.b[j]
        relative.vx[j], relative.x[j] = vx[b] - vx[a], x[b] - x[a]
        relative.vy[j], relative.y[j] = vy[b] - vy[a], y[b] - y[a]


@kernel
def merge_pass(merged, x, y, vx, vy):
    """Make one point of two nodes after the kick, at their centre of mass."""
    for j in range(merged.a.shape[0]):
        a, b, share = merged.a[j], merged.b[j], merged.share_b[j]
        for moved in (x, y, vx, vy):
            moved[a] = moved[b] = moved[a] + share * (moved[b] - moved[a])


@kernel
def pair_pass(pairs, relative, x, y, vx, vy, step):
    """Change velocities and positions after the kick to what spring and damper make of them at
    crossings of two nodes; `joint_operators` has the step.

    `relative` has what `gather_pairs` found before the kick and is kept up to date.
    """
    a_nodes, b_nodes, p, q, s, share_a, share_b = pairs
    old_x, gap_x, old_y, gap_y = relative
    for j in range(a_nodes.shape[0]):
        a, b = a_nodes[j], b_nodes[j]
        kicked_x, kicked_y = vx[b] - vx[a], vy[b] - vy[a]
        new_x = p[j] * old_x[j] + q[j] * kicked_x + s[j] * gap_x[j]
        new_y = p[j] * old_y[j] + q[j] * kicked_y + s[j] * gap_y[j]
        old_x[j] = new_x
        old_y[j] = new_y
        gap_x[j] += step * new_x
        gap_y[j] += step * new_y
        change_x, change_y = new_x - kicked_x, new_y - kicked_y
        vx[a] -= share_a[j] * change_x
        vy[a] -= share_a[j] * change_y
        vx[b] += share_b[j] * change_x
        vy[b] += share_b[j] * change_y
        x[a] -= step * share_a[j] * change_x
        y[a] -= step * share_a[j] * change_y
        x[b] += step * share_b[j] * change_x
        y[b] += step * share_b[j] * change_y


@kernel
def gather_groups(groups, before, x, y, vx, vy):
    """Velocity of each member of a group, and position from the first one: S has no use for where
    they all are, and so no round-off of it."""
    starts, members = groups.starts, groups.members
    for g in range(starts.shape[0] - 1):
        first = members[starts[g]]
        for i in range(starts[g], starts[g + 1]):
            n = members[i]
            before.vx[i], before.x[i] = vx[n], x[n] - x[first]
            before.vy[i], before.y[i] = vy[n], y[n] - y[first]


@kernel
def group_pass(groups, v_before, x_before, kicked, x, v, step):
    """The same for crossings of any number of nodes and one direction, by dense operators P, Q
    and S, from the members' velocities and positions before the kick; `kicked` is scratch."""
    starts, members, offsets, operators = groups
    for i in range(members.shape[0]):
        kicked[i] = v[members[i]]
    for g in range(starts.shape[0] - 1):
        first, count = starts[g], starts[g + 1] - starts[g]
        p = offsets[g]
        q, s = p + count * count, p + 2 * count * count
        for i in range(count):
            new = 0.0
            for j in range(count):
                k, m = i * count + j, first + j
                new += operators[p + k] * v_before[m] + operators[q + k] * kicked[m]
                new += operators[s + k] * x_before[m]
            n = members[first + i]
            v[n] = new
            x[n] += step * (new - kicked[first + i])
