"""What a dry run accepts, runs through: every run of an accepted config starts."""

import math
from functools import cache
from pathlib import Path
from unittest.mock import patch

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from pydantic import BaseModel

from fiberweb import Scene, crosshatch
from fiberweb.config import Config, load
from fiberweb.model.scene import SETUPS
from fiberweb.runs import Run, check, run_table

SMOKE = [Path(__file__).parents[2] / "config" / name for name in ("config.yaml", "smoke.yaml")]
BASE = load(*SMOKE).model_dump()
NUMBERS = {
    float: st.sampled_from([1e-6, 0.01, 0.3, 0.5, 0.9, 1.0, 1.7, 2.0, 10.0, 30.0, 1e3, 1e6]),
    int: st.sampled_from([0, 1, 2, 3, 5, 7, 12, 40, 2**32]),
}


def leaves(section: type[BaseModel], value: dict, path=()):
    """(path, value) of every key that holds a value and no section; those of folders left out."""
    for name, field in section.model_fields.items():
        kind = field.annotation
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            yield from leaves(kind, value[name], (*path, name))
        elif name not in ("results", "published_tables"):
            yield (*path, name), value[name]


def near(value) -> st.SearchStrategy:
    """Values like one in a config: of its kind, in and out of what can be run."""
    if isinstance(value, list):
        return st.lists(near(value[0]), min_size=1, max_size=3) if value else st.just(value)
    if isinstance(value, bool) or value is None:
        return st.sampled_from([True, False, None, 0, 1, 2.0, "kirchhoff", "cosserat", "sliding"])
    if isinstance(value, (int, float)):
        factors = NUMBERS[float].map(lambda factor: type(value)(factor * value))
        return st.one_of(NUMBERS[type(value)], factors)
    return st.sampled_from([None, "draft", "fine", "clamped", "sliding", "pinned", "sprung"])


LEAVES = dict(leaves(Config, BASE))
# what a body of one's own has beside the paper's, the springs with their stiffness
SPRINGS = st.fixed_dictionaries(
    {"ends": st.just("sprung"), "end_stiffness": st.sampled_from([1e-3, 50.0, 1e6])}
)
LOSS = st.fixed_dictionaries(
    {"loss_factor": st.sampled_from([1e-3, 0.1, 10.0])},
    optional={"loss_frequency": st.sampled_from([0.1, 300.0])},
)
BONDS = st.fixed_dictionaries({"bond_stiffness": st.sampled_from([1e-6, 0.1, math.inf])})
CHECK = cache(Run.check)  # what started in one example need not be resolved again in the next
BODY = st.lists(SPRINGS | LOSS | BONDS, max_size=3)


@st.composite
def changes(draw) -> dict:
    """Some keys of the config with other values, as a config file would give them."""
    changed: dict = {}
    for path in draw(st.lists(st.sampled_from(sorted(LEAVES)), min_size=1, max_size=4)):
        section = changed
        for name in path[:-1]:
            section = section.setdefault(name, {})
        section[path[-1]] = draw(near(LEAVES[path]))
    for part in draw(BODY):
        setup = draw(st.sampled_from([*SETUPS]))
        changed.setdefault("setups", {}).setdefault(setup, {}).update(part)
    return changed


@pytest.mark.slow
@settings(max_examples=25, deadline=None, derandomize=True, suppress_health_check=[*HealthCheck])
@given(changed=changes())
@patch.object(Run, "check", CHECK)
def test_every_run_of_an_accepted_config_starts(changed):
    """Scenes are resolved to a mesh and a stable step, and not integrated."""
    try:
        config = load(*SMOKE, changed)
        table = run_table(config)
        check(table.values())
    except ValueError as error:
        assert "\n" not in str(error)
        assume(False)
    for run in table.values():
        run.check()
        assert len(run.scene.times) == run.scene.samples


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"topology": {"length": 0.1}}, "topology.length|spacing = "),
        ({"noise": {"length": 0.02}}, "spacing = "),
        ({"chaos": {"spacing": 0.005}}, "spacing = 0.005 m"),
        ({"scene": {"diameter": 6e-3}}, "diameters of 0.006 m"),
        ({"robustness": {"seed": [1, 2**32]}}, "4294967296"),
        ({"scene": {"sample_rate": 256.0}, "narma": {"rate": 10.0}}, "narma.rate = 10 Hz"),
        ({"scene": {"duration": 1e7}}, "GB of memory"),
        ({"memory_origin": {"filter_element": [1e-6]}}, "elements far shorter than a fibre"),
        ({"scene": {"density": 1e-300}}, "density = 1e-300: its magnitude"),
        ({"buckling": {"buckling": [0.9000001, 0.9]}}, "buckling.buckling holds 0.9 twice"),
        ({"topology": {"polygon": [60]}}, "n = 60: more than 16 vertices"),
        ({"scene": {"sample_rate": 0.005}}, "sample_rate|frame"),
        ({"numerics": {"accuracy": None, "engine": "elastica"}}, "crossing_stiffness = inf"),
        (
            {"setups": {"published": {"bond_stiffness": 1.0}}},
            "topology in the setup published: bond_stiffness = 1: layout = 'authors' of a polygon",
        ),
        (
            {
                "numerics": {"accuracy": None, "engine": "elastica"},
                "setups": {"described": {"crossing_stiffness": 1e3, "loss_factor": 0.1}},
            },
            "loss_factor = 0.1: PyElastica has no material damping; use engine = 'kirchhoff'",
        ),
        (
            {"scene": {"youngs_modulus": 1e11}},
            "of capacity_origin: time_step = 5e-06 s is above",
        ),
    ],
)
def test_what_was_refused_only_after_others_had_run(changed, words):
    with pytest.raises(ValueError, match=words) as caught:
        check(run_table(load(SMOKE[0], changed)).values())
    assert "\n" not in str(caught.value)


def test_seeds_whose_names_collided():
    for n, seeds in ((2, (4630, 7253)), (4, (962, 7837))):
        scenes = [Scene(crosshatch(n, length=0.5), seed=seed, duration=4.0) for seed in seeds]
        names = {Run(scene, {"accuracy": "draft"}, {}, "eq3").name for scene in scenes}
        assert len(names) == 2
