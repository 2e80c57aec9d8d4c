"""Capacities of one response over the ridge penalty."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from fiberweb.meanings import explained
from fiberweb.scoring import capacity, tables
from fiberweb.simulation import dataset


@explained(tables.COLUMNS, tables.CHOICE, {"alpha": capacity.ATTRIBUTES["alpha"]})
def alphas(
    response_paths: Sequence[str | Path], choices: Sequence[str], alpha: Sequence[float]
) -> pd.DataFrame:
    """One row for each run and ridge penalty.

    Args:
        response_paths: files with the attr ``run``.
        choices: of each path, see `fiberweb.studies.base.Point`.
        alpha: ridge penalties, of alpha |w|^2 against the sum of squares of the training part.

    Returns:
        A frame of `tables.COLUMNS`, force_choice and alpha.

    Raises:
        ValueError: a penalty that is not positive, or lost in the round-off of the readouts.
    """
    frames = []
    for path, choice in zip(response_paths, choices, strict=True):
        response = dataset.load(path)
        frames.append(
            tables.rows(
                (capacity.score(response, alpha=each) for each in alpha),
                force_choice=choice,
                alpha=lambda _, scored: scored.attrs["alpha"],
            )
        )
    return pd.concat(frames, ignore_index=True)
