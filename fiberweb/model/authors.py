"""What the authors' code did, each fact with its source; how it cut fibres is in `authors_mesh`.

Facts only, read off their public repository (github.com/NaughtonLab/ReservoirFiberNetworks), and
none of its code. SI units.
"""

from __future__ import annotations

import numpy as np

# Simulation scripts: numpy's legacy generator, and 100 s of knots at 5 Hz with both ends.
SEED = 1234
KNOTS = 501

STEP = 5e-6  # s; simulation scripts

# Simulation scripts. Elements: at least so many on a fibre, but half as long, and no such least
# number, at spacings of 20 and 30 mm. Load: nodes about the middle and their shares of the force;
# a negative index skews what was meant to be symmetric.
ELEMENT = 10e-3  # m
LEAST_ELEMENTS = 50
LOAD = {-2: 0.1875, -1: 0.125, 0: 0.125, 1: 0.1875, 2: 0.375}


def clock(duration: float) -> float:
    """What their clock shows at the end of a run (s): a sum of half steps with its round-off."""
    time, left = 0.0, 2 * round(duration / STEP)
    while left:
        count = min(left, 1_000_000)
        time = np.add.accumulate(np.r_[time, np.full(count, 0.5 * STEP)])[-1]
        left -= count
    return float(time)


SKIPPED_FRAMES = 300  # scoring script of the polygons, which drops these first ones
# scoring scripts of the experiment: estimates of Legendre and of recall targets beyond these are
# replaced, where those of the simulations replace what leaves [-1, 1]
OVERSHOOT = (2.0, 1.5)
SHUFFLE_SEED = 42  # feature selection script: random_state of sklearn's train_test_split

# Simulation scripts of crosshatch and polygon: what a scene leaves open. The damper's 10 /s act on
# velocity and, by its units, as 40 /s on rotation; a stiff pin and the Laplace filter of order 6
# on the crosshatch only, a softer pin on the polygon.
_BOTH = dict(crossing_damping=0.0, damping=10.0, dead_band=True)
PHYSICS = {
    "crosshatch": dict(
        crossing_stiffness=1e6, filter_order=6, ends="sliding", layout="authors", **_BOTH
    ),
    "polygon": dict(
        crossing_stiffness=1e3, filter_order=0, ends="pinned", layout="authors", **_BOTH
    ),
}

# Feature selection script, whose readouts near the springs were chosen by hand: for each row the
# first column of its crossings, and the first section of its midpoints; by N. Columns of vertical
# midpoints are alike.
SPRINGS_CROSSINGS = {4: (3, 1, 1, 0), 6: (5, 4, 3, 2, 1, 0)}
SPRINGS_MIDPOINTS = {4: (3, 2, 1, 1), 6: (5, 5, 3, 3, 2, 1)}
FEATURES_FORCE = 0.2  # N; the same script

# All of their lists of forces hold Eq. 3 with this for 48 delta EI, rounded in two ways.
EQ3_PRODUCT = 50e-6  # N m^3


def reference_force(spacing: float) -> float:
    """Eq. 3 as their simulation scripts round it (N), s in m: to ten digits after the point, so
    that the same force is the same run."""
    return np.round(EQ3_PRODUCT / spacing**3, 10)


def listed_force(force: float) -> float:
    """A force (N) as their lists of forces give it: to six digits."""
    return float(f"{force:.6g}")


# Force-spacing script: spacings, and the reference force of each beside four more.
EQ3_SPACINGS = [round(0.02 + 0.01 * i, 3) for i in range(14)]  # m
FORCES = sorted(
    [listed_force(EQ3_PRODUCT / spacing**3) for spacing in EQ3_SPACINGS] + [5.0, 3.75, 2.5, 1.25]
)  # N

# Their tables density_500mm.csv and force_spacing_4x4.csv, C_nl and C_m to four digits: over N for
# crosshatches of 500 mm (Fig. 1 draws it), and over the force (N) for the 4x4 of 100 mm spacing.
LISTED_AT_500MM = {
    2: (0.5349, 0.1653), 4: (0.8048, 0.3752), 6: (0.8486, 0.4099), 8: (0.9076, 0.5701),
    10: (0.8533, 0.5145), 12: (0.8972, 0.2427),
}  # fmt: skip
LISTED_AT_100MM = {
    0.0148148: (0.7616, 0.3190), 0.0182216: (0.7855, 0.3405), 0.0227583: (0.7903, 0.3606),
    0.0289352: (0.7893, 0.3722), 0.0375657: (0.8112, 0.3710), 0.05: (0.8050, 0.3752),
    0.0685871: (0.8306, 0.3759), 0.0976562: (0.8416, 0.3663), 0.145773: (0.7257, 0.1739),
    0.231481: (0.4843, 0.1536), 0.4: (0.3491, 0.2156), 0.78125: (0.3527, 0.2268),
    1.25: (0.3854, 0.2381), 1.85185: (0.4065, 0.2257), 2.5: (0.3397, 0.1885),
    3.75: (0.3798, 0.2127), 5.0: (0.3836, 0.2080), 6.25: (0.3936, 0.1962),
}  # fmt: skip

# Size script: the best force of each spacing, for C_nl and for C_m (N).
SIZE_C_NL_FORCES = [
    3.75, 1.25, 0.78125, 0.4, 0.231481, 0.231481, 0.145773, 0.145773, 0.0976562, 0.0976562,
    0.0685871, 0.05, 0.05, 0.0375657,
]  # fmt: skip
SIZE_C_M_FORCES = [
    2.5, 1.25, 0.78125, 0.4, 0.231481, 0.145773, 0.145773, 0.0685871, 0.0685871, 0.05, 0.78125,
    0.78125, 0.4, 1.25,
]  # fmt: skip

# Pretension script: the force at each spacing from 50 to 100 mm (N).
PRETENSION_FORCES = [0.4, 0.231481, 0.0976562, 0.0976562, 0.05, 0.05]
