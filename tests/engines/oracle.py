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


def kirchhoff_energy(nodes, rest, stiffness, clamped: bool, order: int = 4):
    """Elastic energy (J) of a Kirchhoff fibre.

    Args:
        nodes: positions, shape (..., nodes, 2), m; may be complex.
        rest: the same at rest, shape (nodes, 2).
        stiffness: EA (N) and EI (N m^2).
        clamped: whether a wall holds the direction of the near end.
        order: 4, or 2 for the chain without spline and bow.
    """
    curvature, form = kirchhoff_bending(nodes, rest, clamped, order)
    edges, rest_edges = np.diff(nodes, axis=-2), np.diff(rest, axis=0)
    length = np.sqrt((edges**2).sum(-1))
    rest_length = np.sqrt((rest_edges**2).sum(-1))
    bow = 0.0
    if order == 4:
        straight = np.zeros((*curvature.shape[:-1], 1))
        ends = [curvature, straight] if clamped else [straight, curvature, straight]
        everywhere = np.concatenate(ends, axis=-1)
        bow = (0.5 * rest_length * (everywhere[..., 1:] + everywhere[..., :-1])) ** 2 / 24
    bending = 0.5 * np.einsum("...i,ij,...j", curvature, form, curvature)
    ratio = rest_length / length
    stretching = 1 / ratio - 1 + np.log(ratio) + (1 / ratio - 1 + 0.5 * bow) * bow
    stretching = (rest_length * stretching).sum(-1)
    axial, bent = stiffness
    return bent * bending + axial * stretching


def kirchhoff_bending(nodes, rest, clamped: bool, order: int):
    """Curvatures at the wall, if any, and at the inner nodes, and the form that the bending energy
    over EI is half of in them."""
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
    curvature = sine * (1 + w / 3 + 2 * w**2 / 15) / span
    form = np.diag(span)
    if order == 4:
        between = rest_length[: len(span) - 1] if clamped else rest_length[1:-1]
        before = np.r_[0.0, between] if clamped else rest_length[:-1]
        after = rest_length[-len(span) :]
        excess = form - np.diag((before + after) / 3)
        excess -= np.diag(between / 6, 1) + np.diag(between / 6, -1)
        form = form + excess + excess @ np.diag(1 / span) @ excess
        if clamped and len(span) > 2 and np.allclose(rest_length[:3], rest_length[0]):
            form[:3, :3] += rest_length[0] / 108 * np.outer([3, -4, 1], [3, -4, 1])
    return curvature, form


def kirchhoff_masses(mesh: Mesh, order: int = 4) -> np.ndarray:
    """Mass of each node (kg): half of either element beside it; to fourth order Gregory's weights
    3/8, 7/6, 23/24 of an element at free far ends, where the motion has a slope."""
    mass = mesh.masses()
    for fibre, last in enumerate(mesh.first[1:] - 1):
        length = mesh.edges(fibre)
        even = len(length) > 3 and np.allclose(length[-3:], length[-1])
        if order == 4 and even and not mesh.held[last].any() and last not in mesh.guided:
            element = mesh.scene.fibres.line_density[fibre] * length[-1]
            mass[[last, last - 1, last - 2]] = element * np.array([3 / 8, 7 / 6, 23 / 24])
    return mass


def kirchhoff(
    mesh: Mesh, step: float, steps: int, order: int = 4, mild: bool = False
) -> np.ndarray:
    """Displacement of every node at every step, shape (steps + 1, nodes, 2), m; mild: viscous
    moments are explicit."""
    scene, mass = mesh.scene, kirchhoff_masses(mesh, order)
    stiffness = np.column_stack([scene.fibres.axial_stiffness, scene.fibres.bending_stiffness])
    # the flow of dv/dt = a - rate v over a step, for a that is held
    decay, kick = _flow(scene.damping, step)
    groups = _meeting(mesh)
    # what crossings that are one point did to velocities in the last step, or, at springs, what the
    # viscous stresses did
    pushed = np.zeros_like(mesh.position)
    x, v = mesh.position.copy(), np.zeros_like(mesh.position)
    out = [x - mesh.position]
    history = {}  # curvatures of each fibre in the steps before
    for k in range(steps):
        time = (k + 0.5) * step
        x = x + 0.5 * step * v
        force = _outer(mesh, time) + _ties(mesh, x, order)
        for fibre, (start, end) in enumerate(pairwise(mesh.first)):
            if mild:
                force[start:end] -= _viscous_moments(
                    x[start:end], mesh.position[start:end], history.setdefault(fibre, []), step,
                    scene.loss_time * stiffness[fibre][1], mesh.clamped[fibre], order,
                )  # fmt: skip
            force[start:end] -= _gradient(
                lambda nodes, s=start, e=end, f=fibre: kirchhoff_energy(
                    nodes, mesh.position[s:e], stiffness[f], mesh.clamped[f], order
                ),
                x[start:end],
            )
        new = decay * v + kick * np.where(mesh.held, 0.0, force / mass[:, None])
        for nodes, spring, damper in groups:
            if np.isinf(spring).any():
                continue
            # m dv/dt = f - K x - N v - m rate v, with f and x held over the step, and in f what
            # viscous stresses did in the last one
            push = (force[nodes] - spring @ x[nodes]) / mass[nodes, None] + pushed[nodes] / kick
            count = len(nodes)
            drag = -damper / mass[nodes, None] - scene.damping * np.eye(count)
            flow = expm(step * np.block([[drag, push], [np.zeros((2, count + 2))]]))
            new[nodes] = flow[:count, :count] @ v[nodes] + flow[:count, count:] - pushed[nodes]
        new[mesh.moved] = _on_path(mesh, x, time, step)
        if scene.loss_time:
            tied = np.unique(mesh.joints)
            merged = np.isinf(mesh.joint_stiffness).any()
            foreseen = pushed if merged else 0.0 * pushed
            without = new.copy()
            new = new + foreseen
            for fibre, (start, end) in enumerate(pairwise(mesh.first)):
                part = slice(start, end)
                eased = kick * np.where(mesh.held[part], 0.0, 1.0 / mass[part, None])
                new[part] = _viscous(
                    x[part], mesh.position[part], v[part], new[part], eased,
                    scene.loss_time * stiffness[fibre], mesh.clamped[fibre], order, mild,
                )  # fmt: skip
            new = new - foreseen
            if not merged:
                pushed[tied] = new[tied] - without[tied]
        apart = new.copy()
        for nodes, spring, _ in groups:
            if np.isinf(spring).any():  # one point: an inelastic collision
                new[nodes] = mass[nodes] @ new[nodes] / mass[nodes].sum()
                if scene.loss_time:
                    pushed[nodes] = new[nodes] - apart[nodes]
        _guide(mesh, new)
        v = new
        x = x + 0.5 * step * v
        out.append(x - mesh.position)
    return np.array(out)


def _viscous_moments(x, rest, history: list, step, viscosity, clamped: bool, order: int):
    """Forces of viscous moments by the rate of the curvatures, of second order from three steps;
    before the first, all were as in it."""
    now, form = kirchhoff_bending(x, rest, clamped, order)
    history[:] = [now, *(history or [now, now])[:2]]
    rate = np.array([1.5, -2.0, 0.5]) @ np.array(history) / step

    def power(nodes):
        return viscosity * kirchhoff_bending(nodes, rest, clamped, order)[0] @ form @ rate

    return _gradient(power, x)


def _viscous(x, rest, before, after, eased, viscosity, clamped: bool, order: int, mild: bool):
    """Velocities of a fibre after the midpoint rule of its viscous stresses, or if damping is mild,
    of the tensions; `eased` is the step over the masses. Dense, with rows of B written out from the
    geometry."""
    count, lengths = len(x), np.sqrt((np.diff(rest, axis=0) ** 2).sum(1))
    edges = np.diff(x, axis=0)
    length = np.sqrt((edges**2).sum(1))
    tangent = edges / length[:, None]
    across = np.column_stack([-tangent[:, 1], tangent[:, 0]]) / length[:, None]
    rows, compliance = [], []
    for e in range(count - 1):
        row = np.zeros((count, 2))
        row[e + 1], row[e] = tangent[e], -tangent[e]
        rows.append(row)
    bent = [] if mild else list(range(0 if clamped else 1, count - 1))
    for i in bent:
        row = np.zeros((count, 2))
        row[i + 1] += across[i]
        row[i] -= across[i]
        if i:
            row[i] -= across[i - 1]
            row[i - 1] += across[i - 1]
        rows.append(row)
    compliance = np.zeros((len(rows), len(rows)))
    compliance[: count - 1, : count - 1] = np.diag(lengths / viscosity[0])
    moments = np.zeros((len(bent), len(bent)))
    for j, i in enumerate(bent):
        beside = lengths[i] + (lengths[i - 1] if i else 0.0)
        moments[j, j] = beside / (3 if order == 4 else 2)
        if order == 4 and j:
            moments[j, j - 1] = moments[j - 1, j] = lengths[i - 1] / 6
    compliance[count - 1 :, count - 1 :] = moments / viscosity[1]
    rates = np.array(rows).reshape(len(rows), -1)
    system = compliance + 0.5 * rates @ (eased.ravel()[:, None] * rates.T)
    stress = np.linalg.solve(system, rates @ (0.5 * (before + after)).ravel())
    return after - eased * (rates.T @ stress).reshape(count, 2)


def _ties(mesh: Mesh, x, order: int) -> np.ndarray:
    """Forces on every node of springs at the ends and of bonds between chords (N)."""
    force = np.zeros_like(x)
    for node, root in zip(mesh.sprung, mesh.springs):
        force[node] -= root * (root @ (x[node] - mesh.position[node]))
    for (a, b), bond in zip(mesh.joints, mesh.bond_stiffness):
        beside = [a - 1, a + 1, b - 1, b + 1]
        rest = _turn(mesh.position[beside])
        for node in (a, b):  # what a couple spread over two elements lacks of compliance
            fibre = np.searchsorted(mesh.first, node, side="right") - 1
            element = 0.5 * np.linalg.norm(mesh.position[node + 1] - mesh.position[node - 1])
            lacking = element / mesh.scene.fibres.bending_stiffness[fibre]
            bond = 1 / (1 / bond + lacking / (3 if order == 4 else 4)) if bond else 0.0
        if bond:
            force[beside] -= _gradient(lambda p, k=bond, o=rest: _bond(p, k, o), x[beside])
    return force


def _turn(points):
    """Unit complex number of the angle from one chord to another, by their four ends."""
    chords = points[..., 1::2, :] - points[..., ::2, :]
    one, two = chords[..., 0, :], chords[..., 1, :]
    cosine, sine = (one * two).sum(-1), one[..., 0] * two[..., 1] - one[..., 1] * two[..., 0]
    over = 1.0 / np.sqrt((one**2).sum(-1) * (two**2).sum(-1))
    return cosine * over, sine * over


def _bond(points, stiffness, rest):
    (c, s), (c0, s0) = _turn(points), rest
    w, sine = 1 - (c * c0 + s * s0), s * c0 - c * s0
    return 0.5 * stiffness * (sine * (1 + w / 3 + 2 * w**2 / 15)) ** 2


def _on_path(mesh: Mesh, x, time: float, step: float) -> np.ndarray:
    """Velocities of the nodes whose motion is given, from the middle of a step to the next one."""
    u = _input(mesh, time + step)
    return (mesh.position[mesh.moved] + u * mesh.path - x[mesh.moved]) / step


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
    return ramp * mesh.pull + _input(mesh, time) * mesh.load


def _input(mesh: Mesh, time: float) -> float:
    """The input u."""
    interval = min(int(time * mesh.drive_rate), len(mesh.drive) - 1)
    return np.polyval(mesh.drive[interval], time - interval / mesh.drive_rate)


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
