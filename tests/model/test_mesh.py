"""Meshes: what is cut where, and what acts on which node."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fiberweb.model.lines import ELEMENT_FLOOR
from fiberweb.model.mesh import build
from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.scene import Scene

networks = st.builds(crosshatch, st.integers(2, 6), spacing=st.floats(0.02, 0.3)) | st.builds(
    polygon, st.sampled_from([6, 8]), diagonals=st.sampled_from(["all", "skip-one"])
)


def rest(mesh):
    """Where each readout lies."""
    return np.array([np.array(r.weights) @ mesh.position[list(r.nodes)] for r in mesh.readouts])


@pytest.mark.parametrize("elements", [1, 3, 8])
@pytest.mark.parametrize("n", [2, 4, 5])
def test_crosshatch_readouts(n, elements):
    """N^2 crossings, N (N + 1) midpoints either way: 3 N^2 + 2 N points."""
    mesh = build(Scene(crosshatch(n, spacing=0.1)), elements)
    kinds = [readout.kind for readout in mesh.readouts]
    assert len(kinds) == 3 * n * n + 2 * n
    assert kinds.count("crossing") == n * n
    assert kinds.count("horizontal_midpoint") == n * (n + 1)
    assert kinds.count("vertical_midpoint") == n * (n + 1)
    assert mesh.elements == 2 * n * (n + 1) * elements
    midpoint = next(i for i, r in enumerate(mesh.readouts)
                    if r[:3] == ("vertical_midpoint", n + 1, 1))  # fmt: skip
    np.testing.assert_allclose(rest(mesh)[midpoint], [0.2, 0.15])


@pytest.mark.parametrize("setup", ["described", "published"])
@pytest.mark.parametrize("n", [6, 8])
def test_skip_one_polygon_readouts(n, setup):
    """2N + 1 crossings and 6N midpoints."""
    mesh = build(Scene(polygon(n, diagonals="skip-one"), setup=setup))
    kinds = [readout.kind for readout in mesh.readouts]
    assert kinds.count("crossing") == 2 * n + 1
    assert kinds.count("section_midpoint") == 6 * n


@settings(max_examples=25, deadline=None)
@given(networks, st.integers(1, 9))
def test_described_meshes_fit_their_network(network, elements):
    """Crossings and midpoints are read where they are, no joint starts with a gap, elements add
    up to the fibres, and the masses to the whole."""
    scene = Scene(network)
    mesh = build(scene, elements)
    kinds = np.array([readout.kind for readout in mesh.readouts])
    np.testing.assert_allclose(
        sorted(map(tuple, np.round(rest(mesh)[kinds == "crossing"], 8))),
        sorted(map(tuple, np.round(network.crossings, 8))), atol=2e-8,
    )  # fmt: skip
    for readout, place in zip(mesh.readouts, rest(mesh)):
        near, far = network.fibres[readout.fibre]
        ends = network.sections(readout.fibre)
        if readout.kind != "crossing":
            along = 0.5 * (ends[readout.section] + ends[readout.section + 1])
            np.testing.assert_allclose(place, near + along / ends[-1] * (far - near), atol=1e-9)
    a, b = mesh.joints.T
    np.testing.assert_allclose(mesh.position[a], mesh.position[b], atol=1e-9)
    lengths = [mesh.edges(f).sum() for f in range(len(network.fibres))]
    np.testing.assert_allclose(lengths, network.fibre_lengths)
    whole = scene.density * scene.area * network.fibre_lengths.sum()
    assert mesh.masses().sum() == pytest.approx(whole)
    if network.topology == "polygon":  # but for sections shorter than the floor itself
        floor = ELEMENT_FLOOR * scene.diameter
        shortest = min(np.diff(network.sections(f)).min() for f in range(len(network.fibres)))
        assert min(mesh.edges(f).min() for f in range(len(lengths))) >= min(floor, shortest) - 1e-9


def test_all_pairs_meet_where_several_fibres_do():
    """Three diameters of a hexagon: three joints at its centre, one at each other crossing."""
    mesh = build(Scene(polygon(6)), 4)
    centred = np.linalg.norm(mesh.position[mesh.joints[:, 0]], axis=1) < 1e-9
    assert centred.sum() == 3
    assert len(mesh.joints) == 12 + 3


@pytest.mark.parametrize(
    ("ends", "far", "clamped"),
    [("clamped", [False, False], True), ("sliding", [False, True], False),
     ("pinned", [False, False], False)],
)  # fmt: skip
def test_ends_of_fibres(ends, far, clamped):
    """Near ends held; far ends free, or free along the fibre only, and pulled along it."""
    mesh = build(Scene(crosshatch(2, spacing=0.1), ends=ends, tension=0.3), 4)
    for fibre in range(4):
        start, end = mesh.first[fibre], mesh.first[fibre + 1] - 1
        along = np.array([1.0, 0.0]) if fibre < 2 else np.array([0.0, 1.0])
        assert mesh.held[start].all()
        np.testing.assert_array_equal(mesh.held[end], far if fibre < 2 else far[::-1])
        np.testing.assert_allclose(mesh.pull[end], 0.3 * along, atol=1e-15)
        assert mesh.clamped[fibre] == clamped
    assert mesh.held.sum() == 4 * (2 + any(far))
    assert np.count_nonzero(mesh.pull.any(axis=1)) == 4


@pytest.mark.parametrize("elements", [2, 3, 4])
def test_described_load_is_one_point(elements):
    """Lateral, at the middle of the central horizontal fibre, shared by four nodes if none is
    there."""
    scene = Scene(crosshatch(4, spacing=0.1))
    mesh = build(scene, elements)
    np.testing.assert_allclose(mesh.load.sum(axis=0), [0.0, scene.force])
    moment = (mesh.load[:, 1:] * mesh.position).sum(axis=0) / scene.force
    np.testing.assert_allclose(moment, [0.25, 0.3])
    assert np.count_nonzero(mesh.load) == (1 if elements % 2 == 0 else 4)


def test_a_shorter_run_is_driven_by_the_same_series():
    short, long = (build(Scene(crosshatch(2, spacing=0.1), duration=d), 2) for d in (3.0, 100.0))
    np.testing.assert_array_equal(short.drive, long.drive)
    assert short.drive.shape == (500, 4)
    assert short.drive[0, 3] == 0.0


@pytest.mark.parametrize("elements", [0, -3])
def test_too_few_elements(elements):
    with pytest.raises(ValueError, match=rf"^elements_per_section = {elements} must be a whole"):
        build(Scene(crosshatch(2, spacing=0.1)), elements)


@pytest.mark.parametrize("diagonals", ["all", "skip-one"])
def test_far_ends_of_a_polygon_slide_along_their_fibres(diagonals):
    """Of any direction: those along x or y are held across, the others guided along a line."""
    mesh = build(Scene(polygon(6, diagonals=diagonals), ends="sliding"), 4)
    guides = dict(zip(mesh.guided.tolist(), mesh.guides))
    for fibre, (near, far) in enumerate(mesh.scene.network.fibres):
        start, end = mesh.first[fibre], mesh.first[fibre + 1] - 1
        along = (far - near) / np.linalg.norm(far - near)
        assert mesh.held[start].all() and not mesh.clamped[fibre]
        if end in guides:
            assert not mesh.held[end].any()
            np.testing.assert_allclose(guides[end], along, atol=1e-12)
        else:
            np.testing.assert_allclose(abs(along), ~mesh.held[end], atol=1e-12)
        np.testing.assert_allclose(mesh.pull[end], mesh.scene.tension * along, atol=1e-15)
    axial = 3  # a diameter along x, and two of the other diagonals along y
    assert len(guides) == len(mesh.scene.network.fibres) - axial


def test_ends_that_do_not_slide_have_no_guides():
    for ends in ("clamped", "pinned"):
        assert not len(build(Scene(polygon(6), ends=ends), 4).guided)
