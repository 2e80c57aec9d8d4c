"""The paper's claims against our tables: what holds, what differs, and by what rule.

`claims.yaml` lists the claims. Each has one function in its study's `claims.py`, marked with its
id, whose docstring is the rule it is judged by, so that the rule can be read before the number. Two
capacities are alike when they differ by no more than `ALLOWANCE`. A rise from one network to the
next may be missed by that much; a rise over the whole range must exceed it.

A function gets `Evidence` (the tables of one setup) and returns an `Answer`, or raises
`NotComputed` when the runs it needs are missing or unstable.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import pandas as pd

from fiberweb.claims.listed import load
from fiberweb.meanings import explained
from fiberweb.model.scene import SETUPS

# in a capacity; our own choice: the paper gives no errors
ALLOWANCE = 0.03
# of a capacity: losing a quarter is a "substantial" decay or a "sharp" drop; our own choice. Of the
# authors' own table C_m falls by .53 at their "substantially" and by .10 at their "plateau".
SUBSTANTIAL = 0.25
CROSSHATCHES = (2, 4, 6, 8, 10, 12)

HOLDS, DIFFERS, CALIBRATED = "holds", "differs", "calibrated"
NOT_APPLICABLE, NOT_COMPUTED = "not applicable", "not computed"
STATED = {
    "id": "of the claim",
    "figure": "of the paper, by our name",
    "kind": "what is compared: a value, a range or an order",
    "statement": "what the paper says",
    "paper": "its number, if it gives one",
}
VALUE = "our number or numbers, or why there are none"
VERDICT = f"{HOLDS}, {DIFFERS}, {CALIBRATED} (it was fitted to), {NOT_APPLICABLE} or {NOT_COMPUTED}"
COLUMNS = STATED | {"value": VALUE, "verdict": VERDICT}
JOINED = {
    name: f"{what}; in this setup"
    for setup in SETUPS
    for name, what in {setup: VALUE, f"{setup}_verdict": VERDICT}.items()
}
FITTED = {("compliant", claim) for claim in ("T1", "T2", "T3", "T4")}
ROUND_OFF = 1e-9  # in a capacity; a limit itself is inside
# Setups in which claims can be judged, by the first letter of their id, where not in all. G: the
# authors' tables were made by their code. E, N: the experiment's twin is one scene, scored by the
# authors (published) or cleanly (described).
APPLICABLE = {
    "G": ("published",), "E": ("described", "published"), "N": ("described", "published")
}  # fmt: skip


class NotComputed(Exception):
    """The tables do not hold what a claim needs; the message, if any, is printed in the cell."""


@dataclass(frozen=True)
class Answer:
    """Our number or numbers as short text, and whether the claim holds for them."""

    text: str
    holds: bool

    def with_remarks(self, remarks: Iterable[str]) -> Answer:
        """The same, with what does not count in brackets behind the text."""
        beside = "; ".join(remarks)
        return Answer(f"{self.text} ({beside})", self.holds) if beside else self


@dataclass(frozen=True)
class Evidence:
    """What one claim is judged by in one setup."""

    claim: dict
    setup: str
    tables: dict[str, pd.DataFrame]
    published_tables: Path | None

    def table(self, name: str) -> pd.DataFrame:
        """Rows of this setup in a table; NotComputed when there are none."""
        frame = self.tables.get(name)
        if frame is None:
            raise NotComputed
        frame = frame[frame["setup"] == self.setup]
        if frame.empty:
            raise NotComputed
        return frame

    def authors_table(self, name: str, columns: Iterable[str]) -> pd.DataFrame:
        """A table of the authors'; NotComputed without them, ValueError if it or one of the columns
        is not there."""
        if self.published_tables is None:
            raise NotComputed
        path = self.published_tables / name
        if not path.is_file():
            raise ValueError(
                f"{path} does not exist; put the authors' table there or give no folder"
            )
        frame = pd.read_csv(path)
        missing = [column for column in columns if column not in frame.columns]
        if missing:
            known = ", ".join(frame.columns)
            raise ValueError(f"{path} has no column {missing[0]!r}; it has {known}")
        return frame

    def totals(self, topology: str, sizes: Iterable[int], column: str) -> list[float]:
        """``c_nl`` or ``c_m`` of each size N in the topology study, dimensionless."""
        frame = self.table("topology")
        frame = frame[frame["topology"] == topology].set_index("n")
        return [self._single(frame, topology, n, column) for n in sizes]

    def curve(self, topology: str, n: int, target: str) -> pd.Series:
        """c of one network over Legendre order, or over lag in s; dimensionless."""
        frame = self.table("topology_curves")
        frame = frame[(frame["topology"] == topology) & (frame["n"] == n)]
        curve = frame[frame["target"] == target].set_index("at")["c"].sort_index()
        if curve.empty:
            raise NotComputed
        if curve.index.has_duplicates:
            raise ValueError(self._twice(topology, n))
        if curve.isna().any():
            raise NotComputed(f"{network(topology, n)} unstable")
        return curve

    def at(self, topology: str, n: int, target: str, place: float) -> float:
        """c of one network at one Legendre order or lag (s)."""
        curve = self.curve(topology, n, target)
        near = [value for at, value in curve.items() if math.isclose(at, place, abs_tol=1e-6)]
        if not near:
            raise NotComputed
        return float(near[0])

    def _single(self, frame: pd.DataFrame, topology: str, n: int, column: str) -> float:
        values = frame.loc[frame.index == n, column]
        if values.empty:
            raise NotComputed
        if len(values) > 1:
            raise ValueError(self._twice(topology, n))
        if values.isna().any():
            raise NotComputed(f"{network(topology, n)} unstable")
        return float(values.iloc[0])

    def _twice(self, topology: str, n: int) -> str:
        return (
            f"the {self.setup} setup has several runs of the {network(topology, n)}; a claim "
            "needs exactly one, so leave the others out of the table"
        )


def check(*ids: str) -> Callable:
    """Mark a function as the rule of these claims."""

    def mark(function: Callable[[Evidence], Answer]) -> Callable[[Evidence], Answer]:
        function.claims = ids
        return function

    return mark


def rules(modules: Iterable[str]) -> dict[str, Callable[[Evidence], Answer]]:
    """The rule of each claim that has one, of modules such as "fiberweb.studies.ridge.claims"."""
    functions = [f for name in modules for f in vars(import_module(name)).values()]
    return {claim: f for f in functions for claim in getattr(f, "claims", ())}


@explained(COLUMNS)
def evaluate(
    tables: dict[str, pd.DataFrame],
    setup: str,
    modules: Iterable[str],
    published_tables: str | Path | None = None,
) -> pd.DataFrame:
    """One row for each claim of the paper, judged in one setup.

    Args:
        tables: tables of the setup by name without suffix. Claims whose table is not there are
            "not computed".
        setup: one of `fiberweb.model.scene.SETUPS`.
        modules: that hold the rules, see `rules`.
        published_tables: folder with the authors' own tables, which the G claims read.

    Returns:
        A frame with the columns `COLUMNS`, one row for every entry of `claims.yaml`.

    Raises:
        ValueError: a file of the authors' is missing from the folder, or a table holds two
            runs where a claim needs one.
    """
    by_claim = rules(modules)
    folder = None if published_tables is None else Path(published_tables)
    records = []
    for claim in load():
        record = {key: claim[key] for key in ("id", "figure", "kind", "statement")}
        rule = by_claim.get(claim["id"])
        value, verdict = _judge(rule, Evidence(claim, setup, tables, folder))
        paper = _papers_word(claim)
        records.append(record | {"paper": paper, "value": value, "verdict": verdict})
    return pd.DataFrame(records, columns=list(COLUMNS))


@explained(STATED, JOINED)
def join(by_setup: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """One row for each claim, with value and verdict in each setup, in columns named after it."""
    shared = list(STATED)
    columns = next(iter(by_setup.values()))[shared]
    for setup, frame in by_setup.items():
        names = {"value": setup, "verdict": f"{setup}_verdict"}
        columns = columns.join(frame[[*names]].rename(columns=names))
    return columns


def _judge(rule: Callable | None, evidence: Evidence) -> tuple[str, str]:
    """(cell text, verdict) of one claim in one setup."""
    name = evidence.claim["id"]
    if evidence.setup not in APPLICABLE.get(name[0], (evidence.setup,)):
        return "", NOT_APPLICABLE
    if rule is None:
        return "", NOT_COMPUTED
    try:
        answer = rule(evidence)
    except NotComputed as reason:
        return str(reason), NOT_COMPUTED
    if (evidence.setup, name) in FITTED:
        return answer.text, CALIBRATED
    return answer.text, HOLDS if answer.holds else DIFFERS


def rises(c: list[float]) -> bool:
    """No step falls by more than the allowance, and the whole exceeds it."""
    steps = all(after >= before - ALLOWANCE for before, after in pairwise(c))
    return steps and c[-1] > c[0] + ALLOWANCE


def within_tolerance(claim: dict, value: float) -> bool:
    return abs(value - claim["paper"]) <= claim["tolerance"] + ROUND_OFF


def inside_range(claim: dict, value: float) -> bool:
    """Whether the value lies in the claim's range, give or take round-off."""
    low, high = claim["range"]
    return low - ROUND_OFF <= value <= high + ROUND_OFF


def _papers_word(claim: dict) -> str:
    """The paper's number as text; an order claim has its statement instead."""
    if claim["kind"] == "range":
        return "{:g} to {:g}".format(*claim["range"])
    paper = claim.get("paper", "")
    return ", ".join(map(str, paper)) if isinstance(paper, list) else str(paper)


def numbers(values: Iterable[float]) -> str:
    """Two decimals each, for the text of an answer."""
    return " ".join(f"{value:.2f}" for value in values)


def network(topology: str, n: int) -> str:
    return f"{n}x{n} crosshatch" if topology == "crosshatch" else f"{n}-sided polygon"
