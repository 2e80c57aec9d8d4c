"""Planar Cosserat rods: PyElastica's discrete equations with motion confined to the plane.

Each element has, besides its edge, an angle and an angular velocity of its own, so that it
can shear; stresses, dilatation factors, dampers, the Laplace filter and the order of
operations within a step are PyElastica's, and trajectories agree with it to round-off; the
other setups make its damper exact (`kick_before_decay`).
Leapfrog: the two half drifts of its position Verlet are joined into one.

References: Gazzola et al., R. Soc. Open Sci. 5, 171628 (2018), Eqs. 3.3 to 3.11;
Jeanmart and Winckelmans, Phys. Fluids 19, 055110 (2007), for the filter.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fiberweb.engines import (
    authors_rotations,
    energy,
    laplace,
    stepping,
    ties,
    viscosity,
    viscosity_elements,
)
from fiberweb.engines import cosserat_passes as passes
from fiberweb.engines.base import Numerics, Recording, record_in_chunks
from fiberweb.engines.cosserat_stiffness import largest_step as largest_step
from fiberweb.engines.cosserat_stiffness import rotary_inertia, shear_stiffness
from fiberweb.engines.jit import entry
from fiberweb.engines.laplace import GAP, REACH
from fiberweb.engines.layout import Interleaving, Layout, interleave, lay_out, packed
from fiberweb.model.mesh import Mesh
from fiberweb.model.scene import Scene

PACKAGES = ("numba", "numpy")
NANOSECONDS = 4.0  # measured by `make bench`, with the filter
PLANAR, MODELS_SHEAR = True, True
MESH_ERRORS = {}


def refuse(mesh: Mesh) -> None:
    """Raise ValueError if the scene needs what this engine does not model."""
    if np.isinf(mesh.joint_stiffness).any():
        raise ValueError(
            f"crossing_stiffness = {mesh.scene.crossing_stiffness}: the cosserat and elastica "
            "engines need a finite spring; give one, or use engine = 'kirchhoff'"
        )
    shortest = np.diff(mesh.first).min() - 1
    if mesh.scene.filter_order and shortest <= REACH + 1:
        raise ValueError(
            f"filter_order = {mesh.scene.filter_order}: the filter needs fibres of at least "
            f"{REACH + 2} elements, and the shortest has {shortest}; raise elements_per_section"
        )


def integrate(mesh: Mesh, numerics: Numerics, watch: Callable | None = None) -> Recording:
    """Integrate a mesh in the plane; see the module's docstring for the model.

    Args:
        mesh, numerics: as for every engine.
        watch: called every `CHUNK` samples with the number of the next one, and angle (rad) and
            squared length of the directors of every element, in the mesh's order.

    Raises:
        ValueError: crossings without compliance.
    """
    refuse(mesh)
    layout = lay_out(mesh, GAP)
    interleaving = interleave(mesh, layout, REACH)
    chain = mesh, layout, interleaving
    timing = stepping.build_stepping(mesh, numerics, interleaving)
    read = stepping.build_readouts(*chain)
    state = _rest(layout, interleaving)
    stepping.displace(state, *chain)
    blocks = packed(*np.zeros((9, len(state.x))))
    scratch = passes.Scratch(*(block[timing.stride :] for block in blocks[:5]), *blocks[5:])
    tied = ties.build_ties(*chain, "chain")
    arguments = (
        state, scratch, *coefficients(*chain, timing.step), held_at_the_end(*chain),
        stepping.build_guides(*chain), tied, viscosity.build_viscosity(*chain, order=2),
        laplace.build_filtering(*chain),
        stepping.build_forcing(*chain, ties.touched(tied, interleaving.stride)), read,
        energy.build_ledger(*chain, layout.mass[interleaving.nodes]), timing,
    )  # fmt: skip

    elements = interleaving.place[np.delete(layout.at, mesh.first[1:] - 1)]  # by their near node

    def advance_to(first, displacement, energies):
        if watch:
            squared = state.cosine**2 + state.sine**2
            watch(first, state.angle[elements], squared[elements])
        return advance(*arguments, first, displacement, energies)

    return record_in_chunks(mesh.scene, len(read.nodes), advance_to)


def _rest(layout: Layout, interleaving: Interleaving) -> passes.State:
    """The fibres straight and still."""
    angle = np.arctan2(np.diff(layout.y), np.diff(layout.x))
    angle[angle < -np.pi + 1e-6] += 2 * np.pi  # a fibre along -x must not straddle the cut
    angle = angle[interleaving.edges]
    nodes = interleaving.nodes
    still, unturned = np.zeros(len(nodes)), np.zeros(len(angle))
    moving = layout.x[nodes], layout.y[nodes], still, still
    directors = np.array([np.cos(angle), np.sin(angle)])
    directors[abs(directors) < 1e-12] = 0.0  # along the axes they are exact, as the authors' are
    return passes.State(*packed(*moving, angle, unturned, *directors))


def held_at_the_end(mesh: Mesh, layout: Layout, interleaving: Interleaving) -> passes.Held:
    """The nodes that damper and filter see moving, and that stop after them: all that are held in
    the authors' order of operations, none otherwise, where a held node is never kicked."""
    if mesh.scene.setup != "published":
        return passes.Held(*np.zeros((2, 0), dtype=np.uint64))
    held = (np.flatnonzero(of_axis) for of_axis in mesh.held.T)
    return passes.Held(*(interleaving.place[layout.at[at]].astype(np.uint64) for at in held))


def coefficients(
    mesh: Mesh, layout: Layout, interleaving: Interleaving, step: float
) -> tuple[passes.Rods, passes.Spin]:
    """What the passes multiply with, and what the ledger needs beside the nodes' masses."""
    scene, fibres = mesh.scene, mesh.scene.fibres
    inertia = rotary_inertia(mesh)[layout.fibre[:-1]] * layout.edge
    uniform, stretched = rotation_damping(mesh, layout, inertia)
    kick = kick_before_decay(scene, step)
    kick_x, kick_y = kick * layout.free_x / layout.mass, kick * layout.free_y / layout.mass
    if scene.setup == "published":  # see `held_at_the_end`
        kick_x[layout.at] = kick_y[layout.at] = kick / layout.mass[layout.at]
    over_nodes = (
        kick_x, kick_y,
        fibres.bending_stiffness[layout.fibre] * layout.bends / layout.span, 0.5 / layout.voronoi,
    )  # fmt: skip
    of_edge, over_edge = layout.fibre[:-1], layout.solid / layout.edge
    axial = layout.solid * fibres.axial_stiffness[of_edge]
    over_elements = (
        layout.edge, over_edge, axial, axial * layout.edge,
        layout.solid * shear_stiffness(mesh)[of_edge], over_edge**2 / rotary_inertia(mesh)[of_edge],
        np.exp(-uniform * step), stretched * step,
    )  # fmt: skip
    rods = passes.Rods(
        *packed(*(a[interleaving.nodes] for a in over_nodes)),
        *packed(*(a[interleaving.edges] for a in over_elements)),
        decay=np.exp(-scene.damping * step),
        spin_kick=kick,
        dead_band=scene.dead_band,
    )
    edges = interleaving.edges
    return rods, passes.Spin((layout.solid * inertia)[edges], uniform[edges])


def kick_before_decay(scene: Scene, step: float) -> float:
    """What forces over masses are multiplied with before the decay of a step (s).

    The step itself in the authors' setup, as in PyElastica: first order in damping * step. In the
    others, whose angular velocities decay like all velocities, what the decay leaves
    `stepping.damped_kick` of: exact.
    """
    if scene.setup == "published":
        return step
    return stepping.damped_kick(scene.damping, step) * np.exp(scene.damping * step)


def rotation_damping(mesh: Mesh, layout: Layout, inertia: np.ndarray):
    """Rates (1/s) at which angular velocities decay: at rest, and per unit of dilatation.

    The authors' damper divides by the inertia in mm-g-s units: 4 / r^2 times the rate on
    velocities with r in mm, to the power of the dilatation. Others are uniform.
    """
    scene = mesh.scene
    if scene.setup != "published":
        return np.full(len(inertia), scene.damping), np.zeros(len(inertia))
    in_mm_g = 1e9  # kg m^2 -> g mm^2
    mass = 1e3 * layout.mass
    element = 0.5 * (mass[1:] + mass[:-1])
    first = np.r_[False, layout.solid[:-1] == 0]
    last = np.r_[layout.solid[1:] == 0, False]
    element += 0.5 * mass[:-1] * first + 0.5 * mass[1:] * last
    rate = scene.damping * element / (inertia * in_mm_g)
    return rate, rate


@entry
def advance(
    state, scratch, rods, spin, held, guides, tied, viscous, filtering, forcing, readouts, ledger,
    timing, first, out, energies,
):  # fmt: skip
    """Record, then integrate to the next sample, for each sample of `out`.

    Arguments and result: as in the kirchhoff engine.
    """
    x, y, vx, vy, angle, omega, cosine, sine = state
    step, per_sample, limit, stride = timing
    outer_x, outer_y = scratch.outer_x, scratch.outer_y
    stress, couple, banded_couple, kick_x, kick_y, turn, drift_x, drift_y, rotate = (
        passes.pass_views(state, scratch, rods, stride)
    )
    dead_band = rods.dead_band
    filtered = filtering.order > 0
    views = laplace.velocity_views(state, filtering, scratch.difference, stride)
    before = passes.Velocities(vx.copy(), vy.copy(), omega.copy())
    kicked = passes.Velocities(vx.copy(), vy.copy(), omega.copy())
    carried, damped = tied.motor.nodes.shape[0] > 0, viscous.moment.shape[0] > 0
    still = np.zeros(vx.shape[0])
    since = ties.grown(forcing, first * per_sample, step)  # what u grew by in the step before
    every = 1 if damped else energy.interval_steps(step)  # what is stiff dissipates by jerks
    for sample in range(out.shape[0]):
        start = (first + sample) * per_sample
        stepping.record(state, readouts, 0.5 * step, out[sample])
        ramp = stepping.ramp_at(start * step, forcing.ramp_time)
        passes.record_energy(
            energies[sample], state, scratch, rods, spin, tied, forcing, readouts, ledger, timing,
            ramp,
        )  # fmt: skip
        if not stepping.in_bounds(vx, vy, limit):
            return sample
        if not dead_band:  # which is made of that drift
            passes.aim(angle, cosine, sine)  # the running product drifts by round-off
        for k in range(start, start + per_sample):
            time = (k + 0.5) * step
            if k == start or ramp < 1.0:
                grown = stepping.ramp_at(time, forcing.ramp_time)
                if grown > ramp:
                    energy.enter_ramp(
                        ledger, ramp - grown, energy.pull_work(x, y, readouts, forcing)
                    )
                ramp = grown
                stepping.apply_pull(forcing, ramp, outer_x, outer_y)
            passes.stress_pass(*stress)
            passes.bond_pass(tied.bonds, state, scratch, rods, stride)
            if dead_band:
                authors_rotations.couple_pass(*banded_couple)
            else:
                passes.couple_pass(*couple)
            u = stepping.drive_value(forcing.drive, forcing.drive_rate, time)
            passes.outer_forces(state, forcing, ledger, ramp, u, outer_x, outer_y)
            ties.spring_forces(tied.springs, x, y, outer_x, outer_y)
            energy.enter_drive(ledger, forcing, 0.5 * step * u, vx, vy)
            due = energy.steps_due(k - start, every, per_sample)
            if due and filtered:
                passes.copy_velocities(state, before)
            if damped:
                energy.keep(vx, vy, viscous.before_x, viscous.before_y)
                passes.copy(omega, viscous.before_spin)
            passes.velocity_pass(*kick_x, rods.decay)
            passes.velocity_pass(*kick_y, rods.decay)
            passes.spin_pass(*turn, rods.spin_kick)
            if carried:
                following = stepping.drive_value(forcing.drive, forcing.drive_rate, time + step)
                ties.carry(tied.motor, x, y, vx, vy, following, step)
            if damped:
                viscosity_elements.damp_elements(viscous, state, scratch, rods, stride)
            if carried:
                mean = 0.5 * (since + following - u)
                work = ties.motor_work(
                    tied.motor, scratch.force_x, scratch.force_y, outer_x, outer_y, mean, stride
                )
                if damped:
                    work += ties.motor_work(
                        tied.motor, viscous.force_x, viscous.force_y, still, still, mean, stride
                    )
                energy.enter_work(ledger, work)
                since = following - u
            if due:
                passes.copy_velocities(state, kicked)
                passes.hold(kicked, held)
                lost = passes.damper_power(kicked, spin, ledger)
            if filtered:
                laplace.filter_velocities(views, filtering, scratch.difference, stride)
            passes.hold(state, held)
            stepping.guide(guides, x, y, vx, vy, 0.0)
            if due:
                if damped:  # over what the filter leaves, as all work is taken
                    last = passes.Velocities(vx, vy, omega)
                    lost += viscosity_elements.elements_power(viscous, last, stride)
                if filtered:
                    lost = passes.add_filter_power(lost, before, kicked, state, spin, ledger, step)
                energy.enter_dissipation(ledger, due * step, lost)
            energy.enter_drive(ledger, forcing, 0.5 * step * u, vx, vy)
            passes.drift_pass(*drift_x, step)
            passes.drift_pass(*drift_y, step)
            if dead_band:
                authors_rotations.rotate_pass(*rotate, step)
            else:
                passes.rotate_pass(*rotate, step)
    return out.shape[0]
