"""Fibres cut into elements, every crossing on a node and each section evenly."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.model.scene import Scene

ELEMENT_FLOOR = 2.0  # shortest element, in fibre diameters: below it a fibre is no slender rod


class Line(NamedTuple):
    """One fibre cut into elements.

    Attributes:
        points: rest position of each node from the near end on, shape (nodes, 2), m.
        along: distance of each node from the near end, shape (nodes,), m.
        crossing_nodes: node on each crossing, in the order of the network's stations.
        section_middles: distance of each section's midpoint from the near end, m.
    """

    points: np.ndarray
    along: np.ndarray
    crossing_nodes: tuple[int, ...]
    section_middles: np.ndarray


def cut(scene: Scene, target: float) -> list[Line]:
    """The fibres of a scene, in elements as near to `target` (m) as sections allow."""
    network = scene.network
    lines = []
    for fibre, (near, far) in enumerate(network.fibres):
        ends = network.sections(fibre)
        lengths = np.diff(ends)
        most = np.maximum(1, np.floor(lengths / (ELEMENT_FLOOR * scene.thickest))).astype(int)
        # the limit is for the short sections of others; a uniform mesh is the user's choice
        counts = np.maximum(1, np.round(lengths / target)).astype(int)
        if network.topology != "crosshatch":
            counts = np.minimum(counts, most)
        along = np.concatenate(
            [[0.0]] + [np.linspace(a, b, c + 1)[1:] for a, b, c in zip(ends, ends[1:], counts)]
        )
        direction = (far - near) / ends[-1]
        lines.append(
            Line(
                near + along[:, None] * direction,
                along,
                tuple(np.cumsum(counts)[:-1].tolist()),
                0.5 * (ends[1:] + ends[:-1]),
            )
        )
    return lines


def nodes_about(along: np.ndarray, distance: float) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """The nodes about a distance (m) along a fibre, four where there are as many, and the weights
    of the polynomial through them."""
    count = min(4, len(along))
    left = np.searchsorted(along, distance * (1 + 1e-12)) - count // 2
    left = int(np.clip(left, 0, len(along) - count))
    near = along[left : left + count]
    weights = [
        np.prod([(distance - b) / (a - b) for b in np.delete(near, i)]) for i, a in enumerate(near)
    ]
    return tuple(range(left, left + count)), tuple(np.round(weights, 12).tolist())
