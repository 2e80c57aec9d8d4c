"""Named groups of signals: which displacements of which readouts (paper, section 'Output feature
down-selection').

A signal is one displacement of one readout; their order is that of `fiberweb.model.readouts`. A
crosshatch is held at its left and lower ends and pulled at its right and upper ones; rows count
from the bottom, columns from the left, and section j of a fibre from its held end, all from 0.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd

from fiberweb.model.authors import SPRINGS_CROSSINGS, SPRINGS_MIDPOINTS
from fiberweb.model.network import Network
from fiberweb.model.readouts import AXES, Place, as_signals, places

ALL = "all"
KINDS = ("crossing", "horizontal_midpoint", "vertical_midpoint")
SUBGROUPS = tuple(f"{kind}_{axis}" for kind in KINDS for axis in "xy")
LATERAL, NEAR_SPRINGS, NEAR_ACTUATION = "lateral_midpoints", "near_springs", "near_actuation"
REDUCED = (LATERAL, NEAR_SPRINGS, NEAR_ACTUATION)
GROUPS = (ALL, *SUBGROUPS, *REDUCED)
OF_POLYGON = (ALL, "crossing_x", "crossing_y")


def readouts(network: Network) -> pd.DataFrame:
    """What a simulation of the network records, in its order.

    Returns:
        One row a readout: kind, fibre, section (number of the crossing or of the section along
        the fibre), x and y (rest position in m).
    """
    return pd.DataFrame(places(network), columns=list(Place._fields))


def names(network: Network) -> tuple[str, ...]:
    """The groups that this network has."""
    return GROUPS if network.topology == "crosshatch" else OF_POLYGON


def mask(group: str, network: Network, points: Mapping) -> np.ndarray:
    """Which signals belong to a group.

    - ``crossing_x`` to ``vertical_midpoint_y``: one displacement of one kind of readout.
    - ``lateral_midpoints``: y of horizontal and x of vertical midpoints.
    - ``near_springs``, x and y: the authors' readouts for N = 4 and 6. They fit no one rule; for
      any other N those beyond the diagonal between the corners where a held and a pulled end
      meet, x + y >= L.
    - ``near_actuation``, x and y: those within N/4 spacings of the centre in x and in y, which is
      the authors' choice for N = 4 and 6.

    Args:
        group: one of `names(network)`.
        network: that was simulated.
        points: ``kind``, ``fibre`` and ``section`` of m readouts, (m,) each: a response, or a
            frame such as `readouts` makes. Some may be missing.

    Returns:
        (2m,) bool.

    Raises:
        ValueError: there is no such group, or this network has none.
    """
    if group not in GROUPS:
        raise ValueError(f"group = {group!r} is unknown; use one of {', '.join(GROUPS)}")
    if group not in names(network):
        raise ValueError(
            f"group = {group!r} needs a crosshatch; a {network.topology} has only "
            f"{', '.join(names(network))}"
        )
    kind = np.asarray(points["kind"]).astype(str)
    if group == ALL:
        return np.ones(2 * len(kind), dtype=bool)
    if group in SUBGROUPS:
        of_kind, axis = group.rsplit("_", 1)
        chosen = kind == of_kind
        return as_signals(*(chosen & (axis == each) for each in AXES))
    if group == LATERAL:
        return as_signals(kind == "vertical_midpoint", kind == "horizontal_midpoint")
    across, along = _places(kind, points, network.n)
    rule = _near_springs if group == NEAR_SPRINGS else _near_actuation
    near = rule(network.n, kind == "crossing", across, along)
    return as_signals(near, near)


def _places(kind: np.ndarray, points: Mapping, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Number of each readout's fibre among its parallels, and its number along that fibre."""
    fibre = np.asarray(points["fibre"])
    return np.where(kind == "vertical_midpoint", fibre - n, fibre), np.asarray(points["section"])


def _near_springs(n: int, crossing: np.ndarray, across: np.ndarray, along: np.ndarray):
    rows = np.arange(n)
    first_crossing = np.array(SPRINGS_CROSSINGS.get(n, n - 1 - rows))
    first_midpoint = np.array(SPRINGS_MIDPOINTS.get(n, n - rows))
    return along >= np.where(crossing, first_crossing[across], first_midpoint[across])


def _near_actuation(n: int, crossing: np.ndarray, across: np.ndarray, along: np.ndarray):
    # in spacings from the centre; whole and half numbers, so that the comparison is exact
    beside = np.abs(across - (n - 1) / 2)
    ahead = np.abs(along - np.where(crossing, (n - 1) / 2, n / 2))
    return np.maximum(beside, ahead) <= n / 4
