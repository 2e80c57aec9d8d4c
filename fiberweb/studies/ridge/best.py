"""The best force of each spacing below buckling, from which the next studies start."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from fiberweb.meanings import explained
from fiberweb.scoring.tables import SCENE
from fiberweb.tables import ordered, read

COLUMNS = {
    "setup": SCENE["setup"],
    "spacing_m": SCENE["spacing_m"],
    "choice": "best_c_nl or best_c_m",
    "force_N": ("below B = 1, with the largest such capacity", "N"),
    "buckling_number": SCENE["buckling_number"],
    "capacity": "which that is: C_nl or C_m of the test part",
}


@explained(COLUMNS)
def best_unbuckled(ridge: pd.DataFrame) -> pd.DataFrame:
    """One row for each spacing and choice: the force below B = 1 with the best C_nl or C_m.

    Args:
        ridge: the ridge's table of one setup.

    Returns:
        A frame of `COLUMNS`, choice being "best_c_nl" or "best_c_m", force in N; no row where no
        run below B = 1 was stable.
    """
    stable = ridge[(ridge["status"] == "ok") & (ridge["buckling_number"] < 1.0)]
    records = []
    for spacing, frame in stable.groupby("spacing_m"):
        for column in ("c_nl", "c_m"):
            row = frame.loc[frame[column].idxmax()]
            values = (row["force_N"], row["buckling_number"], row[column])
            records.append((row["setup"], spacing, f"best_{column}", *values))
    return ordered(pd.DataFrame(records, columns=list(COLUMNS)))


def read_best(path: str | Path) -> dict[tuple[str, float], float]:
    """The written table of `best_unbuckled`: (choice, spacing in m) to force in N."""
    frame = read(path)
    return dict(zip(zip(frame["choice"], frame["spacing_m"]), frame["force_N"]))
