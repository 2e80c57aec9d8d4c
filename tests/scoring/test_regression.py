"""Targets, standardising, and one sentence for each thing that a user can get wrong."""

import numpy as np
import pytest

from fiberweb.scoring import capacity
from fiberweb.scoring import regression as ridge
from tests.scoring.reservoirs import RATE


def test_targets():
    u = ridge.scale_input(np.array([3.0, 5.0, 4.0, 7.0]))
    np.testing.assert_allclose(u, [-1, 0, -0.5, 1])
    np.testing.assert_allclose(
        ridge.legendre_targets(u, (1, 2)), np.column_stack([u, (3 * u**2 - 1) / 2])
    )
    np.testing.assert_array_equal(
        ridge.recall_targets(u, (0, 2)), [[-1, np.nan], [0, np.nan], [-0.5, -1], [1, 0]]
    )
    np.testing.assert_array_equal(
        ridge.targets(u, (1, 2), (0, 2)),
        np.hstack([ridge.legendre_targets(u, (1, 2)), ridge.recall_targets(u, (0, 2))]),
    )


def test_standardising_looks_at_the_fitted_rows_alone():
    x = np.random.default_rng(0).normal(3.0, 2.0, (100, 4)) * [1.0, 1e-6, 1e3, 0.0] + 0.1
    scaled = ridge.standardise(x, slice(20, 70))
    np.testing.assert_allclose(scaled[20:70, :3].mean(axis=0), 0.0, atol=1e-9)
    np.testing.assert_allclose(scaled[20:70, :3].std(axis=0), 1.0)
    assert not scaled[:, 3].any()  # it stands still but for round-off
    moved = x.copy()
    moved[:20] += 1.0
    np.testing.assert_array_equal(ridge.standardise(moved, slice(20, 70))[20:], scaled[20:])


@pytest.mark.parametrize(
    ("start", "frames", "split", "end"),
    [(0, 100, 0.75, 75), (0, 101, 0.75, 75), (50, 150, 0.57, 107), (10, 12, 0.5, 11)],
)
def test_the_test_part_rounds_up(start, frames, split, end):
    assert ridge.training_end(start, frames, split) == end


@pytest.mark.parametrize(
    "options, sentence",
    [
        ({"scoring": "papers"}, "scoring = 'papers' is unknown; use 'clean' or 'published'"),
        ({"alpha": 0.0}, "alpha = 0.0 is not usable; give a finite number above 0"),
        ({"alpha": "small"}, "alpha = 'small' is not usable"),
        ({"alpha": True}, "alpha = True is not usable"),
        ({"horizon": -1.0}, "horizon = -1.0 is not usable"),
        ({"horizon": 0.001}, "horizon = 0.001 s is shorter than a frame; give at least 0.02 s"),
        ({"split": 1.0}, "split = 1.0 is not usable"),
        ({"skip": -1}, "skip = -1 is negative"),
        ({"orders": 0}, "orders = 0 holds no Legendre polynomial"),
        ({"shuffle": True}, "shuffle = True needs scoring = 'published'"),
        ({"horizon": 30.0}, "duration = 40.86 s is too short .* record at least 60 s"),
        ({"skip": 2000}, "duration = 40.86 s is too short .* record at least 42 s"),
    ],
)
def test_bad_options_are_named(options, sentence, well_posed):
    with pytest.raises(ValueError, match=sentence):
        capacity.score_arrays(*well_posed, RATE, **options)


def test_bad_arrays_are_named(well_posed):
    u, x = well_posed
    with pytest.raises(ValueError, match=r"u has shape \(2042,\) and readouts \(2043, 30\)"):
        capacity.score_arrays(u[1:], x, RATE)
    with pytest.raises(ValueError, match="p at least 1"):
        capacity.score_arrays(u, x[:, :0], RATE)
    with pytest.raises(ValueError, match="sample_rate = 0 is not usable"):
        capacity.score_arrays(u, x, 0)
    with pytest.raises(ValueError, match="u = 2 at every frame"):
        capacity.score_arrays(np.full(len(u), 2.0), x, RATE)
    with pytest.raises(ValueError, match="u holds values that are not finite"):
        capacity.score_arrays(np.where(u == u[5], np.nan, u), x, RATE)
    with pytest.raises(ValueError, match=r"lag = 1\.5 s is outside 0 to horizon = 1 s"):
        capacity.predict(u, x, RATE, lags=(1.5,))
    with pytest.raises(ValueError, match="alpha = 1e-15 is lost in the round-off"):
        capacity.score_arrays(u, np.repeat(x[:, :3], 4, axis=1), RATE, alpha=1e-15)
    x = x.copy()
    x[17, 3] = np.inf
    with pytest.raises(ValueError, match=r"readouts\[17, 3\] = inf is not finite; an unstable run"):
        capacity.score_arrays(u, x, RATE)
    capacity.score_arrays(u, x, RATE, scoring="published", skip=18)
