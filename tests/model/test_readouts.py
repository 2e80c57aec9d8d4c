"""The order of readouts and signals, which meshes, groups and responses share."""

import numpy as np
import pytest

from fiberweb.model.mesh import build
from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.readouts import as_signals, of_signals, places
from fiberweb.model.scene import Scene


@pytest.mark.parametrize(
    "network", [crosshatch(4, length=0.5), crosshatch(3, length=0.5), polygon(6), polygon(8)]
)
@pytest.mark.parametrize(("setup", "elements"), [("described", 4), ("published", 3)])
def test_a_mesh_reads_the_places_of_its_network(network, setup, elements):
    mesh = build(Scene(network, setup, layout="exact"), elements)
    expected = places(network)
    assert [readout[:3] for readout in mesh.readouts] == [place[:3] for place in expected]
    lie = [np.dot(r.weights, mesh.position[list(r.nodes)]) for r in mesh.readouts]
    np.testing.assert_allclose(lie, [place[3:] for place in expected], atol=1e-9)


def test_the_authors_mesh_reads_the_same_ones_beside_their_places():
    network = crosshatch(4, length=0.5)
    mesh = build(Scene(network, "published"))
    expected = places(network)
    assert [readout[:3] for readout in mesh.readouts] == [place[:3] for place in expected]
    lie = np.array([np.dot(r.weights, mesh.position[list(r.nodes)]) for r in mesh.readouts])
    assert 0 < np.abs(lie - [place[3:] for place in expected]).max() <= 0.01


def test_crossings_come_first_and_then_midpoints_fibre_by_fibre():
    assert [place[:3] for place in places(crosshatch(2, spacing=0.1))] == [
        *[("crossing", fibre, number) for fibre in (0, 1) for number in (0, 1)],
        *[("horizontal_midpoint", fibre, number) for fibre in (0, 1) for number in (0, 1, 2)],
        *[("vertical_midpoint", fibre, number) for fibre in (2, 3) for number in (0, 1, 2)],
    ]
    assert places(crosshatch(2, spacing=0.1))[4][3:] == pytest.approx((0.05, 0.1))


def test_x_of_all_readouts_comes_before_y():
    x, y = np.arange(6.0).reshape(2, 3), 10 + np.arange(6.0).reshape(2, 3)
    np.testing.assert_array_equal(as_signals(x, y), [[0, 1, 2, 10, 11, 12], [3, 4, 5, 13, 14, 15]])
    readout, axis = of_signals(np.array([0, 2, 3, 5]), 3)
    assert (readout.tolist(), axis) == ([0, 2, 0, 2], ["x", "x", "y", "y"])
