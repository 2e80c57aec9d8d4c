"""Both planar engines against a code that nobody here wrote; `-s` prints the table."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("exudyn", reason="no wheel of exudyn on this platform")
sys.path.insert(0, str(Path(__file__).parent))

import exudyn_model as model

FLOOR = 3e-4  # a tenth of shear and rotary inertia, the stress laws, and Exudyn's own errors


@pytest.fixture(scope="module")
def table():
    rows = model.exudyn_rows()
    for row in rows:
        print("{network:13s} {code:15s} {elements:3d} {time_step:8.2e} {rms_difference:.2e}".format(
            **row))  # fmt: skip
    return rows


def errors(table, network, code):
    return [r["rms_difference"] for r in table if (r["network"], r["code"]) == (network, code)]


def test_exudyn_bends_a_cantilever_as_the_elastica():
    """P L^2 / EI = 5: Bisshopp and Drucker (1945)."""
    np.testing.assert_allclose(model.cantilever(5.0), (0.38763, 0.71379), atol=1e-5)


@pytest.mark.parametrize("network", model.SCENES)
def test_exudyn_has_converged(table, network):
    mesh, step = errors(table, network, "exudyn")
    assert mesh < 1e-3  # of half the elements: its elements are fourth order
    assert step < 2e-4
    assert errors(table, network, "exudyn slender")[0] < 2e-3  # shear and rotary inertia


@pytest.mark.parametrize(
    "network, engine, finest",
    [
        ("single fibre", "kirchhoff", 5e-4),
        ("single fibre", "cosserat", 2e-3),
        ("2x2", "kirchhoff", 2.5e-3),
        ("2x2", "cosserat", 1.2e-2),
    ],
)
def test_engines_converge_to_exudyn(table, network, engine, finest):
    """At second order or better, down to what the models differ by."""
    four, eight, sixteen = errors(table, network, engine)
    assert eight < four / 3
    assert sixteen < finest
    assert sixteen < max(eight / 2, FLOOR)
