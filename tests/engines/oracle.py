"""The planar engines once more, as slow and plain as possible, to check the kernels against.

Loops over fibres, no ghosts, and nothing shared with the engines but the mesh. Fibre forces of
the Kirchhoff rod are the gradient of its energy by complex steps (exact to round-off); nodes
that meet are stepped by a matrix exponential; half drifts are not joined.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from scipy.linalg import expm

from fiberweb.model.buckling import second_moment
from fiberweb.model.mesh import Mesh
from fiberweb.model.scene import Scene


def kirchhoff_energy(nodes, rest, scene: Scene, clamped: bool, order: int = 4):
    """Elastic energy (J) of a Kirchhoff fibre.

    Args:
        nodes: positions, shape (..., nodes, 2), m; may be complex.
        rest: the same at rest, shape (nodes, 2).
        scene: material.
        clamped: whether a wall holds the direction of the near end.
        order: 4, or 2 for the chain without spline and bow.
    """
    edges, rest_edges = np.diff(nodes, axis=-2), np.diff(rest, axis=0)
    length = np.sqrt((edges**2).sum(-1))
    rest_length = np.sqrt((rest_edges**2).sum(-1))
    tangents = edges / length[..., None]
    span = 0.5 * (rest_length[1:] + rest_length[:-1])
    if clamped:
        wall = np.broadcast_to(rest_edges[0] / rest_length[0], (*tangents.shape[:-2], 1, 2))
        tangents = np.concatenate([wall, tangents], axis=-2)
        span = np.r_[0.5 * rest_length[0], span]
    a, b = tangents[..., :-1, :], tangents[..., 1:, :]
    sine = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    cosine = (a * b).sum(-1)
    w = 1 - cosine
    curvature = (
        sine * (1 + w / 3 + 2 * w**2 / 15) / span
    )  # at the wall, if any, and at the inner nodes
    form = np.diag(span)
    bow = 0.0
    if order == 4:
        between = rest_length[: len(span) - 1] if clamped else rest_length[1:-1]
        before = np.r_[0.0, between] if clamped else rest_length[:-1]
        after = rest_length[-len(span) :]
        excess = form - np.diag((before + after) / 3)
        excess -= np.diag(between / 6, 1) + np.diag(between / 6, -1)
        form = form + excess + excess @ np.diag(1 / span) @ excess
        if clamped and len(span) > 2 and np.allclose(rest_length[:3], rest_length[0]):
            form[:3, :3] += rest_length[0] / 108 * np.outer([3, -4, 1], [3, -4, 1])
        straight = np.zeros((*curvature.shape[:-1], 1))
        ends = [curvature, straight] if clamped else [straight, curvature, straight]
        everywhere = np.concatenate(ends, axis=-1)
        bow = (0.5 * rest_length * (everywhere[..., 1:] + everywhere[..., :-1])) ** 2 / 24
    bending = 0.5 * np.einsum("...i,ij,...j", curvature, form, curvature)
    ratio = rest_length / length
    stretching = 1 / ratio - 1 + np.log(ratio) + (1 / ratio - 1 + 0.5 * bow) * bow
    stretching = (rest_length * stretching).sum(-1)
    return scene.bending_stiffness * bending + scene.axial_stiffness * stretching


def kirchhoff_masses(mesh: Mesh, order: int = 4) -> np.ndarray:
    """Mass of each node (kg): half of either element beside it; to fourth order Gregory's weights
    3/8, 7/6, 23/24 of an element at free far ends, where the motion has a slope."""
    mass = mesh.masses()
    for fibre, last in enumerate(mesh.first[1:] - 1):
        length = mesh.edges(fibre)
        even = len(length) > 3 and np.allclose(length[-3:], length[-1])
        if order == 4 and even and not mesh.held[last].any() and last not in mesh.guided:
            element = mesh.scene.density * mesh.scene.area * length[-1]
            mass[[last, last - 1, last - 2]] = element * np.array([3 / 8, 7 / 6, 23 / 24])
    return mass


def kirchhoff(mesh: Mesh, step: float, steps: int, order: int = 4) -> np.ndarray:
    """Displacement of every node at every step, shape (steps + 1, nodes, 2), m."""
    scene, mass = mesh.scene, kirchhoff_masses(mesh, order)
    # the flow of dv/dt = a - rate v over a step, for a that is held
    decay, kick = _flow(scene.damping, step)
    groups = _meeting(mesh)
    x, v = mesh.position.copy(), np.zeros_like(mesh.position)
    out = [x - mesh.position]
    for k in range(steps):
        time = (k + 0.5) * step
        x = x + 0.5 * step * v
        force = _outer(mesh, time)
        for fibre, (start, end) in enumerate(pairwise(mesh.first)):
            force[start:end] -= _gradient(
                lambda nodes, s=start, e=end, f=fibre: kirchhoff_energy(
                    nodes, mesh.position[s:e], scene, mesh.clamped[f], order
                ),
                x[start:end],
            )
        new = decay * v + kick * np.where(mesh.held, 0.0, force / mass[:, None])
        for nodes, spring, damper in groups:
            if np.isinf(spring).any():  # one point: an inelastic collision
                new[nodes] = mass[nodes] @ new[nodes] / mass[nodes].sum()
                continue
            # m dv/dt = f - K x - N v - m rate v, with f and x held over the step
            push = (force[nodes] - spring @ x[nodes]) / mass[nodes, None]
            count = len(nodes)
            drag = -damper / mass[nodes, None] - scene.damping * np.eye(count)
            flow = expm(step * np.block([[drag, push], [np.zeros((2, count + 2))]]))
            new[nodes] = flow[:count, :count] @ v[nodes] + flow[:count, count:]
        _guide(mesh, new)
        v = new
        x = x + 0.5 * step * v
        out.append(x - mesh.position)
    return np.array(out)


def cosserat(mesh: Mesh, step: float, steps: int) -> np.ndarray:
    """Displacement of every node at every step, shape (steps + 1, nodes, 2), m."""
    scene, mass = mesh.scene, mesh.masses()
    fibres = [slice(start, end) for start, end in pairwise(mesh.first)]
    x, v = mesh.position.copy(), np.zeros_like(mesh.position)
    rest_angles = [np.arctan2(*np.diff(x[f], axis=0).T[::-1]) for f in fibres]
    angles = [a.copy() for a in rest_angles]
    spins = [np.zeros(len(a)) for a in angles]
    per_length = scene.density * second_moment(scene.diameter)
    decay, kick = np.exp(-scene.damping * step), step  # PyElastica's: the kick, then the decay
    if scene.setup != "published":
        kick = _flow(scene.damping, step)[1] / decay
    inertia = [per_length * mesh.edges(f) for f in range(len(fibres))]
    out = [x - mesh.position]
    for k in range(steps):
        time = (k + 0.5) * step
        x = x + 0.5 * step * v
        angles = [a + 0.5 * step * w for a, w in zip(angles, spins)]
        force = _outer(mesh, time)
        for (a, b), stiffness, damping in zip(
            mesh.joints, mesh.joint_stiffness, mesh.joint_damping
        ):
            tie = stiffness * (x[b] - x[a]) + damping * (v[b] - v[a])
            force[a] += tie
            force[b] -= tie
        spun = []
        for number, f in enumerate(fibres):
            inner, torque, stretch = _cosserat_fibre(
                scene, x[f], v[f], angles[number], spins[number], rest_angles[number],
                mesh.edges(number), inertia[number], mesh.clamped[number],
            )  # fmt: skip
            force[f] += inner
            spin = spins[number] + kick * torque * stretch / inertia[number]
            spin *= np.exp(-step * _spin_damping(scene, mass[f], inertia[number], stretch))
            spun.append(_filtered(spin, scene.filter_order))
        late = scene.setup == "published"  # held nodes stop after damper and filter, not before
        v = decay * (v + kick * np.where(mesh.held & (not late), 0.0, force / mass[:, None]))
        for f in fibres:
            v[f] = np.column_stack([_filtered(column, scene.filter_order) for column in v[f].T])
        v[mesh.held] = 0.0
        _guide(mesh, v)
        spins = spun
        x = x + 0.5 * step * v
        angles = [a + 0.5 * step * w for a, w in zip(angles, spins)]
        out.append(x - mesh.position)
    return np.array(out)


def _cosserat_fibre(scene, x, v, angle, spin, rest_angle, rest_length, inertia, clamped):
    """Nodal forces, torques on the elements, and dilatations (Gazzola et al. 2018, Eqs. 3.4 to
    3.11, in the plane)."""
    edges = np.diff(x, axis=0)
    length = np.sqrt((edges**2).sum(1))
    stretch, tangent = length / rest_length, edges / length[:, None]
    along = np.column_stack([np.cos(angle), np.sin(angle)])
    across = np.column_stack([-np.sin(angle), np.cos(angle)])
    axial, shear = scene.axial_stiffness, scene.axial_stiffness / 3 * 27 / 28
    stress = (axial * (stretch * (tangent * along).sum(1) - 1))[:, None] * along
    stress += (shear * stretch * (tangent * across).sum(1))[:, None] * across
    force = np.diff(stress / stretch[:, None], axis=0, prepend=0, append=0)
    region = 0.5 * (rest_length[1:] + rest_length[:-1])
    region_stretch = 0.5 * (length[1:] + length[:-1]) / region
    couple = scene.bending_stiffness * np.diff(angle) / region / region_stretch**3
    wall = 0.0
    if clamped:  # half a cell between the wall and the middle of the first element
        wall = scene.bending_stiffness * (angle[0] - rest_angle[0]) / (0.5 * rest_length[0])
        wall /= (0.5 * (1 + stretch[0])) ** 3
    torque = np.diff(couple, prepend=wall, append=0)
    torque += (tangent[:, 0] * stress[:, 1] - tangent[:, 1] * stress[:, 0]) * rest_length
    rate = (edges * np.diff(v, axis=0)).sum(1) / length / rest_length
    return force, torque + inertia * spin / stretch**2 * rate, stretch


def _spin_damping(scene, mass, inertia, stretch):
    """Decay rates of angular velocities: the authors' in mm-g-s, or uniform."""
    if scene.setup != "published":
        return np.full(len(stretch), scene.damping)
    element = 0.5 * (mass[1:] + mass[:-1])
    element[0] += 0.5 * mass[0]
    element[-1] += 0.5 * mass[-1]
    return scene.damping * 1e3 * element / (1e9 * inertia) * stretch


def _filtered(rate, order: int):
    """What `order` second differences, zero at both ends, leave of a rate is taken from it."""
    term = rate.copy()
    for _ in range(order):
        inner = (2 * term[1:-1] - term[:-2] - term[2:]) / 4
        term = np.r_[0.0, inner, 0.0]
    return rate - term if order else rate


def _guide(mesh: Mesh, v) -> None:
    """Leave guided nodes the velocity along their lines."""
    for node, along in zip(mesh.guided, mesh.guides):
        v[node] = np.outer(along, along) @ v[node]


def _outer(mesh: Mesh, time: float) -> np.ndarray:
    """Tension and drive on every node (N)."""
    scene = mesh.scene
    ramp = min(1.0, time / scene.tension_ramp) if scene.tension_ramp else 1.0
    interval = min(int(time * scene.drive_rate), len(mesh.drive) - 1)
    u = np.polyval(mesh.drive[interval], time - interval / scene.drive_rate)
    return ramp * mesh.pull + u * mesh.load


def _flow(rate: float, step: float) -> tuple[float, float]:
    """What a step leaves of a velocity, and what it makes of a constant acceleration (s)."""
    flow = expm(step * np.array([[-rate, 1.0], [0.0, 0.0]]))
    return flow[0, 0], flow[0, 1]


def _gradient(energy, x) -> np.ndarray:
    """Gradient by complex steps."""
    tiny = 1e-30
    moved = x + 1j * tiny * np.eye(x.size).reshape(x.size, *x.shape)
    return energy(moved).imag.reshape(x.shape) / tiny


def _meeting(mesh: Mesh):
    """Nodes that meet at each crossing, with their spring and damper matrices."""
    groups: list[set[int]] = []
    for pair in mesh.joints.tolist():
        touched = [g for g in groups if g & set(pair)]
        groups = [g for g in groups if g not in touched] + [set(pair).union(*touched)]
    result = []
    for group in groups:
        nodes = sorted(group)
        spring, damper = np.zeros((2, len(nodes), len(nodes)))
        for (a, b), k, nu in zip(mesh.joints, mesh.joint_stiffness, mesh.joint_damping):
            if a in group:
                i, j = nodes.index(a), nodes.index(b)
                for matrix, value in ((spring, k), (damper, nu)):
                    matrix[[i, j], [i, j]] += value
                    matrix[[i, j], [j, i]] -= value
        result.append((nodes, spring, damper))
    return result
