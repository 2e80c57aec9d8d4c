"""Tables of the topology study that agree with every claim, but for what is changed."""

import numpy as np
import pandas as pd

NONLINEAR = {2: 0.50, 4: 0.70, 6: 0.80, 8: 0.90, 10: 0.88, 12: 0.91}
MEMORY = {2: 0.15, 4: 0.30, 6: 0.42, 8: 0.55, 10: 0.52, 12: 0.25}
HIGHEST = {2: 1, 4: 2, 6: 3, 8: 5, 10: 5, 12: 6}  # order with c > 0.99
HORIZON = {2: 0.12, 4: 0.28, 6: 0.36, 8: 0.52, 10: 0.48, 12: 0.24}  # s
POLYGON_NONLINEAR = {6: 0.48, 8: 0.44, 10: 0.43, 12: 0.42}
POLYGON_MEMORY = {6: 0.14, 8: 0.12, 10: 0.13, 12: 0.11}
EIGHT = {("order", 4.0): 0.998, ("order", 7.0): 0.90, ("lag", 0.2): 0.996, ("lag", 0.4): 0.70}


def topology_table(setup="published", **changed):
    """Totals that agree with every claim, but for what is changed."""
    frames = []
    for topology, names in (
        ("crosshatch", {"c_nl": NONLINEAR, "c_m": MEMORY}),
        ("polygon", {"c_nl": POLYGON_NONLINEAR, "c_m": POLYGON_MEMORY}),
    ):
        prefix = "" if topology == "crosshatch" else "polygon_"
        columns = {name: values | changed.get(prefix + name, {}) for name, values in names.items()}
        frames.append(pd.DataFrame(columns).rename_axis("n").reset_index())
        frames[-1].insert(0, "topology", topology)
    table = pd.concat(frames, ignore_index=True).assign(setup=setup, status="ok")
    table["spacing_m"] = 0.5 / (table["n"] + 1)
    table["force_N"] = 50e-6 / table["spacing_m"] ** 3
    return table


def curve_table(setup="published", highest=None, horizon=None, eight=None):
    """c over order, c > 0.99 up to the highest order; c over lag, above 0.5 up to the horizon."""
    highest, horizon, eight = HIGHEST | (highest or {}), HORIZON | (horizon or {}), eight or EIGHT
    records = []
    for n in HIGHEST:
        for order in np.arange(1.0, 11.0):
            c = 0.995 if order <= highest[n] else 0.8
            records.append((n, "order", order, eight.get(("order", order), c) if n == 8 else c))
        for lag in np.arange(251) / 250:
            c = 0.9 if lag <= horizon[n] + 1e-9 else 0.1
            records.append((n, "lag", lag, eight.get(("lag", lag), c) if n == 8 else c))
    table = pd.DataFrame(records, columns=["n", "target", "at", "c"])
    return table.assign(setup=setup, topology="crosshatch")
