"""The runs of the study, all scored as the authors score, so that they can stand beside theirs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import pandas as pd

from fiberweb.meanings import explained
from fiberweb.scoring import capacity, tables
from fiberweb.simulation import dataset


@explained(
    tables.COLUMNS,
    tables.CHOICE,
    {
        "layout": "of crossings and readouts: exact, or on the authors' mesh",
        "filter_order": tables.OF_PHYSICS["filter_order"],
        "dead_band": "1 where rotations are rounded as the authors' code does",
    },
    tables.OF_NUMERICS,
)
def table(
    response_paths: Iterable[str | Path], choices: Sequence[str], alpha: float
) -> pd.DataFrame:
    """One row for each run, scored as the authors score.

    Args:
        response_paths: of published scenes with filter and dead band on or off, and of the
            described ones.
        choices: of each, see `fiberweb.studies.base.Point`.
        alpha: ridge penalty.
    """
    frames = [
        tables.rows(
            [capacity.score(dataset.load(path), scoring="published", alpha=alpha)],
            force_choice=choice,
            layout=lambda scene, _: scene.layout,
            filter_order=lambda scene, _: int(scene.filter_order),
            dead_band=lambda scene, _: int(scene.dead_band),
            **tables.NUMERICS,
        )
        for path, choice in zip(response_paths, choices, strict=True)
    ]
    return pd.concat(frames, ignore_index=True)
