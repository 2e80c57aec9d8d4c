"""Spring and damper of the crossings and damping of fibres, held against the paper's Fig. 1d.

The paper does not report these three. Of the compliant setup they are the point of a grid whose
8x8 crosshatch comes nearest to the four capacities that Fig. 1d prints (claims T1 to T4), which
therefore count nowhere. `check` holds the setup's defaults against a grid that was computed, and
this prints the verdict:

    python -m fiberweb.studies.calibration.tables results/tables/compliant/calibration.csv
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path

import pandas as pd

from fiberweb.claims import listed
from fiberweb.meanings import explained
from fiberweb.model.scene import SETUPS
from fiberweb.scoring import tables
from fiberweb.studies.calibration.grid import GRID, SIZE
from fiberweb.tables import read

# column: claim, and where its capacity is: Legendre order, or lag in s
TARGETS = {
    "c_p4": ("T1", "order", 4),
    "c_p7": ("T2", "order", 7),
    "recall_200ms": ("T3", "lag", 0.2),
    "recall_400ms": ("T4", "lag", 0.4),
}
VARIABLES = {"order": "nonlinear", "lag": "memory"}
SETUP = "compliant"
DEFAULTS = SETUPS[SETUP]["crosshatch"]
WORDS = {"order": "Legendre polynomial {:g}", "lag": "u {:g} s ago"}
MEASURED = {
    column: f"capacity for {WORDS[kind].format(at)}: test part; claim {claim}"
    for column, (claim, kind, at) in TARGETS.items()
} | {"misfit": "sum of ((c - paper) / tolerance)^2 over these four; of the 8x8 alone"}
CHECK_COLUMNS = (
    {"setup": tables.SCENE["setup"], "role": "best of the grid, default, paper or tolerance"}
    | {column: tables.OF_PHYSICS[column] for column in GRID}
    | MEASURED
)
DIGITS = 2  # of a misfit; points that agree in these are a tie
NONE_STABLE = "the calibration table has no stable run of the 8x8 crosshatch to judge"


@cache
def paper() -> dict[str, tuple[float, float]]:
    """The paper's capacity and our tolerance, dimensionless, of each column of `TARGETS`."""
    claims = {claim["id"]: claim for claim in listed.load()}
    return {
        column: (claims[name]["paper"], claims[name]["tolerance"])
        for column, (name, _, _) in TARGETS.items()
    }


def misfit(capacities: Sequence[float]) -> float:
    """Sum of ((c - paper) / tolerance)^2 over the four of `TARGETS`, in their order;
    dimensionless, and NaN if one is."""
    terms = zip(capacities, paper().values(), strict=True)
    return sum(((c - value) / tolerance) ** 2 for c, (value, tolerance) in terms)


@explained(tables.COLUMNS, tables.CHOICE, tables.OF_PHYSICS, tables.OF_NUMERICS, MEASURED)
def table(capacity_paths: Iterable[str | Path]) -> pd.DataFrame:
    """One row for each run: the columns of `tables.study`, those of `TARGETS`, and ``misfit``.

    Args:
        capacity_paths: files as for `tables.rows`.

    Returns:
        A frame; ``misfit`` is NaN for networks other than the 8x8 and for unstable runs.
    """
    extra = {column: _reader(*place) for column, (_, *place) in TARGETS.items()}
    return tables.rows(
        capacity_paths, force_choice="eq3", **tables.PHYSICS, **tables.NUMERICS, **extra,
        misfit=_misfit_of_run,
    )  # fmt: skip


def best(frame: pd.DataFrame) -> pd.Series:
    """The row of the least misfit.

    Raises:
        ValueError: no run has a misfit.
    """
    if frame["misfit"].isna().all():
        raise ValueError(NONE_STABLE)
    return frame.loc[frame["misfit"].idxmin()]


@explained(CHECK_COLUMNS)
def check(frame: pd.DataFrame) -> pd.DataFrame:
    """One row for each role: the grid's best point, the compliant setup's defaults, and what both
    are held against.

    Args:
        frame: from `table`.

    Returns:
        A frame of `CHECK_COLUMNS`, one row for each role: "best", "default", "paper" and
        "tolerance". Capacities and misfit of the defaults are NaN where their run was unstable or
        the grid leaves them out; no row is "best" if no run was stable.

    Raises:
        ValueError: the frame is another study's.
    """
    if missing := [name for name in CHECK_COLUMNS if name not in (*frame.columns, "role")]:
        raise ValueError(f"a calibration table has the column {missing[0]!r}, and this one has not")
    default = {column: DEFAULTS[field] for column, field in GRID.items()}
    at = (frame[list(GRID)] == pd.Series(default)).all(axis=1) & (frame["n"] == SIZE)
    (own,) = frame[at].iloc[:1].to_dict("records") or [default]
    records = [{"role": "default", "setup": SETUP} | own]
    if frame["misfit"].notna().any():
        records.append(best(frame).to_dict() | {"role": "best"})
    values, tolerances = zip(*paper().values(), strict=True)
    for role, numbers in (("paper", values), ("tolerance", tolerances)):
        records.append(dict(zip(TARGETS, numbers, strict=True)) | {"role": role, "setup": SETUP})
    return pd.DataFrame(records, columns=list(CHECK_COLUMNS))


def verdict(frame: pd.DataFrame) -> tuple[bool, str]:
    """Whether the defaults are the grid's best point or tie with it, and one sentence on it.

    Args:
        frame: from `check`.
    """
    roles = frame.set_index("role")
    if "best" not in roles.index:
        return False, NONE_STABLE
    default, least = roles.loc["default"], roles.loc["best"]
    if math.isnan(default["misfit"]):
        return False, f"the defaults, {_point(default)}, have no stable 8x8 run in this grid"
    misfits = [f"{row['misfit']:.{DIGITS}f}" for row in (default, least)]
    if misfits[0] == misfits[1]:
        return True, f"the defaults, {_point(default)}, are the grid's best: misfit {misfits[1]}"
    return False, (
        f"the defaults, {_point(default)}, have a misfit of {misfits[0]}, but the grid's best, "
        f"{_point(least)}, has {misfits[1]}"
    )


def _reader(target: str, place: float):
    """A column of `tables.rows`: c at one Legendre order, or at the lag nearest to one (s)."""

    def read(_, scored) -> float:
        return float(scored[VARIABLES[target]].sel({target: place}, method="nearest"))

    return read


def _misfit_of_run(scene, scored) -> float:
    if scene.network.n != SIZE:
        return math.nan
    return misfit([_reader(*place)(scene, scored) for _, *place in TARGETS.values()])


def _point(row: pd.Series) -> str:
    """The three parameters as text."""
    units = ("k = {:g} N/m", "nu = {:g} N s/m", "gamma = {:g} /s")
    return ", ".join(text.format(row[column]) for text, column in zip(units, GRID, strict=True))


def main() -> None:
    """Print the verdict on a table; exit 1 with one sentence if the defaults are not the best."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("table", help="calibration.csv of the workflow")
    try:
        agrees, sentence = verdict(check(read(parser.parse_args().table)))
    except (OSError, ValueError) as error:
        sys.exit(str(error))
    if not agrees:
        sys.exit(sentence)
    print(sentence)


if __name__ == "__main__":
    main()
