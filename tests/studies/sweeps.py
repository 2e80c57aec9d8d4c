"""Made-up tables of force and spacing, size and pretension: for figures, and how to change them."""

import itertools

import numpy as np
import pandas as pd

from fiberweb.model.buckling import critical_force
from fiberweb.studies.ridge.onset import onsets
from tests.figures.legible import BASELINES

SPACINGS = np.linspace(0.02, 0.15, 14).round(3)
FORCES = np.geomspace(0.015, 6.25, 18)


def changed(table, where, **values):
    """A copy with other values in the rows that a query finds."""
    table = table.copy()
    rows = table.query(where).index
    assert len(rows)
    for name, value in values.items():
        table.loc[rows, name] = value
    return table


def unstable(table, where):
    return changed(table, where, c_nl=np.nan, c_m=np.nan, status="unstable")


def finish(rows, **columns):
    """A table of one setup whose last run is unstable."""
    table = pd.DataFrame(rows).assign(
        n=4, setup="described", status="ok", c_nl_se=0.02, c_m_se=0.04
    )
    table = table.assign(**columns)
    table.loc[len(table) - 1, ["c_nl", "c_m", "status"]] = [np.nan, np.nan, "unstable"]
    return table


def ridge_tables(spacings=SPACINGS, forces=FORCES, **columns):
    rows = []
    for spacing, force in itertools.product(spacings, forces):
        b = force / critical_force(spacing, 2e-3, 1e8)
        c_nl, c_m = (0.8 + 0.1 * np.log10(b), 0.3 + 0.03 * np.log10(b)) if b < 1.2 else (0.4, 0.15)
        rows.append(
            {"spacing_m": spacing, "force_N": force, "buckling_number": b, "c_nl": c_nl, "c_m": c_m}
        )
    table = finish(rows, **columns)
    return {"ridge": table, "ridge_onset": onsets(table), "ridge_baselines": BASELINES}


def size_tables(sizes=(2, 4, 6), **columns):
    rows = [
        {"force_choice": choice, "spacing_m": spacing, "n": n, "c_nl": 0.4 + 0.05 * n, "c_m": 0.2}
        for choice, spacing, n in itertools.product(("best_c_nl", "best_c_m"), SPACINGS, sizes)
    ]
    table = finish(rows, time_step_s=5e-6, **columns).assign(n=[row["n"] for row in rows])
    return {"size": table, "ridge_baselines": BASELINES}


def published_size():
    """N = 2 at two steps, of which the longer was unstable once."""
    longer = size_tables((2,), setup="published")["size"]
    shorter = longer.assign(time_step_s=2.5e-6, status="ok").fillna({"c_nl": 0.5, "c_m": 0.123})
    return {"size": pd.concat([longer, shorter], ignore_index=True), "ridge_baselines": BASELINES}


def pretension_tables(tensions=(0.01, 0.1, 0.5, 1.0, 2.0, 5.0)):
    rows = [
        {"spacing_m": spacing, "tension_N": tension, "c_nl": 0.7 - 0.05 * tension, "c_m": 0.2}
        for spacing, tension in itertools.product(SPACINGS[3:9], tensions)
    ]
    return {"pretension": finish(rows), "ridge_baselines": BASELINES}
