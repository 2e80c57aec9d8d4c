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


def test_a_cluster_is_done_when_its_last_job_is():
    assert hours.until_done([3, 1, 2, 2], at_once=1, together=1) == 8
    assert hours.until_done([3, 1, 2, 2], at_once=2, together=1) == 5  # 3 + 2, 1 + 2
    assert hours.until_done([3, 1, 2, 2], at_once=2, together=2) == 4
    assert hours.until_done([3, 1, 2, 2], at_once=9, together=3) == 6


def test_a_group_of_runs_is_as_large_as_in_the_profile():
    assert f"runs={hours.runs_a_group()}\n" in hours.PROFILE.read_text()
