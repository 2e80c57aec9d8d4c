"""What a camera makes of a response: the driven marker is the input, and noise is what is said."""

import numpy as np
import pytest

from fiberweb.scoring.camera import film, films
from tests.studies.experiment import asked_for, response

CAMERA = {"pixels_per_mm": 2.0, "noise": 0.5, "seed": 0}


@pytest.fixture(scope="module")
def scene():
    return asked_for("twin")[0].scene


@pytest.fixture(scope="module")
def shaken(scene):
    return response(scene, "run")


def moved(film):
    return film["displacement"].values


def test_without_noise_the_motion_is_filmed_as_it_is(scene, shaken):
    seen = film(shaken, 2.0, 0.0)
    n = scene.network.n
    assert seen.sizes["readout"] == 3 * n**2 + 2 * n - 1 == 55
    kept = np.abs(shaken["displacement"].sel(readout=0) - seen["displacement"].sel(readout=0))
    assert kept.max() < 1e-15
    # the pull is downwards, and the input grows with it
    assert scene.stroke < 0.0
    np.testing.assert_allclose(seen["input"], -scene.stroke * shaken["input"], atol=1e-15)


def test_the_driven_marker_is_no_readout(scene, shaken):
    seen = film(shaken, 2.0, 0.0)
    x, y = scene.network.driven_point
    assert np.hypot(seen["rest_x"] - x, seen["rest_y"] - y).min() > 0.01
    of_driven = (seen["kind"] == "horizontal_midpoint") & (seen["fibre"] == 2)
    assert list(seen["section"].values[of_driven]) == [0, 1, 3, 4]


def test_noise_is_in_pixels_and_the_first_frame_is_zero(shaken):
    """0.5 pixels of 0.5 mm: 0.25 mm; of the first frame all have the same error."""
    clean, noisy = moved(film(shaken, 2.0, 0.0)), moved(film(shaken, **CAMERA))
    assert np.all(noisy[0] == 0.0)
    error = noisy - clean
    assert error[1:].std(axis=0).mean() == pytest.approx(0.25e-3, rel=0.01)
    offset = error[1:].mean(axis=0)  # minus the noise of the first frame
    assert offset.std() == pytest.approx(0.25e-3, rel=0.15)
    twice = moved(film(shaken, **CAMERA | {"pixels_per_mm": 4.0})) - clean
    np.testing.assert_allclose(twice, error / 2, atol=1e-12)


def test_noise_is_of_run_and_seed(shaken):
    first, again = (moved(film(shaken, **CAMERA)) for _ in range(2))
    np.testing.assert_array_equal(first, again)
    other_seed = moved(film(shaken, **CAMERA | {"seed": 1}))
    other_run = moved(film(shaken.assign_attrs(run="another"), **CAMERA))
    for other in (other_seed, other_run):
        assert (first != other)[1:].all()


def test_every_second_frame_is_taken_for_consecutive(shaken):
    (one, whole), (two, half) = films(shaken, frame_step=[1, 2], **CAMERA)
    assert (one, two) == (1, 2)
    np.testing.assert_array_equal(moved(half), moved(whole)[::2])
    np.testing.assert_array_equal(half["input"], whole["input"][::2])
    assert half.sizes["time"] == whole.sizes["time"] / 2
    np.testing.assert_allclose(half["time"], whole["time"][: half.sizes["time"]])


def test_an_unstable_run_keeps_its_own_input(scene):
    seen = film(response(scene, "run", "unstable"), **CAMERA)
    assert seen.attrs["status"] == "unstable" and np.isfinite(seen["input"]).all()
    assert np.isnan(moved(seen)).any()


def test_a_scene_that_a_force_drives_is_refused(shaken):
    from fiberweb import Scene, crosshatch

    pushed = Scene(crosshatch(4, length=0.52), force=0.1).to_json()
    with pytest.raises(ValueError, match=r"force = 0\.1 N drives this scene: .* give .* a stroke"):
        film(shaken.assign_attrs(scene=pushed), **CAMERA)
    lost = shaken.isel(readout=slice(0, 4))
    with pytest.raises(ValueError, match="no readout lies at the driven point"):
        film(lost, **CAMERA)
