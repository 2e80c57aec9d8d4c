"""The table of the study."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from fiberweb.meanings import explained
from fiberweb.scoring import tables


@explained(
    tables.COLUMNS, {"name": "of the network in the config"}, tables.OF_PHYSICS, tables.OF_NUMERICS
)
def by_name(capacity_paths: Sequence[str | Path], choices: Sequence[str]) -> pd.DataFrame:
    """One row for each network of one's own.

    Args:
        capacity_paths: of the runs.
        choices: of each path, the name of the network.
    """
    frames = [
        tables.rows([path], name=name, **tables.PHYSICS, **tables.NUMERICS)
        for path, name in zip(capacity_paths, choices, strict=True)
    ]
    return pd.concat(frames, ignore_index=True)
