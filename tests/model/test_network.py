"""Fibres and crossings: counts, places, and what is refused."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fiberweb import Scene
from fiberweb.model.network import crosshatch, from_spec, polygon, web

crosshatches = st.builds(crosshatch, st.integers(2, 12), length=st.floats(0.05, 5.0)) | st.builds(
    crosshatch, st.integers(2, 12), spacing=st.floats(0.01, 1.0)
)
polygons = st.builds(
    polygon, st.sampled_from([6, 8, 10]), diameter=st.floats(0.05, 5.0),
    diagonals=st.sampled_from(["all", "skip-one"]),
)  # fmt: skip


@pytest.mark.parametrize("n", [2, 3, 4, 8, 12])
def test_crosshatch_counts(n):
    network = crosshatch(n, length=0.5)
    assert len(network.fibres) == 2 * n
    assert len(network.crossings) == n * n
    assert all(len(stations) == n for stations in network.stations)
    np.testing.assert_allclose(network.fibre_lengths, 0.5)
    assert network.spacing == pytest.approx(0.5 / (n + 1))


@pytest.mark.parametrize("n", [6, 8, 10, 12])
def test_skip_one_polygon_counts(n):
    """N/2 diameters and N short diagonals cross in 2N + 1 points and have 6N sections."""
    network = polygon(n, diagonals="skip-one")
    assert len(network.fibres) == n // 2 + n
    assert len(network.crossings) == 2 * n + 1
    assert sum(len(network.sections(f)) - 1 for f in range(len(network.fibres))) == 6 * n


@pytest.mark.parametrize("n", [6, 8, 10])
def test_full_polygon_counts(n):
    """All N (N - 3) / 2 diagonals; the N/2 diameters meet in one point, the centre."""
    network = polygon(n)
    assert len(network.fibres) == n * (n - 3) // 2
    through = [sum(c in dict(stations) for stations in network.stations)
               for c in range(len(network.crossings))]  # fmt: skip
    centre = int(np.argmin(np.linalg.norm(network.crossings, axis=1)))
    assert through[centre] == n // 2 == max(through)
    np.testing.assert_allclose(network.crossings[centre], 0.0, atol=1e-12)


def test_skip_one_is_everything_in_a_hexagon():
    both = [polygon(6, diagonals=diagonals) for diagonals in ("all", "skip-one")]
    ends = [{frozenset(map(tuple, np.round(fibre, 9))) for fibre in n.fibres} for n in both]
    assert ends[0] == ends[1]


def test_directions_and_driven_points():
    """Horizontal fibres first, left to right; the middle of the central one is shaken. In a
    polygon the first diameter lies along x, shaken beyond the centre."""
    hatch = crosshatch(4, spacing=0.1)
    np.testing.assert_allclose(hatch.fibres[1], [[0, 0.2], [0.5, 0.2]])
    np.testing.assert_allclose(hatch.fibres[4 + 1], [[0.2, 0], [0.2, 0.5]])
    assert (hatch.driven_fibre, hatch.driven_distance) == (2, pytest.approx(0.25))
    hexagon = polygon(6, diameter=0.5)
    np.testing.assert_allclose(hexagon.fibres[0], [[-0.25, 0], [0.25, 0]], atol=1e-15)
    assert hexagon.spacing == pytest.approx(0.25 * np.cos(np.pi / 3))
    assert hexagon.driven_distance == pytest.approx(0.25 + hexagon.spacing / 2)
    np.testing.assert_allclose(hatch.driven_point, [0.25, 0.3])
    np.testing.assert_allclose(hexagon.driven_point, [hexagon.spacing / 2, 0.0], atol=1e-15)
    for network in (hatch, hexagon):
        np.testing.assert_allclose(network.across, [0.0, 1.0], atol=1e-15)


@settings(max_examples=30, deadline=None)
@given(crosshatches | polygons)
def test_crossings_lie_on_their_fibres(network):
    """Each station is where its crossing is, in order along the fibre; sections add up."""
    for fibre, stations in enumerate(network.stations):
        near, far = network.fibres[fibre]
        length = network.fibre_lengths[fibre]
        ends = network.sections(fibre)
        assert (np.diff(ends) > 0).all()
        assert np.diff(ends).sum() == pytest.approx(length)
        for crossing, distance in stations:
            point = near + distance * (far - near) / length
            np.testing.assert_allclose(point, network.crossings[crossing], atol=1e-9)
    met = [sum(c in dict(s) for s in network.stations) for c in range(len(network.crossings))]
    assert min(met) >= 2


@settings(max_examples=20, deadline=None)
@given(crosshatches | polygons)
def test_spec_builds_the_network_again(network):
    again = from_spec(network.spec())
    assert again == network
    np.testing.assert_array_equal(again.fibres, network.fibres)
    assert again.stations == network.stations


@pytest.mark.parametrize(
    ("make", "args", "kwargs", "words"),
    [
        (crosshatch, (1,), dict(length=0.5), "n = 1: a crosshatch has at least 2 fibres"),
        (crosshatch, (2.0,), dict(length=0.5), "n = 2.0: a crosshatch has at least 2 fibres"),
        (crosshatch, (True,), dict(length=0.5), "n = True: "),
        (crosshatch, (4,), {}, "length = None and spacing = None"),
        (crosshatch, (4,), dict(length=0.5, spacing=0.1), "length = 0.5 and spacing = 0.1"),
        (crosshatch, (4,), dict(length=-0.5), "length = -0.5 must be a positive length in metres"),
        (crosshatch, (4,), dict(spacing=0.0), "spacing = 0.0 must be a positive length"),
        (crosshatch, (4,), dict(length=float("nan")), "length = nan must be a positive length"),
        (crosshatch, (4,), dict(length=float("inf")), "length = inf must be a positive length"),
        (crosshatch, (4,), dict(spacing="0.1"), "spacing = '0.1' must be a positive length"),
        (polygon, (7,), {}, "n = 7: a polygon has an even number of vertices"),
        (polygon, (4,), {}, "n = 4: a polygon has an even number of at least 6 vertices"),
        (polygon, (6,), dict(diameter=0), "diameter = 0 must be a positive length"),
        (polygon, (6,), dict(diagonals="few"), "diagonals = 'few' is not one of 'all', 'skip-one'"),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said_in_one_sentence(make, args, kwargs, words):
    with pytest.raises(ValueError) as error:
        make(*args, **kwargs)
    message = str(error.value)
    assert words in message
    assert "\n" not in message


@pytest.mark.parametrize(("make", "n"), [(crosshatch, 501), (polygon, 18), (crosshatch, 2**32)])
def test_a_network_that_no_machine_holds_is_refused_at_once(make, n):
    with pytest.raises(ValueError, match=rf"^n = {n}: more than .* are beyond any machine"):
        make(n, 0.5)


ACROSS = [[[0.0, 0.1], [0.3, 0.1]], [[0.1, 0.0], [0.1, 0.3]]]


@given(crosshatches | polygons)
@settings(max_examples=20, deadline=None)
def test_a_web_of_the_fibres_of_another_is_that_network(network):
    same = web(network.fibres, network.driven_fibre, network.driven_distance)
    np.testing.assert_allclose(same.spacing, network.spacing, rtol=1e-9)
    assert same.stations and [len(each) for each in same.stations] == [
        len(each) for each in network.stations
    ]
    ours, theirs = (sorted(map(tuple, np.round(n.crossings, 9))) for n in (same, network))
    np.testing.assert_allclose(ours, theirs, atol=2e-9)
    assert from_spec(same.spec()) == same


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (([],), "fibres = [] is no list of fibres"),
        (([[1.0, 2.0], [3.0, 4.0]],), "near and the far end of each in metres"),
        (("abc",), "fibres = 'abc'"),
        (([[[0.0, 0.0], [0.0, np.nan]]],), "is no list of fibres"),
        (([[[0.0, 0.0], [0.0, 0.0]]],), "fibre 0 of the web has no length"),
        (([*ACROSS, [[0.0, 0.2], [0.05, 0.3]]],), "fibre 2 of the web would never move"),
        (([*ACROSS, [[0.0, 0.2], [0.1, 0.2]]],), "fibre 2 of the web ends on fibre 1"),
        (([*ACROSS, ACROSS[0][::-1]],), "fibres 0 and 2 of the web lie on one another"),
        ((ACROSS * 60,), "fibres = 120: more than 100 fibres of a web"),
        ((ACROSS, 2), "driven_fibre = 2 does not exist: the web has fibres 0 to 1"),
        ((ACROSS, 0, 0.3), "driven_distance = 0.3 is not on fibre 0; give a length within its 0.3"),
    ],
)
def test_what_is_no_web_is_one_sentence(arguments, words):
    with pytest.raises(ValueError) as error:
        web(*arguments)
    assert words in str(error.value)


def test_the_authors_have_no_web():
    with pytest.raises(ValueError, match="setup = 'published' has no web, only crosshatch or pol"):
        Scene(web(ACROSS), "published")
    with pytest.raises(ValueError, match="layout = 'authors' is of their own networks"):
        Scene(web(ACROSS), layout="authors")


@pytest.mark.parametrize("value", [1e-6, 1e6, 1e200])
def test_a_length_of_no_magnitude_is_refused(value):
    for make, name in ((crosshatch, "length"), (crosshatch, "spacing"), (polygon, "diameter")):
        with pytest.raises(
            ValueError, match=r"(length|diameter) = .* between 1e-05 and 100000, in"
        ):
            make(6, **{name: value})
