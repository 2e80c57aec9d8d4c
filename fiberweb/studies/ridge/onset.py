"""Where the capacities of the force-spacing ridge drop (Fig. 2b), and where they are best."""

from __future__ import annotations

import numpy as np
import pandas as pd

BEST = tuple(f"best_{name}{part}" for name in ("c_nl", "c_m") for part in ("", "_force_N", "_B"))
COLUMNS = (
    "setup", "spacing_m", "points", "onset_B", "below_B", "above_B", "below_force_N", "fall", *BEST
)  # fmt: skip


def onsets(ridge: pd.DataFrame) -> pd.DataFrame:
    """The onset of the drop of C_nl at each spacing, by the rule of `claims.yaml`: the geometric
    mean of the two neighbouring B (Eq. 4) between which C_nl falls most.

    Args:
        ridge: the ridge's table of one setup. Unstable runs are skipped, so that their stable
            neighbours become neighbours of each other.

    Returns:
        A frame of `COLUMNS`, one row a spacing. ``points`` is the number of stable runs;
        ``below_B`` and ``above_B`` are the two neighbours, ``below_force_N`` the force (N) of the
        first, ``fall`` by how much C_nl falls between them; ``best_c_nl`` and ``best_c_m`` are the
        greatest capacities over all forces, with the force (N) and B they are reached at. Without
        a fall its columns are NaN; without a stable run those of the best are too.
    """
    records = [
        {"setup": frame["setup"].iloc[0], "spacing_m": spacing} | _one(frame)
        for spacing, frame in ridge.groupby("spacing_m")
    ]
    return pd.DataFrame(records, columns=list(COLUMNS))


def _one(frame: pd.DataFrame) -> dict[str, float]:
    """The columns of one spacing but the first two."""
    stable = frame[frame["status"] == "ok"].sort_values("buckling_number")
    columns = {"points": len(stable)} | _drop(stable)
    for name in ("c_nl", "c_m"):
        if len(stable):
            best = stable.loc[stable[name].idxmax()]
            columns[f"best_{name}"] = best[name]
            columns[f"best_{name}_force_N"] = best["force_N"]
            columns[f"best_{name}_B"] = best["buckling_number"]
    return columns


def _drop(stable: pd.DataFrame) -> dict[str, float]:
    """The fall of C_nl in rows by rising B; empty if it never falls."""
    falls = -np.diff(stable["c_nl"])
    if not len(falls) or falls.max() <= 0:
        return {}
    at = int(falls.argmax())
    below, above = stable.iloc[at], stable.iloc[at + 1]
    return {
        "onset_B": float(np.sqrt(below["buckling_number"] * above["buckling_number"])),
        "below_B": below["buckling_number"],
        "above_B": above["buckling_number"],
        "below_force_N": below["force_N"],
        "fall": falls[at],
    }
