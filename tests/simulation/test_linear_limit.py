"""Round-off makes no nonlinearity: small forces score what the linear network does."""

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, score, simulate
from fiberweb.scoring import capacity, recording
from fiberweb.simulation import dataset

WEB = crosshatch(4, length=0.5)


def driven(force):
    return simulate(Scene(WEB, duration=40.0, force=force), "draft")


def test_small_forces_score_what_the_linear_network_does(tmp_path):
    """The linear part of the motion is what two forces extrapolate to; the rest goes with the force
    squared, is resolved down to 1e-6 N and adds to C_nl there."""
    one, two = driven(1e-5), driven(2e-5)
    linear = 2.0 * recording.signals(one) - 0.5 * recording.signals(two)
    rate = recording.sample_rate(one)
    expected = capacity.score_arrays(one["input"].values, linear, rate)
    for force in (1e-8, 1e-9):
        dataset.save(driven(force), tmp_path / "response.nc")
        scored = score(dataset.load(tmp_path / "response.nc"))
        assert float(scored["c_nl"]) == pytest.approx(expected.c_nl, abs=2e-3)
        assert float(scored["c_m"]) == pytest.approx(expected.c_m, abs=2e-3)
    small = [float(score(driven(force))["c_nl"]) for force in (1e-6, 1e-5)]
    assert small[1] == pytest.approx(small[0], abs=1e-3)
    assert np.all(np.array(small) > expected.c_nl + 0.1)
