"""Planar Cosserat rods: PyElastica's discrete equations with motion confined to the plane.

Each element has, besides its edge, an angle and an angular velocity of its own, so that it
can shear; stresses, dilatation factors, dampers, the Laplace filter and the order of
operations within a step are PyElastica's, and trajectories agree with it to round-off.
Leapfrog: the two half drifts of its position Verlet are joined into one.

References: Gazzola et al., R. Soc. Open Sci. 5, 171628 (2018), Eqs. 3.3 to 3.11;
Jeanmart and Winckelmans, Phys. Fluids 19, 055110 (2007), for the filter.
"""

from __future__ import annotations

import numpy as np

from fiberweb.engines.base import (
    RUNAWAY,
    Numerics,
    Recording,
    readout_arrays,
    record_in_chunks,
    steps_per_sample,
)
from fiberweb.engines.jit import kernel, summing
from fiberweb.engines.kirchhoff import (
    BOOKING,
    drive_value,
    in_bounds,
    joint_energy,
    joint_power,
    outer_work,
    record,
    squared_speed,
)
from fiberweb.engines.layout import Layout, lay_out
from fiberweb.mesh import Mesh

MARGIN = 32  # room for the filter's odd continuation beyond a fibre's ends
SHEAR_FACTOR = 27.0 / 28.0  # alpha_c of a round section at Poisson's ratio 1/2, as PyElastica's


def refuse(mesh: Mesh) -> None:
    """Raise ValueError if the scene needs what this engine does not model."""
    if np.isinf(mesh.joint_stiffness).any():
        raise ValueError(
            f"crossing_stiffness = {mesh.scene.crossing_stiffness}: the cosserat and elastica "
            "engines need a finite spring; use engine = 'kirchhoff'"
        )


def integrate(mesh: Mesh, numerics: Numerics) -> Recording:
    """Integrate a mesh in the plane; see the module's docstring for the model.

    Raises:
        ValueError: crossings without compliance.
    """
    refuse(mesh)
    scene, layout = mesh.scene, lay_out(mesh)
    per_sample = steps_per_sample(scene, numerics.time_step)
    step = 1.0 / (scene.sample_rate * per_sample)
    nodes, weights = readout_arrays(mesh)
    size = len(layout.x)
    angle = np.arctan2(np.diff(layout.y), np.diff(layout.x))
    angle[angle < -np.pi + 1e-6] += 2 * np.pi  # a fibre along -x must not straddle the cut
    state = (
        layout.x.copy(), layout.y.copy(), np.zeros(size), np.zeros(size),
        angle, np.zeros(size - 1), np.cos(angle), np.sin(angle),
    )  # fmt: skip
    work = (*(np.zeros(size) for _ in range(9)), np.zeros((3, size + 2 * MARGIN)))
    node_arrays, element_arrays, books = coefficients(mesh, layout, step)
    ties = (layout.joints, mesh.joint_stiffness, mesh.joint_damping)
    readouts = (layout.at[nodes], weights, layout.x, layout.y)
    limit = RUNAWAY * scene.wave_speed
    decay = np.exp(-scene.damping * step)
    scalars = (scene.drive_rate, scene.tension_ramp, step, limit, decay)
    fibres = (layout.at[mesh.first[:-1]], layout.at[mesh.first[1:] - 1])
    stencil = filter_stencil(scene.filter_order)

    def advance_to(first, displacement, energy):
        return advance(
            state, work, node_arrays, element_arrays, ties, fibres, stencil, mesh.drive,
            readouts, books, scalars, per_sample, first, displacement, energy,
        )  # fmt: skip

    return record_in_chunks(scene, len(nodes), advance_to)


def coefficients(mesh: Mesh, layout: Layout, step: float):
    """What the kernel multiplies with, over nodes and over elements, and what its books need."""
    scene = mesh.scene
    axial = scene.axial_stiffness * layout.solid
    inertia = scene.density * np.pi * scene.diameter**4 / 64 * layout.edge
    uniform, stretched = rotation_damping(mesh, layout, inertia)
    loaded = np.flatnonzero(layout.load_x**2 + layout.load_y**2)
    node_arrays = (
        step * layout.free_x / layout.mass, step * layout.free_y / layout.mass,
        layout.pull_x, layout.pull_y, scene.bending_stiffness * layout.bends / layout.span,
        0.5 / layout.voronoi, loaded, layout.load_x[loaded], layout.load_y[loaded],
    )  # fmt: skip
    element_arrays = (
        axial, axial / 3.0 * SHEAR_FACTOR, layout.edge, 1.0 / layout.edge,
        layout.solid / inertia, np.exp(-uniform * step), stretched * step,
    )  # fmt: skip
    books = (np.zeros(2), layout.mass, layout.solid * inertia, scene.damping, uniform)
    return node_arrays, element_arrays, books


def filter_stencil(order: int) -> np.ndarray:
    """Weights of order - 1 applications of minus a quarter of the second difference, from the
    centre outwards, shape (order,); empty without a filter."""
    weights = np.ones(1)
    for _ in range(order - 1):
        weights = np.convolve(weights, [-0.25, 0.5, -0.25])
    return weights[len(weights) // 2 :] if order else np.zeros(0)


def rotation_damping(mesh: Mesh, layout: Layout, inertia: np.ndarray):
    """Rates (1/s) at which angular velocities decay: at rest, and per unit of dilatation.

    The authors' damper divides by the inertia in mm-g-s units: 4 / r^2 times the rate on
    velocities with r in mm, to the power of the dilatation. The described one is uniform.
    """
    scene = mesh.scene
    if scene.setup == "described":
        return np.full(len(inertia), scene.damping), np.zeros(len(inertia))
    in_mm_g = 1e9  # kg m^2 -> g mm^2
    mass = 1e3 * layout.mass
    element = 0.5 * (mass[1:] + mass[:-1])
    first = np.r_[False, layout.solid[:-1] == 0]
    last = np.r_[layout.solid[1:] == 0, False]
    element += 0.5 * mass[:-1] * first + 0.5 * mass[1:] * last
    rate = scene.damping * element / (inertia * in_mm_g)
    return rate, rate


@kernel
def stress_pass(
    x0, x1, y0, y1, vx0, vx1, vy0, vy1, omega, c, s, axial, shear, edge, over_edge, over_inertia,
    fx, fy, length, dilatation, alpha,
):  # fmt: skip
    """Forces in the elements, and the angular acceleration from shear and stretching."""
    for i in range(fx.shape[0]):
        dx = x1[i] - x0[i]
        dy = y1[i] - y0[i]
        q = dx * dx + dy * dy
        r = 1.0 / np.sqrt(q)
        over_e = edge[i] * r
        e = q * r * over_edge[i]
        n3 = axial[i] * ((dx * c[i] + dy * s[i]) * over_edge[i] - 1.0)
        ns = shear[i] * ((dy * c[i] - dx * s[i]) * over_edge[i])
        nx = n3 * c[i] - ns * s[i]
        ny = n3 * s[i] + ns * c[i]
        fx[i] = nx * over_e
        fy[i] = ny * over_e
        length[i] = q * r
        dilatation[i] = e
        couple = (dx * ny - dy * nx) * over_e
        rate = (dx * (vx1[i] - vx0[i]) + dy * (vy1[i] - vy0[i])) * r * r
        alpha[i] = couple * e * over_inertia[i] + omega[i] * rate


@kernel
def couple_pass(angle0, angle1, length0, length1, bend, half_over_voronoi, couple):
    """Bending couple at inner nodes."""
    for i in range(couple.shape[0]):
        e = (length0[i] + length1[i]) * half_over_voronoi[i]
        couple[i] = bend[i] * (angle1[i] - angle0[i]) / (e * e * e)


@kernel
def velocity_pass(v, f0, f1, outer, kick, decay):
    """Kick and damp one direction of the nodes' velocities."""
    for i in range(v.shape[0]):
        v[i] = decay * (v[i] + kick[i] * (f1[i] - f0[i] + outer[i]))


@kernel
def drift_pass(x, v, step):
    """Positions by velocities."""
    for i in range(x.shape[0]):
        x[i] += step * v[i]


@kernel
def spin_pass(omega, alpha, couple0, couple1, dilatation, over_inertia, decay, stretched, step):
    """Kick and damp the angular velocities; the damper's power of dilatation as a series."""
    for i in range(omega.shape[0]):
        e = dilatation[i]
        new = omega[i] + step * (alpha[i] + (couple1[i] - couple0[i]) * e * over_inertia[i])
        a = stretched[i] * (e - 1.0)
        omega[i] = new * decay[i] * (1.0 - a * (1.0 - a * (0.5 - a * (1.0 / 6.0))))


@kernel
def rotate_pass(angle, omega, c, s, step):
    """Turn each element by step times omega: series for sine and cosine of a small angle."""
    for i in range(angle.shape[0]):
        d = step * omega[i]
        angle[i] += d
        q = d * d
        sine = d * (1.0 - q * (1 / 6) * (1.0 - q * (1 / 20) * (1.0 - q * (1 / 42))))
        cosine = 1.0 - q * 0.5 * (1.0 - q * (1 / 12) * (1.0 - q * (1 / 30) * (1.0 - q * (1 / 56))))
        new = c[i] * cosine - s[i] * sine
        s[i] = s[i] * cosine + c[i] * sine
        c[i] = new


@kernel
def difference_pass(left, middle, right, out):
    """Minus a quarter of the second difference."""
    for i in range(out.shape[0]):
        out[i] = 0.25 * (2.0 * middle[i] - left[i] - right[i])


@kernel
def stencil_pass(rate, f, l1, r1, l2, r2, l3, r3, l4, r4, l5, r5, w):
    """Take the 11-point sum of f from the rate."""
    for i in range(rate.shape[0]):
        near = w[0] * f[i] + w[1] * (l1[i] + r1[i]) + w[2] * (l2[i] + r2[i])
        rate[i] -= near + w[3] * (l3[i] + r3[i]) + w[4] * (l4[i] + r4[i]) + w[5] * (l5[i] + r5[i])


@kernel
def laplace_filter(rate, first, last, weights, scratch):
    """Jeanmart-Winckelmans filter of one fibre: what is left of `rate` between `first` and
    `last`, its two ends, after `order` second differences is taken away.

    PyElastica sets each difference to zero at the ends. So the first difference, continued
    beyond them as an odd function, has its own further differences everywhere, and those are
    one stencil.
    """
    order = weights.shape[0]
    m = MARGIN
    count = last - first + 1
    f = scratch[: count + 2 * m]
    difference_pass(
        rate[first : last - 1], rate[first + 1 : last], rate[first + 2 : last + 1],
        f[m + 1 : m + count - 1],
    )  # fmt: skip
    f[m] = 0.0
    f[m + count - 1] = 0.0
    for k in range(1, order):
        f[m - k] = -f[m + min(k, count - 1)]
        f[m + count - 1 + k] = -f[m + count - 1 - min(k, count - 1)]
    target = rate[first + 1 : last]
    a, b = m + 1, m + count - 1
    if order == 6:
        stencil_pass(
            target, f[a:b], f[a - 1 : b - 1], f[a + 1 : b + 1], f[a - 2 : b - 2],
            f[a + 2 : b + 2], f[a - 3 : b - 3], f[a + 3 : b + 3], f[a - 4 : b - 4],
            f[a + 4 : b + 4], f[a - 5 : b - 5], f[a + 5 : b + 5], weights,
        )  # fmt: skip
        return
    for i in range(target.shape[0]):
        total = weights[0] * f[a + i]
        for k in range(1, order):
            total += weights[k] * (f[a + i - k] + f[a + i + k])
        target[i] -= total


@kernel
def outer_forces(x, y, vx, vy, joints, stiffness, damping, pull_x, pull_y, ramp, outer_x, outer_y):
    """Pull, and spring and damper of the crossings, at the nodes that have any."""
    for j in range(joints.shape[0]):
        for k in range(2):
            n = joints[j, k]
            outer_x[n] = ramp * pull_x[n]
            outer_y[n] = ramp * pull_y[n]
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        fx = stiffness[j] * (x[b] - x[a]) + damping[j] * (vx[b] - vx[a])
        fy = stiffness[j] * (y[b] - y[a]) + damping[j] * (vy[b] - vy[a])
        outer_x[a] += fx
        outer_y[a] += fy
        outer_x[b] -= fx
        outer_y[b] -= fy


@kernel
def strain_energy(x, y, angle, node_arrays, element_arrays):
    """Elastic energy of the fibres (J): the potential of stretch, and of shear and bending to
    leading order in the stretch, whose factors in PyElastica's equations have none."""
    bend, half_over_voronoi = node_arrays[4], node_arrays[5]
    axial, shear, edge, over_edge = element_arrays[:4]
    total, before = 0.0, 0.0
    for i in range(angle.shape[0]):
        dx, dy = x[i + 1] - x[i], y[i + 1] - y[i]
        length = np.sqrt(dx * dx + dy * dy)
        c, s = np.cos(angle[i]), np.sin(angle[i])
        along = (dx * c + dy * s) * over_edge[i]
        across = (dy * c - dx * s) * over_edge[i]
        if axial[i] > 0.0:
            total += axial[i] * edge[i] * (along - 1.0 - np.log(along))
            total += 0.5 * shear[i] * edge[i] * across * across
        if i > 0 and bend[i] > 0.0:
            e = (before + length) * half_over_voronoi[i]
            total += 0.5 * bend[i] * (angle[i] - angle[i - 1]) ** 2 / (e * e * e)
        before = length
    return total


@summing
def squared_spin(omega, weight):
    """Sum of weight times omega^2."""
    total = 0.0
    for i in range(omega.shape[0]):
        total += weight[i] * omega[i] * omega[i]
    return total


@kernel
def advance(
    state, work, node_arrays, element_arrays, ties, fibres, stencil, drive, readouts, books,
    scalars, per_sample, first, out, energy,
):  # fmt: skip
    """Record, then integrate to the next sample, for each sample of `out`.

    Args:
        state: x, y (m; half a step ahead of the time), vx, vy (m/s), each (n,); angle, angular
            velocity, cosine, sine, each (n - 1,).
        work: scratch, nine arrays of (n,) and the filter's.
        node_arrays, element_arrays, books: see `coefficients`.
        ties: joints, their stiffness and damping.
        fibres: first and last node of each.
        stencil: see `filter_stencil`.
        drive, readouts, scalars, per_sample, first, out, energy: as in the kirchhoff engine.

    Returns:
        How many samples were recorded before the run became unstable.
    """
    x, y, vx, vy, angle, omega, c, s = state
    fx, fy, length = work[0][1:], work[1][1:], work[2][1:]
    dilatation, alpha, couple = work[3][1:], work[4][1:], work[5]
    outer_x, outer_y, scratch = work[6], work[7], work[9]
    kick_x, kick_y, pull_x, pull_y, bend, half_over_voronoi, loaded, load_x, load_y = node_arrays
    axial, shear, edge, over_edge, over_inertia, spin_decay, stretched = element_arrays
    joints, stiffness, damping = ties
    firsts, lasts = fibres
    at, weights, rest_x, rest_y = readouts
    done, mass, inertia, rate, spin_rate = books
    drive_rate, ramp_time, step, limit, decay = scalars
    filtered = stencil.shape[0] > 0
    every = max(1, int(BOOKING / step))
    for sample in range(out.shape[0]):
        record(x, y, vx, vy, at, weights, rest_x, rest_y, 0.5 * step, out[sample])
        here_x, here_y = x - 0.5 * step * vx, y - 0.5 * step * vy
        here_angle = angle - 0.5 * step * omega
        energy[sample, 0] = 0.5 * squared_speed(vx, vy, mass) + 0.5 * squared_spin(omega, inertia)
        energy[sample, 1] = strain_energy(here_x, here_y, here_angle, node_arrays, element_arrays)
        energy[sample, 1] += joint_energy(here_x, here_y, joints, stiffness)
        start = (first + sample) * per_sample
        ramp = min(1.0, start * step / ramp_time) if ramp_time > 0.0 else 1.0
        pulled = outer_work(here_x - rest_x, here_y - rest_y, pull_x, pull_y)
        energy[sample, 2] = done[0] + ramp * pulled
        energy[sample, 3] = done[1]
        if not in_bounds(vx, vy, limit):
            return sample
        c[:] = np.cos(angle)  # the running product drifts by round-off
        s[:] = np.sin(angle)
        for k in range(start, start + per_sample):
            time = (k + 0.5) * step
            if k == start or ramp < 1.0:
                grown = min(1.0, time / ramp_time) if ramp_time > 0.0 else 1.0
                if grown > ramp:
                    done[0] -= (grown - ramp) * outer_work(x - rest_x, y - rest_y, pull_x, pull_y)
                ramp = grown
                for i in range(outer_x.shape[0]):
                    outer_x[i] = ramp * pull_x[i]
                    outer_y[i] = ramp * pull_y[i]
            stress_pass(
                x[:-1], x[1:], y[:-1], y[1:], vx[:-1], vx[1:], vy[:-1], vy[1:], omega, c, s,
                axial, shear, edge, over_edge, over_inertia, fx, fy, length, dilatation, alpha,
            )  # fmt: skip
            couple_pass(
                angle[:-1], angle[1:], length[:-1], length[1:], bend[1:-1],
                half_over_voronoi[1:-1], couple[1:-1],
            )  # fmt: skip
            u = drive_value(drive, drive_rate, time)
            for i in range(loaded.shape[0]):
                m = loaded[i]
                outer_x[m] = ramp * pull_x[m]
                outer_y[m] = ramp * pull_y[m]
            outer_forces(
                x, y, vx, vy, joints, stiffness, damping, pull_x, pull_y, ramp, outer_x, outer_y
            )
            for i in range(loaded.shape[0]):
                m = loaded[i]
                outer_x[m] += u * load_x[i]
                outer_y[m] += u * load_y[i]
                done[0] += 0.5 * step * u * (load_x[i] * vx[m] + load_y[i] * vy[m])
            velocity_pass(vx[1:-1], fx[:-1], fx[1:], outer_x[1:-1], kick_x[1:-1], decay)
            velocity_pass(vy[1:-1], fy[:-1], fy[1:], outer_y[1:-1], kick_y[1:-1], decay)
            spin_pass(
                omega, alpha, couple[:-1], couple[1:], dilatation, over_inertia, spin_decay,
                stretched, step,
            )  # fmt: skip
            for i in range(loaded.shape[0]):
                m = loaded[i]
                done[0] += 0.5 * step * u * (load_x[i] * vx[m] + load_y[i] * vy[m]) / decay
            booked = (k - start) % every == 0
            if booked:
                span = min(every, start + per_sample - k) * step
                lost = rate * squared_speed(vx, vy, mass)
                for i in range(omega.shape[0]):
                    lost += inertia[i] * spin_rate[i] * omega[i] * omega[i]
                lost += joint_power(vx, vy, joints, damping)
                if filtered:
                    lost += 0.5 * squared_speed(vx, vy, mass) / step
                    lost += 0.5 * squared_spin(omega, inertia) / step
            if filtered:
                for f in range(firsts.shape[0]):
                    laplace_filter(vx, firsts[f], lasts[f], stencil, scratch[0])
                    laplace_filter(vy, firsts[f], lasts[f], stencil, scratch[1])
                    laplace_filter(omega, firsts[f], lasts[f] - 1, stencil, scratch[2])
            if booked:
                if filtered:
                    lost -= 0.5 * squared_speed(vx, vy, mass) / step
                    lost -= 0.5 * squared_spin(omega, inertia) / step
                done[1] += span * lost
            drift_pass(x, vx, step)
            drift_pass(y, vy, step)
            rotate_pass(angle, omega, c, s, step)
    return out.shape[0]
