"""A plan: what it chooses, what it refuses, and that a job makes one mesh and finds one limit."""

import pytest

from fiberweb import Scene, crosshatch, simulate
from fiberweb.engines import ENGINES, load
from fiberweb.model import authors, mesh
from fiberweb.simulation.explain import describe
from fiberweb.simulation.plan import (
    ACCURACIES,
    SAFETY,
    SAFETY_BY_STRAIN,
    plan,
    safety,
    stubby,
)
from fiberweb.simulation.simulate import run

SHORT = {"duration": 0.02, "sample_rate": 100.0}
DESCRIBED = Scene(crosshatch(2, spacing=0.1), **SHORT)
PUBLISHED = Scene(crosshatch(2, spacing=0.1), "published", **SHORT)


@pytest.fixture
def calls(monkeypatch):
    """Names of the functions called, of those that cost time."""
    names = []

    def counted(name, function):
        def wrapper(*args, **kwargs):
            names.append(name)
            return function(*args, **kwargs)

        return wrapper

    monkeypatch.setattr(mesh, "build", counted("build", mesh.build))
    for engine in map(load, ENGINES):
        monkeypatch.setattr(engine, "largest_step", counted("limit", engine.largest_step))
    return names


@pytest.mark.parametrize("scene", [DESCRIBED, PUBLISHED], ids=lambda scene: scene.setup)
def test_a_job_makes_one_mesh_and_finds_one_limit(scene, calls):
    planned = plan(scene)
    text = describe(planned)
    response = run(planned)
    assert sorted(calls) == ["build", "limit"]
    assert response.attrs["status"] == "ok"
    assert response.attrs["time_step"] == planned.numerics.time_step
    assert f"{1e6 * planned.limit:.3g} us" in text


def test_the_published_setup_needs_no_limit_to_run(calls):
    run(plan(PUBLISHED))
    assert calls == ["build"]


@pytest.mark.parametrize(("accuracy", "elements"), [(None, 4), *ACCURACIES.items()])
def test_an_accuracy_chooses_engine_mesh_and_step(accuracy, elements):
    planned = plan(DESCRIBED, accuracy)
    assert planned.numerics[:2] == ("kirchhoff", elements)
    assert planned.mesh.elements == 4 * 3 * elements
    assert planned.numerics.time_step == SAFETY * load("kirchhoff").largest_step(planned.mesh)


def test_the_published_setup_has_the_authors_mesh_and_step():
    planned = plan(PUBLISHED)
    assert planned.numerics == ("cosserat", None, authors.STEP)
    assert planned.mesh.edges(0) == pytest.approx(0.3 / authors.LEAST_ELEMENTS)


def test_a_plan_is_simulated_as_its_scene_is():
    assert run(plan(DESCRIBED, "draft")).identical(simulate(DESCRIBED, "draft"))


@pytest.mark.parametrize(
    ("scene", "asked", "words"),
    [
        (DESCRIBED, {"accuracy": "ultra"}, "accuracy = 'ultra' does not exist; choose one of dr"),
        (DESCRIBED, {"engine": "kirchoff"}, "engine = 'kirchoff': .*kirchhoff"),
        (PUBLISHED, {"accuracy": "fine"}, "accuracy = 'fine': the published setup fixes its own"),
        (DESCRIBED, {"accuracy": "fine", "engine": "cosserat"}, "engine = 'cosserat': an accuracy"),
        (DESCRIBED, {"accuracy": "fine", "time_step": 1e-6}, "time_step = 1e-06: an accuracy"),
        (DESCRIBED, {"time_step": -1.0}, r"time_step = -1\.0 must be a positive number of seconds"),
        (DESCRIBED, {"time_step": "1"}, "time_step = '1' must be a positive number of seconds"),
        (DESCRIBED, {"time_step": 1e-3}, r"time_step = 0\.001 s is above the stability limit of .* "
         "kirchhoff engine on this mesh; take a smaller one or leave it out"),
        (DESCRIBED, {"elements_per_section": 0}, "elements_per_section = 0 must be a whole number"),
        (Scene(crosshatch(2, spacing=0.1), tension=400.0), {}, "tension = 400 N: no fibre holds a"),
        (Scene(crosshatch(2, spacing=0.009)), {}, r"spacing = 0\.009 m: a section shorter than 5 "
         "diameters of 0.002 m shears, which the kirchhoff engine leaves out; take a longer one, "
         "or engine = 'cosserat' with a finite crossing_stiffness$"),
        (Scene(crosshatch(2, spacing=0.009), "compliant"), {}, ".* or engine = 'cosserat'$"),
        (DESCRIBED, {"engine": "cosserat"}, "crossing_stiffness = inf: the cosserat and elastica "
         "engines need a finite spring; give one, or use engine = 'kirchhoff'"),
        (Scene(crosshatch(2, spacing=0.1), filter_order=6), {}, "filter_order = 6: the kirchhoff"),
        (Scene(crosshatch(2, spacing=0.1), sample_rate=1e-30), {}, "duration = 100 s at "
         "sample_rate = 1e-30 Hz takes .* steps of .* s, more than any machine gets through"),
    ],
)  # fmt: skip
def test_what_is_refused_is_refused_in_one_sentence(scene, asked, words):
    with pytest.raises(ValueError, match=f"^{words}") as error:
        plan(scene, **asked)
    assert "\n" not in str(error.value)


def test_a_step_above_the_limit_can_be_forced():
    planned = plan(DESCRIBED, time_step=1e-3, force_time_step=True)
    assert planned.numerics.time_step == 1e-3 > planned.limit


def test_a_filter_allows_a_step_above_the_limit_without_it():
    filtered = plan(PUBLISHED, time_step=1e-4)
    assert filtered.numerics.time_step == 1e-4 > filtered.limit


def test_a_stubby_network_may_be_run_by_an_engine_that_is_named():
    stout = Scene(crosshatch(2, spacing=0.009), crossing_stiffness=1e6)
    assert stubby(stout) and not stubby(DESCRIBED)
    for engine in ("kirchhoff", "cosserat"):
        assert plan(stout, engine=engine).engine == engine


def test_a_strained_network_is_given_a_shorter_step():
    strained = [
        safety(Scene(crosshatch(2, spacing=0.1), tension=1.01 * least * DESCRIBED.axial_stiffness))
        for least in SAFETY_BY_STRAIN
    ]
    assert [safety(DESCRIBED), *strained] == [0.9, 0.7, 0.4]
