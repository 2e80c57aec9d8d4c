"""Centre lines: recorded beside the readouts, which stay as they were, and drawn as splines."""

from dataclasses import replace

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, score, simulate
from fiberweb.engines.base import Numerics, Recording
from fiberweb.engines.elastica import assemble
from fiberweb.model.centre_lines import along, bulge, bulges, columns, widest
from fiberweb.model.mesh import build
from fiberweb.simulation.dataset import load, save
from fiberweb.simulation.response import response

NETWORK = crosshatch(2, spacing=0.1)
SCENE = Scene(NETWORK, duration=8.0, centre_lines=True)
CLAMPED, PINNED = ("clamped", "pinned")


@pytest.fixture(scope="module")
def runs():
    """The same run with centre lines and without."""
    return simulate(SCENE, "draft"), simulate(replace(SCENE, centre_lines=False), "draft")


def bent(shape, ends=CLAMPED, elements=4, samples=3, unstable_at=None):
    """A response in which every node of each fibre is displaced to the left by shape(distance),
    more with every sample."""
    scene = Scene(NETWORK, duration=samples / 250, centre_lines=True, ends=ends)
    mesh = build(scene, elements)
    moved = np.zeros((samples, len(mesh.readouts), 2))
    for number, readout in enumerate(mesh.readouts):
        near, far = NETWORK.fibres[readout.fibre]
        forward = (far - near) / NETWORK.length
        distance = (mesh.position[readout.nodes[0]] - near) @ forward
        moved[:, number] = np.arange(samples)[:, None] * shape(distance) * forward[::-1] * [-1, 1]
    if unstable_at is not None:
        moved[unstable_at:] = np.nan
    recording = Recording(moved, np.zeros((samples, 4)), unstable_at and unstable_at / 250)
    return response(mesh, Numerics("kirchhoff", elements, 1e-4), recording)


def test_readouts_are_those_of_a_run_without(runs):
    """Bit by bit, and so are the scores."""
    with_lines, without = runs
    for name in without.variables:
        np.testing.assert_array_equal(with_lines[name].values, without[name].values)
    assert set(with_lines.variables) - set(without.variables) == {
        "centre_line", "node_rest_x", "node_rest_y", "node_fibre"
    }  # fmt: skip
    scored, other = (score(run, orders=2) for run in runs)
    assert float(scored["c_nl"]) == float(other["c_nl"])
    assert float(scored["c_m"]) == float(other["c_m"])


def test_every_node_is_recorded(runs):
    data = runs[0]
    mesh = build(SCENE, data.attrs["elements_per_section"])
    assert data["centre_line"].dims == ("time", "node", "axis")
    assert data["centre_line"].dtype == np.float64
    np.testing.assert_array_equal(data["node_rest_x"], mesh.position[:, 0])
    np.testing.assert_array_equal(data["node_rest_y"], mesh.position[:, 1])
    np.testing.assert_array_equal(np.bincount(data["node_fibre"]), np.diff(mesh.first))
    for number, readout in enumerate(mesh.readouts[: data.sizes["readout"]]):
        if readout.kind == "crossing":
            node = data["centre_line"][:, readout.nodes[0]]
            np.testing.assert_array_equal(data["displacement"][:, number], node)
    assert np.abs(data["centre_line"]).max() > 1e-3


def test_nodes_are_readouts_of_the_mesh_after_all_others():
    plain = build(replace(SCENE, centre_lines=False), 4)
    mesh = build(SCENE, 4)
    assert mesh.readouts[: len(plain.readouts)] == plain.readouts
    nodes = mesh.readouts[len(plain.readouts) :]
    assert [readout.nodes for readout in nodes] == [(i,) * 4 for i in range(len(mesh.position))]
    assert nodes[13][:3] == ("node", 1, 0)  # three sections of four elements a fibre


def test_the_file_holds_them(runs, tmp_path):
    """All but what is rounded: a line like a readout, so that both still agree at crossings."""
    save(runs[0], tmp_path / "response.nc")
    kept = load(tmp_path / "response.nc")
    lines = ["displacement", "centre_line"]
    assert kept.drop_vars(lines).identical(runs[0].drop_vars(lines))
    for name in lines:
        np.testing.assert_allclose(kept[name], runs[0][name], rtol=0, atol=1e-6 * 1e-3)
    crossing = build(SCENE, kept.attrs["elements_per_section"]).readouts[0]
    np.testing.assert_array_equal(
        kept["displacement"][:, 0], kept["centre_line"][:, crossing.nodes[0]]
    )


def test_a_disturbance_moves_the_driven_point():
    """By as much, in every engine, and no other point."""
    scene = Scene(NETWORK, "compliant", duration=0.008, disturbance=1e-4, centre_lines=True)
    mesh = build(scene, 4)
    expected = np.zeros_like(mesh.position)
    expected[mesh.first[1] + 6, 1] = 1e-4
    np.testing.assert_allclose(mesh.start, expected)
    _, rods, _, _ = assemble(mesh, Numerics("elastica", 4, 5e-6))
    moved = np.concatenate([rod.position_collection.T for rod in rods]) / 1e3
    np.testing.assert_allclose(moved[:, :2] - mesh.position, expected, atol=1e-15)
    assert not moved[:, 2].any()
    for engine in ("kirchhoff", "cosserat"):
        data = simulate(scene, engine=engine, elements_per_section=4, time_step=5e-6)
        np.testing.assert_allclose(data["centre_line"][0], expected, atol=1e-9)


@pytest.mark.parametrize("fibre", [0, 3])
def test_a_loaded_cantilever_is_drawn_exactly(fibre):
    """A cubic, clamped at the near end and straight at the far one."""
    length, tip = NETWORK.length, 0.02
    data = bent(lambda x: tip * (3 * length * x**2 - x**3) / (2 * length**3))
    distance = np.linspace(0.0, length, 50)
    place, curvature = along(data, fibre, distance)
    x = distance / length
    forward, left = (0, 1) if fibre < 2 else (1, 0)
    near = NETWORK.fibres[fibre, 0]
    np.testing.assert_allclose(place[2, :, forward], near[forward] + distance, atol=1e-7)
    sideways = (place[2, :, left] - near[left]) * (1 if fibre < 2 else -1)
    np.testing.assert_allclose(sideways, tip * (3 * x**2 - x**3), atol=1e-7)
    slope = tip / length * (6 * x - 3 * x**2)
    expected = tip / length**2 * (6 - 6 * x) / (1 + slope**2) ** 1.5
    np.testing.assert_allclose(curvature[2], expected, atol=1e-3 * expected.max())


def test_a_pinned_end_may_turn():
    data = bent(lambda x: 0.1 * x, PINNED)
    _, curvature = along(data, 0, np.linspace(0.0, NETWORK.length, 20))
    np.testing.assert_allclose(curvature, 0.0, atol=1e-3)
    _, clamped = along(bent(lambda x: 0.1 * x), 0, np.array([0.0]))
    assert clamped[2, 0] > 1.0


def test_columns_reach_from_the_driven_section_to_the_held_ends():
    assert columns(crosshatch(2, spacing=0.1)) == [(2, 1), (3, 1)]
    assert columns(crosshatch(3, spacing=0.1)) == [(4, 1)]  # driven at a crossing
    assert columns(crosshatch(4, spacing=0.1)) == [(5, 2), (6, 2)]


def test_bulge_is_measured_from_the_chord():
    """A shift and a turn of a section are none; a bow to the left is negative."""
    turned = bent(lambda x: 0.003 + 0.02 * x, PINNED)
    np.testing.assert_allclose(bulge(turned, 2, 1), 0.0, atol=1e-7)
    bow = bent(lambda x: 4e-3 * np.sin(np.pi * (x - 0.1) / 0.1) if 0.1 < x < 0.2 else 0.0)
    np.testing.assert_allclose(bulge(bow, 2, 1), [0.0, -4e-3, -8e-3], atol=1e-7)
    np.testing.assert_allclose(bulges(bow), np.outer([0, -4e-3, -8e-3], [1, 1]), atol=1e-7)


def test_an_unstable_run_has_a_shape_until_then():
    data = bent(lambda x: 0.01 * x**2, samples=4, unstable_at=2)
    place, curvature = along(data, 0, np.array([0.1, 0.2]))
    np.testing.assert_array_equal(np.isfinite(place[:, 0, 0]), [True, True, False, False])
    np.testing.assert_array_equal(np.isfinite(curvature[:, 1]), [True, True, False, False])
    assert widest([bulges(data)]) == 1


def test_widest_is_sought_in_all_runs():
    one, other = np.zeros((5, 2)), np.zeros((5, 2))
    one[1, 0], other[3, 1] = 0.3, -0.4
    assert widest([one, other]) == 3
