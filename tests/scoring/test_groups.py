"""Groups of signals: the authors' counts, and the order in which a response has them."""

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, polygon
from fiberweb.model.mesh import build
from fiberweb.scoring import groups


def count(group, n):
    network = crosshatch(n, length=0.5)
    return int(groups.mask(group, network, groups.readouts(network)).sum())


@pytest.mark.parametrize(
    ("network", "setup"),
    [
        (crosshatch(4, length=0.5), "described"),
        (crosshatch(3, length=0.5), "published"),
        (polygon(6), "described"),
    ],
)
def test_readouts_are_those_that_a_simulation_records(network, setup):
    points = groups.readouts(network)
    mesh = build(Scene(network, setup, layout="exact"), elements_per_section=4)
    assert list(points["kind"]) == [readout.kind for readout in mesh.readouts]
    assert list(points["fibre"]) == [readout.fibre for readout in mesh.readouts]
    assert list(points["section"]) == [readout.section for readout in mesh.readouts]
    places = [np.dot(r.weights, mesh.position[list(r.nodes)]) for r in mesh.readouts]
    np.testing.assert_allclose(points[["x", "y"]], places, atol=1e-9)


@pytest.mark.parametrize(
    ("group", "four", "six"),
    [
        ("all", 112, 240),
        ("crossing_x", 16, 36),
        ("horizontal_midpoint_y", 20, 42),
        ("lateral_midpoints", 40, 84),
        ("near_springs", 2 * (11 + 13 + 13), 134),
        ("near_actuation", 2 * (4 + 6 + 6), 80),
    ],
)
def test_counts_are_the_authors(group, four, six):
    assert (count(group, 4), count(group, 6)) == (four, six)


def test_near_actuation_of_6x6_holds_the_authors_indices():
    network = crosshatch(6, length=0.5)
    points = groups.readouts(network)
    chosen = points[groups.mask("near_actuation", network, points)[: len(points)]]
    crossings = chosen[chosen["kind"] == "crossing"]
    assert set(zip(crossings["fibre"], crossings["section"])) == {
        (row, column) for row in range(1, 5) for column in range(1, 5)
    }
    midpoints = chosen[chosen["kind"] != "crossing"]
    assert set(zip(midpoints["fibre"], midpoints["section"])) == {
        (fibre, section) for fibre in (1, 2, 3, 4, 7, 8, 9, 10) for section in (2, 3, 4)
    }


def test_near_springs_of_6x6_keeps_the_authors_irregular_rows():
    network = crosshatch(6, length=0.5)
    points = groups.readouts(network)
    chosen = points[groups.mask("near_springs", network, points)[: len(points)]]
    rows = chosen[chosen["kind"] == "horizontal_midpoint"].groupby("fibre")["section"].min()
    assert list(rows) == [5, 5, 3, 3, 2, 1]


def test_near_springs_elsewhere_lies_beyond_the_diagonal():
    for n in (2, 3, 5, 8):
        network = crosshatch(n, length=1.0)
        points = groups.readouts(network)
        chosen = groups.mask("near_springs", network, points)
        beyond = points["x"] + points["y"] >= 1.0 - 1e-9
        np.testing.assert_array_equal(chosen, np.tile(beyond, 2))


def test_subgroups_split_all_signals_and_x_comes_first():
    network = crosshatch(5, length=0.5)
    points = groups.readouts(network)
    masks = np.array([groups.mask(name, network, points) for name in groups.SUBGROUPS])
    assert (masks.sum(axis=0) == 1).all()
    lateral = groups.mask("lateral_midpoints", network, points)
    np.testing.assert_array_equal(lateral, masks[3] | masks[4])  # horizontal y, vertical x
    assert masks[0][: len(points)].any() and not masks[0][len(points) :].any()


def test_missing_readouts_leave_their_signals_out():
    network = crosshatch(6, length=0.5)
    points = groups.readouts(network)
    fewer = points[(points["kind"] != "crossing") | (points["fibre"] != 3)]
    assert groups.mask("crossing_y", network, fewer).sum() == 30


def test_a_group_that_does_not_exist_is_refused_in_a_sentence():
    network = polygon(6)
    points = groups.readouts(network)
    assert groups.mask("crossing_y", network, points).any()
    with pytest.raises(ValueError, match="'near_springs' needs a crosshatch; a polygon has only"):
        groups.mask("near_springs", network, points)
    with pytest.raises(ValueError, match="group = 'left' is unknown; use one of all, crossing_x"):
        groups.mask("left", network, points)
