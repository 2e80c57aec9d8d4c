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


def cut_crosshatch(scene: Scene) -> list[Line]:
    """Equal elements, crossings on the node below their place, and the fibres laid through those
    nodes."""
    network = scene.network
    coarse = network.spacing > 0.03 + 1e-9
    count = round(network.length / (ELEMENT if coarse else ELEMENT / 2))
    count = max(LEAST_ELEMENTS, count) if coarse else count
    along = np.linspace(0.0, network.length, count + 1)
    grid = np.linspace(0, count + 1, network.n + 2)
    nodes = tuple(grid[1:-1].astype(int).tolist())
    middles = along[(0.5 * (grid[1:] + grid[:-1])).astype(int)]
    lines = []
    for across in along[list(nodes)]:
        lines.append(
            Line(np.column_stack([along, np.full_like(along, across)]), along, nodes, middles)
        )
    return lines + [line._replace(points=line.points[:, ::-1]) for line in lines]


def load_crosshatch(scene: Scene, first: np.ndarray) -> np.ndarray:
    """Force on every node for u = 1, shape (nodes, 2), N: downwards, on nodes about the middle of
    the driven fibre, which is the first one for N = 2."""
    network = scene.network
    fibre = 0 if network.n == 2 else network.driven_fibre
    middle = first[fibre] + (first[fibre + 1] - first[fibre] - 1) // 2
    load = np.zeros((first[-1], 2))
    for offset, share in LOAD.items():
        load[middle + offset, 1] -= share * scene.force
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


def crossing_share(network: Network, a: int, b: int) -> float:
    """Stiffness where two fibres of a polygon cross, relative to others: a hundredth between two
    diagonals, and none between the last diagonal and the first."""
    diameters = network.n // 2
    if a < diameters or b < diameters:
        return 1.0
    return 0.0 if {a, b} == {diameters, diameters + network.n - 1} else 0.01


def pulled(network: Network) -> range:
    """The fibres that are pulled: all of a crosshatch, the diameters only of a polygon."""
    polygon = network.topology == "polygon"
    return range(network.n // 2 if polygon else len(network.fibres))
