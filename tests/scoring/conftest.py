"""A network that is no fibres' and computes all the same, for every test of scoring."""

import numpy as np
import pytest

from tests.scoring.reservoirs import drive, reservoir


@pytest.fixture(scope="module")
def well_posed():
    u = drive(41.0)[:-7]  # no multiple of 4: the split has to round
    return u, reservoir(u, 30, np.random.default_rng(3))


@pytest.fixture(scope="module")
def collinear(well_posed):
    """Sixty signals of rank ten, but for noise of one in a million: like a web's readouts."""
    u, x = well_posed
    rng = np.random.default_rng(4)
    mixed = x[:, :10] @ rng.standard_normal((10, 60))
    return u, mixed * (1 + 1e-6 * rng.standard_normal(mixed.shape)) + 0.02
