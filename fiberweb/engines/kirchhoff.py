"""Planar Kirchhoff rods: no shear, no rotary inertia, no dilatation of the cross-section.

A fibre is a chain of nodes; its energy is that of its edges' stretch and of the angles between
them. Stress is PyElastica's, EA (1 - l0 / l). Bending is fourth order in the element length:

- A beam loaded at its nodes is a cubic spline, and its energy k^T A k EI / 2 follows from the
  turns phi = A k at the nodes by Clapeyron's three-moment matrix A = l tridiag(1/6, 2/3, 1/6).
  The inverse of A is expanded about the lumped lengths S to second order, S^-1 + S^-1 X S^-1 +
  S^-1 X S^-1 X S^-1 with X = S - A, which couples two neighbours on each side. The zeroth
  order is the usual chain, with moment (EI / S) f(phi), where

      f(phi) = sin(phi) (1 + w / 3 + 2 w^2 / 15) = phi (1 - phi^6 / 140 + ...), w = 1 - cos(phi)

  needs neither division nor arc tangent and is nowhere stiffer than at phi = 0.
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

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_array, diags_array

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
from fiberweb.engines.crossings import (
    group_pass,
    joint_operators,
    look_at_groups,
    look_at_pairs,
    pair_pass,
)
from fiberweb.engines.jit import entry, kernel
from fiberweb.engines.kirchhoff_passes import (
    edge_views,
    force_pass,
    kick_pass,
    moment_pass,
    strain_energy,
    stretch_pass,
    tension_pass,
    turn_pass,
)
from fiberweb.engines.layout import Layout, Strips, lay_out, packed, strips
from fiberweb.model.mesh import Mesh

GAP = 2  # ghosts between fibres: the moment reaches two nodes beyond its own
PACKAGES = ("numba", "numpy")
NANOSECONDS = 3.0  # of CPU an element and step: `make bench`
PLANAR, MODELS_SHEAR = True, False
# rms error of the trajectories, and the larger of the errors of C_nl and C_m, by elements per
# section at B = 0.8: the worse of 4x4 and 8x8 in speed_accuracy.csv
MESH_ERRORS = {2: (0.14, 0.015), 4: (0.016, 0.002), 8: (0.0017, 0.0005), 16: (0.0002, 0.0003)}


def largest_step(mesh: Mesh) -> float:
    """The largest stable step (s); see `fiberweb.engines.stability`."""
    from fiberweb.engines import stability

    return stability.largest_step(mesh, "kirchhoff")


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
    scene, layout = mesh.scene, fourth_order_layout(mesh) if order == 4 else lay_out(mesh, GAP)
    per_sample = steps_per_sample(scene, numerics.time_step)
    step = 1.0 / (scene.sample_rate * per_sample)
    nodes, weights = readout_arrays(mesh)
    strip = strips(mesh, layout, GAP)
    rest_x, rest_y, mass = packed(*(a[strip.nodes] for a in (layout.x, layout.y, layout.mass)))
    still = np.zeros(len(strip.nodes))
    state = packed(rest_x, rest_y, still, still)
    state[0][strip.place[layout.at]] += mesh.start[:, 0]
    state[1][strip.place[layout.at]] += mesh.start[:, 1]
    decay, chain = coefficients(mesh, layout, strip, step, order)
    joints = joint_operators(mesh, layout, strip, step)
    work = packed(*[still] * 10)
    edge_x, edge_y = (a[strip.stride :] - a[: -strip.stride] for a in state[:2])
    work[2][strip.stride :] = 1.0 / np.hypot(edge_x, edge_y)
    books = (np.zeros(2), mass, scene.damping, strip.place[layout.joints], mesh.joint_stiffness,
             mesh.joint_damping)  # fmt: skip
    scalars = (scene.drive_rate, scene.tension_ramp, step, RUNAWAY * scene.wave_speed, decay)
    readouts = (strip.place[layout.at[nodes]], weights, rest_x, rest_y)

    def advance_to(first, displacement, energy):
        return advance(
            state, work, chain, joints, mesh.drive, readouts, books, scalars, strip.stride,
            per_sample, first, displacement, energy,
        )  # fmt: skip

    return record_in_chunks(scene, len(nodes), advance_to)


def fourth_order_layout(mesh: Mesh) -> Layout:
    """The layout with mass lumped to fourth order at free ends.

    Halves at the ends of a fibre are a trapezoid rule. Its error is second order where the
    motion has a slope, at a free end; Gregory's weights of the last three nodes remove it.
    """
    layout = lay_out(mesh, GAP)
    mass = layout.mass.copy()
    for fibre, last in enumerate(layout.at[mesh.first[1:] - 1]):
        edges = mesh.edges(fibre)
        even = len(edges) > 3 and np.allclose(edges[-3:], edges[-1], rtol=1e-6)
        if even and not mesh.held[mesh.first[fibre + 1] - 1].any():
            element = mesh.scene.density * mesh.scene.area * edges[-1]
            mass[last - 2 : last + 1] += element * np.array([-1 / 24, 1 / 6, -1 / 8])
    return replace(layout, mass=mass)


def coefficients(mesh: Mesh, layout: Layout, strip: Strips, step: float, order: int):
    """Decay of a free velocity over a step, and what the kernel multiplies with."""
    half = np.exp(-0.5 * mesh.scene.damping * step)
    stiffness = mesh.scene.bending_stiffness
    load_x, load_y = layout.load_x[strip.nodes], layout.load_y[strip.nodes]
    loaded = np.flatnonzero(load_x**2 + load_y**2)
    matrix = diags_array(layout.span * layout.bends) + (order == 4) * spline_matrix(layout)
    bands = [np.r_[(stiffness * matrix).diagonal(k), np.zeros(k)] for k in range(3)]
    over_edges = mesh.scene.axial_stiffness * layout.solid, layout.edge
    over_nodes = (
        layout.bends / layout.span, *bands, half * step * layout.free_x / layout.mass,
        half * step * layout.free_y / layout.mass, layout.pull_x, layout.pull_y,
    )  # fmt: skip
    chain = (
        *packed(*(a[strip.edges] for a in over_edges), *(a[strip.nodes] for a in over_nodes)),
        loaded, load_x[loaded], load_y[loaded], 0.5 if order == 4 else 0.0,
    )  # fmt: skip
    if np.array_equal(chain[6], chain[7]):  # the same kick in x and in y: one array less to load
        chain = (*chain[:7], chain[6], *chain[8:])
    return half * half, chain


def spline_matrix(layout: Layout) -> csr_array:
    """What the spline's energy adds to the lumped one as a quadratic form in curvatures, X +
    X S^-1 X, shape (n, n), m."""
    length = layout.edge * layout.solid
    beside = np.r_[0.0, length] + np.r_[length, 0.0]
    both = layout.bends[1:] * layout.bends[:-1]
    excess = layout.bends * (layout.span - beside / 3.0)
    x = csr_array(
        diags_array([excess, -both * length / 6.0, -both * length / 6.0], offsets=[0, 1, -1])
    )
    matrix = (x + x @ diags_array(1.0 / layout.span) @ x).tolil()
    # At a wall the expansion does not converge with the mesh; this makes statics exact there.
    wall = np.outer([3.0, -4.0, 1.0], [3.0, -4.0, 1.0]) / 108.0
    clamps = np.flatnonzero((layout.bends[1:-1] > 0) & (layout.solid[:-1] == 0)) + 1
    for i in clamps:
        if layout.bends[i : i + 3].all() and np.allclose(length[i : i + 3], length[i], rtol=1e-6):
            matrix[i : i + 3, i : i + 3] += length[i] * wall
    return csr_array(matrix)


@kernel
def pass_views(state, work, chain, s):
    """The shifted parts of the arrays that each pass runs over, in the order of its arguments.

    Made once a call: within the loop over steps they would cost as much as a pass.
    """
    x, y, vx, vy = state
    tx, ty, inverse, fy, fx, bowing = edge_views(work, s)
    k, moment, outer_x, outer_y = work[6:]
    axial, edge, over_span, c, c_up, c_up2, kick_x, kick_y = chain[:8]
    n = x.shape[0]
    inner, two = slice(s, n - s), slice(2 * s, n - 2 * s)
    return (
        (x[:-s], x[s:], y[:-s], y[s:], tx, ty, inverse, fy),
        (tx[:-s], tx[s:], ty[:-s], ty[s:], over_span[inner], k[inner], moment[inner]),
        (k[:-s], k[s:], inverse, fy, axial, edge, fx, bowing),
        (moment[two], c[two], c_up[two], c_up2[two], c_up[s : n - 3 * s],
         c_up2[: n - 4 * s], k[two], k[3 * s : n - s], k[4 * s :], k[s : n - 3 * s],
         k[: n - 4 * s], bowing[s : n - 3 * s], bowing[2 * s : n - 2 * s]),
        (tx, ty, inverse, moment[:-s], moment[s:], fx, fy),
        (x[inner], vx[inner], fx[:-s], fx[s:], outer_x[inner], kick_x[inner]),
        (y[inner], vy[inner], fy[:-s], fy[s:], outer_y[inner], kick_y[inner]),
    )  # fmt: skip


@entry
def advance(
    state, work, chain, joints, drive, readouts, books, scalars, stride, per_sample, first, out,
    energy,
):  # fmt: skip
    """Record, then integrate to the next sample, for each sample of `out`.

    Args:
        state: x, y (m; half a step ahead of the time) and vx, vy (m/s), each (n,).
        work: scratch, 10 arrays of (n,); the third starts with the inverse lengths of edges.
        chain, joints: see `coefficients` and `joint_operators`.
        drive: spline coefficients, (intervals, 4).
        readouts: nodes, weights (readouts, 4), rest x, rest y (n,).
        books: work done and dissipated so far (2,), mass (n,), damping rate, joints, their
            stiffness and damping.
        scalars: drive rate, tension ramp, step, velocity limit, decay per step.
        stride: how far apart neighbours are, see `Strips`.
        per_sample: steps between samples.
        first: number of the first sample of `out`.
        out: displacement, (samples, readouts, 2), filled.
        energy: kinetic, elastic, work done, dissipated (samples, 4), filled.

    Returns:
        How many samples were recorded before the run became unstable.
    """
    x, y, vx, vy = state
    pull_x, pull_y, loaded, load_x, load_y, half = chain[8:]
    pairs, groups = joints[:7], joints[7:]
    members = groups[1]
    motion = np.zeros((4, pairs[0].shape[0]))
    before, kicked = np.zeros((4, members.shape[0])), np.zeros(members.shape[0])
    before_x, before_y = before[:2], before[2:]
    nodes, weights, rest_x, rest_y = readouts
    done, mass, damping, ties, tie_stiffness, tie_damping = books
    drive_rate, ramp_time, step, limit, decay = scalars
    n = x.shape[0]
    outer_x, outer_y = work[8], work[9]
    stretch, turn, tightness, bending, force, x_kick, y_kick = pass_views(
        state, work, chain, stride
    )
    every = max(1, int(BOOKING / step))
    for sample in range(out.shape[0]):
        record(x, y, vx, vy, nodes, weights, rest_x, rest_y, 0.5 * step, out[sample])
        here_x, here_y = x - 0.5 * step * vx, y - 0.5 * step * vy
        energy[sample, 0] = 0.5 * squared_speed(vx, vy, mass)
        energy[sample, 1] = strain_energy(here_x, here_y, chain, work, stride)
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
        held = 0.5 * (ramp + grown)
        for i in range(n):
            outer_x[i] = held * pull_x[i]
            outer_y[i] = held * pull_y[i]
        done[0] += (ramp - held) * pulled
        look_at_pairs(pairs, motion, x, y, vx, vy)
        for k in range(start, start + per_sample):
            u = drive_value(drive, drive_rate, (k + 0.5) * step)
            for i in range(loaded.shape[0]):
                m = loaded[i]
                outer_x[m] = held * pull_x[m] + u * load_x[i]
                outer_y[m] = held * pull_y[m] + u * load_y[i]
                done[0] += 0.5 * step * u * (load_x[i] * vx[m] + load_y[i] * vy[m])
            stretch_pass(*stretch)
            turn_pass(*turn)
            tension_pass(*tightness, half)
            moment_pass(*bending)
            force_pass(*force)
            look_at_groups(members, before, x, y, vx, vy)
            kick_pass(*x_kick, decay, step)
            kick_pass(*y_kick, decay, step)
            pair_pass(pairs, motion, x, y, vx, vy, step)
            group_pass(groups, before_x, kicked, x, vx, step)
            group_pass(groups, before_y, kicked, y, vy, step)
            for i in range(loaded.shape[0]):
                m = loaded[i]
                done[0] += 0.5 * step * u * (load_x[i] * vx[m] + load_y[i] * vy[m])
            # looked at in the middle of each interval, whose length it stands for
            begun = (k - start) // every * every
            count = min(every, per_sample - begun)
            if k - start == begun + count // 2:
                span = count * step
                lost = damping * squared_speed(vx, vy, mass)
                done[1] += span * (lost + joint_power(vx, vy, ties, tie_damping))
        if grown > ramp:
            pulled = outer_work(
                x - 0.5 * step * vx - rest_x, y - 0.5 * step * vy - rest_y, pull_x, pull_y
            )
            done[0] += (held - grown) * pulled
    return out.shape[0]
