"""Forward selection against fits from scratch."""

import numpy as np
import pytest

from fiberweb.scoring import capacity, selection

RATE = 20.0


@pytest.fixture(scope="module")
def run():
    """An input, and readouts of which some help, one repeats another and one stands still."""
    random = np.random.default_rng(0)
    u = np.convolve(random.uniform(-1, 1, 1019), np.hanning(20), mode="valid")
    useful = [u, u**2, u**3, np.roll(u, 6), np.roll(u, 14)]
    readouts = [*useful, useful[0], *random.normal(size=(3, len(u))), np.full(len(u), 0.1)]
    return u, np.column_stack(readouts) + 1e-3 * random.normal(size=(len(u), 1)) * (
        np.arange(10) < 9
    )


@pytest.mark.parametrize("target", ["c_nl", "c_m"])
def test_totals_are_those_of_the_clean_scoring(run, target):
    u, readouts = run
    selected = selection.forward(u, readouts, RATE, target, alpha=0.1)
    assert sorted(selected.signal) == list(range(9))  # the last one stands still
    for k in (1, 4, 9):
        some = readouts[:, selected.signal[:k]]
        expected = capacity.score_arrays(u, some, RATE, alpha=0.1)
        for name in ("c_nl", "c_m", "c_nl_train", "c_m_train"):
            assert getattr(selected, name)[k - 1] == pytest.approx(
                getattr(expected, name), abs=1e-9
            )


def test_each_step_takes_what_helps_training_most(run):
    u, readouts = run
    selected = selection.forward(u, readouts, RATE, "c_nl", alpha=1e-6)
    taken = list(selected.signal[:2])
    for k, signal in enumerate(taken):
        scores = {
            other: capacity.score_arrays(u, readouts[:, [*taken[:k], other]], RATE, alpha=1e-6)
            for other in set(range(9)) - set(taken[:k])
        }
        assert max(scores, key=lambda other: scores[other].c_nl_train) == signal


def test_the_choice_does_not_look_at_the_test_part(run):
    u, readouts = run
    other = readouts.copy()
    other[770:] = np.random.default_rng(2).normal(size=other[770:].shape)
    for target in selection.TARGETS:
        first, second = (selection.forward(u, x, RATE, target) for x in (readouts, other))
        np.testing.assert_array_equal(first.signal, second.signal)
        assert not np.allclose(first.c_m, second.c_m)


def test_needed_asks_that_the_share_is_never_lost_again():
    assert selection.needed(np.array([0.2, 0.96, 0.9, 0.97, 1.0]), 0.95) == 4
    assert selection.needed(np.array([0.96, 0.98, 1.0]), 0.95) == 1
    assert selection.needed(np.array([0.2, 0.3, 1.0]), 0.95) == 3


def test_another_target_is_refused(run):
    with pytest.raises(ValueError, match="target = 'both' is unknown; use 'c_nl' or 'c_m'"):
        selection.forward(*run, RATE, "both")
