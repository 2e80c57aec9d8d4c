"""Planar Kirchhoff rods: no shear, no rotary inertia, no dilatation of the cross-section.

A fibre is a chain of nodes; its energy is that of its edges' stretch and of the angles between
them. Stress is PyElastica's, EA (1 - l0 / l). Bending is fourth order in the element length:

- A beam loaded at its nodes is a cubic spline, and its energy k^T A k EI / 2 follows from the
  turns phi = A k at the nodes by Clapeyron's three-moment matrix A = l tridiag(1/6, 2/3, 1/6).
  The inverse of A is expanded about the lumped lengths S to second order, S^-1 + S^-1 X S^-1 +
  S^-1 X S^-1 X S^-1 with X = S - A, which couples two neighbours on each side. The zeroth
  order is the usual chain, with moment (EI / S) f(phi), where

      f(phi) = 3 sin(phi) / (2 + cos(phi)) = phi (1 - phi^4 / 180 + ...)

  needs one division and no arc tangent and is nowhere stiffer than at phi = 0.
- A curved element is longer than its chord by b^2 / 24, b the angle it turns through. Without
  this the chord's slope alone carries the axial force and the critical load is wrong at second
  order, whatever the bending term: that is why statics ask for another constant than waves.

All is derived from one potential, so leapfrog (PyElastica's position Verlet with its half
drifts joined) keeps energy. Crossings: spring and damper as an exact exponential of the
damper over each step, so that they set no limit and a stiff damper slips at the speed that
its force implies; an infinite stiffness makes the nodes one point.

References: Bergou et al., Discrete elastic rods, ACM Trans. Graph. 27 (2008), for the chain;
Hochbruck and Ostermann, Exponential integrators, Acta Numerica 19 (2010), for the damper;
Timoshenko, Strength of Materials I (1930), for the three-moment theorem.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import expm
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.csgraph import connected_components

from fiberweb.engines.base import (
    RUNAWAY,
    Numerics,
    Recording,
    readout_arrays,
    record_in_chunks,
    steps_per_sample,
)
from fiberweb.engines.jit import kernel, summing
from fiberweb.engines.layout import Layout, lay_out
from fiberweb.mesh import Mesh

BOOKING = 0.25e-3  # s between two looks at what is dissipated: well below a network's periods


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


def integrate(mesh: Mesh, numerics: Numerics, order: int = 4) -> Recording:
    """Integrate a mesh in the plane; see the module's docstring for the model.

    Args:
        mesh, numerics: as for every engine.
        order: 4, or 2 for the usual chain, which is what a Cosserat rod converges to without
            shear on the same mesh.

    Raises:
        ValueError: the scene has a Laplace filter or is the published setup.
    """
    refuse(mesh)
    scene, layout = mesh.scene, lay_out(mesh)
    per_sample = steps_per_sample(scene, numerics.time_step)
    step = 1.0 / (scene.sample_rate * per_sample)
    nodes, weights = readout_arrays(mesh)
    size = len(layout.x)
    state = (layout.x.copy(), layout.y.copy(), np.zeros(size), np.zeros(size))
    decay, chain = coefficients(mesh, layout, step, order)
    joints = joint_operators(mesh, layout, step)
    work = tuple(np.zeros(size) for _ in range(13))
    books = (np.zeros(2), layout.mass, scene.damping, layout.joints, mesh.joint_stiffness,
             mesh.joint_damping)  # fmt: skip
    scalars = (scene.drive_rate, scene.tension_ramp, step, RUNAWAY * scene.wave_speed, decay)
    readouts = (layout.at[nodes], weights, layout.x, layout.y)

    def advance_to(first, displacement, energy):
        return advance(
            state, work, chain, joints, mesh.drive, readouts, books, scalars, per_sample, first,
            displacement, energy,
        )  # fmt: skip

    return record_in_chunks(scene, len(nodes), advance_to)


def coefficients(mesh: Mesh, layout: Layout, step: float, order: int):
    """Decay of a free velocity over a step, and what the kernel multiplies with."""
    half = np.exp(-0.5 * mesh.scene.damping * step)
    stiffness = mesh.scene.bending_stiffness
    loaded = np.flatnonzero(layout.load_x**2 + layout.load_y**2)
    bow = layout.edge * layout.solid if order == 4 else np.zeros(len(layout.edge))
    chain = (
        mesh.scene.axial_stiffness * layout.solid, layout.edge, 0.5 * bow,
        3.0 * stiffness * layout.bends / layout.span, layout.bends / layout.span,
        *(stiffness * band * (order == 4) for band in spline_correction(layout)),
        half * step * layout.free_x / layout.mass, half * step * layout.free_y / layout.mass,
        layout.pull_x, layout.pull_y, loaded, layout.load_x[loaded], layout.load_y[loaded],
    )  # fmt: skip
    return half * half, chain


def spline_correction(layout: Layout):
    """What the spline's energy adds to the lumped one, as a quadratic form in curvatures.

    Returns:
        Diagonal and first and second upper diagonal of X + X S^-1 X (m), each (n,); the entry i
        of a diagonal couples node i with i + 0, 1, 2.
    """
    matrix = spline_matrix(layout)
    return [np.r_[matrix.diagonal(k), np.zeros(k)] for k in range(3)]


def spline_matrix(layout: Layout) -> csr_array:
    """X + X S^-1 X of `spline_correction`, shape (n, n), m."""
    length = layout.edge * layout.solid
    beside = np.r_[0.0, length] + np.r_[length, 0.0]
    both = layout.bends[1:] * layout.bends[:-1]
    excess = layout.bends * (layout.span - beside / 3.0)
    x = csr_array(
        diags_array([excess, -both * length / 6.0, -both * length / 6.0], offsets=[0, 1, -1])
    )
    return csr_array(x + x @ diags_array(1.0 / layout.span) @ x)


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
def stretch_pass(x0, x1, y0, y1, tx, ty, inverse, length):
    """Unit tangents, inverse lengths and lengths of the edges."""
    for i in range(tx.shape[0]):
        dx = x1[i] - x0[i]
        dy = y1[i] - y0[i]
        q = dx * dx + dy * dy
        r = 1.0 / np.sqrt(q)
        tx[i] = dx * r
        ty[i] = dy * r
        inverse[i] = r
        length[i] = q * r


@kernel
def turn_pass(tx0, tx1, ty0, ty1, bend3, over_span, moment, curvature, slope):
    """Lumped moment at inner nodes, sine of the turn over the span, and its derivative."""
    for i in range(moment.shape[0]):
        sine = tx0[i] * ty1[i] - ty0[i] * tx1[i]
        cosine = tx0[i] * tx1[i] + ty0[i] * ty1[i]
        moment[i] = bend3[i] * sine / (2.0 + cosine)
        curvature[i] = over_span[i] * sine
        slope[i] = over_span[i] * cosine


@kernel
def tension_pass(curvature0, curvature1, inverse, length, axial, edge, half, tension, bowing):
    """Tension of each edge with its bow, and the derivative of its energy by curvature."""
    for i in range(tension.shape[0]):
        b = half[i] * (curvature0[i] + curvature1[i])
        longer = b * b * (1.0 / 24.0)
        tension[i] = axial[i] * (1.0 - edge[i] * inverse[i] + longer)
        excess = length[i] - edge[i] + edge[i] * longer
        bowing[i] = axial[i] * excess * half[i] * b * (1.0 / 12.0)


@kernel
def moment_pass(
    moment, slope, c, c_up, c_up2, c_down, c_down2, s, s_up, s_up2, s_down, s_down2,
    bowing0, bowing1,
):  # fmt: skip
    """Add to the lumped moments those of the spline and of the bow."""
    for i in range(moment.shape[0]):
        curved = c[i] * s[i] + (c_up[i] * s_up[i] + c_down[i] * s_down[i])
        curved += c_up2[i] * s_up2[i] + c_down2[i] * s_down2[i]
        moment[i] += slope[i] * (curved + (bowing0[i] + bowing1[i]))


@kernel
def force_pass(tx, ty, inverse, tension, moment0, moment1, fx, fy):
    """Force in each edge: tension along it, moment difference across it."""
    for i in range(fx.shape[0]):
        shear = (moment0[i] - moment1[i]) * inverse[i]
        fx[i] = tension[i] * tx[i] - shear * ty[i]
        fy[i] = tension[i] * ty[i] + shear * tx[i]


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
def outer_work(ux, uy, fx, fy):
    """Work of constant forces over displacements (J)."""
    total = 0.0
    for i in range(ux.shape[0]):
        total += fx[i] * ux[i] + fy[i] * uy[i]
    return total


@kernel
def in_bounds(vx, vy, limit):
    """Whether every velocity is finite and below the limit."""
    for i in range(vx.shape[0]):
        if not (abs(vx[i]) < limit and abs(vy[i]) < limit):
            return False
    return True


@summing
def squared_speed(vx, vy, mass):
    """Sum of m v^2 over all nodes (J)."""
    total = 0.0
    for i in range(vx.shape[0]):
        total += mass[i] * (vx[i] * vx[i] + vy[i] * vy[i])
    return total


@kernel
def joint_power(vx, vy, joints, damping):
    """Power that the crossings' dampers take (W)."""
    total = 0.0
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        total += damping[j] * ((vx[b] - vx[a]) ** 2 + (vy[b] - vy[a]) ** 2)
    return total


@kernel
def joint_energy(x, y, joints, stiffness):
    """Energy of the crossings' springs (J); none where the nodes are one point."""
    total = 0.0
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        if stiffness[j] < np.inf:
            total += 0.5 * stiffness[j] * ((x[b] - x[a]) ** 2 + (y[b] - y[a]) ** 2)
    return total


@kernel
def strain_energy(x, y, chain):
    """Elastic energy of the fibres at given positions (J); the potential of the passes."""
    axial, edge, half, bend3, over_span, c, c_up, c_up2 = chain[:8]
    n = x.shape[0]
    curvature = np.zeros(n)
    total = 0.0
    for i in range(1, n - 1):
        ax, ay, bx, by = x[i] - x[i - 1], y[i] - y[i - 1], x[i + 1] - x[i], y[i + 1] - y[i]
        over = 1.0 / np.sqrt((ax * ax + ay * ay) * (bx * bx + by * by))
        cosine = (ax * bx + ay * by) * over
        curvature[i] = over_span[i] * (ax * by - ay * bx) * over
        total -= bend3[i] * np.log((2.0 + cosine) / 3.0)
    for i in range(n - 1):
        l = np.sqrt((x[i + 1] - x[i]) ** 2 + (y[i + 1] - y[i]) ** 2)
        b = half[i] * (curvature[i] + curvature[i + 1])
        longer = b * b / 24.0
        stretch = l - edge[i] - edge[i] * np.log(l / edge[i])
        total += axial[i] * (stretch + (l - edge[i]) * longer + 0.5 * edge[i] * longer * longer)
    for i in range(n - 2):
        k = curvature[i]
        total += k * (0.5 * c[i] * k + c_up[i] * curvature[i + 1] + c_up2[i] * curvature[i + 2])
    return total


@kernel
def advance(
    state, work, chain, joints, drive, readouts, books, scalars, per_sample, first, out, energy
):
    """Record, then integrate to the next sample, for each sample of `out`.

    Args:
        state: x, y (m; half a step ahead of the time) and vx, vy (m/s), each (n,).
        work: scratch, 13 arrays of (n,).
        chain, joints: see `coefficients` and `joint_operators`.
        drive: spline coefficients, (intervals, 4).
        readouts: nodes, weights (readouts, 2), rest x, rest y (n,).
        books: work done and dissipated so far (2,), mass (n,), damping rate, joints, their
            stiffness and damping.
        scalars: drive rate, tension ramp, step, velocity limit, decay per step.
        per_sample: steps between samples.
        first: number of the first sample of `out`.
        out: displacement, (samples, readouts, 2), filled.
        energy: kinetic, elastic, work done, dissipated (samples, 4), filled.

    Returns:
        How many samples were recorded before the run became unstable.
    """
    x, y, vx, vy = state
    (axial, edge, half, bend3, over_span, c, c_up, c_up2, kick_x, kick_y, pull_x, pull_y,
     loaded, load_x, load_y) = chain  # fmt: skip
    a_nodes, b_nodes, p, q, s, share_a, share_b, starts, members, offsets, operators = joints
    nodes, weights, rest_x, rest_y = readouts
    done, mass, damping, ties, tie_stiffness, tie_damping = books
    drive_rate, ramp_time, step, limit, decay = scalars
    # views are made once: at a few hundred elements they would cost a fifth of the step
    n = x.shape[0]
    x0, x1, y0, y1 = x[:-1], x[1:], y[:-1], y[1:]
    tx, ty, inverse, length = work[0][1:], work[1][1:], work[2][1:], work[3][1:]
    tension, bowing, fx, fy = work[4][1:], work[5][1:], work[6][1:], work[7][1:]
    moment, curvature, slope = work[8], work[9], work[10]
    outer_x, outer_y = work[11], work[12]
    old, kicked = np.zeros(members.shape[0]), np.zeros(members.shape[0])
    every = max(1, int(BOOKING / step))
    for sample in range(out.shape[0]):
        record(x, y, vx, vy, nodes, weights, rest_x, rest_y, 0.5 * step, out[sample])
        here_x, here_y = x - 0.5 * step * vx, y - 0.5 * step * vy
        energy[sample, 0] = 0.5 * squared_speed(vx, vy, mass)
        energy[sample, 1] = strain_energy(here_x, here_y, chain)
        energy[sample, 1] += joint_energy(here_x, here_y, ties, tie_stiffness)
        pulled = outer_work(here_x - rest_x, here_y - rest_y, pull_x, pull_y)
        start = (first + sample) * per_sample
        ramp = min(1.0, start * step / ramp_time) if ramp_time > 0.0 else 1.0
        energy[sample, 2] = done[0] + ramp * pulled
        energy[sample, 3] = done[1]
        if not in_bounds(vx, vy, limit):
            return sample
        # the pull is a potential while it is constant; when it grows, what it holds changes
        grown = min(1.0, (start + per_sample) * step / ramp_time) if ramp_time > 0.0 else 1.0
        for i in range(n):
            outer_x[i] = ramp * pull_x[i]
            outer_y[i] = ramp * pull_y[i]
        for k in range(start, start + per_sample):
            u = drive_value(drive, drive_rate, (k + 0.5) * step)
            for i in range(loaded.shape[0]):
                m = loaded[i]
                outer_x[m] = ramp * pull_x[m] + u * load_x[i]
                outer_y[m] = ramp * pull_y[m] + u * load_y[i]
                done[0] += 0.5 * step * u * (load_x[i] * vx[m] + load_y[i] * vy[m])
            stretch_pass(x0, x1, y0, y1, tx, ty, inverse, length)
            turn_pass(
                tx[:-1], tx[1:], ty[:-1], ty[1:], bend3[1:-1], over_span[1:-1], moment[1:-1],
                curvature[1:-1], slope[1:-1],
            )  # fmt: skip
            tension_pass(
                curvature[:-1], curvature[1:], inverse, length, axial, edge, half, tension, bowing
            )
            moment_pass(
                moment[2:-2], slope[2:-2], c[2:-2], c_up[2:-2], c_up2[2:-2], c_up[1:-3],
                c_up2[: n - 4], curvature[2:-2], curvature[3:-1], curvature[4:], curvature[1:-3],
                curvature[: n - 4], bowing[1:-2], bowing[2:-1],
            )  # fmt: skip
            force_pass(tx, ty, inverse, tension, moment[:-1], moment[1:], fx, fy)
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
            kick_pass(x[1:-1], vx[1:-1], fx[:-1], fx[1:], outer_x[1:-1], kick_x[1:-1], decay, step)
            kick_pass(y[1:-1], vy[1:-1], fy[:-1], fy[1:], outer_y[1:-1], kick_y[1:-1], decay, step)
            for i in range(loaded.shape[0]):
                m = loaded[i]
                done[0] += 0.5 * step * u * (load_x[i] * vx[m] + load_y[i] * vy[m])
            if (k - start) % every == 0:
                span = min(every, start + per_sample - k) * step
                lost = damping * squared_speed(vx, vy, mass)
                done[1] += span * (lost + joint_power(vx, vy, ties, tie_damping))
        if grown > ramp:
            pulled = outer_work(
                x - 0.5 * step * vx - rest_x, y - 0.5 * step * vy - rest_y, pull_x, pull_y
            )
            done[0] -= (grown - ramp) * pulled
    return out.shape[0]
