"""A scene cut into elements: the flat arrays that every engine integrates."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from fiberweb.model.drive import spline
from fiberweb.model.scene import Scene

ELEMENT_FLOOR = 2.0  # shortest element, in fibre diameters: below it a fibre is no slender rod
AUTHORS_ELEMENT = 10e-3  # m
# The authors' load: five nodes about the middle; a negative index skews what they meant to be
# symmetric.
AUTHORS_LOAD = {-2: 0.1875, -1: 0.125, 0: 0.125, 1: 0.1875, 2: 0.375}


class Readout(NamedTuple):
    """One point that is read: where it lies, and the four nodes and weights that give it."""

    kind: str  # crossing, horizontal_midpoint, vertical_midpoint, section_midpoint, node
    fibre: int
    section: int  # along the fibre: number of the crossing, of the section, or of the node
    nodes: tuple[int, ...]
    weights: tuple[float, ...]


@dataclass(frozen=True)
class Mesh:
    """Nodes of all fibres one after the other, and everything that acts on them.

    Attributes:
        scene: what was meshed; engines take the material from it.
        position: rest position of each node, shape (nodes, 2), m.
        first: fibre f has the nodes first[f] to first[f + 1] - 1, shape (fibres + 1,).
        held: which displacements are prevented, shape (nodes, 2), bool.
        clamped: whether the near end of each fibre keeps its direction, shape (fibres,).
        pull: constant force on each node once the ramp is over, shape (nodes, 2), N.
        load: force on each node for u = 1, shape (nodes, 2), N.
        joints: pairs of nodes tied by spring and damper, shape (joints, 2).
        joint_stiffness: shape (joints,), N/m; infinite: the nodes are one point.
        joint_damping: shape (joints,), N s/m.
        drive: cubic coefficients of u on each knot interval, highest power first, shape
            (intervals, 4); the interval is 1 / scene.drive_rate s long.
        readouts: what is recorded.
        start: displacement at t = 0, shape (nodes, 2), m.
    """

    scene: Scene
    position: np.ndarray
    first: np.ndarray
    held: np.ndarray
    clamped: np.ndarray
    pull: np.ndarray
    load: np.ndarray
    joints: np.ndarray
    joint_stiffness: np.ndarray
    joint_damping: np.ndarray
    drive: np.ndarray
    readouts: tuple[Readout, ...]
    start: np.ndarray

    @property
    def elements(self) -> int:
        """Number of elements of all fibres."""
        return len(self.position) - len(self.first) + 1

    def edges(self, fibre: int) -> np.ndarray:
        """Rest length of the elements of a fibre, m."""
        nodes = self.position[self.first[fibre] : self.first[fibre + 1]]
        return np.linalg.norm(np.diff(nodes, axis=0), axis=1)

    def masses(self) -> np.ndarray:
        """Lumped mass of each node, shape (nodes,), kg."""
        line_density = self.scene.density * self.scene.area
        mass = np.zeros(len(self.position))
        for fibre, start in enumerate(self.first[:-1]):
            half = 0.5 * line_density * self.edges(fibre)
            mass[start : start + len(half)] += half
            mass[start + 1 : start + 1 + len(half)] += half
        return mass


def build(scene: Scene, elements_per_section: int | None = None) -> Mesh:
    """Cut a scene into elements.

    Args:
        scene: to be meshed.
        elements_per_section: elements on a section as long as the network's spacing; other
            sections get proportionally many. None: the authors' mesh, 10 mm and at least 50
            elements a fibre.

    Raises:
        ValueError: elements_per_section below 1, or sliding ends on slanted fibres.
    """
    if elements_per_section is not None and elements_per_section < 1:
        raise ValueError(
            f"elements_per_section = {elements_per_section} must be a whole number of at least 1"
        )
    network = scene.network
    uniform = elements_per_section is None and network.topology == "crosshatch"
    lines = _authors_lines(scene) if uniform else _section_lines(scene, elements_per_section)
    position = np.concatenate([line.points for line in lines])
    first = np.cumsum([0] + [len(line.points) for line in lines])
    joints, stiffness, damping = _joints(scene, lines, first)
    held, pull = _ends(scene, lines, first)
    load = _load(scene, lines, first)
    return Mesh(
        scene=scene,
        position=position,
        first=first,
        held=held,
        clamped=np.full(len(lines), scene.ends == "clamped"),
        pull=pull,
        load=load,
        joints=joints,
        joint_stiffness=stiffness,
        joint_damping=damping,
        drive=np.ascontiguousarray(spline(scene.seed, scene.duration, scene.drive_rate).c.T),
        readouts=_readouts(scene, lines, first),
        start=load * (scene.disturbance / scene.force),
    )


class _Line(NamedTuple):
    """One meshed fibre."""

    points: np.ndarray  # (nodes, 2)
    along: np.ndarray  # distance of each node from the near end (m)
    crossing_nodes: tuple[int, ...]  # in the order of the network's stations
    section_middles: np.ndarray  # distance of each section's midpoint (m)


def _section_lines(scene: Scene, elements_per_section: int | None) -> list[_Line]:
    """Every crossing on a node, sections cut evenly."""
    network = scene.network
    target = (
        AUTHORS_ELEMENT if elements_per_section is None else network.spacing / elements_per_section
    )
    lines = []
    for fibre, (near, far) in enumerate(network.fibres):
        ends = network.sections(fibre)
        lengths = np.diff(ends)
        most = np.maximum(1, np.floor(lengths / (ELEMENT_FLOOR * scene.diameter))).astype(int)
        # the floor is for the short sections of a polygon; a uniform mesh is the user's choice
        counts = np.maximum(1, np.round(lengths / target)).astype(int)
        if network.topology == "polygon":
            counts = np.minimum(counts, most)
        along = np.concatenate(
            [[0.0]] + [np.linspace(a, b, c + 1)[1:] for a, b, c in zip(ends, ends[1:], counts)]
        )
        direction = (far - near) / ends[-1]
        lines.append(
            _Line(
                near + along[:, None] * direction,
                along,
                tuple(np.cumsum(counts)[:-1].tolist()),
                0.5 * (ends[1:] + ends[:-1]),
            )
        )
    return lines


def _authors_lines(scene: Scene) -> list[_Line]:
    """The authors' crosshatch: equal elements, crossings on the node below their place, and
    the fibres laid through those nodes."""
    network = scene.network
    coarse = network.spacing > 0.03 + 1e-9  # 5 mm elements at 20 and 30 mm
    count = round(network.length / (AUTHORS_ELEMENT if coarse else AUTHORS_ELEMENT / 2))
    count = max(50, count) if coarse else count
    along = np.linspace(0.0, network.length, count + 1)
    grid = np.linspace(0, count + 1, network.n + 2)
    nodes = tuple(grid[1:-1].astype(int).tolist())
    middles = along[(0.5 * (grid[1:] + grid[:-1])).astype(int)]
    lines = []
    for across in along[list(nodes)]:
        lines.append(
            _Line(np.column_stack([along, np.full_like(along, across)]), along, nodes, middles)
        )
    return lines + [line._replace(points=line.points[:, ::-1]) for line in lines]


def _joints(scene: Scene, lines: list[_Line], first: np.ndarray):
    """Pairs of nodes at each crossing, with their stiffness and damping."""
    network = scene.network
    members: list[list[tuple[int, int]]] = [[] for _ in network.crossings]  # (fibre, node)
    for fibre, stations in enumerate(network.stations):
        for (crossing, _), node in zip(stations, lines[fibre].crossing_nodes):
            members[crossing].append((fibre, first[fibre] + node))
    authors_polygon = scene.setup == "published" and network.topology == "polygon"
    if authors_polygon:
        members += _vertices(network, first)
    pairs, scale = [], []
    for group in members:
        for (fibre_a, a), (fibre_b, b) in combinations(group, 2):
            factor = _authors_polygon_scale(network, fibre_a, fibre_b) if authors_polygon else 1.0
            at_end = a in first[:-1] or a + 1 in first[1:]
            factor = 1.0 if at_end else factor
            if factor:
                pairs.append((a, b))
                scale.append(factor)
    scale = np.array(scale)
    return (
        np.array(pairs, dtype=np.int64).reshape(-1, 2),
        scene.crossing_stiffness * scale,
        scene.crossing_damping * scale,
    )


def _authors_polygon_scale(network, a: int, b: int) -> float:
    """Stiffness of a joint relative to the others: a hundredth between two diagonals, and none
    between the last diagonal and the first."""
    diameters = network.n // 2
    if a < diameters or b < diameters:
        return 1.0
    return 0.0 if {a, b} == {diameters, diameters + network.n - 1} else 0.01


def _vertices(network, first: np.ndarray) -> list[list[tuple[int, int]]]:
    """Fibre ends that meet at each vertex, as (fibre, node)."""
    groups: dict[tuple[float, float], list[tuple[int, int]]] = {}
    for fibre, ends in enumerate(network.fibres):
        for end, node in zip(ends, (first[fibre], first[fibre + 1] - 1)):
            groups.setdefault((round(end[0], 9) + 0.0, round(end[1], 9) + 0.0), []).append(
                (fibre, node)
            )
    return list(groups.values())


def _ends(scene: Scene, lines: list[_Line], first: np.ndarray):
    """Held displacements and tension of every node."""
    network = scene.network
    held = np.zeros((first[-1], 2), dtype=bool)
    pull = np.zeros((first[-1], 2))
    held[first[:-1]] = True
    authors_polygon = scene.setup == "published" and network.topology == "polygon"
    for fibre, line in enumerate(lines):
        direction = (line.points[-1] - line.points[0]) / line.along[-1]
        far = first[fibre + 1] - 1
        if scene.ends == "sliding":
            if abs(direction).min() > 1e-12:
                raise ValueError(
                    "ends = 'sliding' needs fibres along x or y; a polygon takes 'clamped' or "
                    "'pinned'"
                )
            held[far] = abs(direction) < 0.5
        if not authors_polygon or fibre < network.n // 2:  # the authors pull the diameters only
            pull[far] = scene.tension * direction
    return held, pull


def _load(scene: Scene, lines: list[_Line], first: np.ndarray) -> np.ndarray:
    """Force on every node for u = 1: lateral, on the driven fibre."""
    network = scene.network
    load = np.zeros((first[-1], 2))
    if scene.setup == "published" and network.topology == "crosshatch":
        fibre = 0 if network.n == 2 else network.driven_fibre
        middle = first[fibre] + (len(lines[fibre].points) - 1) // 2
        for offset, weight in AUTHORS_LOAD.items():
            load[middle + offset, 1] -= weight * scene.force
        return load
    fibre = network.driven_fibre
    nodes, weights = _at(lines[fibre].along, network.driven_distance)
    near, far = network.fibres[fibre]
    lateral = np.array([-(far - near)[1], (far - near)[0]]) / np.linalg.norm(far - near)
    for node, weight in zip(nodes, weights):
        load[first[fibre] + node] += weight * scene.force * lateral
    return load


def _at(along: np.ndarray, distance: float):
    """The nodes about a distance along a fibre, four where there are as many, and the weights of
    the polynomial through them."""
    count = min(4, len(along))
    left = np.searchsorted(along, distance * (1 + 1e-12)) - count // 2
    left = int(np.clip(left, 0, len(along) - count))
    near = along[left : left + count]
    weights = [
        np.prod([(distance - b) / (a - b) for b in np.delete(near, i)]) for i, a in enumerate(near)
    ]
    return tuple(range(left, left + count)), tuple(np.round(weights, 12).tolist())


def _readouts(scene: Scene, lines: list[_Line], first: np.ndarray) -> tuple[Readout, ...]:
    """Crossings (read on their first fibre), then section midpoints, fibre by fibre; then every
    node of every fibre if the scene asks for centre lines."""
    network = scene.network
    seen, readouts = set(), []
    for fibre, stations in enumerate(network.stations):
        for number, ((crossing, _), node) in enumerate(zip(stations, lines[fibre].crossing_nodes)):
            if crossing not in seen:
                seen.add(crossing)
                readouts.append(_readout("crossing", fibre, number, first[fibre], (node,), (1.0,)))
    for fibre, line in enumerate(lines):
        kind = "section_midpoint"
        if network.topology == "crosshatch":
            kind = "horizontal_midpoint" if fibre < network.n else "vertical_midpoint"
        for section, distance in enumerate(line.section_middles):
            nodes, weights = _at(line.along, distance)
            readouts.append(_readout(kind, fibre, section, first[fibre], nodes, weights))
    if scene.centre_lines:
        for fibre, line in enumerate(lines):
            for number in range(len(line.points)):
                readouts.append(_readout("node", fibre, number, first[fibre], (number,), (1.0,)))
    return tuple(readouts)


def _readout(kind: str, fibre: int, section: int, first: int, nodes, weights) -> Readout:
    """A readout by nodes of its fibre, filled up to four of which the last have no weight."""
    spare = 4 - len(nodes)
    nodes = tuple(int(first + node) for node in (*nodes, *[nodes[-1]] * spare))
    return Readout(kind, fibre, section, nodes, (*weights, *[0.0] * spare))
