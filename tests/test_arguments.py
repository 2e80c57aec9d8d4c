"""The library's arguments: NumPy's numbers are numbers, and what is wrong is one sentence."""

from pathlib import Path

import numpy as np
import pytest

import fiberweb
from fiberweb import Scene, baselines, crosshatch, explain, polygon, score, simulate
from fiberweb.arguments import plain
from fiberweb.config import load
from fiberweb.runs import runs
from fiberweb.simulation.plan import plan

SHORT = Scene(crosshatch(2, spacing=0.1), duration=4.0, sample_rate=20.0, tension=0.0)
NUMPY = {
    "force": np.float32(0.1),
    "tension": np.float32(0.02),
    "duration": np.int64(4),
    "seed": np.uint32(7),
    "sample_rate": np.int16(20),
    "damping": np.float16(2.5),
    "crossing_stiffness": np.longdouble(70),
    "filter_order": np.int8(0),
    "ends": np.str_("clamped"),
    "setup": np.str_("described"),
    "centre_lines": np.bool_(False),
    "density": np.array(1000.0),
}


@pytest.fixture(scope="module")
def response():
    return simulate(SHORT, "draft")


# --- numbers of NumPy -------------------------------------------------------------------------


@pytest.mark.parametrize("name", NUMPY)
def test_a_field_of_numpy_is_the_number_it_is(name):
    value = NUMPY[name]
    scene = Scene(crosshatch(2, spacing=0.1), **{name: value})
    own = getattr(scene, name)
    assert own == value and type(own) in (float, int, str, bool)
    assert scene == Scene(crosshatch(2, spacing=0.1), **{name: plain(value)})
    assert Scene.from_json(scene.to_json()) == scene


@pytest.mark.parametrize(
    ("network", "equal"),
    [
        (crosshatch(np.int64(3), spacing=np.float32(0.1)), crosshatch(3, spacing=0.1)),
        (crosshatch(np.uint8(3), length=np.float64(0.5)), crosshatch(3, length=0.5)),
        (crosshatch(3, length=np.int32(1)), crosshatch(3, length=1.0)),
        (polygon(np.int16(8), diameter=np.float32(0.5)), polygon(8)),
    ],
)
def test_networks_of_numpys_numbers(network, equal):
    assert network.n == equal.n and type(network.n) is int
    assert network.length == pytest.approx(equal.length, rel=1e-7)
    assert type(network.length) is float and network.fibres.dtype == np.float64
    scene = Scene(network)
    assert Scene.from_json(scene.to_json()) == scene


def test_a_loop_over_numpys_numbers_runs_and_is_scored():
    for n in np.arange(2, 4):
        scene = Scene(crosshatch(n, spacing=np.float32(0.1)), **NUMPY)
        response = simulate(scene, time_step=np.float32(1e-5), elements_per_section=np.int64(2))
        assert Scene.from_json(response.attrs["scene"]) == scene
        options = {"alpha": np.float32(0.1), "split": np.float64(0.5), "skip": np.int64(1)}
        scored = score(response, orders=np.int64(3), horizon=np.int32(1), **options)
        assert scored.sizes["order"] == 3 and np.isfinite(scored.c_nl)
        assert type(scored.attrs["skip"]) is int and scored.attrs["alpha"] == np.float32(0.1)
        assert np.isfinite(baselines(response, alpha=np.float32(0.1)).c_m).all()
        assert "step: 10 us" in explain(scene, time_step=np.float32(1e-5))


def test_a_config_of_numpys_numbers_is_that_of_pythons():
    def config(numbers, whole, own):
        return {
            "scene": {"duration": own(20.0), "seed": whole(3)},
            "topology": {"crosshatch": numbers, "polygon": []},
            "numerics": {"accuracy": None, "elements_per_section": whole(2)},
        }

    ours = load(config(np.arange(2, 5), np.int64, np.float32))
    assert ours == load(config([2, 3, 4], int, float))
    names = [run.name for run in runs(ours, "topology", "described")]
    assert len(set(names)) == 3


# --- what is wrong ----------------------------------------------------------------------------


def hatch():
    return crosshatch(2, spacing=0.1)


WRONG = {
    "crosshatch n": (lambda: crosshatch(2.5, length=0.5), ["n = 2.5", "at least 2", "whole"]),
    "crosshatch list": (lambda: crosshatch(4, spacing=[0.1]), ["spacing = [0.1]", "positive"]),
    "crosshatch None": (lambda: crosshatch(4, length=None), ["either length or spacing"]),
    "crosshatch word": (lambda: crosshatch("4", length=0.5), ["n = '4'", "whole number"]),
    "crosshatch misspelt": (lambda: crosshatch(4, spaceing=0.1), ["spaceing = 0.1", "'spacing'"]),
    "polygon misspelt": (lambda: polygon(6, diamter=0.1), ["diamter = 0.1", "'diameter'"]),
    "polygon list": (lambda: polygon(6, diagonals=["all"]), ["diagonals = ['all']", "'skip-one'"]),
    "scene misspelt": (lambda: Scene(hatch(), tensoin=0.1), ["tensoin = 0.1", "'tension'"]),
    "scene array": (lambda: Scene(hatch(), force=np.ones(2)), ["force = [1.0, 1.0]", "number"]),
    "scene seed": (lambda: Scene(hatch(), seed=2**32), ["seed = 4294967296", "4294967295"]),
    "simulate a network": (lambda: simulate(hatch()), ["scene = Network(...)", "Scene("]),
    "simulate misspelt": (lambda: simulate(SHORT, acuracy="fine"), ["acuracy = ", "'accuracy'"]),
    "accuracy number": (lambda: simulate(SHORT, 4), ["accuracy = 4", "draft, standard"]),
    "accuracy list": (lambda: simulate(SHORT, ["fine"]), ["accuracy = ['fine']", "draft"]),
    "engine list": (lambda: simulate(SHORT, engine=["kirchhoff"]), ["engine = ['kirch", "valid"]),
    "elements 2.5": (
        lambda: simulate(SHORT, elements_per_section=2.5), ["elements_per_section = 2.5", "whole"],
    ),
    "elements True": (
        lambda: simulate(SHORT, elements_per_section=True), ["section = True", "whole"],
    ),
    "step True": (lambda: simulate(SHORT, time_step=True), ["time_step = True", "positive"]),
    "step inf": (lambda: simulate(SHORT, time_step=np.inf), ["time_step = inf", "positive"]),
    "step nan": (lambda: plan(SHORT, time_step=np.nan), ["time_step = nan", "positive"]),
    "step endless": (lambda: plan(SHORT, time_step=1e-13), ["steps of 1e-13 s", "larger steps"]),
    "force yes": (
        lambda: simulate(SHORT, time_step=1e-5, force_time_step="yes"),
        ["force_time_step = 'yes'", "True or False"],
    ),
    "explain misspelt": (lambda: explain(SHORT, engin="kirchhoff"), ["engin = ", "'engine'"]),
    "explain a path": (lambda: explain("run.nc"), ["scene = 'run.nc'", "Scene("]),
    "score a scene": (lambda: score(SHORT), ["response = Scene(", "simulate returns"]),
    "score a path": (lambda: score("file.nc"), ["response = 'file.nc'", "load_dataset('file.nc')"]),
    "score a Path": (lambda: score(Path("f.nc")), ["response = ", "load_dataset('f.nc')"]),
    "score None": (lambda: score(None), ["response = None", "Dataset that simulate returns"]),
    "baselines a scene": (lambda: baselines(SHORT), ["response = Scene(", "simulate returns"]),
}  # fmt: skip
WRONG_FOR_A_RESPONSE = {
    "split": (lambda r: score(r, split="0.5"), ["split = '0.5'", "fraction"]),
    "split 2": (lambda r: score(r, split=2), ["split = 2", "fraction"]),
    "skip": (lambda r: score(r, skip=2.5), ["skip = 2.5", "number of frames"]),
    "orders": (lambda r: score(r, orders="3"), ["orders = '3'", "whole number"]),
    "orders 2.5": (lambda r: score(r, orders=2.5), ["orders = 2.5", "whole number"]),
    "shuffle": (lambda r: score(r, shuffle="no"), ["shuffle = 'no'", "True or False"]),
    "horizon": (lambda r: score(r, horizon="1"), ["horizon = '1'", "above 0"]),
    "alpha": (lambda r: score(r, alpha=None), ["alpha = None", "above 0"]),
    "scoring": (lambda r: score(r, ["clean"]), ["scoring = ['clean']", "'published'"]),
    "misspelt": (lambda r: score(r, splt=0.5), ["splt = 0.5", "'split'"]),
    "misspelt order": (lambda r: score(r, order=3), ["order = 3", "'orders'"]),
    "one axis": (lambda r: score(r.isel(axis=[0])), ["axis = ['x']", "['x', 'y']"]),
    "no axis": (lambda r: score(r.sel(axis="x")), ["displacement(time, readout)", "axis)"]),
    "no input": (lambda r: score(r.drop_vars("input")), ["no variable 'input'", "input(time)"]),
    "capacities": (lambda r: score(score(r)), ["no variable 'input'", "simulate returns"]),
    "an array": (lambda r: score(r.displacement), ["response = ", "Dataset that simulate"]),
    "no status": (lambda r: score(r.drop_attrs()), ["no attribute 'setup'", "'described'"]),
    "baselines alpha": (lambda r: baselines(r, alpha="1"), ["alpha = '1'", "above 0"]),
    "baselines misspelt": (lambda r: baselines(r, skp=1), ["skp = 1", "'skip'"]),
    "baselines capacities": (lambda r: baselines(score(r)), ["no variable 'input'"]),
}  # fmt: skip


def refused(call, words):
    with pytest.raises(ValueError) as error:
        call()
    text = str(error.value)
    assert "\n" not in text and ". " not in text and len(text) < 300
    assert all(word in text for word in words), text


@pytest.mark.parametrize(("call", "words"), WRONG.values(), ids=WRONG)
def test_a_wrong_argument_is_one_sentence(call, words):
    refused(call, words)


@pytest.mark.parametrize(("call", "words"), WRONG_FOR_A_RESPONSE.values(), ids=WRONG_FOR_A_RESPONSE)
def test_a_wrong_argument_of_scoring_is_one_sentence(call, words, response):
    refused(lambda: call(response), words)


def test_a_recording_needs_no_setup_if_the_scoring_is_named(response):
    recorded = response.copy()
    del recorded.attrs["setup"], recorded.attrs["scene"]
    assert float(score(recorded, "clean").c_nl) == float(score(response).c_nl)


def test_every_public_function_refuses_a_misspelt_argument(response):
    first = {"crosshatch": 2, "polygon": 6, "Scene": hatch(), "simulate": SHORT, "explain": SHORT}
    for name in fiberweb.__all__:
        call = getattr(fiberweb, name)
        with pytest.raises(ValueError, match="mispelt = 1: unknown argument 'mispelt'"):
            call(first.get(name, response), mispelt=1)
