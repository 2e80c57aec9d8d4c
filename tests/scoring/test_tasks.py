"""Where the NARMA recursions diverge."""

import numpy as np
import pytest

from fiberweb.scoring.tasks import ORDERS, narma, safe_amplitude


@pytest.mark.parametrize("order", ORDERS)
def test_the_safe_range_is_where_a_constant_input_begins_to_diverge(order):
    limit = safe_amplitude(order)
    assert narma(np.full(20_000, 0.999 * limit), order).max() < 2.0
    with pytest.raises(ValueError, match=rf"NARMA-{order} diverges .* safe .* 0 to {limit:.3g}"):
        narma(np.full(20_000, 1.001 * limit), order)


@pytest.mark.parametrize("order", ORDERS)
def test_no_input_in_the_safe_range_goes_above_the_constant_one(order):
    limit = safe_amplitude(order)
    random = limit * np.random.default_rng(order).uniform(0, 1, 3000)
    assert (narma(random, order) <= narma(np.full(3000, limit), order) + 1e-12).all()
