"""PyElastica itself: Cosserat rods in three dimensions, the reference.

Built in mm-g-s, as the authors' scripts are: their damper is dimensionally inconsistent and
means 40 /s on rotations only in those units (in SI the same call gives 4e7 /s).
"""

from __future__ import annotations

import fiberweb.engines.jit  # noqa: F401  (first: it says where PyElastica's kernels are kept, too)

# isort: split
from itertools import chain

import elastica as ea
import numpy as np
from elastica._rotations import _inv_rotate
from numba import njit

from fiberweb.engines.base import RUNAWAY, Numerics, Recording, fitted_step, readout_arrays
from fiberweb.engines.cosserat import kick_before_decay
from fiberweb.engines.cosserat import largest_step as largest_step
from fiberweb.engines.cosserat import refuse as cannot_model
from fiberweb.engines.stepping import drive_value
from fiberweb.model.mesh import Mesh

PACKAGES = ("pyelastica", "numba", "numpy")
NANOSECONDS = 500.0  # measured by `make bench`
PLANAR, MODELS_SHEAR = False, True
MESH_ERRORS = {}

MM, MICRONEWTON = 1e3, 1e6  # a metre in mm; a newton in g mm / s^2
GRAM_PER_SECOND = 1e3  # of one N s/m, and of one N/m per second


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Connections, ea.Damping):
    """Rods with everything a fibre network needs."""


class DampedFirst(Simulator):
    """The order of PyElastica 0.3.2, which the authors ran: damper, filter, constraints."""

    def constrain_rates(self, time):
        """Damp, filter and then hold velocities."""
        for act in chain(self._feature_group_damping, self._feature_group_constrain_rates):
            act(time=time)


class Drive(ea.NoForces):
    """A force pattern times the input u(t)."""

    def __init__(self, nodes, load, coefficients, rate):
        super().__init__()
        self.nodes, self.load = nodes, load
        self.coefficients, self.rate = coefficients, rate

    def apply_forces(self, system, time=0.0):
        """Add the load at this time."""
        u = drive_value(self.coefficients, self.rate, time)
        system.external_forces[:, self.nodes] += u * self.load


class Guide(ea.ConstraintBase):
    """A node that slides along a slanted line."""

    def __init__(self, *_, node, along, **kwargs):
        super().__init__(**kwargs)
        self.node, self.along = node, along

    def constrain_values(self, system, time):
        """Its position follows from its velocity."""

    def constrain_rates(self, system, time):
        """Leave it the part of its velocity along the line."""
        velocity = system.velocity_collection[:, self.node]
        velocity[:] = (self.along @ velocity) * self.along


class Wall(ea.NoForces):
    """Bending moment of a clamp on the first element: the curvature of the half cell between
    wall and element centre (see `fiberweb.engines.layout`)."""

    def __init__(self, rod):
        super().__init__()
        self.directors = np.repeat(rod.director_collection[..., :1], 2, axis=2)
        self.stiffness = np.diag(rod.bend_matrix[..., 0]) / (0.5 * rod.rest_lengths[0])

    def apply_torques(self, system, time=0.0):
        """Turn the first element back towards the wall's direction."""
        _wall_torque(
            self.directors, system.director_collection, self.stiffness, system.dilatation,
            system.external_torques,
        )  # fmt: skip


@njit(cache=True)
def _wall_torque(pair, directors, stiffness, dilatation, torques):
    pair[:, :, 1] = directors[:, :, 0]
    turn = _inv_rotate(pair)
    e = 0.5 * (1.0 + dilatation[0])
    for i in range(3):
        torques[i, 0] -= stiffness[i] * turn[i, 0] / e**3


class ExactDamper(ea.DamperBase):
    """The decay of all velocities, exact for constant forces: what PyElastica's kick by the step
    lacks of `cosserat.kick_before_decay` is added before it."""

    def __init__(self, rate, step, missing, free_nodes, free_elements, **kwargs):
        super().__init__(**kwargs)
        self.decay = np.exp(-rate * step)
        self.of_nodes, self.of_elements = missing * free_nodes, missing * free_elements

    def dampen_rates(self, system, time=0.0):
        """Correct and damp; constraints have acted already, so what they hold is left alone."""
        system.velocity_collection += self.of_nodes * system.acceleration_collection
        system.omega_collection += self.of_elements * system.alpha_collection
        system.velocity_collection *= self.decay
        system.omega_collection *= self.decay


def refuse(mesh: Mesh) -> None:
    """Raise ValueError if the scene needs what this engine does not model."""
    cannot_model(mesh)
    if mesh.scene.dead_band:
        raise ValueError(
            f"dead_band = {mesh.scene.dead_band}: PyElastica has had none since 0.3.3; use "
            "engine = 'cosserat', or dead_band = False"
        )


def integrate(mesh: Mesh, numerics: Numerics, disturbance: float = 0.0) -> Recording:
    """Integrate a mesh with PyElastica.

    Args:
        mesh: as for every engine.
        numerics: as for every engine.
        disturbance: velocity (m/s) out of the plane given to the driven nodes at the start.

    Raises:
        ValueError: crossings without compliance, or a dead band.
    """
    simulator, rods, step, per_sample = assemble(mesh, numerics)
    for rod, nodes in _driven(mesh, rods):
        rod.velocity_collection[2, nodes] += disturbance * MM
    nodes, weights = readout_arrays(mesh)
    rest = mesh.position
    limit = RUNAWAY * mesh.scene.wave_speed * MM
    out = np.full((mesh.scene.samples, len(nodes), 2), np.nan)
    no_ledger = np.full((mesh.scene.samples, 4), np.nan)
    stepper, time = ea.PositionVerlet(), 0.0
    for sample in range(mesh.scene.samples):
        at = np.concatenate([rod.position_collection[:2].T for rod in rods]) / MM - rest
        out[sample] = np.einsum("rk,rkc->rc", weights, at[nodes])
        fastest = np.max([np.abs(rod.velocity_collection).max() for rod in rods])  # NaN if any is
        if not (fastest < limit and np.isfinite(at).all()):
            out[sample:] = np.nan
            return Recording(out, no_ledger, sample / mesh.scene.sample_rate)
        if sample + 1 < mesh.scene.samples:
            time = run_steps(simulator, stepper, time, step, per_sample)
    return Recording(out, no_ledger, None)


def run_steps(simulator, stepper, time: float, step: float, count: int) -> float:
    """Take `count` steps; returns the time reached (s)."""
    with np.errstate(all="ignore"):  # a run that blows up is recorded, not warned about
        for _ in range(count):
            time = stepper.step(simulator, time, step)
    return time


def assemble(mesh: Mesh, numerics: Numerics):
    """The simulator, its rods, the step (s) and the steps per sample."""
    refuse(mesh)
    scene = mesh.scene
    step, per_sample = fitted_step(scene, numerics.time_step)
    simulator = DampedFirst() if scene.setup == "published" else Simulator()
    rods = [_rod(mesh, fibre) for fibre in range(len(mesh.first) - 1)]
    for fibre, rod in enumerate(rods):
        moved = mesh.start[mesh.first[fibre] : mesh.first[fibre + 1]]
        rod.position_collection[:2] += MM * moved.T
        simulator.append(rod)
    for fibre, rod in enumerate(rods):
        _hold(simulator, mesh, fibre, rod)
        _pull(simulator, mesh, fibre, rod)
        _damp(simulator, mesh, fibre, rod, step)
    for rod, nodes in _driven(mesh, rods):
        load = mesh.load[mesh.first[rods.index(rod)] + nodes]
        simulator.add_forcing_to(rod).using(
            Drive,
            nodes=nodes,
            load=MICRONEWTON * np.column_stack([load, np.zeros(len(load))]).T,
            coefficients=mesh.drive,
            rate=scene.drive_rate,
        )
    fibre_of = np.repeat(np.arange(len(rods)), np.diff(mesh.first))
    for (a, b), k, nu in zip(mesh.joints, mesh.joint_stiffness, mesh.joint_damping):
        simulator.connect(
            rods[fibre_of[a]], rods[fibre_of[b]],
            int(a - mesh.first[fibre_of[a]]), int(b - mesh.first[fibre_of[b]]),
        ).using(ea.FreeJoint, k=k * GRAM_PER_SECOND, nu=nu * GRAM_PER_SECOND)  # fmt: skip
    simulator.finalize()
    return simulator, rods, step, per_sample


def _rod(mesh: Mesh, fibre: int):
    nodes = MM * mesh.position[mesh.first[fibre] : mesh.first[fibre + 1]]
    span = nodes[-1] - nodes[0]
    scene = mesh.scene
    return ea.CosseratRod.straight_rod(
        n_elements=len(nodes) - 1,
        start=np.array([*nodes[0], 0.0]),
        direction=np.array([*span, 0.0]) / np.linalg.norm(span),
        normal=np.array([0.0, 0.0, 1.0]),
        base_length=np.linalg.norm(span),
        base_radius=0.5 * scene.diameter * MM,
        density=scene.density * 1e3 / MM**3,
        youngs_modulus=scene.youngs_modulus,  # 1 Pa is 1 g / (mm s^2)
        shear_modulus=scene.youngs_modulus / 3.0,
        position=np.column_stack([nodes, np.zeros(len(nodes))]).T,
    )


def _hold(simulator, mesh: Mesh, fibre: int, rod) -> None:
    held = mesh.held[mesh.first[fibre] : mesh.first[fibre + 1]]
    for node in np.flatnonzero(held.any(axis=1)):
        simulator.constrain(rod).using(
            ea.GeneralConstraint,
            constrained_position_idx=(int(node),),
            translational_constraint_selector=np.array([*held[node], True]),
        )
    for node, along in zip(mesh.guided, mesh.guides):
        if 0 <= node - mesh.first[fibre] < len(held):
            index = int(node - mesh.first[fibre])
            simulator.constrain(rod).using(
                Guide, constrained_position_idx=(index,), node=index, along=np.array([*along, 0.0])
            )
    if mesh.clamped[fibre]:
        simulator.add_forcing_to(rod).using(Wall, rod=rod)
    else:
        simulator.constrain(rod).using(
            ea.GeneralConstraint,
            constrained_director_idx=(0,),
            rotational_constraint_selector=np.array([True, True, False]),
        )


def _pull(simulator, mesh: Mesh, fibre: int, rod) -> None:
    near, far = mesh.pull[mesh.first[fibre]], mesh.pull[mesh.first[fibre + 1] - 1]
    if far.any():
        simulator.add_forcing_to(rod).using(
            ea.EndpointForces,
            start_force=MICRONEWTON * np.array([*near, 0.0]),
            end_force=MICRONEWTON * np.array([*far, 0.0]),
            ramp_up_time=max(mesh.scene.tension_ramp, 1e-12),
        )


def _damp(simulator, mesh: Mesh, fibre: int, rod, step: float) -> None:
    scene = mesh.scene
    if scene.setup == "published":
        simulator.dampen(rod).using(
            ea.AnalyticalLinearDamper, time_step=step, damping_constant=scene.damping
        )
    else:
        held = mesh.held[mesh.first[fibre] : mesh.first[fibre + 1]]
        free_nodes = 1.0 - np.column_stack([held, held.any(axis=1)]).T
        free_elements = np.ones((3, rod.n_elems))
        if not mesh.clamped[fibre]:
            free_elements[:2, 0] = 0.0
        simulator.dampen(rod).using(
            ExactDamper, rate=scene.damping, step=step,
            missing=kick_before_decay(scene, step) - step,
            free_nodes=free_nodes, free_elements=free_elements,
        )  # fmt: skip
    if scene.filter_order:
        simulator.dampen(rod).using(ea.LaplaceDissipationFilter, filter_order=scene.filter_order)


def _driven(mesh: Mesh, rods):
    """(rod, its loaded nodes) for each rod that is driven."""
    for fibre, rod in enumerate(rods):
        load = mesh.load[mesh.first[fibre] : mesh.first[fibre + 1]]
        nodes = np.flatnonzero(np.abs(load).any(axis=1))
        if len(nodes):
            yield rod, nodes
