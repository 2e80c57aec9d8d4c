"""What is recorded of a network: its readouts and signals, in the one order that all data have.

A signal is one displacement of one readout. All readouts' x come first, then all readouts' y.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.model.network import Network

AXES = ("x", "y")


class Place(NamedTuple):
    """One readout of a network, however it is meshed.

    Attributes:
        kind: crossing; horizontal_midpoint or vertical_midpoint of a crosshatch, section_midpoint
            of other networks.
        fibre: on which it is read.
        section: number of the crossing or of the section along the fibre.
        x, y: rest position, m.
    """

    kind: str
    fibre: int
    section: int
    x: float
    y: float


def places(network: Network) -> list[Place]:
    """Crossings (each on the first of its fibres), then section midpoints, fibre by fibre."""
    seen, readouts = set(), []
    for fibre, stations in enumerate(network.stations):
        for number, (crossing, _) in enumerate(stations):
            if crossing not in seen:
                seen.add(crossing)
                readouts.append(Place("crossing", fibre, number, *network.crossings[crossing]))
    for fibre, (near, far) in enumerate(network.fibres):
        kind = "section_midpoint"
        if network.topology == "crosshatch":
            kind = "horizontal_midpoint" if fibre < network.n else "vertical_midpoint"
        ends = network.sections(fibre)
        for section, distance in enumerate(0.5 * (ends[1:] + ends[:-1])):
            readouts.append(
                Place(kind, fibre, section, *(near + (far - near) * distance / ends[-1]))
            )
    return readouts


def as_signals(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """What belongs to either displacement of m readouts, (..., m) each, as signals (..., 2m)."""
    return np.concatenate([x, y], axis=-1)


def of_signals(numbers: np.ndarray, readouts: int) -> tuple[np.ndarray, list[str]]:
    """Readout and axis of signals by their numbers; readouts: how many there are."""
    return numbers % readouts, [AXES[number // readouts] for number in numbers]
