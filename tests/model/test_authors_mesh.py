"""The authors' own meshes: where their nodes are, and what ties, pulls and loads them."""

import numpy as np
import pytest

from fiberweb.model.mesh import build
from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.scene import Scene


def rest(mesh):
    """Where each readout lies."""
    return np.array([np.array(r.weights) @ mesh.position[list(r.nodes)] for r in mesh.readouts])


@pytest.mark.parametrize("n", [2, 4, 6, 8, 10, 12])
def test_authors_mesh_at_500_mm(n):
    """50 elements of 10 mm; crossings on nodes int(linspace(0, 51, N + 2)), the fibres laid
    through them, so that no joint starts with a gap; midpoints rounded down likewise."""
    mesh = build(Scene(crosshatch(n, length=0.5), setup="published"))
    assert mesh.elements == 2 * n * 50
    np.testing.assert_allclose(mesh.edges(0), 0.01)
    grid = np.linspace(0, 51, n + 2)
    expected = grid[1:-1].astype(int)
    crossings = [r for r in mesh.readouts if r.kind == "crossing"]
    for fibre in range(n):
        at = [r.nodes[0] - mesh.first[fibre] for r in crossings if r.fibre == fibre]
        np.testing.assert_array_equal(at, expected)
        np.testing.assert_allclose(
            mesh.position[mesh.first[fibre] : mesh.first[fibre + 1], 1], 0.01 * expected[fibre]
        )
    a, b = mesh.joints.T
    assert len(a) == n * n
    np.testing.assert_allclose(mesh.position[a], mesh.position[b], atol=1e-12)
    middles = (0.5 * (grid[1:] + grid[:-1])).astype(int)
    places = rest(mesh)[[r.kind == "horizontal_midpoint" and r.fibre == 0 for r in mesh.readouts]]
    np.testing.assert_allclose(places[:, 0], 0.01 * middles, atol=1e-9)


@pytest.mark.parametrize(
    ("spacing", "elements", "size"),
    [(0.02, 20, 5e-3), (0.03, 30, 5e-3), (0.04, 50, 4e-3), (0.1, 50, 10e-3), (0.15, 75, 10e-3)],
)
def test_authors_elements_at_other_spacings(spacing, elements, size):
    """10 mm and at least 50 a fibre, but 5 mm at 20 and 30 mm; 4x4."""
    mesh = build(Scene(crosshatch(4, spacing=spacing), setup="published"))
    np.testing.assert_allclose(mesh.edges(0), size)
    assert len(mesh.edges(0)) == elements


@pytest.mark.parametrize(("n", "fibre"), [(2, 0), (4, 2), (6, 3)])
def test_authors_load(n, fibre):
    """Five nodes about the middle of fibre N // 2 (0 for N = 2), weights skewed, downwards."""
    scene = Scene(crosshatch(n, length=0.5), setup="published")
    mesh = build(scene)
    loaded = np.flatnonzero(mesh.load.any(axis=1))
    np.testing.assert_array_equal(loaded, mesh.first[fibre] + 25 + np.arange(-2, 3))
    weights = mesh.load[loaded, 1] / scene.force
    np.testing.assert_allclose(weights, [-0.1875, -0.125, -0.125, -0.1875, -0.375])
    assert weights.sum() == pytest.approx(-1.0)
    assert not mesh.load[:, 0].any()


@pytest.mark.parametrize(
    ("n", "per_section", "split"), [(12, 4, 1), (12, 8, 2), (4, 4, 1), (2, 34, 2)]
)
def test_the_authors_layout_on_finer_meshes(n, per_section, split):
    """The same places and forces in any setup; elements cut in so many."""
    network = crosshatch(n, length=0.5)
    theirs = build(Scene(network, "published"))
    ours = build(Scene(network, layout="authors", force=0.05), per_section)
    np.testing.assert_allclose(ours.edges(0), 0.01 / split)
    np.testing.assert_allclose(rest(ours), rest(theirs), atol=1e-12)
    at = [np.flatnonzero(mesh.load.any(axis=1)) for mesh in (ours, theirs)]
    places = [mesh.position[nodes] for mesh, nodes in zip((ours, theirs), at)]
    np.testing.assert_allclose(*places, atol=1e-12)
    forces = [mesh.load[nodes, 1] / mesh.scene.force for mesh, nodes in zip((ours, theirs), at)]
    np.testing.assert_allclose(*forces)


def test_a_polygon_of_theirs_needs_springs():
    with pytest.raises(ValueError, match="layout = 'authors' of a polygon starts with gaps"):
        Scene(polygon(6), layout="authors")


def test_authors_polygon():
    """Crossings on the nodes before them, so that joints start with gaps; a hundredth of the
    stiffness between diagonals, the first two of which stay free; a chain at the centre; no joints
    of diagonals at vertices; diameters alone are pulled, the first one pushed in one node."""
    network = polygon(6, diagonals="skip-one")
    mesh = build(Scene(network, setup="published"))
    fibre_of = np.repeat(np.arange(len(network.fibres)), np.diff(mesh.first))
    a, b = mesh.joints.T
    ends = np.isin(a, mesh.first[:-1]) | np.isin(a + 1, mesh.first[1:])
    diagonals = (fibre_of[a] >= 3) & (fibre_of[b] >= 3)
    np.testing.assert_allclose(mesh.joint_stiffness[diagonals], 10.0)
    np.testing.assert_allclose(mesh.joint_stiffness[~diagonals], 1e3)
    assert diagonals.sum() == 6 - 1 and not ends[diagonals].any()  # six points, one left out
    assert ends.sum() == 6 * 2  # at each vertex a diameter with two diagonals
    chain = (fibre_of[a] < 3) & (fibre_of[b] < 3)
    assert list(zip(fibre_of[a[chain]], fibre_of[b[chain]])) == [(0, 1), (1, 2)]
    gap = np.linalg.norm(mesh.position[a] - mesh.position[b], axis=1)
    assert gap.max() == pytest.approx(7.1e-3, abs=1e-4)  # as their script prints it
    assert np.unique(fibre_of[mesh.pull.any(axis=1)]).tolist() == [0, 1, 2]
    (pushed,) = np.flatnonzero(mesh.load.any(axis=1))
    assert pushed == (25 + 37) // 2 and mesh.load[pushed, 1] == mesh.scene.force


def test_the_authors_polygon_on_a_finer_mesh():
    """The same places and forces, elements cut in two."""
    network = polygon(8, diagonals="skip-one")
    theirs, ours = (build(Scene(network, "published"), per_section) for per_section in (None, 36))
    assert ours.elements == 2 * theirs.elements
    np.testing.assert_allclose(rest(ours), rest(theirs), atol=1e-12)
    for pair in zip(ours.joints.T, theirs.joints.T):
        np.testing.assert_allclose(*(m.position[j] for m, j in zip((ours, theirs), pair)))
