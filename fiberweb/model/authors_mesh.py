"""How the authors cut their fibres, tied them and loaded them.

Facts only, read off the simulation scripts of crosshatch and polygon in their public repository
(github.com/NaughtonLab/ReservoirFiberNetworks), and none of its code. Constants: `authors`.
"""

from __future__ import annotations

import numpy as np

from fiberweb.model.authors import ELEMENT, LEAST_ELEMENTS, LOAD
from fiberweb.model.lines import Line
from fiberweb.model.network import Network
from fiberweb.model.scene import Scene


def elements(network: Network) -> int:
    """Of each fibre of a crosshatch."""
    if network.spacing > 0.03 + 1e-9:
        return max(LEAST_ELEMENTS, round(network.length / ELEMENT))
    return round(network.length / (ELEMENT / 2))


def parts(network: Network, elements_per_section: int | None) -> int:
    """In how many each of their elements is cut, so that a section has so many, about; at least 1,
    since crossings are on their nodes. None: 1."""
    theirs = network.spacing / ELEMENT
    if network.topology == "crosshatch":
        theirs = elements(network) * network.spacing / network.length
    return max(1, round((elements_per_section or theirs) / theirs))


def cut(network: Network, split: int = 1) -> list[Line]:
    """The fibres in their elements, or each of these in so many."""
    each = cut_crosshatch if network.topology == "crosshatch" else cut_polygon
    return each(network, split)


def cut_crosshatch(network: Network, split: int = 1) -> list[Line]:
    """Equal elements, crossings on the node below their place, and the fibres laid through those
    nodes.

    split: see `parts`.
    """
    count = elements(network)
    theirs = np.linspace(0.0, network.length, count + 1)
    grid = np.linspace(0, count + 1, network.n + 2)
    crossings = grid[1:-1].astype(int)
    middles = theirs[(0.5 * (grid[1:] + grid[:-1])).astype(int)]
    along = np.linspace(0.0, network.length, split * count + 1)
    nodes = tuple((split * crossings).tolist())
    lines = []
    for across in theirs[crossings]:
        lines.append(
            Line(np.column_stack([along, np.full_like(along, across)]), along, nodes, middles)
        )
    return lines + [line._replace(points=line.points[:, ::-1]) for line in lines]


def cut_polygon(network: Network, split: int = 1) -> list[Line]:
    """Elements of about 10 mm; crossings and midpoints on the node before their place, the fibres
    where they belong, so that what is tied is some millimetres apart.

    split: see `parts`.
    """
    lines = []
    for fibre, (near, far) in enumerate(network.fibres):
        ends = network.sections(fibre)
        count = round(ends[-1] / ELEMENT)
        theirs = np.linspace(0.0, ends[-1], count + 1)
        along = np.linspace(0.0, ends[-1], split * count + 1)
        before = np.floor(count * ends[1:-1] / ends[-1] + 1e-9).astype(int)
        middles = np.floor(count * 0.5 * (ends[1:] + ends[:-1]) / ends[-1] + 1e-9).astype(int)
        points = near + along[:, None] * (far - near) / ends[-1]
        lines.append(Line(points, along, tuple((split * before).tolist()), theirs[middles]))
    return lines


def load_polygon(scene: Scene, lines: list[Line], first: np.ndarray) -> np.ndarray:
    """The same of a polygon: on the node halfway between those of the centre and of the next
    crossing of the first diameter."""
    network = scene.network
    fibre, line = network.driven_fibre, lines[network.driven_fibre]
    count = round(line.along[-1] / ELEMENT)
    split, centre = (len(line.points) - 1) // count, count // 2
    following = min(node // split for node in line.crossing_nodes if node > split * centre)
    load = np.zeros((first[-1], 2))
    load[first[fibre] + split * ((centre + following) // 2), 1] = scene.force
    return load


def load_crosshatch(scene: Scene, first: np.ndarray) -> np.ndarray:
    """Force on every node for u = 1, shape (nodes, 2), N: downwards, on their nodes about the
    middle of the driven fibre, which is the first one for N = 2."""
    network = scene.network
    fibre = 0 if network.n == 2 else network.driven_fibre
    count = elements(network)
    split = (first[fibre + 1] - first[fibre] - 1) // count
    load = np.zeros((first[-1], 2))
    for offset, share in LOAD.items():
        load[first[fibre] + split * (count // 2 + offset), 1] -= share * scene.force
    return load


def vertices(network: Network, first: np.ndarray) -> list[list[tuple[int, int]]]:
    """Fibre ends that meet at each vertex of a polygon, which are tied, as (fibre, node)."""
    groups: dict[tuple[float, float], list[tuple[int, int]]] = {}
    for fibre, ends in enumerate(network.fibres):
        for end, node in zip(ends, (first[fibre], first[fibre + 1] - 1)):
            groups.setdefault((round(end[0], 9) + 0.0, round(end[1], 9) + 0.0), []).append(
                (fibre, node)
            )
    return list(groups.values())


def crossing_share(network: Network, a: int, b: int, at_end: bool) -> float:
    """Stiffness where two fibres of a polygon cross, a before b, relative to others: diameters are
    tied in a chain at the centre, diagonals to one another by a hundredth and not at vertices, and
    the first two of them not at all."""
    diameters = network.n // 2
    if b < diameters:
        return float(b == a + 1)
    if a < diameters:
        return 1.0
    return 0.0 if at_end or (a, b) == (diameters, diameters + 1) else 0.01


def pulled(network: Network) -> range:
    """The fibres that are pulled: all of a crosshatch, the diameters only of a polygon."""
    polygon = network.topology == "polygon"
    return range(network.n // 2 if polygon else len(network.fibres))
