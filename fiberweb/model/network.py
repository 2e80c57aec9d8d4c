"""Fibres and where they cross: the geometry of a network, free of material and mesh.

Every fibre is straight at rest and runs from its *near* end, the one a scene holds,
to its *far* end, the one a scene pulls. Lengths are in metres.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations

import numpy as np

from fiberweb.arguments import check_magnitude, plain, positive, shown, spelt, whole

METRES = " must be a positive length in metres"
# Beyond these a network alone takes minutes to lay out: a polygon has some n^4 / 24 crossings.
MOST_FIBRES, MOST_VERTICES = 500, 16
MOST_STRAIGHT = 100  # fibres of a web, whose crossings are looked for one by one
SHORTEST, LONGEST = 1e-5, 1e5  # m; of shorter polygons crossings would be taken for one
COINCIDENT = 1e-9  # two crossings closer than this (m) are one: several fibres through a point


@dataclass(frozen=True)
class Network:
    """Straight fibres and their crossings.

    Attributes:
        topology: "crosshatch", "polygon" or "web".
        n: fibres in each direction, vertices of the polygon, or fibres of the web.
        length: outer dimension (m): fibre length, diameter of the circumscribed circle, or the
            longer side of the box around the web.
        spacing: length (m) of the driven section; s of Eqs. 3 and 4.
        diagonals: "all" or "skip-one" for a polygon, else "".
        fibres: near and far end of each fibre, shape (fibres, 2, 2), m.
        stations: for each fibre the crossings on it from near to far end, as pairs
            (index of the crossing, distance from the near end in m).
        crossings: where fibres cross, shape (crossings, 2), m.
        driven_fibre: index of the fibre that is shaken.
        driven_distance: distance of the driven point from that fibre's near end (m).
    """

    topology: str
    n: int
    length: float
    spacing: float
    diagonals: str
    fibres: np.ndarray = field(repr=False, compare=False)
    stations: tuple[tuple[tuple[int, float], ...], ...] = field(repr=False, compare=False)
    crossings: np.ndarray = field(repr=False, compare=False)
    driven_fibre: int = field(repr=False)
    driven_distance: float = field(repr=False)

    @property
    def fibre_lengths(self) -> np.ndarray:
        """Rest length of each fibre, shape (fibres,), m."""
        return np.linalg.norm(self.fibres[:, 1] - self.fibres[:, 0], axis=1)

    @property
    def driven_point(self) -> np.ndarray:
        """Where the driven fibre is shaken, shape (2,), m."""
        near, far = self.fibres[self.driven_fibre]
        return near + (far - near) * (self.driven_distance / np.linalg.norm(far - near))

    @property
    def across(self) -> np.ndarray:
        """Unit vector across the driven fibre, along which it is shaken, shape (2,)."""
        near, far = self.fibres[self.driven_fibre]
        return np.array([-(far - near)[1], (far - near)[0]]) / np.linalg.norm(far - near)

    @property
    def readouts(self) -> int:
        """How many there are: crossings, and the midpoints of all sections."""
        return len(self.crossings) + sum(len(stations) + 1 for stations in self.stations)

    def sections(self, fibre: int) -> np.ndarray:
        """Ends of the sections of a fibre, from 0 to its length, shape (crossings + 2,), m."""
        inner = [distance for _, distance in self.stations[fibre]]
        return np.array([0.0, *inner, self.fibre_lengths[fibre]])

    def spec(self) -> dict:
        """What `from_spec` needs to build the network again."""
        if self.topology == "web":
            driven = {"driven_fibre": self.driven_fibre, "driven_distance": self.driven_distance}
            return {"topology": "web", "fibres": self.fibres.tolist()} | driven
        spec = {"topology": self.topology, "n": self.n, "length": self.length}
        return spec | ({"diagonals": self.diagonals} if self.diagonals else {})


@spelt
def crosshatch(n: int, length: float | None = None, spacing: float | None = None) -> Network:
    """N + N fibres crossing at right angles, with end stubs as long as a section.

    Fibres 0..N-1 are horizontal from the bottom up and run from left to right; N..2N-1 are
    vertical from the left and run upwards. Paper, section "Fiber network setup"; the fibre
    length is (N + 1) spacings.

    Args:
        n: fibres in each direction, 2 to `MOST_FIBRES`.
        length: fibre length (m); give this or `spacing`.
        spacing: distance between neighbouring parallel fibres (m).

    Raises:
        ValueError: n out of range, neither or both of length and spacing, or one not positive.
    """
    n = whole("n", n, 2, ": a crosshatch has at least 2 fibres in each direction, a whole number")
    _refuse_endless(n, MOST_FIBRES, "fibres in each direction")
    if (length is None) == (spacing is None):
        raise ValueError(
            f"crosshatch takes either length or spacing, not length = {length} and "
            f"spacing = {spacing}"
        )
    if spacing is None:
        length = positive("length", length, METRES)
    else:
        length = positive("spacing", spacing, METRES) * (n + 1)
    check_magnitude("length", length, SHORTEST, LONGEST)
    spacing = length / (n + 1)
    at = spacing * np.arange(1, n + 1)
    horizontal = [[[0.0, y], [length, y]] for y in at]
    vertical = [[[x, 0.0], [x, length]] for x in at]
    # crossing index = row * n + column
    stations = [tuple((row * n + col, at[col]) for col in range(n)) for row in range(n)]
    stations += [tuple((row * n + col, at[row]) for row in range(n)) for col in range(n)]
    crossings = np.array([[x, y] for y in at for x in at])
    return Network(
        "crosshatch", n, length, spacing, "", np.array(horizontal + vertical),
        tuple(stations), crossings, n // 2, length / 2,
    )  # fmt: skip


@spelt
def polygon(n: int, diameter: float = 0.5, diagonals: str = "all") -> Network:
    """Fibres along the diagonals of a regular N-gon, N even.

    Fibres 0..N/2-1 are the diameters; the first lies along x. The driven point is on it,
    halfway between the centre and the next crossing towards its far end, and that section is
    the s of Eq. 3.

    Args:
        n: vertices, an even number from 6 to `MOST_VERTICES`.
        diameter: of the circumscribed circle (m).
        diagonals: "all" joins every pair of non-neighbours (the paper's text), "skip-one"
            only the diameters and the vertices two apart (the authors' code).

    Raises:
        ValueError: n odd or out of range, diameter not positive, or another word in diagonals.
    """
    n = whole("n", n, 6, ": a polygon has an even number of at least 6 vertices")
    _refuse_endless(n, MOST_VERTICES, "vertices")
    if n % 2:
        raise ValueError(f"n = {n}: a polygon has an even number of vertices, for its diameters")
    diameter, diagonals = positive("diameter", diameter, METRES), plain(diagonals)
    check_magnitude("diameter", diameter, SHORTEST, LONGEST)
    if diagonals not in ("all", "skip-one"):
        raise ValueError(f"diagonals = {diagonals!r} is not one of 'all', 'skip-one'")
    # vertex 0 at -x, so that the first diameter runs from left to right
    angle = np.pi + 2 * np.pi * np.arange(n) / n
    vertex = 0.5 * diameter * np.column_stack([np.cos(angle), np.sin(angle)])
    pairs = [(i, i + n // 2) for i in range(n // 2)]
    if diagonals == "skip-one":
        pairs += [(i, (i + 2) % n) for i in range(n)] if n > 4 else []
    else:
        pairs += [
            (i, j) for i, j in combinations(range(n), 2)
            if 2 <= j - i <= n - 2 and j - i != n // 2
        ]  # fmt: skip
    fibres = np.array([[vertex[i], vertex[j]] for i, j in pairs])
    crossings, stations = _cross(fibres)
    centre = 0.5 * diameter
    spacing = min(d - centre for _, d in stations[0] if d - centre > COINCIDENT)
    return Network(
        "polygon", n, diameter, spacing, diagonals, fibres, stations, crossings,
        0, centre + spacing / 2,
    )  # fmt: skip


@spelt
def web(fibres, driven_fibre: int = 0, driven_distance: float | None = None) -> Network:
    """Straight fibres of one's own; they are tied wherever they cross.

    The s of Eqs. 3 and 4 is the length of the section that is driven.

    Args:
        fibres: near and far end of each, [[[x, y], [x, y]], ...], shape (fibres, 2, 2), m; up to
            `MOST_STRAIGHT`.
        driven_fibre: number of the fibre that is shaken, from 0.
        driven_distance: of the driven point from that fibre's near end (m); None: halfway along.

    Raises:
        ValueError: fibres that are none, lie on one another, end on one another or hang on nothing
            that is driven; or no driven point; one sentence.
    """
    fibres = _checked(fibres)
    crossings, stations = _cross(fibres)
    _refuse_loose(fibres, stations, driven_fibre)
    length = float(np.linalg.norm(np.subtract(*fibres[driven_fibre])))
    distance = length / 2
    if driven_distance is not None:
        inside = f" is not on fibre {driven_fibre}; give a length within its {length:g} m"
        distance = positive("driven_distance", driven_distance, inside)
        if distance >= length:
            raise ValueError(f"driven_distance = {distance:g}{inside}")
    ends = np.array([0.0, *(at for _, at in stations[driven_fibre]), length])
    after = int(np.searchsorted(ends, distance))
    return Network(
        "web", len(fibres), float(np.ptp(fibres.reshape(-1, 2), axis=0).max()),
        float(ends[after] - ends[after - 1]), "", fibres, stations, crossings,
        driven_fibre, distance,
    )  # fmt: skip


def _checked(given) -> np.ndarray:
    """The ends of fibres (fibres, 2, 2), m; ValueError, one sentence, for others."""
    try:
        fibres = np.array(plain(given), dtype=float)
    except (TypeError, ValueError):
        fibres = np.empty(0)
    if fibres.ndim != 3 or fibres.shape[1:] != (2, 2) or not np.isfinite(fibres).all():
        raise ValueError(
            f"fibres = {shown(given)} is no list of fibres; give the near and the far end of each "
            "in metres, [[[x, y], [x, y]], ...]"
        )
    _refuse_endless(len(fibres), MOST_STRAIGHT, "fibres of a web", "fibres")
    length = np.linalg.norm(fibres[:, 1] - fibres[:, 0], axis=1)
    if (length < COINCIDENT).any():
        fibre = int(np.argmin(length))
        raise ValueError(f"fibre {fibre} of the web has no length: its two ends are one point")
    for each in (float(length.min()), float(length.max())):
        check_magnitude("length of a fibre", each, SHORTEST, LONGEST)
    for a, (near, far) in enumerate(fibres):
        along = (far - near) / length[a]
        for b in range(len(fibres)):
            # ends of b as seen from a: distance along it, and beside it
            x, y = np.array([along, [-along[1], along[0]]]) @ (fibres[b] - near).T
            on = (np.abs(y) < COINCIDENT) & (x > COINCIDENT) & (x < length[a] - COINCIDENT)
            if a != b and on.any():
                raise ValueError(
                    f"fibre {b} of the web ends on fibre {a}: ends are held and pulled, and fibres "
                    "are tied where they cross; let it go on beyond the crossing, or stop before"
                )
            same = (np.abs(y) < COINCIDENT).all() and min(x) < length[a] / 2 < max(x)
            if a < b and same:
                raise ValueError(f"fibres {a} and {b} of the web lie on one another; leave one out")
    return fibres


def _refuse_loose(fibres: np.ndarray, stations, driven_fibre: int) -> None:
    """Raise ValueError, one sentence, if nothing is driven, or not all hangs on it."""
    whole("driven_fibre", driven_fibre, 0)
    if driven_fibre >= len(fibres):
        raise ValueError(
            f"driven_fibre = {driven_fibre} does not exist: the web has fibres 0 to "
            f"{len(fibres) - 1}"
        )
    on = [{crossing for crossing, _ in each} for each in stations]
    reached, queue = {driven_fibre}, [driven_fibre]
    while queue:
        now = queue.pop()
        new = {f for f in range(len(on)) if f not in reached and on[f] & on[now]}
        reached |= new
        queue += new
    if loose := set(range(len(on))) - reached:
        raise ValueError(
            f"fibre {min(loose)} of the web would never move: no crossings lead from it to driven "
            f"fibre {driven_fibre}; let it cross another one, or leave it out"
        )


def _refuse_endless(n: int, most: int, of: str, name: str = "n") -> None:
    if n > most:
        raise ValueError(f"{name} = {n}: more than {most} {of} are beyond any machine; take fewer")


def from_spec(spec: dict) -> Network:
    """The network whose `spec()` this is."""
    spec = dict(spec)
    topology = spec.pop("topology")
    if topology == "web":
        return web(**spec)
    if topology == "crosshatch":
        return crosshatch(**spec)
    return polygon(spec["n"], diameter=spec["length"], diagonals=spec["diagonals"])


def _cross(fibres: np.ndarray):
    """Interior crossings of straight fibres; those through one point are one crossing."""
    start, span = fibres[:, 0], fibres[:, 1] - fibres[:, 0]
    length = np.linalg.norm(span, axis=1)
    points, count = np.empty((len(fibres) * (len(fibres) - 1) // 2, 2)), 0
    on_fibre: list[dict[int, float]] = [{} for _ in fibres]
    for a, b in combinations(range(len(fibres)), 2):
        determinant = span[a, 0] * span[b, 1] - span[a, 1] * span[b, 0]
        if abs(determinant) < 1e-12 * length[a] * length[b]:
            continue
        gap = start[b] - start[a]
        at_a = (gap[0] * span[b, 1] - gap[1] * span[b, 0]) / determinant
        at_b = (gap[0] * span[a, 1] - gap[1] * span[a, 0]) / determinant
        if not (1e-9 < at_a < 1 - 1e-9 and 1e-9 < at_b < 1 - 1e-9):
            continue  # they meet at a vertex, or not at all
        point = start[a] + at_a * span[a]
        near = np.flatnonzero(np.hypot(*(points[:count] - point).T) < COINCIDENT)
        index = int(near[0]) if len(near) else count
        if index == count:
            points[count] = point
            count += 1
        on_fibre[a].setdefault(index, at_a * length[a])
        on_fibre[b].setdefault(index, at_b * length[b])
    stations = tuple(tuple(sorted(f.items(), key=lambda item: item[1])) for f in on_fibre)
    return points[:count], stations
