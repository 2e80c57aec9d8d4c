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
its force implies; an infinite stiffness makes the nodes one point. The damping of all velocities
is exact in the same way (`fiberweb.engines.stepping.damped_kick`).

References: Bergou et al., Discrete elastic rods, ACM Trans. Graph. 27 (2008), for the chain;
Hochbruck and Ostermann, Exponential integrators, Acta Numerica 19 (2010), for the damper;
Timoshenko, Strength of Materials I (1930), for the three-moment theorem.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import diags_array

from fiberweb.engines import crossings, energy, stepping, ties, viscosity, viscosity_mild
from fiberweb.engines import kirchhoff_passes as passes
from fiberweb.engines.base import Numerics, Recording, record_in_chunks
from fiberweb.engines.jit import entry, kernel
from fiberweb.engines.kirchhoff_stiffness import GAP, fourth_order_layout, spline_matrix
from fiberweb.engines.kirchhoff_stiffness import largest_step as largest_step
from fiberweb.engines.layout import Interleaving, Layout, interleave, lay_out, packed
from fiberweb.model.mesh import Mesh

PACKAGES = ("numba", "numpy")
NANOSECONDS = 3.0  # measured by `make bench`, networks of 4x4 to 8x8
PLANAR, MODELS_SHEAR = True, False
# The worse of 4x4 and 8x8 of 0.5 m at B = 0.8, over 1 s and over 50 s. Source: speed_accuracy.csv.
MESH_ERRORS = {2: (0.14, 0.015), 4: (0.016, 0.002), 8: (0.0017, 0.0005), 16: (0.0002, 0.0003)}


def refuse(mesh: Mesh) -> None:
    """Raise ValueError if the scene needs what this engine does not model."""
    scene = mesh.scene
    if scene.filter_order:
        raise ValueError(
            f"filter_order = {scene.filter_order}: the kirchhoff engine has no Laplace filter; "
            "use engine = 'cosserat'"
        )
    if scene.dead_band:
        raise ValueError(
            f"dead_band = {scene.dead_band}: the kirchhoff engine has no rotations to have one; "
            "use engine = 'cosserat', or dead_band = False"
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
        ValueError: the scene has a Laplace filter or a dead band, or is the published setup.
    """
    refuse(mesh)
    layout = fourth_order_layout(mesh) if order == 4 else lay_out(mesh, GAP)
    interleaving = interleave(mesh, layout, GAP)
    chain = mesh, layout, interleaving
    timing = stepping.build_stepping(mesh, numerics, interleaving)
    read = stepping.build_readouts(*chain)
    still = np.zeros(len(interleaving.nodes))
    state = passes.State(*packed(read.rest_x, read.rest_y, still, still))
    stepping.displace(state, *chain)
    (mass,) = packed(layout.mass[interleaving.nodes])
    tied = ties.build_ties(*chain, "spline" if order == 4 else "chain")
    touched = ties.touched(tied, interleaving.stride)
    arguments = (
        state, _scratch(state, interleaving.stride), coefficients(*chain, timing.step, order),
        *crossings.joint_operators(*chain, timing.step), stepping.build_guides(*chain), tied,
        viscosity.build_viscosity(*chain, order, timing.step),
        stepping.build_forcing(*chain, touched), read, energy.build_ledger(*chain, mass), timing,
    )  # fmt: skip

    def advance_to(first, displacement, energies):
        return advance(*arguments, first, displacement, energies)

    return record_in_chunks(mesh.scene, len(read.nodes), advance_to)


def _scratch(state: passes.State, stride: int) -> passes.Scratch:
    """Room for the passes, with the inverse lengths of a state's edges."""
    blocks = packed(*np.zeros((10, len(state.x))))
    scratch = passes.Scratch(*(block[stride:] for block in blocks[:6]), *blocks[6:])
    edge_x, edge_y = (a[stride:] - a[:-stride] for a in (state.x, state.y))
    scratch.inverse[:] = 1.0 / np.hypot(edge_x, edge_y)
    return scratch


def coefficients(
    mesh: Mesh, layout: Layout, interleaving: Interleaving, step: float, order: int
) -> passes.Rods:
    """What the passes multiply with."""
    kick = stepping.damped_kick(mesh.scene.damping, step)
    matrix = diags_array(layout.span * layout.bends) + (order == 4) * spline_matrix(layout)
    fibres = mesh.scene.fibres
    stiffness = diags_array(fibres.bending_stiffness[layout.fibre]) @ matrix
    over_edges = fibres.axial_stiffness[layout.fibre[:-1]] * layout.solid, layout.edge
    over_nodes = (
        layout.bends / layout.span, *(np.r_[stiffness.diagonal(k), np.zeros(k)] for k in range(3)),
        kick * layout.free_x / layout.mass, kick * layout.free_y / layout.mass,
    )  # fmt: skip
    arrays = packed(
        *(a[interleaving.edges] for a in over_edges), *(a[interleaving.nodes] for a in over_nodes)
    )
    decay = np.exp(-mesh.scene.damping * step)
    rods = passes.Rods(*arrays, half=0.5 if order == 4 else 0.0, decay=decay)
    if np.array_equal(rods.kick_x, rods.kick_y):  # the same in x and in y: one array less to load
        rods = rods._replace(kick_y=rods.kick_x)
    return rods


@kernel
def tie(merged, pairs, groups, relative, before, kicked, state, step):
    """Change velocities and positions after the kick to what crossings make of them."""
    x, y, vx, vy = state
    crossings.merge_pass(merged, x, y, vx, vy)
    crossings.pair_pass(pairs, relative, x, y, vx, vy, step)
    crossings.group_pass(groups, before.vx, before.x, kicked, x, vx, step)
    crossings.group_pass(groups, before.vy, before.y, kicked, y, vy, step)


@entry
def advance(
    state, scratch, rods, merged, pairs, groups, guides, tied, viscous, forcing, readouts, ledger,
    timing, first, out, energies,
):  # fmt: skip
    """Record, then integrate to the next sample, for each sample of `out`.

    Args:
        state, scratch, rods, merged, pairs, groups, guides, tied, viscous, forcing, readouts,
            ledger, timing: see the classes of these names, `Ties`, `Viscosity` and, of the last,
            `Stepping`.
        first: number of the first sample of `out`.
        out: displacement, (samples, readouts, 2), filled.
        energies: kinetic, elastic, work done, dissipated (samples, 4), filled.

    Returns:
        How many samples were recorded before the run became unstable.
    """
    x, y, vx, vy = state
    step, per_sample, limit, stride = timing
    outer_x, outer_y = scratch.outer_x, scratch.outer_y
    stretch, turn, tension, moment, force, kick_x, kick_y = passes.pass_views(
        state, scratch, rods, stride
    )
    relative = crossings.no_motion(pairs.a.shape[0])
    before, kicked = crossings.no_motion(groups.members.shape[0]), np.zeros(groups.members.shape[0])
    mean_x, mean_y = vx.copy(), vy.copy()
    carried, damped = tied.motor.nodes.shape[0] > 0, viscous.moment.shape[0] > 0
    if damped:  # kept at every step, and no longer needed when the mean is
        mean_x, mean_y = viscous.before_x, viscous.before_y
    bonded, still = tied.bonds.a.shape[0] > 0, np.zeros(vx.shape[0])
    since = ties.grown(forcing, first * per_sample, step)  # what u grew by in the step before
    damping = viscosity.views(viscous, scratch, rods, state, stride)
    viscous_power = viscosity.power_views(viscous, mean_x, mean_y, stride)
    curvatures = viscous.curvatures
    mild = curvatures.last.shape[0] > 0
    if mild and first == 0:  # at rest, until now
        passes.stretch_pass(*stretch)
        passes.turn_pass(*turn)
        now = scratch.curvature
        energy.keep(now, now, curvatures.last, curvatures.earlier)
    every = 1 if damped else energy.interval_steps(step)  # what is stiff dissipates by jerks
    for sample in range(out.shape[0]):
        start = (first + sample) * per_sample
        stepping.record(state, readouts, 0.5 * step, out[sample])
        ramp = stepping.ramp_at(start * step, forcing.ramp_time)
        pulled = passes.record_energy(
            energies[sample], state, scratch, rods, tied, forcing, readouts, ledger, timing,
            ramp,
        )  # fmt: skip
        if not stepping.in_bounds(vx, vy, limit):
            return sample
        # between samples a growing pull holds its mean, and is entered where it changes
        grown = stepping.ramp_at((start + per_sample) * step, forcing.ramp_time)
        held = 0.5 * (ramp + grown)
        stepping.apply_pull(forcing, held, outer_x, outer_y)
        energy.enter_ramp(ledger, ramp - held, pulled)
        crossings.gather_pairs(pairs, relative, x, y, vx, vy)
        for k in range(start, start + per_sample):
            u = stepping.drive_value(forcing.drive, forcing.drive_rate, (k + 0.5) * step)
            stepping.apply_forces(forcing, held, u, outer_x, outer_y)
            ties.spring_forces(tied.springs, x, y, outer_x, outer_y)
            if bonded:
                ties.chord_bonds(tied.bonds, x, y, outer_x, outer_y, stride)
            energy.enter_drive(ledger, forcing, 0.5 * step * u, vx, vy)
            passes.stretch_pass(*stretch)
            passes.turn_pass(*turn)
            passes.tension_pass(*tension, rods.half)
            if mild:
                viscosity_mild.lead_pass(scratch.curvature, curvatures)
            passes.moment_pass(*moment)
            passes.force_pass(*force)
            crossings.gather_groups(groups, before, x, y, vx, vy)
            due = energy.steps_due(k - start, every, per_sample)
            if due:
                energy.keep(vx, vy, mean_x, mean_y)
            if carried:  # before the kick, which decays and drifts them
                after = (k + 1.5) * step
                following = stepping.drive_value(forcing.drive, forcing.drive_rate, after)
                ties.carry(tied.motor, x, y, vx, vy, following, step * rods.decay)
            passes.kick_pass(*kick_x, rods.decay, step)
            passes.kick_pass(*kick_y, rods.decay, step)
            if not damped:
                tie(merged, pairs, groups, relative, before, kicked, state, step)
            elif tied.merged:  # made one point last, so that they are
                viscosity.foresee(viscous, vx, vy)
                viscosity.damp(viscous, damping, step, stride)
                viscosity.take_back(viscous, vx, vy)
                tie(merged, pairs, groups, relative, before, kicked, state, step)
                viscosity.learn(viscous, vx, vy)
            else:  # springs first, or viscous stresses after them would limit the step
                viscosity.foresee(viscous, vx, vy)
                tie(merged, pairs, groups, relative, before, kicked, state, step)
                viscosity.take_back(viscous, vx, vy)
                viscosity.damp(viscous, damping, step, stride)
                viscosity.learn(viscous, vx, vy)
                crossings.gather_pairs(pairs, relative, x, y, vx, vy)
            if carried:
                mean = 0.5 * (since + following - u)
                fx, fy = scratch.tension, scratch.length  # as `force_pass` leaves them
                work = ties.motor_work(tied.motor, fx, fy, outer_x, outer_y, mean, stride)
                energy.enter_work(ledger, work)
                if damped:
                    fx, fy = viscous.force_x, viscous.force_y
                    work = ties.motor_work(tied.motor, fx, fy, still, still, mean, stride)
                    energy.enter_work(ledger, work)
                since = following - u
            stepping.guide(guides, x, y, vx, vy, step)
            energy.enter_drive(ledger, forcing, 0.5 * step * u, vx, vy)
            if due:  # at the mean velocity, of which times the step a force's work is
                squared = energy.average(mean_x, mean_y, vx, vy, ledger.mass)
                lost = ledger.damping * squared + energy.joint_power(ledger, mean_x, mean_y)
                if damped:
                    lost += viscosity.edge_power(*viscous_power)
                if mild:
                    led = scratch.curvature
                    lost += viscosity_mild.bending_power(led, curvatures, rods, step, stride)
                energy.enter_dissipation(ledger, due * step, lost)
        if grown > ramp:
            pulled = energy.pull_work(x - 0.5 * step * vx, y - 0.5 * step * vy, readouts, forcing)
            energy.enter_ramp(ledger, held - grown, pulled)
    return out.shape[0]
