"""What targets cost, before they run."""

from fiberweb.config import load
from fiberweb.tools import hours

SMOKE = hours.CONFIG.with_name("smoke.yaml")


def test_a_study_that_waits_for_the_ridge_is_counted_once_a_force():
    config = load(hours.CONFIG, SMOKE)
    found = hours.wanted(config, "size", "described")
    assert {run.scene.network.n for run in found} == {2, 3}
    per_spacing = [run for run in found if run.scene.network.n == 2]
    assert len(per_spacing) == 2 * len(config.ridge.spacing)  # the best for C_nl and for C_m


def test_the_best_forces_for_the_two_capacities_are_taken_to_differ():
    config = load(hours.CONFIG, SMOKE, {"ridge": {"force": [0.05, 0.1]}})
    found = hours.wanted(config, "size", "described")
    assert {(run.choice, run.scene.force) for run in found} == {
        ("best_c_nl", 0.1),
        ("best_c_m", 0.05),
    }
