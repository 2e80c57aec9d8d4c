"""Total information-processing capacity of the paper's networks, by degree and delay.

It is the score card's, by the same regression, surrogates and bootstrap, on functions that suit the
paper's input (Dambre et al. 2012 prove their bound for inputs that are independent from step to
step, and this one is not):

- **Delays** are whole intervals between the knots of the spline. There the input has one new
  number each. Closer, a delayed input is nearly told by its neighbours, and the little that is left
  would count as much as a knot: any smooth signal would seem to remember.
- **Sampling**: all frames, as for C_nl and C_m. At the knots alone there were fewer rows than
  readouts of a 12x12, and knowing the slope there is knowing the knots on either side.
- **Degrees** go to that of C_nl, for these networks are nonlinear far beyond the card's degree 3.
  Degree d goes back by degree / d - 1 intervals, at most the horizon: a sum over all products would
  have more functions than the input has values. Orthogonalising mixes each function with those
  before it by chance, and so loses up to one part in `VALUES_EACH` of its capacity.
- **Threshold**: that of the card, the largest capacity of any function in 99 surrogates, whose
  blocks are as long as the horizon and so keep the smoothness.

What lies between the delays, and higher degrees of delayed input, is not counted: the total is a
lower bound. A delay line with one tap each interval has a capacity of exactly its taps.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from math import comb
from pathlib import Path

import numpy as np
import pandas as pd

from fiberweb.meanings import explained
from fiberweb.model.scene import Scene
from fiberweb.scoring import capacity, processing, rank, recording, tables
from fiberweb.scoring.blocks import capacity_of, interval, redrawn
from fiberweb.scoring.limits import HORIZON, SPLIT, training_end
from fiberweb.scoring.regression import Options, checked, recall_targets, scale_input
from fiberweb.simulation import dataset

VALUES_EACH = 5  # knots of the training part for each function
TOTALS = {
    "ipc": "total information-processing capacity, of all degrees and delays",
    "ipc_low": "lower end of its 95 % interval",
    "ipc_high": "upper end of its 95 % interval",
    "ipc_threshold": "capacity of one function above which it counts",
}
RANKS = rank.RANKS
SPLIT_COLUMNS = {
    "degree": "of the functions of the input",
    "delay_s": ("the longest delay in them", "s"),
    "capacity": "that counts at this degree and delay",
}
DELAY_LINE = "delay line"
READOUT = {"readout": f"{tables.READOUT['readout']}; delay line: one tap each knot"}


@explained(tables.COLUMNS, tables.CHOICE, TOTALS, RANKS, SPLIT_COLUMNS)
def table(
    capacity_paths: Sequence[str | Path],
    response_paths: Sequence[str | Path],
    choices: Sequence[str],
    alpha: float,
    degree: int,
) -> pd.DataFrame:
    """One row for each run, degree and longest delay.

    Args:
        capacity_paths, choices: as for `fiberweb.scoring.tables.study`.
        response_paths: of the same runs.
        alpha: ridge penalty.
        degree: the highest.

    Returns:
        The columns of `fiberweb.scoring.tables.rows`, force_choice, and those of `spectrum`. An
        unstable run has one row, without numbers.
    """
    frames = []
    for scored, response_path, choice in zip(capacity_paths, response_paths, choices, strict=True):
        run = tables.rows([scored], force_choice=choice)
        response = dataset.load(response_path)
        if response.attrs["status"] != "ok":
            frames.append(run.assign(**dict.fromkeys((*TOTALS, *RANKS, *SPLIT_COLUMNS), math.nan)))
            continue
        found = spectrum(*_arrays(response), recording.signals(response), alpha, degree)
        frames.append(run.merge(found, how="cross"))
    return pd.concat(frames, ignore_index=True)


@explained(READOUT, TOTALS, RANKS, SPLIT_COLUMNS)
def baselines(response_path: str | Path, alpha: float, degree: int) -> pd.DataFrame:
    """One row for each readout that sees no network, degree and longest delay.

    Args:
        response_path: of a run; only its input is used, which every run of the study has.
        alpha, degree: as for `table`.

    Returns:
        readout, being "u", "derivatives", "powers" or "delay line" (one tap each interval between
        knots, up to the horizon), and the columns of `spectrum`.
    """
    u, rate, step = _arrays(dataset.load(response_path))
    taps = np.nan_to_num(recall_targets(u, range(0, round(HORIZON * rate) + 1, step)))
    readouts = capacity.trivial_readouts(u, rate) | {DELAY_LINE: taps}
    frames = [
        spectrum(u, rate, step, signals, alpha, degree).assign(readout=name)
        for name, signals in readouts.items()
    ]
    return pd.concat(frames, ignore_index=True)[["readout", *TOTALS, *RANKS, *SPLIT_COLUMNS]]


def spectrum(
    u: np.ndarray, rate: float, step: int, signals: np.ndarray, alpha: float, degree: int
) -> pd.DataFrame:
    """Capacity by degree and delay; see the module.

    Args:
        u: (T,) input, any unit.
        rate: Hz.
        step: frames between knots.
        signals: (T, p) readouts, any unit.
        alpha: ridge penalty.
        degree: the highest; less if the run is too short for it.

    Returns:
        One row for each ``degree`` and longest delay ``delay_s`` (s), with the ``capacity`` that
        counts; and in every row the total ``ipc``, the ends ``ipc_low`` and ``ipc_high`` of its
        95 % interval, NaN of a test part of one block, its ``ipc_threshold``, and the ranks of
        `fiberweb.scoring.rank.ranks`.

    Raises:
        ValueError: as `fiberweb.scoring.capacity.score_arrays`, or if no signal moves.
    """
    u, signals = checked(u, signals, rate, Options(alpha=alpha))
    horizon = round(HORIZON * rate)
    fitted = slice(horizon, training_end(horizon, len(u), SPLIT))
    u, signals = scale_input(u), signals[:, rank.different(signals[fitted])]
    values = (fitted.stop - fitted.start) // step
    delays = affordable(degree, horizon // step, values // VALUES_EACH)
    functions = processing.products(u, fitted, step, delays)
    sums, threshold = processing.processing(signals, functions, fitted, alpha, horizon)
    c, again = capacity_of(sums.sum(axis=1)), redrawn(sums)
    counted = c > threshold
    draws = None if again is None else processing.total(capacity_of(again), counted)
    totals = (processing.total(c, counted), *interval(draws), threshold)
    split = processing.by_degree_and_delay(functions, np.where(counted, c, 0.0))
    rows = [(d, delay / rate, value) for (d, delay), value in split.items()]
    found = pd.DataFrame(rows, columns=list(SPLIT_COLUMNS))
    return found.assign(
        **dict(zip(TOTALS, totals, strict=True)), **rank.ranks(signals, u, fitted, step, step)
    )


def affordable(degree: int, longest: int, most: int) -> dict[int, int]:
    """Of each degree the longest delay, in intervals, at most `longest`: the rule of the module for
    this highest degree, or for the next lower one that has no more than `most` functions."""
    for highest in range(degree, 0, -1):
        delays = {d: min(longest, highest // d - 1) for d in range(1, highest + 1)}
        if sum(comb(delay + d, d) for d, delay in delays.items()) <= most:
            break
    return delays


def _arrays(response) -> tuple[np.ndarray, float, int]:
    """Input (T,), its rate (Hz), and the frames between its knots."""
    rate = recording.sample_rate(response)
    drive_rate = Scene.from_json(response.attrs["scene"]).drive_rate
    return response["input"].values, rate, max(1, round(rate / drive_rate))
