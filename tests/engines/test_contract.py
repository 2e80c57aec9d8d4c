"""What every engine offers, and that nobody outside asks which one it is."""

from __future__ import annotations

import inspect
import re
from importlib.metadata import version
from pathlib import Path

import numpy as np
import pytest

import fiberweb
from fiberweb import engines
from fiberweb.engines.base import Engine
from fiberweb.model.mesh import build
from fiberweb.model.network import crosshatch
from fiberweb.model.scene import Scene
from tests.engines.fibres import ENGINES

ROOT = Path(fiberweb.__file__).parent
ATTRIBUTES = list(Engine.__annotations__)
FUNCTIONS = [name for name, member in vars(Engine).items()
             if inspect.isfunction(member) and not name.startswith("_")]  # fmt: skip
COMPARED = re.compile(r"""engine\s*[!=]=\s*["']|["']\s*[!=]=\s*[\w.]*engine\b""")


@pytest.mark.parametrize("name", engines.ENGINES)
def test_an_engine_offers_the_contract(name):
    engine = engines.load(name)
    for member in FUNCTIONS:
        asked = list(inspect.signature(getattr(Engine, member)).parameters)[1:]
        given = inspect.signature(getattr(engine, member)).parameters
        assert list(given)[: len(asked)] == asked
        assert all(p.default is not p.empty for p in list(given.values())[len(asked) :])
    assert all(hasattr(engine, attribute) for attribute in ATTRIBUTES)
    assert all(version(package) for package in engine.PACKAGES)
    assert engine.NANOSECONDS > 0
    errors = [engine.MESH_ERRORS[elements] for elements in sorted(engine.MESH_ERRORS)]
    assert errors == sorted(errors, reverse=True)


def small(**fields):
    """A mesh of four elements a section."""
    return build(Scene(crosshatch(2, spacing=0.1), **fields), 4)


@pytest.mark.parametrize("name", ENGINES)
def test_what_an_engine_does_not_model_it_refuses(name):
    cosserat = name != "kirchhoff"
    assert engines.accepts(name, small()) != cosserat  # the described setup joins fibres
    assert engines.accepts(name, small(setup="compliant"))
    assert engines.accepts(name, small(setup="published")) == (name == "cosserat")
    assert engines.accepts(name, small(setup="published", dead_band=False)) == cosserat
    assert engines.accepts(name, small(setup="compliant", filter_order=3)) == cosserat
    banded = small(setup="compliant", dead_band=True)
    assert engines.accepts(name, banded) == (name == "cosserat")
    assert engines.accepts(name, small(setup="compliant", crossing_stiffness=np.inf)) != cosserat
    three_elements = Scene(crosshatch(2, spacing=0.1), setup="compliant", filter_order=3)
    filtered = build(three_elements, 1)
    assert not engines.accepts(name, filtered)
    with pytest.raises(ValueError, match=r"filter_order = 3: .*; (use|raise) "):
        engines.load(name).refuse(filtered)


@pytest.mark.parametrize("name", engines.ENGINES)
def test_the_largest_step_is_shorter_than_a_wave_needs_for_an_element(name):
    mesh = small()
    step = engines.load(name).largest_step(mesh)
    assert 0.0 < step < 1.01 * mesh.edges(0).max() / mesh.scene.wave_speed


def test_no_module_outside_asks_for_an_engine_by_name():
    """What differs between engines stands in the engines."""
    asked = [
        f"{path.relative_to(ROOT)}: {line.strip()}"
        for path in ROOT.rglob("*.py")
        for line in path.read_text().splitlines()
        if ROOT / "engines" not in path.parents and COMPARED.search(line)
    ]
    assert not asked
