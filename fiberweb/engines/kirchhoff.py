"""Planar Kirchhoff rods: no shear, no rotary inertia, no dilatation of the cross-section.

A fibre is a chain of nodes. Its energy is that of its edges' stretch, with PyElastica's
stress EA (l - l0) / l, and of the angles phi between them, with moment (EI / D) f(phi) where

    f(phi) = 3 sin(phi) / (2 + cos(phi)) = phi (1 - phi^4 / 180 + ...)

needs one division and no arc tangent, and is nowhere stiffer than at phi = 0: the explicit
limit of the straight rod holds for every shape. Cross-section and rotation dropped, the
explicit limit is that of axial waves, 4 to 6 times the Cosserat rod's.

Time is integrated by leapfrog, as PyElastica's position Verlet with its two half drifts
joined. Crossings: spring and damper as an exact exponential of the damper over each step, so
that they set no limit and a stiff damper slips at the speed that its force implies; an
infinite stiffness makes the nodes one point.

References: Bergou et al., Discrete elastic rods, ACM Trans. Graph. 27 (2008), for the chain;
Hochbruck and Ostermann, Exponential integrators, Acta Numerica 19 (2010), for the damper.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from fiberweb.engines.base import (
    RUNAWAY,
    Numerics,
    Recording,
    readout_arrays,
    steps_per_sample,
)
from fiberweb.engines.jit import kernel
from fiberweb.engines.layout import Layout, lay_out
from fiberweb.mesh import Mesh

CHUNK = 250  # samples between two returns to Python, where an interrupt is seen


def refuse(mesh: Mesh) -> None:
    """Raise ValueError if the scene needs what this engine does not model."""
    scene = mesh.scene
    if scene.filter_order:
        raise ValueError(
            f"filter_order = {scene.filter_order}: the kirchhoff engine has no Laplace filter; "
            "use engine = 'cosserat'"
        )
    if scene.setup == "published":
        raise ValueError(
            "setup = 'published' damps rotations, which the kirchhoff engine does not have; "
            "use engine = 'cosserat'"
        )


def integrate(mesh: Mesh, numerics: Numerics) -> Recording:
    """Integrate a mesh in the plane; see the module's docstring for the model.

    Raises:
        ValueError: the scene has a Laplace filter or is the published setup.
    """
    refuse(mesh)
    scene, layout = mesh.scene, lay_out(mesh)
    per_sample = steps_per_sample(scene, numerics.time_step)
    step = 1.0 / (scene.sample_rate * per_sample)
    nodes, weights = readout_arrays(mesh)
    samples = scene.samples
    out = np.full((samples, len(nodes), 2), np.nan)
    state = State(layout)
    arrays = _coefficients(mesh, layout, step)
    limit = RUNAWAY * scene.wave_speed
    done = 0
    while done < samples:
        end = min(samples, done + CHUNK)
        good = advance(
            state.chain, state.work, arrays.chain, arrays.joints, mesh.drive,
            (layout.at[nodes], weights, layout.x, layout.y),
            (scene.drive_rate, scene.tension_ramp, step, limit, arrays.decay),
            per_sample, done, out[done:end],
        )  # fmt: skip
        if good < end - done:
            out[done + good :] = np.nan
            return Recording(out, (done + good) / scene.sample_rate)
        done = end
    return Recording(out, None)


class State:
    """Positions and velocities over the padded chain, and what the passes leave each other."""

    def __init__(self, layout: Layout):
        size = len(layout.x)
        self.chain = (layout.x.copy(), layout.y.copy(), np.zeros(size), np.zeros(size))
        self.work = tuple(np.zeros(size - 1) for _ in range(5)) + tuple(
            np.zeros(size) for _ in range(3)
        )


class _coefficients:
    """Everything constant that the kernel multiplies with."""

    def __init__(self, mesh: Mesh, layout: Layout, step: float):
        half = np.exp(-0.5 * mesh.scene.damping * step)
        self.decay = half * half
        axial = mesh.scene.axial_stiffness * layout.solid
        kick_x = half * step * layout.free_x / layout.mass
        kick_y = half * step * layout.free_y / layout.mass
        loaded = np.flatnonzero(layout.load_x**2 + layout.load_y**2)
        self.chain = (
            axial, layout.edge, 3.0 * layout.bend, kick_x, kick_y, layout.pull_x, layout.pull_y,
            loaded, layout.load_x[loaded], layout.load_y[loaded],
        )  # fmt: skip
        self.joints = joint_operators(mesh, layout, step)


def joint_operators(mesh: Mesh, layout: Layout, step: float):
    """What a step does to the nodes that meet at a crossing, beyond what it does to all.

    With v the velocities before the kick, v* after the kick of all but the crossing, and x the
    positions, the step gives v' = P v + Q v* + S x, where for the damper matrix N, spring
    matrix K (graph Laplacians) and lumped masses M

        E = exp(-h M^-1 N),   Phi = (h M^-1 N)^-1 (1 - E),
        P = E - Phi,   Q = Phi,   S = -h Phi M^-1 K,

    (times the decay of free velocities): exact for forces constant over the step. Nodes that
    are one point get the mass-weighted mean of v*.

    Returns:
        For crossings of two nodes, on the relative motion: nodes a and b, p, q, s and the
        shares of a and b in a change of relative velocity, each (pairs,). For the others: start
        of each group in members, members (padded node indices), start of each group in the
        operators, operators (P, Q, S of each group, each row by row).
    """
    pairs, others = [], []
    for nodes, spring, damper in _groups(mesh, layout):
        mass = layout.mass[nodes]
        operators = _group_operators(mass, spring, damper, step, mesh.scene.damping)
        if len(nodes) == 2:
            # applied to a relative displacement, each operator gives back a multiple of it
            p, q, s = (operator[1, 1] - operator[0, 1] for operator in operators)
            pairs.append((*nodes, p, q, s, *(1.0 - mass / mass.sum())))
        else:
            others.append((nodes, operators))
    a, b, *rest = (np.array(column) for column in zip(*pairs)) if pairs else [np.zeros(0)] * 7
    integer = np.int64
    return (
        a.astype(integer), b.astype(integer), *rest,
        np.cumsum([0] + [len(nodes) for nodes, _ in others]),
        np.array([n for nodes, _ in others for n in nodes], dtype=integer),
        np.cumsum([0] + [operators.size for _, operators in others]),
        np.concatenate([operators.ravel() for _, operators in others] or [np.zeros(0)]),
    )  # fmt: skip


def _groups(mesh: Mesh, layout: Layout):
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


def _group_operators(mass, spring, damper, step, rate) -> np.ndarray:
    """P, Q and S of one group, shape (3, nodes, nodes)."""
    count = len(mass)
    if not np.isfinite(spring).all():
        mean = np.tile(mass / mass.sum(), (count, 1))
        return np.array([np.zeros((count, count)), mean, np.zeros((count, count))])
    damping = step * damper / mass[:, None]
    # the phi function from one exponential of an augmented matrix: no division by zero rates
    augmented = np.block([[-damping, np.eye(count)], [np.zeros((count, 2 * count))]])
    exponential = expm(augmented)
    decayed, phi = exponential[:count, :count], exponential[:count, count:]
    kick = -step * np.exp(-0.5 * rate * step) * phi @ (spring / mass[:, None])
    return np.array([np.exp(-rate * step) * (decayed - phi), phi, kick])


@kernel
def stretch_pass(x0, x1, y0, y1, tx, ty, inverse):
    """Unit tangents and inverse lengths of the edges."""
    for i in range(tx.shape[0]):
        dx = x1[i] - x0[i]
        dy = y1[i] - y0[i]
        r = 1.0 / np.sqrt(dx * dx + dy * dy)
        tx[i] = dx * r
        ty[i] = dy * r
        inverse[i] = r


@kernel
def moment_pass(tx0, tx1, ty0, ty1, bend3, moment):
    """Moment at inner nodes from the edges on either side."""
    for i in range(moment.shape[0]):
        cross = tx0[i] * ty1[i] - ty0[i] * tx1[i]
        dot = tx0[i] * tx1[i] + ty0[i] * ty1[i]
        moment[i] = bend3[i] * cross / (2.0 + dot)


@kernel
def force_pass(tx, ty, inverse, axial, edge, moment0, moment1, fx, fy):
    """Force in each edge: tension along it, moment difference across it."""
    for i in range(fx.shape[0]):
        tension = axial[i] * (1.0 - edge[i] * inverse[i])
        shear = (moment0[i] - moment1[i]) * inverse[i]
        fx[i] = tension * tx[i] - shear * ty[i]
        fy[i] = tension * ty[i] + shear * tx[i]


@kernel
def kick_pass(x, v, f0, f1, outer, kick, decay, step):
    """Velocity by the net force, then position by the velocity (one direction)."""
    for i in range(v.shape[0]):
        new = decay * v[i] + kick[i] * (f1[i] - f0[i] + outer[i])
        v[i] = new
        x[i] += step * new


@kernel
def pair_pass(x, v, f, outer, kick, a_nodes, b_nodes, p, q, s, share_a, share_b, decay):
    """Change the velocities of crossings of two nodes such that the kick that follows leaves
    them as spring and damper would (one direction); `joint_operators` has the step."""
    for j in range(a_nodes.shape[0]):
        a, b = a_nodes[j], b_nodes[j]
        old = v[b] - v[a]
        kicked = decay * old + (
            kick[b] * (f[b] - f[b - 1] + outer[b]) - kick[a] * (f[a] - f[a - 1] + outer[a])
        )
        change = (p[j] * old + q[j] * kicked + s[j] * (x[b] - x[a]) - kicked) / decay
        v[a] -= share_a[j] * change
        v[b] += share_b[j] * change


@kernel
def group_pass(x, v, f, outer, kick, starts, members, offsets, operators, decay, old, kicked):
    """The same for crossings of any number of nodes, by dense operators."""
    for g in range(starts.shape[0] - 1):
        first, count = starts[g], starts[g + 1] - starts[g]
        p = offsets[g]
        q, s = p + count * count, p + 2 * count * count
        for i in range(count):
            n = members[first + i]
            old[i] = v[n]
            kicked[i] = decay * v[n] + kick[n] * (f[n] - f[n - 1] + outer[n])
        for i in range(count):
            new = -kicked[i]
            for j in range(count):
                k = i * count + j
                new += operators[p + k] * old[j] + operators[q + k] * kicked[j]
                new += operators[s + k] * x[members[first + j]]
            v[members[first + i]] += new / decay


@kernel
def drive_value(coefficients, rate, time):
    """The input's spline at one time."""
    i = min(int(time * rate), coefficients.shape[0] - 1)
    s = time - i / rate
    c = coefficients[i]
    return ((c[0] * s + c[1]) * s + c[2]) * s + c[3]


@kernel
def record(x, y, vx, vy, nodes, weights, rest_x, rest_y, half, out):
    """Displacement of the readouts at a whole step, from positions half a step ahead."""
    for r in range(nodes.shape[0]):
        ux = 0.0
        uy = 0.0
        for k in range(2):
            i = nodes[r, k]
            ux += weights[r, k] * (x[i] - half * vx[i] - rest_x[i])
            uy += weights[r, k] * (y[i] - half * vy[i] - rest_y[i])
        out[r, 0] = ux
        out[r, 1] = uy


@kernel
def in_bounds(vx, vy, limit):
    """Whether every velocity is finite and below the limit."""
    for i in range(vx.shape[0]):
        if not (abs(vx[i]) < limit and abs(vy[i]) < limit):
            return False
    return True


@kernel
def advance(chain, work, coefficients, joints, drive, readouts, scalars, per_sample, first, out):
    """Record, then integrate to the next sample, for each sample of `out`.

    Args:
        chain: x, y (m; half a step ahead of the time) and vx, vy (m/s), each (n,).
        work: tx, ty, inverse, fx, fy (n - 1,); moment and outer force in x and y (n,).
        coefficients, joints: see `_coefficients` and `joint_operators`.
        drive: spline coefficients, (intervals, 4).
        readouts: nodes, weights (readouts, 2), rest x, rest y (n,).
        scalars: drive rate, tension ramp, step, velocity limit, decay per step.
        per_sample: steps between samples.
        first: number of the first sample of `out`.
        out: (samples, readouts, 2), filled.

    Returns:
        How many samples were recorded before the run became unstable.
    """
    x, y, vx, vy = chain
    tx, ty, inverse, fx, fy, moment, outer_x, outer_y = work
    axial, edge, bend3, kick_x, kick_y, pull_x, pull_y, loaded, load_x, load_y = coefficients
    a_nodes, b_nodes, p, q, s, share_a, share_b, starts, members, offsets, operators = joints
    nodes, weights, rest_x, rest_y = readouts
    drive_rate, ramp_time, step, limit, decay = scalars
    # views are made once: at a few hundred elements they would cost a fifth of the step
    x0, x1, y0, y1 = x[:-1], x[1:], y[:-1], y[1:]
    tx0, tx1, ty0, ty1 = tx[:-1], tx[1:], ty[:-1], ty[1:]
    moment0, moment1, inner_moment, inner_bend = moment[:-1], moment[1:], moment[1:-1], bend3[1:-1]
    xi, yi, vxi, vyi = x[1:-1], y[1:-1], vx[1:-1], vy[1:-1]
    fx0, fx1, fy0, fy1 = fx[:-1], fx[1:], fy[:-1], fy[1:]
    kxi, kyi, oxi, oyi = kick_x[1:-1], kick_y[1:-1], outer_x[1:-1], outer_y[1:-1]
    old, kicked = np.zeros(members.shape[0]), np.zeros(members.shape[0])
    for sample in range(out.shape[0]):
        record(x, y, vx, vy, nodes, weights, rest_x, rest_y, 0.5 * step, out[sample])
        if not in_bounds(vx, vy, limit):
            return sample
        start = (first + sample) * per_sample
        ramp = min(1.0, start * step / ramp_time) if ramp_time > 0.0 else 1.0
        for i in range(outer_x.shape[0]):
            outer_x[i] = ramp * pull_x[i]
            outer_y[i] = ramp * pull_y[i]
        for k in range(start, start + per_sample):
            u = drive_value(drive, drive_rate, (k + 0.5) * step)
            for i in range(loaded.shape[0]):
                n = loaded[i]
                outer_x[n] = ramp * pull_x[n] + u * load_x[i]
                outer_y[n] = ramp * pull_y[n] + u * load_y[i]
            stretch_pass(x0, x1, y0, y1, tx, ty, inverse)
            moment_pass(tx0, tx1, ty0, ty1, inner_bend, inner_moment)
            force_pass(tx, ty, inverse, axial, edge, moment0, moment1, fx, fy)
            pair_pass(
                x, vx, fx, outer_x, kick_x, a_nodes, b_nodes, p, q, s, share_a, share_b, decay
            )
            pair_pass(
                y, vy, fy, outer_y, kick_y, a_nodes, b_nodes, p, q, s, share_a, share_b, decay
            )
            if starts.shape[0] > 1:
                group_pass(
                    x, vx, fx, outer_x, kick_x, starts, members, offsets, operators, decay, old,
                    kicked,
                )  # fmt: skip
                group_pass(
                    y, vy, fy, outer_y, kick_y, starts, members, offsets, operators, decay, old,
                    kicked,
                )  # fmt: skip
            kick_pass(xi, vxi, fx0, fx1, oxi, kxi, decay, step)
            kick_pass(yi, vyi, fy0, fy1, oyi, kyi, decay, step)
    return out.shape[0]
