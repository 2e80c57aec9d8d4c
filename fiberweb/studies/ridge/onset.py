"""Where the capacities of the force-spacing ridge drop (Fig. 2b), and where they are best."""

from __future__ import annotations

import numpy as np
import pandas as pd

from fiberweb.meanings import explained
from fiberweb.scoring.tables import SCENE

COLUMNS = {
    "setup": SCENE["setup"],
    "spacing_m": SCENE["spacing_m"],
    "points": "stable runs of this spacing",
    "onset_B": "B at which C_nl drops: geometric mean of below_B and above_B",
    "below_B": "B before the largest fall of C_nl from one run to the next",
    "above_B": "B after it",
    "below_force_N": ("force at below_B", "N"),
    "fall": "by how much C_nl falls there",
}
for _name, _words in {"c_nl": "C_nl", "c_m": "C_m"}.items():
    COLUMNS |= {
        f"best_{_name}": f"greatest {_words} over all forces",
        f"best_{_name}_force_N": (f"force at which {_words} is greatest", "N"),
        f"best_{_name}_B": f"B at which {_words} is greatest",
    }


@explained(COLUMNS)
def onsets(ridge: pd.DataFrame) -> pd.DataFrame:
    """One row for each spacing: where C_nl drops, and where capacities are best.

    The onset of the drop, by the rule of `claims.yaml`, is the geometric mean of the two
    neighbouring B (Eq. 4) between which C_nl falls most.

    Args:
        ridge: the ridge's table of one setup. Unstable runs are skipped, so that their stable
            neighbours become neighbours of each other.

    Returns:
        A frame of `COLUMNS`. Without a fall its columns are NaN; without a stable run those of the
        best are too.
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
