"""A scene cut into elements: the flat arrays that every engine integrates."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import NamedTuple

import numpy as np

from fiberweb.arguments import whole
from fiberweb.model import authors_mesh, drive
from fiberweb.model.authors import ELEMENT
from fiberweb.model.lines import Line, cut, nodes_about
from fiberweb.model.readouts import places
from fiberweb.model.scene import Scene


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
        guided: nodes that slide along a slanted line, shape (guided,).
        guides: unit vectors of these lines, shape (guided, 2).
        clamped: whether the near end of each fibre keeps its direction, shape (fibres,).
        pull: constant force on each node once the ramp is over, shape (nodes, 2), N.
        load: force on each node for u = 1, shape (nodes, 2), N.
        joints: pairs of nodes tied by spring and damper, shape (joints, 2).
        joint_stiffness: shape (joints,), N/m; infinite: the nodes are one point.
        joint_damping: shape (joints,), N s/m.
        bond_stiffness: of springs that keep the angle between the fibres at each joint, shape
            (joints,), N m.
        sprung: nodes held by a spring along their fibre, shape (sprung,).
        springs: its unit vector times the root of its stiffness, shape (sprung, 2), (N/m)^(1/2).
        moved: nodes whose motion is given, shape (moved,).
        path: their displacement for u = 1, shape (moved, 2), m.
        drive: cubic coefficients of u on each interval, highest power first, shape (intervals, 4).
        drive_rate: intervals per second (Hz).
        readouts: what is recorded.
        start: displacement at t = 0, shape (nodes, 2), m.
        stoutness: what rotary inertia and shear compliance are multiplied with, to see more of
            what they do at a step that is longer by as much; see `fiberweb.validation.certificate`.
    """

    scene: Scene
    position: np.ndarray
    first: np.ndarray
    held: np.ndarray
    guided: np.ndarray
    guides: np.ndarray
    clamped: np.ndarray
    pull: np.ndarray
    load: np.ndarray
    joints: np.ndarray
    joint_stiffness: np.ndarray
    joint_damping: np.ndarray
    bond_stiffness: np.ndarray
    sprung: np.ndarray
    springs: np.ndarray
    moved: np.ndarray
    path: np.ndarray
    drive: np.ndarray
    drive_rate: float
    readouts: tuple[Readout, ...]
    start: np.ndarray
    stoutness: float = 1.0

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
        mass = np.zeros(len(self.position))
        line_density = self.scene.fibres.line_density
        for fibre, start in enumerate(self.first[:-1]):
            half = 0.5 * line_density[fibre] * self.edges(fibre)
            mass[start : start + len(half)] += half
            mass[start + 1 : start + 1 + len(half)] += half
        return mass


def build(scene: Scene, elements_per_section: int | None = None) -> Mesh:
    """Cut a scene into elements.

    Args:
        scene: to be meshed.
        elements_per_section: elements on a section as long as the network's spacing; other
            sections get proportionally many; in the authors' layout not less than on their mesh,
            whose nodes the crossings are. None: the authors' mesh, 10 mm and, of a crosshatch
            in their layout, at least 50 elements per fibre.

    Raises:
        ValueError: elements_per_section below 1, or no node where a stroke carries one.
    """
    if elements_per_section is not None:
        elements_per_section = whole("elements_per_section", elements_per_section, 1)
    network = scene.network
    if scene.layout == "authors":
        parts = authors_mesh.parts(network, elements_per_section)
        lines = authors_mesh.cut(network, parts)
    elif elements_per_section is not None:
        lines = cut(scene, network.spacing / elements_per_section)
    else:
        lines = cut(scene, ELEMENT)
    position = np.concatenate([line.points for line in lines])
    first = np.cumsum([0] + [len(line.points) for line in lines])
    joints, stiffness, damping = _joints(scene, lines, first)
    held, guided, guides, pull = _ends(scene, lines, first)
    sprung, springs = _springs(scene, lines, first, pull)
    load = _load(scene, lines, first)
    moved, path = _motor(scene, lines, first)
    held[moved] = True
    u = drive.of_scene(scene)
    return Mesh(
        scene=scene,
        position=position,
        first=first,
        held=held,
        guided=guided,
        guides=guides,
        clamped=np.full(len(lines), scene.ends == "clamped"),
        pull=pull,
        load=load,
        joints=joints,
        joint_stiffness=stiffness,
        joint_damping=damping,
        bond_stiffness=np.full(len(joints), scene.bond_stiffness),
        sprung=sprung,
        springs=springs,
        moved=moved,
        path=path,
        drive=np.ascontiguousarray(u.c.T),
        drive_rate=drive.rate(scene),
        readouts=_readouts(scene, lines, first),
        start=load * (scene.disturbance / scene.force) if scene.disturbance else 0.0 * load,
    )


def _joints(scene: Scene, lines: list[Line], first: np.ndarray):
    """Pairs of nodes at each crossing, with their stiffness and damping."""
    network = scene.network
    members: list[list[tuple[int, int]]] = [[] for _ in network.crossings]  # (fibre, node)
    for fibre, stations in enumerate(network.stations):
        for (crossing, _), node in zip(stations, lines[fibre].crossing_nodes):
            members[crossing].append((fibre, first[fibre] + node))
    authors_polygon = scene.layout == "authors" and network.topology == "polygon"
    if authors_polygon:
        members += authors_mesh.vertices(network, first)
    pairs, scale = [], []
    for group in members:
        for (fibre_a, a), (fibre_b, b) in combinations(group, 2):
            at_end = a in first[:-1] or a + 1 in first[1:]
            factor = 1.0
            if authors_polygon:
                factor = authors_mesh.crossing_share(network, fibre_a, fibre_b, at_end)
            if factor:
                pairs.append((a, b))
                scale.append(factor)
    scale = np.array(scale)
    return (
        np.array(pairs, dtype=np.int64).reshape(-1, 2),
        scene.crossing_stiffness * scale,
        scene.crossing_damping * scale,
    )


def _ends(scene: Scene, lines: list[Line], first: np.ndarray):
    """Held displacements, nodes on slanted lines with their directions, tension of every node."""
    network = scene.network
    held = np.zeros((first[-1], 2), dtype=bool)
    pull = np.zeros((first[-1], 2))
    held[first[:-1]] = True
    slanted = {}
    pulled = range(len(lines))
    if scene.setup == "published":
        pulled = authors_mesh.pulled(network)
    for fibre, line in enumerate(lines):
        direction = (line.points[-1] - line.points[0]) / line.along[-1]
        far = first[fibre + 1] - 1
        if scene.ends in ("sliding", "sprung"):
            if abs(direction).min() > 1e-12:
                slanted[far] = direction
            else:
                held[far] = abs(direction) < 0.5
        if fibre in pulled:
            pull[far] = scene.tension * direction
            if scene.setup == "published":
                pull[first[fibre]] = -pull[far]  # on a held node, where only the filter sees it
    guided = np.array(list(slanted), dtype=np.int64)
    return held, guided, np.array([*slanted.values()]).reshape(-1, 2), pull


def _springs(scene: Scene, lines: list[Line], first: np.ndarray, pull: np.ndarray):
    """Nodes on springs, and these. What the springs give way when the fibres stretch under their
    tension is added to the pull."""
    if scene.ends != "sprung":
        return np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    far = first[1:] - 1
    along = np.array([(line.points[-1] - line.points[0]) / line.along[-1] for line in lines])
    tension = np.linalg.norm(pull[far], axis=1)
    given_way = scene.network.fibre_lengths * tension / (scene.fibres.axial_stiffness - tension)
    pull[far] += scene.end_stiffness * given_way[:, None] * along
    return far, np.sqrt(scene.end_stiffness) * along


def _motor(scene: Scene, lines: list[Line], first: np.ndarray):
    """The node that a stroke carries, and its displacement for u = 1."""
    if scene.stroke is None:
        return np.zeros(0, dtype=np.int64), np.zeros((0, 2))
    network = scene.network
    fibre = network.driven_fibre
    nodes, weights = nodes_about(lines[fibre].along, network.driven_distance)
    if max(weights) < 1.0:
        raise ValueError(
            f"stroke = {scene.stroke:g} carries the middle of a section, where this mesh has no "
            "node; take an even number of elements_per_section"
        )
    node = first[fibre] + nodes[weights.index(max(weights))]
    return np.array([node]), scene.stroke * network.across[None]


def _load(scene: Scene, lines: list[Line], first: np.ndarray) -> np.ndarray:
    """Force on every node for u = 1: lateral, on the driven fibre."""
    network = scene.network
    if scene.layout == "authors" and network.topology == "crosshatch":
        return authors_mesh.load_crosshatch(scene, first)
    if scene.layout == "authors":
        return authors_mesh.load_polygon(scene, lines, first)
    load = np.zeros((first[-1], 2))
    if scene.stroke is not None:
        return load
    fibre = network.driven_fibre
    nodes, weights = nodes_about(lines[fibre].along, network.driven_distance)
    for node, weight in zip(nodes, weights):
        load[first[fibre] + node] += weight * scene.force * network.across
    return load


def _readouts(scene: Scene, lines: list[Line], first: np.ndarray) -> tuple[Readout, ...]:
    """Those of the network, where the mesh has them; then every node of every fibre if the scene
    asks for centre lines."""
    readouts = []
    for kind, fibre, section, *_ in places(scene.network):
        line = lines[fibre]
        if kind == "crossing":
            nodes, weights = (line.crossing_nodes[section],), (1.0,)
        else:
            nodes, weights = nodes_about(line.along, line.section_middles[section])
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
