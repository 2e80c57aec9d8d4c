"""The score card of a body, recorded or simulated: what it computes, beside what its input alone
and a delay line compute through the same readout."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from pydantic import ValidationError

from fiberweb.arguments import check_names, plain
from fiberweb.errors import sentence
from fiberweb.meanings import check
from fiberweb.scoring import arguments, processing, rank, recording, tasks
from fiberweb.scoring.blocks import block_sums, capacity_of, interval, redrawn
from fiberweb.scoring.capacity import trivial_readouts
from fiberweb.scoring.card_options import CardOptions
from fiberweb.scoring.limits import check_frames, training_end
from fiberweb.scoring.penalty import best_penalty
from fiberweb.scoring.regression import (
    Options,
    checked,
    estimated,
    legendre_targets,
    recall_targets,
    scale_input,
)
from fiberweb.scoring.verdict import BODY, TAPS, notes, verdict

if TYPE_CHECKING:
    import xarray as xr

LEGENDRE = np.arange(1, 11)  # orders of C_nl, as in the paper
LONGEST = 50_000  # frames that are scored: more would tell no more
READOUTS = (
    f"{BODY}; or made of its input: u; derivatives (u and its first three); powers (to u^3); {TAPS}"
)
SCORES = {
    "readout": READOUTS,
    "quantity": "name of the number, one of those below",
    "value": "of the quantity; dimensionless",
    "low": "lower end of its 95 % interval; empty of counts",
    "high": "upper end of its 95 % interval; empty of counts",
}
PROFILE = {
    "readout": READOUTS,
    "degree": "of the functions of the input",
    "delay_s": ("the longest delay in them", "s"),
    "capacity": "that counts at this degree and delay",
}
QUANTITIES = rank.RANKS | {
    "c_nl": "nonlinear capacity, mean over the Legendre orders",
    "c_m": "memory capacity, mean over the lags",
    "ipc": "total information-processing capacity",
    **{f"ipc_{degree}": f"of it, that of degree {degree}" for degree in processing.DEGREES},
    "ipc_threshold": "capacity of one function above which it counts",
}
for _order in tasks.ORDERS:
    QUANTITIES |= {
        f"narma{_order}_rmse": f"NARMA-{_order}: root of the mean squared error",
        f"narma{_order}_nrmse": f"NARMA-{_order}: rmse over the standard deviation of the target",
        f"narma{_order}_nmse": f"NARMA-{_order}: square of nrmse",
    }
FACTS = {
    "run": "name of the recording or run",
    "frames": "that were scored",
    "rate_Hz": ("of these frames", "Hz"),
    "trained_s": ("length of the training part", "s"),
    "tested_s": ("length of the test part", "s"),
    "blocks": "that the test part holds whole; intervals are redrawn from these and the rest",
    "horizon_s": ("longest delay, and length of a block", "s"),
    "taps": "of the delay line",
    "taps_s": ("length of the delay line", "s"),
    "delay_step_s": ("between the delays of the functions of ipc", "s"),
    "functions": "of ipc, how many",
    "amplitude": "of the NARMA tasks' input, from 0",
    "alpha": "ridge penalty, or cv",
    "recipe": "of others, instead of the defaults; null: none",
    "bar": "NMSE below which a NARMA task counts as passed; null: none",
    "cut_frames": "that came before and were too many to be scored",
    "refused": "tasks that were left out, a sentence each",
}
CARD = {
    "status": "ok or refused",
    "verdict": "what the body computes that its input does not, or why it was refused",
    "notes": "what has to be known beside it, a sentence each",
    "facts": "numbers that belong to all of the card, by name",
    "scores": "the rows of card.csv",
    "profile": "capacity by readout, degree and longest delay, a row each",
}


@dataclass(frozen=True)
class Card:
    """What a body computes.

    Attributes:
        status: 'ok', or 'refused' of a recording that has no card: then the verdict says why, and
            the rest is empty.
        verdict: one sentence.
        notes: what has to be known beside it, a sentence each.
        facts: numbers that belong to all of the card, by name.
        scores: a row for each readout and quantity: value, and the ends low and high of the
            interval that holds 95 % of what redrawn blocks of the test part give; NaN of counts.
        profile: a row for each readout, degree and longest delay (s): the capacity that counts.
    """

    verdict: str
    notes: list[str]
    facts: dict
    scores: pd.DataFrame
    profile: pd.DataFrame
    status: str = "ok"

    def as_dict(self) -> dict:
        """All of it in what JSON has; no number is null."""
        tables = {name: getattr(self, name) for name in ("scores", "profile")}
        rows = {
            name: table.astype(object).where(table.notna(), None).to_dict("records")
            for name, table in tables.items()
        }
        return {"status": self.status, "verdict": self.verdict, "notes": self.notes,
                "facts": plain(self.facts)} | plain(rows)  # fmt: skip

    def __str__(self) -> str:
        table = self.scores.pivot(index="quantity", columns="readout", values="value")
        table = table.reindex(index=self.scores["quantity"].unique())
        table = table[self.scores["readout"].unique()]
        return "\n".join([self.verdict, *self.notes, table.to_string(float_format="%.3g")])


def card(response: xr.Dataset, **options) -> Card:
    """The score card of a recording, a twin or a simulation.

    Everything is estimated by the clean ridge readout: scale, penalty and weights of the training
    rows alone. Rows begin after the washout and one horizon; targets know the input before that.

    Args:
        response: as for `fiberweb.scoring.capacity.score`.
        **options: of `CardOptions`, such as rate (Hz), alpha, taps, recipe.

    Raises:
        ValueError: what `score` refuses, an unstable run, or an option; one sentence. A task that
            diverges is left out, and a note says so.
    """
    check_names(options, CardOptions.model_fields)
    try:
        chosen = CardOptions(**plain(options)).settled()
    except ValidationError as error:
        raise ValueError(sentence(error)) from None
    arguments.check(response, "clean", {})
    if response.attrs["status"] != "ok":
        raise ValueError("an unstable run has no score card; give one that stays finite")
    u, x, rate, cut = _arrays(response, chosen.rate)
    u, x = checked(u, x, rate, Options(split=chosen.split, horizon=chosen.horizon))
    horizon = round(chosen.horizon * rate)
    start = max(int(chosen.washout * len(u)), horizon)
    check_frames(len(u) - start + horizon, rate, chosen.horizon, chosen.split)
    if chosen.taps and chosen.taps > start + 1:
        start = chosen.taps - 1
        try:
            check_frames(len(u) - start + horizon, rate, chosen.horizon, chosen.split)
        except ValueError:
            raise ValueError(
                f"taps = {chosen.taps} leave {max(0, len(u) - start)} of {len(u)} frames with all "
                "of them in the recording, too few to train and test on; give fewer"
            ) from None
    fitted = slice(start, training_end(start, len(u), chosen.split))
    for part, where in {"training": fitted, "test": slice(fitted.stop, None)}.items():
        if not np.ptp(u[where]):
            raise ValueError(f"the input does not change in the {part} part; cut the recording")
    x, scaled = x[:, rank.different(x[fitted])], scale_input(u)
    targets, refused = _targets(scaled, horizon, chosen)
    taps = chosen.taps or _remembered(scaled, x, fitted, chosen, horizon)
    functions = processing.basis(scaled, fitted, horizon)
    step = processing.apart(scaled[fitted], horizon)
    judge = _Judge(fitted, horizon, chosen.alpha)
    quantities, rows, profile = {}, [], []
    # the input 0 .. taps - 1 frames ago, 0 before the start
    delay_line = np.nan_to_num(recall_targets(u, range(taps)))
    readouts = {BODY: x} | trivial_readouts(u, rate) | {TAPS: delay_line}
    for name, signals in readouts.items():
        found = {}
        for target, values in targets.items():
            found |= _quantities(target, judge.sums(signals, values))
        totals, threshold, at_delay = judge.processing(signals, functions)
        quantities[name] = found | totals
        counts = rank.ranks(signals, scaled, fitted, max(taps - 1, step), step)
        counts["ipc_threshold"] = threshold
        rows += [(name, quantity, value, np.nan, np.nan) for quantity, value in counts.items()]
        rows += [
            (name, quantity, float(value), *interval(draws))
            for quantity, (value, draws) in quantities[name].items()
        ]
        profile += [(name, degree, delay / rate, c) for (degree, delay), c in at_delay.items()]
    tested = len(u) - fitted.stop
    facts = {
        "run": response.attrs.get("run", ""), "frames": len(u), "rate_Hz": rate,
        "trained_s": (fitted.stop - start) / rate, "tested_s": tested / rate,
        "blocks": tested // horizon, "horizon_s": chosen.horizon, "taps": int(taps),
        "taps_s": taps / rate, "delay_step_s": step / rate, "functions": len(functions.degree),
        "amplitude": chosen.amplitude, "alpha": chosen.alpha, "recipe": chosen.recipe,
        "bar": chosen.bar, "cut_frames": cut, "refused": refused,
    }  # fmt: skip
    scores = pd.DataFrame(rows, columns=list(SCORES))
    check(scores["quantity"], QUANTITIES, "the score card")
    check(facts, FACTS, "the score card")
    said = notes(scores, facts, response.attrs.get("sanity"))
    return Card(
        verdict(quantities, facts),
        said,
        facts,
        scores,
        pd.DataFrame(profile, columns=list(PROFILE)),
    )


def attempt(response: xr.Dataset, options: dict) -> Card:
    """`card`, or one that was refused, of a recording that was refused when it was read or that
    cannot be scored."""
    try:
        if response.attrs["status"] == "refused":
            raise ValueError(json.loads(response.attrs["sanity"])[0][-1])
        return card(response, **options)
    except ValueError as error:
        empty = pd.DataFrame(columns=list(SCORES)), pd.DataFrame(columns=list(PROFILE))
        return Card(str(error), [], {}, *empty, status="refused")


class _Judge:
    """Estimates targets from any readouts in the same way, and sums up the test part."""

    def __init__(self, fitted: slice, block: int, alpha: float | str):
        self._fitted, self._block, self._alpha = fitted, block, alpha

    def sums(self, readouts: np.ndarray, targets: np.ndarray) -> np.ndarray:
        """`block_sums` of the test part, (4, blocks, q)."""
        tested = slice(self._fitted.stop, None)
        alpha = self._penalty(readouts, targets)
        estimate = estimated(readouts, targets, self._fitted, alpha, tested)
        return block_sums(targets[tested], estimate, np.ones_like(estimate, bool), self._block)

    def processing(self, readouts: np.ndarray, functions: processing.Basis) -> tuple:
        """Totals as in `_quantities`, the threshold, and the capacity at each (degree, delay)."""
        alpha = self._penalty(readouts, functions.values)
        sums, threshold = processing.processing(
            readouts, functions, self._fitted, alpha, self._block
        )
        c, again = capacity_of(sums.sum(axis=1)), redrawn(sums)
        draws = None if again is None else capacity_of(again)
        counted = c > threshold
        groups = {"ipc": counted}
        groups |= {f"ipc_{d}": counted & (functions.degree == d) for d in processing.DEGREES}
        totals = {
            name: tuple(
                None if each is None else processing.total(each, group) for each in (c, draws)
            )
            for name, group in groups.items()
        }
        at_delay = processing.by_degree_and_delay(functions, np.where(counted, c, 0.0))
        return totals, threshold, at_delay

    def _penalty(self, readouts: np.ndarray, targets: np.ndarray) -> float:
        if self._alpha != "cv":
            return self._alpha
        return best_penalty(readouts[self._fitted], targets[self._fitted])


def _arrays(response, rate: float | None) -> tuple[np.ndarray, np.ndarray, float, int]:
    """Input, signals, rate, and how many frames were cut off before."""
    own = recording.sample_rate(response)
    step = 1 if rate is None else round(own / rate)
    if rate is not None and (step < 1 or abs(step * rate - own) > 1e-6 * own):
        raise ValueError(
            f"rate = {rate:g} Hz does not divide the recording's {own:g} Hz; choose one that does"
        )
    thinned = response.isel(time=slice(None, None, step))
    cut = max(0, thinned.sizes["time"] - LONGEST)
    scored = thinned.isel(time=slice(cut, None))
    return scored["input"].values, recording.signals(scored), own / step, cut


def _targets(scaled: np.ndarray, horizon: int, chosen: CardOptions) -> tuple[dict, list[str]]:
    """Targets (T, q) by name, and why others are left out."""
    targets = {
        "c_nl": legendre_targets(scaled, LEGENDRE),
        # in the rows that are scored, no lag reaches beyond the start
        "c_m": np.nan_to_num(recall_targets(scaled, np.arange(horizon + 1))),
    }
    refused = []
    for order in chosen.order:
        try:
            series = tasks.narma(chosen.amplitude * (1.0 + scaled) / 2.0, order)
            targets[f"narma{order}"] = series[: len(scaled), None]
        except ValueError as error:
            refused.append(str(error))
    return targets, refused


def _remembered(u, x, fitted: slice, chosen: CardOptions, horizon: int) -> int:
    """Frames of the input that the signals recall, lags added up: of the training rows alone, the
    last of which are held out."""
    inner = slice(fitted.start, training_end(fitted.start, fitted.stop, chosen.split))
    lagged = np.nan_to_num(recall_targets(u[: fitted.stop], range(horizon + 1)))
    sums = _Judge(inner, horizon, chosen.alpha).sums(x[: fitted.stop], lagged)
    c = np.maximum(capacity_of(sums.sum(axis=1)), 0.0)
    return min(max(1, round(c.sum())), horizon)


def _quantities(target: str, sums: np.ndarray) -> dict[str, tuple]:
    """(value, redrawn values or None) of what is said of a target, from sums (4, blocks, q)."""
    measures = {target: _mean}
    if target.startswith("narma"):
        measures = {f"{target}_{error}": of for error, of in _ERRORS.items()}
    whole, draws = sums.sum(axis=1), redrawn(sums)
    return {
        name: (of(whole), None if draws is None else of(draws)) for name, of in measures.items()
    }


def _mean(sums: np.ndarray) -> np.ndarray:
    return np.maximum(capacity_of(sums), 0.0).mean(axis=-1)


_ERRORS = {
    "rmse": lambda sums: np.sqrt(sums[3] / sums[0])[..., 0],
    "nrmse": lambda sums: np.sqrt(1.0 - capacity_of(sums))[..., 0],
    "nmse": lambda sums: (1.0 - capacity_of(sums))[..., 0],
}
