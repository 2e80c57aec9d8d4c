"""What targets cost, before they run."""

from dataclasses import replace

import pytest

from fiberweb.config import load
from fiberweb.simulation.explain import cost, describe
from fiberweb.simulation.plan import plan
from fiberweb.tools import hours

SMOKE = hours.CONFIG.with_name("smoke.yaml")


def test_a_study_that_waits_for_the_ridge_is_counted_once_a_force():
    config = load(hours.CONFIG, SMOKE)
    found = hours.wanted(config, "size", "described")
    assert {run.scene.network.n for run in found} == {2, 3}
    per_spacing = [run for run in found if run.scene.network.n == 2]
    assert len(per_spacing) == 2 * len(config.ridge.spacing)  # the best for C_nl and for C_m


def test_the_cost_is_that_of_the_plan_in_words_and_grows_with_time():
    run, *_ = hours.wanted(load(hours.CONFIG, SMOKE), "topology", "described")
    planned = plan(run.scene, **run.numerics)
    assert f"about {cost(planned):.2g} s of one core" in describe(planned)
    twice = plan(replace(run.scene, duration=12.0), **run.numerics)
    assert cost(twice) == pytest.approx(2 * cost(planned), rel=1e-2)
