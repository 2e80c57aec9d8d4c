"""The explanation of an accuracy says what is chosen, how wrong it is, and what it leaves out."""

from dataclasses import replace

import pytest

from fiberweb import Scene, crosshatch
from fiberweb.simulation.explain import explain
from fiberweb.simulation.plan import ACCURACIES

PAPER = Scene(crosshatch(4, length=0.5))


def lines(scene, accuracy=None, **numerics):
    """The explanation, by the word before each colon; several warnings are joined."""
    texts = {}
    for line in explain(scene, accuracy, **numerics).splitlines():
        key, text = line.split(": ", 1)
        texts[key] = texts.get(key, "") + text
    return texts


@pytest.mark.parametrize(("accuracy", "elements"), ACCURACIES.items())
def test_every_accuracy_names_engine_mesh_and_error(accuracy, elements):
    texts = lines(PAPER, accuracy)
    assert texts["choice"] == (
        f"kirchhoff engine, {elements} elements per section (accuracy {accuracy})"
    )
    assert "% of the trajectories' rms at B = 0.8" in texts["error"]
    assert f"{4 * 2 * 5 * elements} elements" in texts["cost"]
    assert "beware" not in texts


def test_errors_fall_with_accuracy():
    errors = [float(lines(PAPER, a)["error"].split(" %")[0]) for a in ACCURACIES]
    assert errors == sorted(errors, reverse=True)


def test_shear_falls_with_slenderness():
    slender, stout = (
        lines(Scene(crosshatch(4, spacing=s)))["left out"].split("about ")[1] for s in (0.1, 0.02)
    )
    assert "0.23 %" in slender and "5.8 %" in stout


def test_step_is_below_its_limit():
    text = lines(PAPER)["step"]
    assert float(text.split(", ")[1].split(" of ")[0]) <= 0.9
    assert "limit" in text


def test_a_forced_step_is_owned_up_to():
    text = lines(PAPER, elements_per_section=4, time_step=1e-3, force_time_step=True)["step"]
    assert "will most likely blow up" in text


def test_it_knows_the_damping():
    """At 1e5 /s the decay of a mode was x / sinh x of what it should be, x = damping * step / 2."""
    scene = Scene(crosshatch(4, length=0.5), damping=1e5)
    step = 1e-6 * float(lines(scene)["step"].split()[0])
    decays = lines(scene)["damping"].removeprefix("100000 /s, exact at any step (").split()[0]
    assert float(decays) == pytest.approx(1e5 * step, rel=0.05)  # two digits are printed
    published = lines(Scene(crosshatch(4, length=0.5), "published", damping=1e4))["damping"]
    assert published == "10000 /s after the kick, as PyElastica's: forces act 2.5 % short"


def test_published_setup():
    texts = lines(Scene(crosshatch(4, length=0.5), "published"))
    assert "cosserat engine, the authors' mesh" in texts["choice"]
    assert texts["error"].startswith("none against the authors' own numbers")
    assert "shear" not in texts["left out"] and "out-of-plane" in texts["left out"]


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (Scene(crosshatch(4, length=0.5), force=0.85), ["past buckling", "never trajectories"]),
        (Scene(crosshatch(2, spacing=0.015)), ["s/d = 7.5"]),
        (Scene(crosshatch(2, spacing=0.1), tension=50.0), ["tension = 50 N", "of EA"]),
    ],
)
def test_warnings(scene, words):
    assert all(word in lines(scene)["beware"] for word in words)


def test_a_refusal_is_the_one_of_simulate():
    with pytest.raises(ValueError, match="accuracy = 'ultra' does not exist"):
        explain(PAPER, "ultra")


def test_a_stubby_network_needs_an_engine_named():
    """4.5 diameters: the dial refuses it, in words, and takes the engine that has shear, with the
    springs that it needs."""
    stubby = Scene(crosshatch(2, spacing=0.009))
    advice = r"spacing = 0\.009 m: .* take a longer one, or engine = 'cosserat' with a finite "
    with pytest.raises(ValueError, match=advice + "crossing_stiffness"):
        explain(stubby, "standard")
    sprung = replace(stubby, crossing_stiffness=1e6)
    with pytest.raises(ValueError, match=r"take a longer one, or engine = .cosserat.$"):
        explain(sprung, "standard")
    assert "cosserat engine" in lines(sprung, engine="cosserat")["choice"]
