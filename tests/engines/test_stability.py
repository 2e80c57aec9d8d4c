"""The predicted limit of the time step is where runs blow up, and what blows up says so."""

from dataclasses import replace

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, engines, simulate
from fiberweb.engines.base import Numerics
from fiberweb.engines.cosserat_stiffness import SHEAR_FACTOR
from fiberweb.model.mesh import build
from tests.engines.fibres import (
    ENGINES,
    every_node,
    fibre,
    largest_step,
    sampled,
    side_by_side,
    struck,
)

STEPS = 4000  # at 5 % above the limit a mode grows by 1.4 to 1.9 a step
CROSSINGS = {
    "compliant": dict(crossing_stiffness=70.0, crossing_damping=3.0),
    "stiff": dict(crossing_stiffness=3e6, crossing_damping=0.0),  # the spring sets the limit
    "sticky": dict(crossing_stiffness=70.0, crossing_damping=20.0),  # the explicit damper does
}
UNDAMPED = dict(setup="compliant", damping=0.0)


def single_fibre():
    """Undamped, 10 mm elements, with a soft blow on its end that moves axial and lateral modes."""
    return struck(fibre(10, 0.1, damping=0.0), -1, (1e-3, 1e-3), 0.0, 2e-4)


def network(crossings):
    """2x2, 10 mm elements, undamped but for the crossings, with a soft step load."""
    scene = Scene(crosshatch(2, spacing=0.05), force=1e-3, **UNDAMPED, **CROSSINGS[crossings])
    mesh = build(scene, 5)
    return replace(mesh, drive=np.array([[0.0, 0.0, 0.0, 1.0]]), readouts=every_node(mesh))


def record(mesh, engine, step, samples=41):
    """A recording of STEPS steps."""
    mesh = sampled(mesh, step, samples, STEPS // (samples - 1))
    return engines.load(engine).integrate(mesh, Numerics(engine, None, step))


def assert_threshold(mesh, engine):
    limit = largest_step(mesh, engine)
    below = record(mesh, engine, 0.97 * limit)
    assert below.unstable_at is None
    assert np.abs(below.displacement).max() < 1e-3  # m; some 0.1 mm are due to the load
    above = record(mesh, engine, 1.05 * limit)
    assert above.unstable_at is not None
    gone = round(above.unstable_at * above.displacement.shape[0] / (STEPS * 1.05 * limit))
    assert np.isnan(above.displacement[gone:]).all()
    assert np.isfinite(above.displacement[: gone - 1]).all()


@pytest.mark.parametrize("engine", ENGINES)
def test_a_fibre_blows_up_just_past_the_limit(engine):
    """Stable at 0.97 of the limit, gone at 1.05."""
    assert_threshold(single_fibre(), engine)


@pytest.mark.parametrize("crossings", CROSSINGS)
@pytest.mark.parametrize("engine", ENGINES)
def test_a_network_blows_up_just_past_the_limit(engine, crossings):
    """The same with crossings, whose damper the Cosserat engines take explicitly."""
    assert_threshold(network(crossings), engine)


@pytest.mark.parametrize("elements", [20, 50, 100])
def test_limits_of_long_fibres(elements):
    """Shear against rotation and stretch together in the Cosserat rod, h = 2 / sqrt(a G A / (rho
    I) + 4 (E + a G) / (rho l^2)), within 3 % as the ends matter most to short elements; axial
    waves alone in the Kirchhoff rod, h = l / c, within 0.2 %."""
    mesh = fibre(elements, 0.2, ends="sliding")  # a free end is lighter at fourth order
    scene, length = mesh.scene, 0.2 / elements
    shear = SHEAR_FACTOR * scene.youngs_modulus / 3.0
    rotation = shear * scene.area / (scene.bending_stiffness / scene.youngs_modulus)
    square = (rotation + 4 * (scene.youngs_modulus + shear) / length**2) / scene.density
    assert largest_step(mesh, "kirchhoff") == pytest.approx(length / scene.wave_speed, rel=0.002)
    assert largest_step(mesh, "cosserat") == pytest.approx(2 / np.sqrt(square), rel=0.03)


@pytest.mark.parametrize("engine", ["cosserat", "elastica"])
def test_fibres_gone_are_seen_beside_one_that_is_well(engine):
    """The last two of three fibres joined by a damper far beyond its explicit limit: NaN in
    theirs alone is still an unstable run."""
    one = single_fibre()
    mesh = side_by_side(one, one, one)
    mesh = replace(
        mesh, drive=one.drive, joints=np.add([[5, 6]], mesh.first[1:3]),
        joint_stiffness=np.array([70.0]), joint_damping=np.array([1000.0]),
    )  # fmt: skip
    recording = record(mesh, engine, 0.9 * largest_step(one, engine), samples=3)
    assert recording.unstable_at is not None
    assert np.isnan(recording.displacement[-1]).all()


@pytest.mark.parametrize("engine", ENGINES)
def test_status_of_a_run_that_blows_up(engine):
    """`simulate` says unstable, with NaN from then on; without force it refuses the step."""
    scene = Scene(crosshatch(2, spacing=0.05), setup="compliant", duration=0.04)
    limit = largest_step(build(scene, 4), engine)
    kwargs = dict(engine=engine, elements_per_section=4, time_step=1.5 * limit)
    with pytest.raises(ValueError, match=r"time_step = .* is above the stability limit"):
        simulate(scene, **kwargs)
    response = simulate(scene, force_time_step=True, **kwargs)
    assert response.attrs["status"] == "unstable"
    moved = response["displacement"].values
    gone = response["time"].values >= response.attrs["unstable_at"]
    assert np.isnan(moved[gone]).all()
    assert np.isfinite(moved[~gone]).all()
    response = simulate(scene, engine=engine, elements_per_section=4)
    assert response.attrs["status"] == "ok"
    assert np.isfinite(response["displacement"].values).all()
