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
from fiberweb.engines.energy import (
    BOOKING,
    drive_value,
    in_bounds,
    joint_energy,
    joint_power,
    outer_work,
    record,
    squared_speed,
)
from fiberweb.engines.cosserat_passes import (
    couple_pass,
    drift_pass,
    filter_loss,
    rotate_pass,
    spin_pass,
    squared_spin,
    strain_energy,
    stress_pass,
    velocity_pass,
)
from fiberweb.engines.jit import entry, kernel
from fiberweb.engines.laplace import (
    GAP,
    REACH,
    filter_stencil,
    filter_views,
    filtered_points,
    laplace_filter,
)
from fiberweb.engines.layout import Layout, Strips, lay_out, packed, strips
from fiberweb.model.mesh import Mesh

SHEAR_FACTOR = 27.0 / 28.0  # alpha_c of a round section at Poisson's ratio 1/2, as PyElastica's
PACKAGES = ("numba", "numpy")
NANOSECONDS = 4.0  # of CPU an element and step: `make bench`
PLANAR, MODELS_SHEAR = True, True
MESH_ERRORS = {}  # none on record for the described setup


def largest_step(mesh: Mesh) -> float:
    """The largest stable step (s); see `fiberweb.engines.stability`."""
    from fiberweb.engines import stability

    return stability.largest_step(mesh, "cosserat")


def refuse(mesh: Mesh) -> None:
    """Raise ValueError if the scene needs what this engine does not model."""
    if np.isinf(mesh.joint_stiffness).any():
        raise ValueError(
            f"crossing_stiffness = {mesh.scene.crossing_stiffness}: the cosserat and elastica "
            "engines need a finite spring; use engine = 'kirchhoff'"
        )
    shortest = np.diff(mesh.first).min() - 1
    if mesh.scene.filter_order and shortest <= REACH + 1:
        raise ValueError(
            f"filter_order = {mesh.scene.filter_order}: the filter needs fibres of at least "
            f"{REACH + 2} elements, and the shortest has {shortest}; raise elements_per_section"
        )


def integrate(mesh: Mesh, numerics: Numerics) -> Recording:
    """Integrate a mesh in the plane; see the module's docstring for the model.

    Raises:
        ValueError: crossings without compliance.
    """
    refuse(mesh)
    scene, layout = mesh.scene, lay_out(mesh, GAP)
    per_sample = steps_per_sample(scene, numerics.time_step)
    step = 1.0 / (scene.sample_rate * per_sample)
    nodes, weights = readout_arrays(mesh)
    strip = strips(mesh, layout, REACH)
    angle = np.arctan2(np.diff(layout.y), np.diff(layout.x))
    angle[angle < -np.pi + 1e-6] += 2 * np.pi  # a fibre along -x must not straddle the cut
    angle = angle[strip.edges]
    rest_x, rest_y = packed(layout.x[strip.nodes], layout.y[strip.nodes])
    still = np.zeros(len(strip.nodes))
    state = packed(
        rest_x, rest_y, still, still, angle, np.zeros(len(angle)), np.cos(angle), np.sin(angle)
    )
    state[0][strip.place[layout.at]] += mesh.start[:, 0]
    state[1][strip.place[layout.at]] += mesh.start[:, 1]
    work = packed(*[still] * 8)
    node_arrays, element_arrays, books = coefficients(mesh, layout, strip, step)
    joints = strip.place[layout.joints].astype(np.uint64)
    ties = (joints, mesh.joint_stiffness, mesh.joint_damping)
    readouts = (strip.place[layout.at[nodes]], weights, rest_x, rest_y)
    limit = RUNAWAY * scene.wave_speed
    decay = np.exp(-scene.damping * step)
    scalars = (scene.drive_rate, scene.tension_ramp, step, limit, decay)
    inner_nodes, inner_elements = filtered_points(layout)
    ends = (strip.place[layout.at[at]] for at in (mesh.first[:-1], mesh.first[1:] - 1))
    filtering = (
        scene.filter_order, 4.0 * filter_stencil(scene.filter_order),
        *packed(0.25 * inner_nodes[strip.nodes], 0.25 * inner_elements[strip.edges]),
        *(rows[:: strip.stride].astype(np.uint64) for rows in ends),
    )  # fmt: skip

    def advance_to(first, displacement, energy):
        return advance(
            state, work, node_arrays, element_arrays, ties, filtering, mesh.drive,
            readouts, books, scalars, strip.stride, per_sample, first, displacement, energy,
        )  # fmt: skip

    return record_in_chunks(scene, len(nodes), advance_to)


def coefficients(mesh: Mesh, layout: Layout, strip: Strips, step: float):
    """What the kernel multiplies with, over nodes and over elements, and what its books need."""
    scene = mesh.scene
    inertia_per_length = scene.density * np.pi * scene.diameter**4 / 64
    inertia = inertia_per_length * layout.edge
    uniform, stretched = rotation_damping(mesh, layout, inertia)
    load_x, load_y = layout.load_x[strip.nodes], layout.load_y[strip.nodes]
    loaded = np.flatnonzero(load_x**2 + load_y**2)
    over_nodes = (
        step * layout.free_x / layout.mass, step * layout.free_y / layout.mass,
        layout.pull_x, layout.pull_y, scene.bending_stiffness * layout.bends / layout.span,
        0.5 / layout.voronoi,
    )  # fmt: skip
    over_elements = (
        layout.edge, layout.solid / layout.edge, np.exp(-uniform * step), stretched * step
    )  # fmt: skip
    node_arrays = (
        *packed(*(a[strip.nodes] for a in over_nodes)), loaded, load_x[loaded], load_y[loaded]
    )  # fmt: skip
    element_arrays = (
        *packed(*(a[strip.edges] for a in over_elements)), scene.axial_stiffness,
        scene.axial_stiffness / 3.0 * SHEAR_FACTOR, 1.0 / inertia_per_length,
    )  # fmt: skip
    of_elements = (layout.solid * inertia)[strip.edges], uniform[strip.edges]
    books = (np.zeros(2), layout.mass[strip.nodes], of_elements[0], scene.damping, of_elements[1])
    return node_arrays, element_arrays, books


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


@entry
def advance(
    state, work, node_arrays, element_arrays, ties, filtering, drive, readouts, books, scalars,
    stride, per_sample, first, out, energy,
):  # fmt: skip
    """Record, then integrate to the next sample, for each sample of `out`.

    Args:
        state: x, y (m; half a step ahead of the time), vx, vy (m/s), each (n,); angle, angular
            velocity, cosine, sine, each (n - 1,).
        work: scratch, nine arrays of (n,) and the filter's.
        node_arrays, element_arrays, books: see `coefficients`.
        ties: joints, their stiffness and damping.
        filtering: order and weights of the filter, where it acts on nodes and on elements, and
            where rows of first and of last nodes of fibres begin.
        drive, readouts, scalars, stride, per_sample, first, out, energy: as in the kirchhoff
            engine.

    Returns:
        How many samples were recorded before the run became unstable.
    """
    x, y, vx, vy, angle, omega, c, s = state
    fx, fy, length, alpha = work[0][stride:], work[1][stride:], work[2][stride:], work[3][stride:]
    couple, outer_x, outer_y, scratch = work[4], work[5], work[6], work[7]
    kick_x, kick_y, pull_x, pull_y, bend, half_over_voronoi, loaded, load_x, load_y = node_arrays
    edge, over_edge, spin_decay, stretched, axial, shear, over_inertia = element_arrays
    joints, stiffness, damping = ties
    order, stencil, quarter_node, quarter_element, firsts, lasts = filtering
    last_elements = lasts - np.uint64(stride)
    at, weights, rest_x, rest_y = readouts
    done, mass, inertia, rate, spin_rate = books
    drive_rate, ramp_time, step, limit, decay = scalars
    filtered = order > 0
    old_x, old_y, old_o = vx.copy(), vy.copy(), omega.copy()
    was_x, was_y, was_o = vx.copy(), vy.copy(), omega.copy()
    every = max(1, int(BOOKING / step))
    # Views are made once: at a few hundred elements they would cost a fifth of the step. They leave
    # out all ghosts before and after the chain but those that an element reaches.
    low, high = (REACH - 1) * stride, x.shape[0] - (REACH - 1) * stride
    a, b = slice(low, high - stride), slice(low + stride, high)
    inner, before = slice(b.start, a.stop), slice(low, a.stop - stride)
    x0, x1, y0, y1, vx0, vx1, vy0, vy1 = x[a], x[b], y[a], y[b], vx[a], vx[b], vy[a], vy[b]
    angle_a, omega_a, c_a, s_a, alpha_a = angle[a], omega[a], c[a], s[a], alpha[a]
    edge_a, over_edge_a = edge[a], over_edge[a]
    spin_decay_a, stretched_a = spin_decay[a], stretched[a]
    fx_a, fy_a, length_a, couple0, couple1 = fx[a], fy[a], length[a], couple[a], couple[b]
    angle0, angle1, length0, length1 = angle[before], angle[inner], length[before], length[inner]
    fx0, fx1, fy0, fy1 = fx[before], fx[inner], fy[before], fy[inner]
    inner_bend, inner_half, inner_couple = bend[inner], half_over_voronoi[inner], couple[inner]
    vxi, vyi, oxi, oyi = vx[inner], vy[inner], outer_x[inner], outer_y[inner]
    kxi, kyi, xi, yi, short = kick_x[inner], kick_y[inner], x[inner], y[inner], scratch[:-stride]
    views_x = filter_views(vx, quarter_node, scratch, stride)
    views_y = filter_views(vy, quarter_node, scratch, stride)
    views_omega = filter_views(omega, quarter_element, short, stride)
    for sample in range(out.shape[0]):
        record(x, y, vx, vy, at, weights, rest_x, rest_y, 0.5 * step, out[sample])
        here_x, here_y = x - 0.5 * step * vx, y - 0.5 * step * vy
        here_angle = angle - 0.5 * step * omega
        energy[sample, 0] = 0.5 * squared_speed(vx, vy, mass) + 0.5 * squared_spin(omega, inertia)
        energy[sample, 1] = strain_energy(
            here_x, here_y, here_angle, node_arrays, element_arrays, stride
        )
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
                x0, x1, y0, y1, vx0, vx1, vy0, vy1, omega_a, c_a, s_a, edge_a, over_edge_a, axial,
                shear, over_inertia, fx_a, fy_a, length_a, alpha_a,
            )  # fmt: skip
            couple_pass(angle0, angle1, length0, length1, inner_bend, inner_half, inner_couple)
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
            # looked at in the middle of each interval, whose length it stands for
            begun = (k - start) // every * every
            count = min(every, per_sample - begun)
            booked = k - start == begun + count // 2
            if booked and filtered:
                old_x[:] = vx
                old_y[:] = vy
                old_o[:] = omega
            velocity_pass(vxi, fx0, fx1, oxi, kxi, decay)
            velocity_pass(vyi, fy0, fy1, oyi, kyi, decay)
            spin_pass(
                omega_a, alpha_a, couple0, couple1, length_a, over_edge_a, spin_decay_a,
                stretched_a, over_inertia, step,
            )  # fmt: skip
            if booked:
                span = count * step
                lost = rate * squared_speed(vx, vy, mass)
                for i in range(omega.shape[0]):
                    lost += inertia[i] * spin_rate[i] * omega[i] * omega[i]
                lost += joint_power(vx, vy, joints, damping)
                if filtered:
                    was_x[:] = vx
                    was_y[:] = vy
                    was_o[:] = omega
            if filtered:
                laplace_filter(views_x, firsts, lasts, stencil, scratch, stride)
                laplace_filter(views_y, firsts, lasts, stencil, scratch, stride)
                laplace_filter(views_omega, firsts, last_elements, stencil, short, stride)
            if booked:
                if filtered:
                    # of leapfrog's kick, what the filter takes away never became work
                    lost += filter_loss(was_x, old_x, vx, mass) / step
                    lost += filter_loss(was_y, old_y, vy, mass) / step
                    lost += filter_loss(was_o, old_o, omega, inertia) / step
                done[1] += span * lost
            for i in range(loaded.shape[0]):
                m = loaded[i]
                done[0] += 0.5 * step * u * (load_x[i] * vx[m] + load_y[i] * vy[m])
            drift_pass(xi, vxi, step)
            drift_pass(yi, vyi, step)
            rotate_pass(angle_a, omega_a, c_a, s_a, step)
    return out.shape[0]
