"""Both planar engines against a code that nobody here wrote; `-s` prints the table."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("exudyn", reason="no wheel of exudyn on this platform")

from fiberweb.validation import accuracy, exudyn_beams, exudyn_check

FLOOR = 3e-4  # a tenth of shear and rotary inertia, the stress laws, and Exudyn's own errors


@pytest.fixture(scope="module")
def table():
    differences = exudyn_check.table()
    print(differences.to_string())
    return differences


def rows(table, network, code, against):
    same = [table["network"] == network, table["engine"] == code, table["against"] == against]
    return table[np.logical_and.reduce(same)]


def test_exudyn_bends_a_cantilever_as_the_elastica():
    """P L^2 / EI = 5: Bisshopp and Drucker (1945)."""
    np.testing.assert_allclose(exudyn_beams.cantilever(5.0), (0.38763, 0.71379), atol=1e-5)


@pytest.mark.parametrize("network", exudyn_check.SCENES)
def test_exudyn_has_converged(table, network):
    exudyn = rows(table, network, "exudyn", "kirchhoff")
    mesh, step = exudyn["mesh_error"].iloc[0], exudyn["step_error"].iloc[1]
    assert mesh < 1e-3  # of half the elements: its elements are fourth order
    assert step < 2e-4
    (slender,) = rows(table, network, "exudyn slender", "exudyn")["difference"]
    assert slender < 2e-3  # shear and rotary inertia


@pytest.mark.parametrize(
    "network, engine, against, finest",
    [
        ("single fibre", "kirchhoff", "exudyn slender", 5e-4),
        ("single fibre", "cosserat", "exudyn", 2e-3),
        ("2x2", "kirchhoff", "exudyn slender", 2.5e-3),
        ("2x2", "cosserat", "exudyn", 1.2e-2),
    ],
)
def test_engines_converge_to_exudyn(table, network, engine, against, finest):
    """At second order or better, down to what the models differ by."""
    four, eight, sixteen = rows(table, network, engine, against)["difference"]
    assert eight < four / 3
    assert sixteen < finest
    assert sixteen < max(eight / 2, FLOOR)


def test_exudyn_stands_in_the_accuracy_table(table):
    errors = accuracy.exudyn_rows(table)
    assert list(errors.columns) == list(accuracy.COLUMNS)
    assert set(errors["network"]) == set(exudyn_check.SCENES)
    assert set(errors["setup"]) == {scene.setup for scene in exudyn_check.SCENES.values()}
    assert errors["trajectory_error"].between(0.0, 2e-3).all()  # shear and rotary inertia, again
    assert errors["seconds_per_run"].isna().all()
