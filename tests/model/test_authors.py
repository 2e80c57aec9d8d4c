"""What is known of the authors' numbers, and that no module but one holds them."""

import ast
from pathlib import Path

import pytest

from fiberweb.model import authors
from fiberweb.model.network import crosshatch
from fiberweb.model.scene import Scene

ROOT = Path(authors.__file__).parents[1]


@pytest.mark.parametrize(
    ("n", "force"), [(2, 0.0108), (4, 0.05), (6, 0.1372), (8, 0.2916), (10, 0.5324), (12, 0.8788)]
)
def test_reference_forces_of_the_authors(n, force):
    """Eq. 3 as their scripts round it, 50e-6 N m3 / s3, at 500 mm."""
    scene = Scene(crosshatch(n, length=0.5), setup="published")
    assert scene.force == pytest.approx(force, rel=1e-4)


def test_listed_forces_are_reference_forces_to_six_digits():
    """And the four more; every force that other scripts list for a spacing is one of them."""
    references = [float(authors.reference_force(spacing)) for spacing in authors.EQ3_SPACINGS]
    others = [
        force for force in authors.FORCES if force not in map(authors.listed_force, references)
    ]
    assert others == [1.25, 2.5, 3.75, 5.0]
    assert len(authors.FORCES) == len(authors.EQ3_SPACINGS) + 4 == 18
    for forces in (authors.SIZE_C_NL_FORCES, authors.SIZE_C_M_FORCES, authors.PRETENSION_FORCES):
        assert set(forces) <= set(authors.FORCES)


def test_the_load_adds_up_and_is_skewed():
    assert sum(authors.LOAD.values()) == pytest.approx(1.0)
    assert authors.LOAD[-2] != authors.LOAD[2]


@pytest.mark.parametrize("constant", [1234, 501, 0.1875, 50e-6])
def test_no_other_module_repeats_what_theirs_alone_is(constant):
    holders = {
        path.relative_to(ROOT).as_posix()
        for path in ROOT.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.Constant) and node.value == constant
    }
    assert holders == {"model/authors.py"}
