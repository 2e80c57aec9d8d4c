"""PyElastica itself: Cosserat rods in three dimensions, the reference.

Built in mm-g-s, as the authors' scripts are: their damper is dimensionally inconsistent and
means 40 /s on rotations only in those units (in SI the same call gives 4e7 /s).
"""

from __future__ import annotations

import fiberweb.engines.jit  # noqa: F401  (first: it says where PyElastica's kernels are kept, too)

# isort: split
import elastica as ea
import numpy as np

from fiberweb.engines.base import RUNAWAY, Numerics, Recording, fitted_step, readout_arrays
from fiberweb.engines.cosserat import kick_before_decay
from fiberweb.engines.cosserat import largest_step as largest_step
from fiberweb.engines.cosserat import refuse as cannot_model
from fiberweb.engines.elastica_parts import (
    DampedFirst,
    Drive,
    ExactDamper,
    Guide,
    Motor,
    Simulator,
    Spring,
    Wall,
)
from fiberweb.engines.ties import angles, bonds
from fiberweb.model.mesh import Mesh

PACKAGES = ("pyelastica", "numba", "numpy")
NANOSECONDS = 500.0  # measured by `make bench`
PLANAR, MODELS_SHEAR = False, True
MESH_ERRORS = {}

MM, MICRONEWTON = 1e3, 1e6  # a metre in mm; a newton in g mm / s^2
GRAM_PER_SECOND = 1e3  # of one N s/m, and of one N/m per second


def refuse(mesh: Mesh) -> None:
    """Raise ValueError if the scene needs what this engine does not model."""
    cannot_model(mesh)
    if mesh.scene.dead_band:
        raise ValueError(
            f"dead_band = {mesh.scene.dead_band}: PyElastica has had none since 0.3.3; use "
            "engine = 'cosserat', or dead_band = False"
        )
    if mesh.scene.loss_factor:
        raise ValueError(
            f"loss_factor = {mesh.scene.loss_factor:g}: PyElastica has no material damping; use "
            "engine = 'kirchhoff' or 'cosserat'"
        )


def integrate(mesh: Mesh, numerics: Numerics, disturbance: float = 0.0) -> Recording:
    """Integrate a mesh with PyElastica.

    Args:
        mesh: as for every engine.
        numerics: as for every engine.
        disturbance: velocity (m/s) out of the plane given to the driven nodes at the start.

    Raises:
        ValueError: crossings without compliance, a dead band, or material damping.
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
        _hold(simulator, mesh, fibre, rod, step)
        _pull(simulator, mesh, fibre, rod)
        _damp(simulator, mesh, fibre, rod, step)
    for rod, nodes in _driven(mesh, rods):
        load = mesh.load[mesh.first[rods.index(rod)] + nodes]
        simulator.add_forcing_to(rod).using(
            Drive,
            nodes=nodes,
            load=MICRONEWTON * np.column_stack([load, np.zeros(len(load))]).T,
            coefficients=mesh.drive,
            rate=mesh.drive_rate,
        )
    _connect(simulator, mesh, rods)
    simulator.finalize()
    return simulator, rods, step, per_sample


def _connect(simulator, mesh: Mesh, rods) -> None:
    """Tie the rods where they cross, and keep their angle there: PyElastica's joint does it for the
    elements behind two nodes, so a bond takes two of them, half as stiff (`ties`)."""
    fibre_of = np.repeat(np.arange(len(rods)), np.diff(mesh.first))
    direction = np.repeat(angles(mesh), np.diff(mesh.first))
    bond_of = np.zeros(len(mesh.joints))
    bond_of[mesh.bond_stiffness > 0.0] = bonds(mesh, "chain")
    for (a, b), k, nu, bond in zip(mesh.joints, mesh.joint_stiffness, mesh.joint_damping, bond_of):
        pair = rods[fibre_of[a]], rods[fibre_of[b]]
        one, two = int(a - mesh.first[fibre_of[a]]), int(b - mesh.first[fibre_of[b]])
        simulator.connect(*pair, one, two).using(
            ea.FreeJoint, k=k * GRAM_PER_SECOND, nu=nu * GRAM_PER_SECOND
        )
        for back in (0, 1) if bond else ():
            simulator.connect(*pair, one - back, two - back).using(
                ea.FixedJoint, k=0.0, nu=0.0, kt=0.5 * bond * MM * MICRONEWTON,
                rest_rotation_matrix=_rest_rotation(direction[b] - direction[a]),
            )  # fmt: skip


def _rest_rotation(angle: float) -> np.ndarray:
    """Directors of one rod times those of another, transposed, at an angle in the plane. The first
    director is out of the plane, the third along the rod."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])


def _rod(mesh: Mesh, fibre: int):
    nodes = MM * mesh.position[mesh.first[fibre] : mesh.first[fibre + 1]]
    span = nodes[-1] - nodes[0]
    fibres = mesh.scene.fibres
    return ea.CosseratRod.straight_rod(
        n_elements=len(nodes) - 1,
        start=np.array([*nodes[0], 0.0]),
        direction=np.array([*span, 0.0]) / np.linalg.norm(span),
        normal=np.array([0.0, 0.0, 1.0]),
        base_length=np.linalg.norm(span),
        base_radius=0.5 * fibres.diameter[fibre] * MM,
        density=fibres.density[fibre] * 1e3 / MM**3,
        youngs_modulus=fibres.youngs_modulus[fibre],  # 1 Pa is 1 g / (mm s^2)
        shear_modulus=fibres.youngs_modulus[fibre] / 3.0,
        position=np.column_stack([nodes, np.zeros(len(nodes))]).T,
    )


def _hold(simulator, mesh: Mesh, fibre: int, rod, step: float) -> None:
    first = mesh.first[fibre]
    held = mesh.held[first : mesh.first[fibre + 1]].copy()
    for node, path in zip(mesh.moved - first, mesh.path):
        if 0 <= node < len(held):
            held[node] = False
            simulator.constrain(rod).using(
                Motor, constrained_position_idx=(int(node),), node=int(node),
                rest=_in_space(mesh.position[first + node]), path=_in_space(path),
                coefficients=mesh.drive, rate=mesh.drive_rate, step=step,
                decay=np.exp(-mesh.scene.damping * step),
            )  # fmt: skip
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
    for node, root in zip(mesh.sprung, mesh.springs):
        if mesh.first[fibre] <= node < mesh.first[fibre + 1]:
            simulator.add_forcing_to(rod).using(
                Spring, node=int(node - mesh.first[fibre]), rest=_in_space(mesh.position[node]),
                root=np.sqrt(GRAM_PER_SECOND) * _in_space(root) / MM,
            )  # fmt: skip


def _in_space(vector: np.ndarray) -> np.ndarray:
    """A vector of the plane (m) in space, mm."""
    return MM * np.array([*vector, 0.0])


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
