"""The paper's claims against our tables: what holds, what differs, and by what rule.

`claims.yaml` lists the claims. Each has one function here, registered under its id, whose
docstring is the rule it is judged by, so that the rule can be read before the number. Two
capacities are alike when they differ by no more than `ALLOWANCE`. A rise from one network to the
next may be missed by that much; a rise over the whole range must exceed it.

A function gets `Evidence` (the tables of one setup) and returns an `Answer`, or raises
`NotComputed` when the runs it needs are missing or unstable.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import import_module
from itertools import pairwise
from pathlib import Path

import pandas as pd
import yaml

ALLOWANCE = 0.03  # in a capacity
VERY_HIGH = 0.99  # the paper's own word for c > 0.99
RECALLED = 0.5  # an input is recalled at a lag where c is above this
SUBSTANTIAL = 0.25  # the least part of a capacity whose loss is a substantial decay
PAPERS_REACH, REACH_TOLERANCE = 0.5, 0.1  # s
CROSSHATCHES = (2, 4, 6, 8, 10, 12)
POLYGONS = (6, 8, 10, 12)

SETUPS = ("published", "described")
COLUMNS = (
    "id", "figure", "kind", "statement", "paper",
    "published", "published_verdict", "described", "described_verdict",
)  # fmt: skip

HOLDS, DIFFERS, CALIBRATED = "holds", "differs", "calibrated"
NOT_APPLICABLE, NOT_COMPUTED = "not applicable", "not computed"
FITTED = {("described", claim) for claim in ("T1", "T2", "T3", "T4")}
ROUND_OFF = 1e-9


class NotComputed(Exception):
    """The tables do not hold what a claim needs; the message, if any, is printed in the cell."""


@dataclass(frozen=True)
class Answer:
    """Our number or numbers as short text, and whether the claim holds for them."""

    text: str
    holds: bool


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
            raise NotComputed(f"{_network(topology, n)} unstable")
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
            raise NotComputed(f"{_network(topology, n)} unstable")
        return float(values.iloc[0])

    def _twice(self, topology: str, n: int) -> str:
        return (
            f"the {self.setup} setup has several runs of the {_network(topology, n)}; a claim "
            "needs exactly one, so leave the others out of the table"
        )


CHECKS: dict[str, Callable[[Evidence], Answer]] = {}
FURTHER = ("ridge", "sweeps", "features")  # fiberweb.claims_<name> holds more rules


def check(*ids: str) -> Callable:
    """Register a function as the rule of these claims."""

    def register(function: Callable[[Evidence], Answer]) -> Callable[[Evidence], Answer]:
        CHECKS.update(dict.fromkeys(ids, function))
        return function

    return register


def load() -> list[dict]:
    """The claims in the paper's order: dicts with id, figure, kind, statement and, by kind,
    paper and tolerance, or range."""
    text = Path(__file__).with_name("claims.yaml").read_text(encoding="utf-8")
    return yaml.safe_load(text)


def rules() -> dict[str, str]:
    """The rule of each claim that has one, from its function's docstring."""
    _register_all()
    return {name: inspect.getdoc(function) for name, function in CHECKS.items()}


def evaluate(
    tables: dict[str, pd.DataFrame], published_tables: str | Path | None = None
) -> pd.DataFrame:
    """Judge every claim in both setups.

    Args:
        tables: our tables by study: "topology" and "topology_curves" (`tables.study`,
            `tables.curves`) and those of later studies. Claims whose table is not there are
            "not computed".
        published_tables: folder with the authors' own tables, which the G claims read.

    Returns:
        A frame with the columns `COLUMNS`, one row for every entry of `claims.yaml`.

    Raises:
        ValueError: a file of the authors' is missing from the folder, or a table holds two
            runs where a claim needs one.
    """
    _register_all()
    folder = None if published_tables is None else Path(published_tables)
    records = []
    for claim in load():
        record = {key: claim[key] for key in ("id", "figure", "kind", "statement")}
        record["paper"] = _papers_word(claim)
        for setup in SETUPS:
            text, verdict = _judge(Evidence(claim, setup, tables, folder))
            record |= {setup: text, f"{setup}_verdict": verdict}
        records.append(record)
    return pd.DataFrame(records, columns=list(COLUMNS))


def _register_all() -> None:
    """Import the other modules with rules, at call time because they import this one."""
    for name in FURTHER:
        import_module(f"fiberweb.claims_{name}")


def _judge(evidence: Evidence) -> tuple[str, str]:
    """(cell text, verdict) of one claim in one setup."""
    name = evidence.claim["id"]
    if name.startswith("G") and evidence.setup == "described":
        return "", NOT_APPLICABLE  # the authors' tables were made by their code
    if name not in CHECKS:
        return "", NOT_COMPUTED
    try:
        answer = CHECKS[name](evidence)
    except NotComputed as reason:
        return str(reason), NOT_COMPUTED
    if (evidence.setup, name) in FITTED:
        return answer.text, CALIBRATED
    return answer.text, HOLDS if answer.holds else DIFFERS


@check("T1", "T2", "T3", "T4")
def single_target_of_8x8(evidence: Evidence) -> Answer:
    """|c - paper| <= tolerance, for c of the 8x8 crosshatch at one target: P_4, P_7, and recall
    at 0.2 s and 0.4 s. In the described setup the crossings were fitted to these: calibrated."""
    places = {"T1": ("order", 4), "T2": ("order", 7), "T3": ("lag", 0.2), "T4": ("lag", 0.4)}
    value = evidence.at("crosshatch", 8, *places[evidence.claim["id"]])
    return Answer(f"{value:.3f}", _within_tolerance(evidence.claim, value))


@check("T5")
def nonlinear_capacity_saturates(evidence: Evidence) -> Answer:
    """Rises: C_nl(N+2) >= C_nl(N) - 0.03 for N = 2, 4, 6, and C_nl(8) > C_nl(2) + 0.03.
    Adds little or nothing: C_nl(10) and C_nl(12) <= C_nl(8) + 0.03."""
    c = evidence.totals("crosshatch", CROSSHATCHES, "c_nl")
    return Answer(
        f"C_nl {numbers(c)}", rises(c[:4]) and all(dense <= c[3] + ALLOWANCE for dense in c[4:])
    )


@check("T6")
def very_high_orders_do_not_fall(evidence: Evidence) -> Answer:
    """With k(N) the highest Legendre order of c > 0.99 (0 if none): some network has k > 0, and
    from each N to the next, N = 2 to 12, the larger network has an order of at least k(N) with
    c > 0.99 - 0.03."""
    curves = [evidence.curve("crosshatch", n, "order") for n in CROSSHATCHES]
    highest = [_last_above(curve, VERY_HIGH) for curve in curves]
    allowed = [_last_above(curve, VERY_HIGH - ALLOWANCE) for curve in curves]
    kept = all(larger >= smaller for smaller, larger in zip(highest, allowed[1:], strict=False))
    text = " ".join(f"{order:.0f}" for order in highest)
    return Answer(f"highest order {text}", kept and max(highest) > 0)


@check("T7")
def memory_capacity_peaks(evidence: Evidence) -> Answer:
    """Rises: C_m(N+2) >= C_m(N) - 0.03 for N = 2, 4, 6, and C_m(8) > C_m(2) + 0.03.
    Plateaus: C_m(10) <= C_m(8) + 0.03, and no substantial decay, C_m(10) > 0.75 C_m(8).
    Decays substantially: C_m(12) <= 0.75 C_m(10), a loss of a quarter or more."""
    c = evidence.totals("crosshatch", CROSSHATCHES, "c_m")
    kept = 1 - SUBSTANTIAL
    plateaus = kept * c[3] < c[4] <= c[3] + ALLOWANCE
    return Answer(f"C_m {numbers(c)}", rises(c[:4]) and plateaus and c[5] <= kept * c[4])


@check("T8")
def larger_networks_recall_further(evidence: Evidence) -> Answer:
    """With the horizon h(N) the last lag of c > 0.5, and h'(N) that of c > 0.5 - 0.03: h'(N+2) >=
    h(N) for N = 2, 4, 6 (beyond 8x8 the paper's own C_m falls); h(8) > h(2); h'(10) and h'(12) >=
    h(2); and the longest h is 0.5 s, give or take 0.1 s."""
    curves = [evidence.curve("crosshatch", n, "lag") for n in CROSSHATCHES]
    horizon = [_last_above(curve, RECALLED) for curve in curves]
    allowed = [_last_above(curve, RECALLED - ALLOWANCE) for curve in curves]
    grows = horizon[3] > horizon[0] and all(allowed[i + 1] >= horizon[i] for i in range(3))
    beyond_smallest = all(dense >= horizon[0] for dense in allowed[4:])
    reach = abs(max(horizon) - PAPERS_REACH) <= REACH_TOLERANCE + ROUND_OFF
    return Answer(f"horizon {numbers(horizon)} s", grows and beyond_smallest and reach)


@check("T9")
def polygons_stay_below(evidence: Evidence) -> Answer:
    """For each polygon N = 6, 8, 10, 12: C_nl and C_m <= those of the 2x2 crosshatch + 0.03. Best:
    C_nl(6) >= C_nl(N) - 0.03 for the others. Alike: each C_m within 0.03 of the middle of their
    range, max C_m - min C_m <= 0.06."""
    columns = ("c_nl", "c_m")
    polygon = {name: evidence.totals("polygon", POLYGONS, name) for name in columns}
    (nl,), (m,) = (evidence.totals("crosshatch", (2,), name) for name in columns)
    below = max(polygon["c_nl"]) <= nl + ALLOWANCE and max(polygon["c_m"]) <= m + ALLOWANCE
    hexagon_best = polygon["c_nl"][0] >= max(polygon["c_nl"]) - ALLOWANCE
    alike = max(polygon["c_m"]) - min(polygon["c_m"]) <= 2 * ALLOWANCE + ROUND_OFF
    return Answer(
        f"C_nl {numbers(polygon['c_nl'])}, C_m {numbers(polygon['c_m'])}; 2x2 {nl:.2f}, {m:.2f}",
        below and hexagon_best and alike,
    )


@check("G3")
def authors_density_table(evidence: Evidence) -> Answer:
    """Largest |C_m - theirs| over the crosshatches that both tables hold, with spacing and force
    equal within 1 %, inside the range. The largest |C_nl - theirs| is printed beside it."""
    if evidence.published_tables is None:
        raise NotComputed
    ours = evidence.table("topology")
    ours = ours[ours["topology"] == "crosshatch"]
    theirs = authors_table(
        evidence.published_tables / "density_500mm.csv",
        ("num_threads", "spacing(mm)", "force_mag(N)", "nonlinearity", "memory"),
    )
    both = ours.merge(theirs, left_on="n", right_on="num_threads")
    same_spacing = (1e3 * both["spacing_m"] / both["spacing(mm)"] - 1).abs() < 0.01
    same_force = (both["force_N"] / both["force_mag(N)"] - 1).abs() < 0.01
    both = both[same_spacing & same_force].reset_index(drop=True)
    if both.empty:
        raise NotComputed
    if both["c_m"].isna().any():
        raise NotComputed(f"{_network('crosshatch', both['n'][both['c_m'].isna()].min())} unstable")
    c_m = (both["c_m"] - both["memory"]).abs()
    c_nl = (both["c_nl"] - both["nonlinearity"]).abs()
    text = (
        f"C_m {c_m.max():.3f} (N = {both['n'][c_m.idxmax()]}), "
        f"C_nl {c_nl.max():.3f} (N = {both['n'][c_nl.idxmax()]}), of {len(both)} networks"
    )
    return Answer(text, inside_range(evidence.claim, c_m.max()))


def authors_table(path: Path, columns: Iterable[str]) -> pd.DataFrame:
    """A table of the authors'; ValueError if it or one of the columns is not there."""
    if not path.is_file():
        raise ValueError(f"{path} does not exist; put the authors' table there or give no folder")
    frame = pd.read_csv(path)
    missing = [name for name in columns if name not in frame.columns]
    if missing:
        raise ValueError(f"{path} has no column {missing[0]!r}; it has {', '.join(frame.columns)}")
    return frame


def rises(c: list[float]) -> bool:
    """No step falls by more than the allowance, and the whole exceeds it."""
    steps = all(after >= before - ALLOWANCE for before, after in pairwise(c))
    return steps and c[-1] > c[0] + ALLOWANCE


def _last_above(curve: pd.Series, threshold: float) -> float:
    """The last order or lag where c exceeds the threshold; 0 if there is none."""
    above = curve.index[curve > threshold]
    return float(above[-1]) if len(above) else 0.0


def _within_tolerance(claim: dict, value: float) -> bool:
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


def _network(topology: str, n: int) -> str:
    return f"{n}x{n} crosshatch" if topology == "crosshatch" else f"{n}-sided polygon"
