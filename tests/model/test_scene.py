"""Scenes: what they fill in, what they refuse, and that JSON keeps all of it."""

import math
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.scene import SETUPS, Scene

HATCH = crosshatch(4, length=0.5)
positive = st.floats(1e-6, 1e6)


def test_material_of_the_paper():
    """d = 2 mm, E = 100 MPa, 1000 kg/m3."""
    scene = Scene(HATCH)
    assert scene.bending_stiffness == pytest.approx(7.854e-5, rel=1e-4)
    assert scene.axial_stiffness == pytest.approx(314.16, rel=1e-4)
    assert scene.density * scene.area == pytest.approx(3.1416e-3, rel=1e-4)
    assert scene.wave_speed == pytest.approx(316.2, rel=1e-4)


def test_reference_force_and_buckling_number():
    """Eqs. 3 and 4: 48 delta EI / s3 for delta = 13.3 mm, and B = 1 at 2 pi2 EI / s2."""
    scene = Scene(crosshatch(4, spacing=0.1))
    assert scene.force == pytest.approx(48 * 13.3e-3 * scene.bending_stiffness / 1e-3)
    critical = 2 * math.pi**2 * scene.bending_stiffness / 0.01
    assert Scene(crosshatch(4, spacing=0.1), force=critical).buckling_number == pytest.approx(1)


@pytest.mark.parametrize(
    "text",
    [
        "[1,2]",
        "5",
        "{}",
        '{"a":',
        "",
        5,
        None,
        '{"network": "x"}',
        '{"network": {}}',
        '{"network": 1}',
    ],
)
def test_what_is_no_scene_is_refused(text):
    with pytest.raises(ValueError):
        Scene.from_json(text)


@pytest.mark.parametrize(
    ("setup", "network"),
    [
        ("described", HATCH),
        ("published", HATCH),
        ("described", polygon(6)),
        ("published", polygon(6)),
        ("compliant", HATCH),
        ("compliant", polygon(6)),
    ],
)
def test_setups_fill_what_is_open_and_nothing_else(setup, network):
    scene = Scene(network, setup=setup)
    for name, value in SETUPS[setup][network.topology].items():
        assert getattr(scene, name) == value
    assert Scene(network, setup=setup, damping=3.0).damping == 3.0


def test_times_start_at_zero_and_are_spaced_by_the_sample_rate():
    scene = Scene(HATCH, duration=2, sample_rate=250)
    assert scene.samples == len(scene.times) == 500
    assert scene.times[0] == 0.0
    np.testing.assert_allclose(np.diff(scene.times), 4e-3)
    assert Scene(HATCH, duration=1e-3).samples == 2


@settings(max_examples=30, deadline=None)
@given(
    st.fixed_dictionaries(
        {},
        optional={
            "setup": st.sampled_from(list(SETUPS)),
            "force": positive,
            "tension": st.just(0.0) | positive,
            "duration": st.floats(1e-2, 1e3),
            "seed": st.integers(0, 2**31),
            "diameter": positive,
            "crossing_stiffness": positive | st.just(math.inf),
            "crossing_damping": st.just(0.0) | positive,
            "damping": st.just(0.0) | positive,
            "filter_order": st.integers(0, 6),
            "dead_band": st.booleans(),
            "ends": st.sampled_from(["clamped", "sliding", "pinned"]),
        },
    ),
    st.sampled_from([HATCH, crosshatch(3, spacing=0.07), polygon(8, diagonals="skip-one")]),
)
def test_json_keeps_every_field(values, network):
    gaps = values.get("setup") == "published" and network.topology == "polygon"
    assume(not (gaps and values.get("crossing_stiffness") == math.inf))  # refused
    scene = Scene(network, **values)
    again = Scene.from_json(scene.to_json())
    assert again == scene
    assert "\n" not in scene.to_json()
    np.testing.assert_array_equal(again.network.fibres, network.fibres)
    for name, value in values.items():
        assert getattr(again, name) == value


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (dict(force=-1.0), "force = -1.0: input should be greater than 0"),
        (dict(force=0.0), "force = 0.0: "),
        (dict(force=math.inf), "force = inf: input should be a finite number"),
        (dict(force="1"), "force = '1': "),
        (dict(tension=-0.01), "tension = -0.01: "),
        (dict(duration=math.nan), "duration = nan: "),
        (dict(seed=1.5), "seed = 1.5: "),
        (dict(seed=-1), "seed = -1: "),
        (dict(diameter=0), "diameter = 0: "),
        (dict(crossing_stiffness=0.0), "crossing_stiffness = 0.0: "),
        (dict(crossing_stiffness=math.nan), "crossing_stiffness = nan: "),
        (dict(damping=True), "damping = True: "),
        (dict(filter_order=-1), "filter_order = -1: "),
        (dict(filter_order=21), "filter_order = 21: "),
        (
            dict(setup="paper"),
            "setup = 'paper': input should be 'described', 'published' or 'compliant'",
        ),
        (dict(ends="free"), "ends = 'free': "),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(values, words):
    with pytest.raises(ValueError) as error:
        Scene(HATCH, **values)
    message = str(error.value)
    assert message.startswith(words)
    assert "\n" not in message


def test_a_scene_needs_a_network():
    with pytest.raises(ValueError, match=r"network = 4 is not a network; make one with crosshatch"):
        Scene(4)


def test_every_field_is_documented():
    for field in fields(Scene):
        assert f"\n        {field.name}: " in Scene.__doc__


def test_what_tells_a_scene_from_others_is_what_is_not_the_setups_own():
    network = crosshatch(2, length=0.5)
    assert Scene(network, force=0.1).distinct() == {
        "network": network.spec(), "setup": "described", "force": 0.1
    }  # fmt: skip
    spelt_out = Scene(network, force=0.1, damping=10.0, ends="sliding", seed=1234)
    assert spelt_out.distinct() == Scene(network, force=0.1).distinct()
    other = Scene(network, "published", damping=1.0, seed=5).distinct()
    assert (other["setup"], other["damping"], other["seed"]) == ("published", 1.0, 5)
    assert "filter_order" not in other


@pytest.mark.parametrize("name", ["diameter", "youngs_modulus", "drive_rate", "stroke", "damping"])
@pytest.mark.parametrize("value", [1e-200, 1e200])
def test_a_number_of_no_magnitude_is_refused(name, value):
    """Found by random scenes: fourth powers overflowed, and splines of such knots were NaN."""
    with pytest.raises(ValueError, match=f"{name} = .*magnitude has to be between 1e-40 and 1e"):
        Scene(HATCH, **{name: value})
