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
    steps_per_sample,
)
from fiberweb.engines.jit import kernel
from fiberweb.engines.kirchhoff import CHUNK, drive_value, in_bounds, record
from fiberweb.engines.layout import Layout, lay_out
from fiberweb.mesh import Mesh

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
    out = np.full((scene.samples, len(nodes), 2), np.nan)
    state, arrays = State(layout), _coefficients(mesh, layout, step)
    limit = RUNAWAY * scene.wave_speed
    for done in range(0, scene.samples, CHUNK):
        part = out[done : done + CHUNK]
        good = advance(
            state.nodes, state.elements, state.work, arrays.nodes, arrays.elements, arrays.joints,
            arrays.inside, mesh.drive, (layout.at[nodes], weights, layout.x, layout.y),
            (scene.drive_rate, scene.tension_ramp, step, limit, arrays.decay),
            scene.filter_order, per_sample, done, part,
        )  # fmt: skip
        if good < len(part):
            out[done + good :] = np.nan
            return Recording(out, (done + good) / scene.sample_rate)
    return Recording(out, None)


class State:
    """Positions, angles and velocities over the padded chain, and the passes' scratch."""

    def __init__(self, layout: Layout):
        size = len(layout.x)
        angle = np.arctan2(np.diff(layout.y), np.diff(layout.x))
        angle[angle < -np.pi + 1e-6] += 2 * np.pi  # a fibre along -x must not straddle the cut
        self.nodes = (layout.x.copy(), layout.y.copy(), np.zeros(size), np.zeros(size))
        self.elements = (angle, np.zeros(size - 1), np.cos(angle), np.sin(angle))
        self.work = tuple(np.zeros(size - 1) for _ in range(7)) + tuple(
            np.zeros(size) for _ in range(2)
        )


class _coefficients:
    """Everything constant that the kernel multiplies with."""

    def __init__(self, mesh: Mesh, layout: Layout, step: float):
        scene = mesh.scene
        self.decay = np.exp(-scene.damping * step)
        axial = scene.axial_stiffness * layout.solid
        shear = axial / 3.0 * SHEAR_FACTOR
        inertia = scene.density * np.pi * scene.diameter**4 / 64 * layout.edge
        uniform, stretched = rotation_damping(mesh, layout, inertia)
        loaded = np.flatnonzero(layout.load_x**2 + layout.load_y**2)
        self.nodes = (
            step * layout.free_x / layout.mass, step * layout.free_y / layout.mass,
            layout.pull_x, layout.pull_y, layout.bend, 1.0 / layout.voronoi,
            loaded, layout.load_x[loaded], layout.load_y[loaded],
        )  # fmt: skip
        self.elements = (
            axial, shear, layout.edge, layout.solid / inertia,
            np.exp(-uniform * step), stretched * step,
        )  # fmt: skip
        self.joints = (
            layout.joints, mesh.joint_stiffness, mesh.joint_damping,
            np.zeros((len(layout.joints), 2)),
        )  # fmt: skip
        # where the filter acts: not on a fibre's first and last node or element
        fibre = layout.solid > 0
        inner_node = np.zeros(len(layout.x))
        inner_node[1:-1] = fibre[1:] & fibre[:-1]
        inner_element = np.zeros(len(fibre))
        inner_element[1:-1] = fibre[1:-1] & fibre[2:] & fibre[:-2]
        self.inside = (inner_node, inner_element)


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
    x0, x1, y0, y1, vx0, vx1, vy0, vy1, omega, c, s, axial, shear, edge, over_inertia,
    fx, fy, length, dilatation, alpha,
):  # fmt: skip
    """Forces in the elements, and the angular acceleration from shear and stretching."""
    for i in range(fx.shape[0]):
        dx = x1[i] - x0[i]
        dy = y1[i] - y0[i]
        l = np.sqrt(dx * dx + dy * dy)
        e = l / edge[i]
        n3 = axial[i] * ((dx * c[i] + dy * s[i]) / edge[i] - 1.0)
        ns = shear[i] * ((dy * c[i] - dx * s[i]) / edge[i])
        nx = n3 * c[i] - ns * s[i]
        ny = n3 * s[i] + ns * c[i]
        fx[i] = nx / e
        fy[i] = ny / e
        length[i] = l
        dilatation[i] = e
        couple = (dx * ny - dy * nx) / l * edge[i]
        rate = (dx * (vx1[i] - vx0[i]) + dy * (vy1[i] - vy0[i])) / (l * edge[i])
        alpha[i] = couple * e * over_inertia[i] + omega[i] * rate / e


@kernel
def couple_pass(angle0, angle1, length0, length1, bend, over_voronoi, couple):
    """Bending couple at inner nodes."""
    for i in range(couple.shape[0]):
        e = 0.5 * (length0[i] + length1[i]) * over_voronoi[i]
        couple[i] = bend[i] * (angle1[i] - angle0[i]) / (e * e * e)


@kernel
def velocity_pass(v, f0, f1, pull, kick, ramp, decay):
    """Kick and damp one direction of the nodes' velocities."""
    for i in range(v.shape[0]):
        v[i] = decay * (v[i] + kick[i] * (f1[i] - f0[i] + ramp * pull[i]))


@kernel
def spin_pass(omega, alpha, couple0, couple1, dilatation, over_inertia, decay, stretched, step):
    """Kick and damp the angular velocities; the damper's power of dilatation as a series."""
    for i in range(omega.shape[0]):
        e = dilatation[i]
        new = omega[i] + step * (alpha[i] + (couple1[i] - couple0[i]) * e * over_inertia[i])
        a = stretched[i] * (e - 1.0)
        omega[i] = new * decay[i] * (1.0 - a * (1.0 - a * (0.5 - a / 6.0)))


@kernel
def rotate_pass(angle, omega, c, s, step):
    """Turn each element by step times omega: series for sine and cosine of a small angle."""
    for i in range(angle.shape[0]):
        d = step * omega[i]
        angle[i] += d
        q = d * d
        sd = d * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0)))
        cd = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0)))
        new = c[i] * cd - s[i] * sd
        s[i] = s[i] * cd + c[i] * sd
        c[i] = new


@kernel
def drift_pass(x, v, step):
    """Positions by velocities."""
    for i in range(x.shape[0]):
        x[i] += step * v[i]


@kernel
def difference_pass(left, middle, right, inside, out):
    """Minus a quarter of the second difference, zero at the ends of fibres."""
    for i in range(out.shape[0]):
        out[i] = inside[i] * 0.25 * (2.0 * middle[i] - left[i] - right[i])


@kernel
def subtract_pass(rate, term):
    """Take the filtered-out part away."""
    for i in range(rate.shape[0]):
        rate[i] -= term[i]


@kernel
def laplace_filter(rate, inside, order, a, b):
    """Jeanmart-Winckelmans filter: what is left of `rate` after `order` second differences is
    taken away."""
    n = rate.shape[0]
    a[:] = rate
    for _ in range(order):
        difference_pass(a[: n - 2], a[1 : n - 1], a[2:], inside[1 : n - 1], b[1 : n - 1])
        b[0] = 0.0
        b[n - 1] = 0.0
        a, b = b, a
    subtract_pass(rate, a)


@kernel
def joint_forces(x, y, vx, vy, joints, stiffness, damping, force):
    """Spring and damper between the two nodes of each joint."""
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        force[j, 0] = stiffness[j] * (x[b] - x[a]) + damping[j] * (vx[b] - vx[a])
        force[j, 1] = stiffness[j] * (y[b] - y[a]) + damping[j] * (vy[b] - vy[a])


@kernel
def point_kicks(vx, vy, kick_x, kick_y, joints, force, loaded, load_x, load_y, u, decay):
    """Add what joints and drive do to velocities that have been kicked by all else."""
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        vx[a] += decay * kick_x[a] * force[j, 0]
        vy[a] += decay * kick_y[a] * force[j, 1]
        vx[b] -= decay * kick_x[b] * force[j, 0]
        vy[b] -= decay * kick_y[b] * force[j, 1]
    for i in range(loaded.shape[0]):
        n = loaded[i]
        vx[n] += decay * kick_x[n] * u * load_x[i]
        vy[n] += decay * kick_y[n] * u * load_y[i]


@kernel
def advance(
    nodes, elements, work, node_arrays, element_arrays, joint_arrays, inside, drive, readouts,
    scalars, order, per_sample, first, out,
):  # fmt: skip
    """Record, then integrate to the next sample, for each sample of `out`.

    Args:
        nodes: x, y (m; half a step ahead of the time), vx, vy (m/s), each (n,).
        elements: angle, angular velocity, cosine, sine, each (n - 1,).
        work: fx, fy, length, dilatation, alpha and two scratch (n - 1,); two scratch (n,).
        node_arrays, element_arrays, joint_arrays, inside: see `_coefficients`.
        drive, readouts, scalars, per_sample, first, out: as in the kirchhoff engine.
        order: of the Laplace filter.

    Returns:
        How many samples were recorded before the run became unstable.
    """
    x, y, vx, vy = nodes
    angle, omega, c, s = elements
    fx, fy, length, dilatation, alpha, ea, eb, na, nb = work
    kick_x, kick_y, pull_x, pull_y, bend, over_voronoi, loaded, load_x, load_y = node_arrays
    axial, shear, edge, over_inertia, spin_decay, stretched = element_arrays
    joints, stiffness, damping, force = joint_arrays
    inner_node, inner_element = inside
    at, weights, rest_x, rest_y = readouts
    drive_rate, ramp_time, step, limit, decay = scalars
    couple = np.zeros(x.shape[0])
    for sample in range(out.shape[0]):
        record(x, y, vx, vy, at, weights, rest_x, rest_y, 0.5 * step, out[sample])
        if not in_bounds(vx, vy, limit):
            return sample
        c[:] = np.cos(angle)  # the running product drifts by round-off
        s[:] = np.sin(angle)
        start = (first + sample) * per_sample
        for k in range(start, start + per_sample):
            time = (k + 0.5) * step
            ramp = 1.0 if time >= ramp_time else time / ramp_time
            stress_pass(
                x[:-1], x[1:], y[:-1], y[1:], vx[:-1], vx[1:], vy[:-1], vy[1:], omega, c, s,
                axial, shear, edge, over_inertia, fx, fy, length, dilatation, alpha,
            )  # fmt: skip
            couple_pass(
                angle[:-1], angle[1:], length[:-1], length[1:], bend[1:-1], over_voronoi[1:-1],
                couple[1:-1],
            )  # fmt: skip
            joint_forces(x, y, vx, vy, joints, stiffness, damping, force)
            velocity_pass(vx[1:-1], fx[:-1], fx[1:], pull_x[1:-1], kick_x[1:-1], ramp, decay)
            velocity_pass(vy[1:-1], fy[:-1], fy[1:], pull_y[1:-1], kick_y[1:-1], ramp, decay)
            spin_pass(
                omega, alpha, couple[:-1], couple[1:], dilatation, over_inertia, spin_decay,
                stretched, step,
            )  # fmt: skip
            u = drive_value(drive, drive_rate, time)
            point_kicks(vx, vy, kick_x, kick_y, joints, force, loaded, load_x, load_y, u, decay)
            if order > 0:
                laplace_filter(vx, inner_node, order, na, nb)
                laplace_filter(vy, inner_node, order, na, nb)
                laplace_filter(omega, inner_element, order, ea, eb)
            drift_pass(x, vx, step)
            drift_pass(y, vy, step)
            rotate_pass(angle, omega, c, s, step)
    return out.shape[0]
