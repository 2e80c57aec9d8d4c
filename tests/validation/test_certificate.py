"""Each change is the run it says, costs what it may, and gets the verdict it should."""

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from fiberweb import Scene, certify, crosshatch, polygon, score, simulate
from fiberweb.engines import load
from fiberweb.engines.base import Numerics
from fiberweb.model.mesh import build
from fiberweb.simulation.plan import plan
from fiberweb.validation.certificate import (
    CHAOS,
    TIED,
    TOLERANCE,
    _cost,
    certificate,
    frames,
    variants,
    verdict,
)

SHORT = Scene(crosshatch(2, length=0.5), duration=20.0)


@pytest.fixture(scope="module")
def published():
    scene = Scene(crosshatch(2, length=0.5), "published", duration=5.0)
    return scene, certify(scene)


def planned(scene, **numerics):
    """What variants need to know of a response, without the run."""
    plans = plan(scene, **numerics)
    return xr.Dataset(
        coords={"time": scene.times},
        attrs={
            "scene": scene.to_json(), "engine": plans.engine, "elements": plans.mesh.elements,
            "elements_per_section": plans.elements_per_section or "authors",
            "time_step": plans.numerics.time_step, "sample_rate": scene.sample_rate,
        },
    )  # fmt: skip


@pytest.mark.parametrize(
    ("changes", "found"),
    [
        ({"step": 0.0, "mesh": 0.0049, CHAOS: 0.0}, "physics"),
        ({"step": -0.0051, "mesh": 0.0, CHAOS: 0.0}, "step"),
        ({"step": 0.02, "mesh": -0.02, CHAOS: 0.004}, "step and mesh"),
        ({"step": 0.02, "mesh": -0.02, CHAOS: 0.03}, CHAOS),  # no more than another start does
        ({"step": 0.02, "mesh": 0.2, CHAOS: -0.03}, f"mesh and {CHAOS}"),
        ({"step": 0.1, CHAOS: 0.0, "filter": 0.1, "rounding": 0.01}, "filter and rounding"),
        ({"step": 0.1, "mesh": 0.1, CHAOS: 0.0, "filter": 0.001}, "step and mesh"),
        ({"step": math.nan, "mesh": 0.0, CHAOS: 0.0}, "step"),  # unstable only then
        ({"step": 0.0, "mesh": 0.0, CHAOS: math.nan}, CHAOS),
        ({"": 0.3, "step": 0.0, CHAOS: 0.0}, "physics"),  # of other physics altogether
    ],
)  # fmt: skip
def test_the_verdict_names_what_a_capacity_follows(changes, found):
    assert verdict(changes) == found


def test_each_change_is_the_run_it_says(published):
    scene, table = published
    after = table.set_index(["changed", "capacity"])["after"]
    no_filter, exact = replace(scene, filter_order=0), replace(scene, dead_band=False)
    for words, alone in (("without the filter", no_filter), ("exact rotations", exact)):
        assert after[words, "c_m"] == pytest.approx(float(score(simulate(alone)).c_m), abs=1e-9)
    physics = dict(force=scene.force, duration=scene.duration, layout="authors")
    described = Scene(scene.network, **physics)
    expected = float(score(simulate(described), "published").c_nl)
    assert after["described setup", "c_nl"] == pytest.approx(expected, abs=1e-9)


def test_steps_and_meshes_are_compared_on_one_part_of_the_recording():
    response = simulate(SHORT)
    table = certificate(response).set_index(["changed", "capacity"])
    part = response.isel(time=slice(0, frames(response, 0.4, {})))
    assert part.sizes["time"] == 2000 and table.loc[("half the step", "c_nl"), "share"] == 0.4
    assert table.loc[("twice the mesh", "c_nl"), "before"] == float(score(part).c_nl)
    finer = simulate(SHORT, elements_per_section=8).isel(time=slice(0, 2000))
    assert table.loc[("twice the mesh", "c_nl"), "after"] == pytest.approx(
        float(score(finer).c_nl), abs=1e-6
    )
    assert set(table["verdict"]) == {"physics"}


def test_a_coarse_mesh_is_found():
    scene = Scene(crosshatch(4, length=0.5), force=0.06, duration=20.0)
    table = certify(scene, elements_per_section=1)
    verdicts = table.groupby("capacity")["verdict"].first()
    assert "mesh" in verdicts["c_nl"]
    change = table[(table["changed"] == "twice the mesh") & (table["capacity"] == "c_nl")]["change"]
    assert abs(float(change.iloc[0])) > TOLERANCE


@pytest.mark.parametrize("setup", ["described", "published", "compliant"])
@pytest.mark.parametrize(
    "network", [crosshatch(2, length=0.5), crosshatch(12, length=0.5), polygon(8, 0.5)]
)
def test_all_of_it_costs_less_than_six_runs(setup, network):
    response = planned(Scene(network, setup))
    shares = [
        frames(response, each.share, {}) / response.sizes["time"] for each in variants(response)
    ]
    costs = [_cost(each, response) for each in variants(response)]
    assert 3 < 1 + np.dot(shares, costs) < 6


def test_a_recording_too_short_to_be_cut_is_compared_whole():
    response = planned(replace(SHORT, duration=3.0))
    assert frames(response, 0.4, {}) == 750


def test_stoutness_shows_what_shear_does_larger_and_no_different():
    """Differences that shear and rotary inertia make, over what they were multiplied with."""
    mesh = build(replace(SHORT, duration=2.0, crossing_stiffness=TIED), 4)
    limit = load("cosserat").largest_step(mesh)

    def moved(stoutness):
        stout = replace(mesh, stoutness=stoutness)
        assert load("cosserat").largest_step(stout) > 0.97 * limit * stoutness
        return load("cosserat").integrate(stout, Numerics("cosserat", 4, 5e-6)).displacement

    one, two, eight = moved(1.0), moved(2.0), moved(8.0)
    once, exaggerated = two - one, (eight - two) / 6.0
    assert np.linalg.norm(once - exaggerated) < 0.05 * np.linalg.norm(once)


def test_an_unstable_run_has_no_certificate():
    scene = replace(SHORT, duration=4.0)
    blown = simulate(scene, engine="kirchhoff", time_step=1e-3, force_time_step=True)
    assert blown.attrs["status"] == "unstable"
    table = certificate(blown)
    assert set(table["verdict"]) == {"unstable"}
    assert table.loc[table["changed"] == "start", "before"].isna().all()
