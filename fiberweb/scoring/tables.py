"""Tables: one row a run (or a point of a run's curve), as CSV with the same bytes every time."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from fiberweb.model.scene import Scene
from fiberweb.scoring import capacity
from fiberweb.simulation import dataset

if TYPE_CHECKING:
    import xarray as xr

SCALARS = ("c_nl", "c_m", "c_nl_train", "c_m_train", "c_nl_raw", "c_m_raw", "c_nl_se", "c_m_se")
COLUMNS = (
    "setup", "topology", "n", "spacing_m", "force_N", "tension_N", "buckling_number",
    *SCALARS, "status", "run",
)  # fmt: skip
PHYSICS = {
    "crossing_stiffness_N_m": lambda scene, _: scene.crossing_stiffness,
    "crossing_damping_Ns_m": lambda scene, _: scene.crossing_damping,
    "damping_per_s": lambda scene, _: scene.damping,
    "filter_order": lambda scene, _: scene.filter_order,
    "seed": lambda scene, _: scene.seed,
    "disturbance_m": lambda scene, _: scene.disturbance,
    "duration_s": lambda scene, _: scene.duration,
}
NUMERICS = {
    "engine": lambda _, scored: scored.attrs["engine"],
    "elements_per_section": lambda _, scored: scored.attrs["elements_per_section"],
    "time_step_s": lambda _, scored: scored.attrs["time_step"],
}
BEST_COLUMNS = ("setup", "spacing_m", "choice", "force_N", "buckling_number", "capacity")
CURVE_COLUMNS = ("setup", "topology", "n", "target", "at", "c", "c_train", "c_raw", "run")
FLOOR_COLUMNS = ("readout", "c_nl", "c_m")
# Rows are put in this order, so that a table does not depend on the order in which runs end.
SORTED_BY = ("setup", "topology", "n", "spacing_m", "force_N", "tension_N", "run", "target", "at")
FLOAT_FORMAT = "%.10g"


def rows(scored: Iterable[str | Path | xr.Dataset], **extra: object) -> pd.DataFrame:
    """One row for each set of capacities.

    Args:
        scored: outputs of `capacity.score` with the attrs ``scene``, ``run`` and ``status``, or
            files that hold them.
        **extra: columns that a study adds after `COLUMNS`: a constant, or a function of the
            run's (Scene, capacity Dataset), such as ``length_m=lambda scene, _:
            scene.network.length``.

    Returns:
        A frame of `COLUMNS` and the extra ones; spacing in m, forces in N, capacities
        dimensionless and NaN for an unstable run.
    """
    return _frame([_row(*_read_run(each), extra) for each in scored], (*COLUMNS, *extra))


def study(capacity_paths: Sequence[str | Path], choices: Sequence[str]) -> pd.DataFrame:
    """One row for each run and choice of its force, with `STUDY_COLUMNS` after `COLUMNS`.

    Args:
        capacity_paths: as for `rows`; a run that two choices agree on comes twice.
        choices: of each path, see `fiberweb.studies.points.Point`.
    """
    records = []
    for path, choice in zip(capacity_paths, choices, strict=True):
        scene, scored = _read_run(path)
        records.append(_row(scene, scored, {"force_choice": choice} | PHYSICS | NUMERICS))
    return _frame(records, (*COLUMNS, "force_choice", *PHYSICS, *NUMERICS))


def best_unbuckled(ridge: pd.DataFrame) -> pd.DataFrame:
    """The force below B = 1 with the best C_nl, and the one with the best C_m, of each spacing.

    Args:
        ridge: the ridge's table of one setup.

    Returns:
        Columns setup, spacing_m, choice ("best_c_nl" or "best_c_m"), force_N, buckling_number and
        capacity; no row where no run below B = 1 was stable.
    """
    stable = ridge[(ridge["status"] == "ok") & (ridge["buckling_number"] < 1.0)]
    records = []
    for spacing, frame in stable.groupby("spacing_m"):
        for column in ("c_nl", "c_m"):
            row = frame.loc[frame[column].idxmax()]
            found = (row["force_N"], row["buckling_number"], row[column])
            records.append((row["setup"], spacing, f"best_{column}", *found))
    return _frame(records, BEST_COLUMNS)


def read_best(path: str | Path) -> dict[tuple[str, float], float]:
    """What `best_unbuckled` found: (choice, spacing in m) to force in N."""
    frame = read(path)
    return dict(zip(zip(frame["choice"], frame["spacing_m"]), frame["force_N"]))


def curves(capacity_paths: Iterable[str | Path]) -> pd.DataFrame:
    """Capacity of every single target, long: one row for each run and target.

    Columns: `CURVE_COLUMNS`. ``target`` is "order" (``at`` is the Legendre order) or "lag"
    (``at`` is the lag in s); ``c`` is the headline value on the test part.
    """
    records = []
    for path in capacity_paths:
        scene, scored = _read_run(path)
        run = (scene.setup, scene.network.topology, scene.network.n)
        for target, name in (("order", "nonlinear"), ("lag", "memory")):
            at = scored[target].values.astype(float)  # orders and lags share a column
            c = (scored[name + part].values for part in ("", "_train", "_raw"))
            records += [
                (*run, target, *point, scored.attrs["run"]) for point in zip(at, *c, strict=True)
            ]
    return _frame(records, CURVE_COLUMNS)


def floors(
    response_path: str | Path, alpha: float = 0.01, scoring: str | None = None, **options: object
) -> pd.DataFrame:
    """What readouts made of the input alone would score: the floor of every capacity.

    Args:
        response_path: a response; of it only the input and its sample rate are used, and every
            run of a study has the same.
        alpha, scoring, **options: as for `capacity.score_arrays`; scoring None is the one of
            the response's setup.

    Returns:
        A frame of `FLOOR_COLUMNS`, readout being "u", "derivatives" or "powers".
    """
    response = dataset.load(response_path)
    if scoring is None:
        scoring = "published" if response.attrs["setup"] == "published" else "clean"
    sample_rate = float(response.attrs["sample_rate"])
    u = response["input"].values  # whole even in an unstable run
    records = []
    for name, readouts in capacity.trivial_readouts(u, sample_rate).items():
        scored = capacity.score_arrays(
            u, readouts, sample_rate, scoring=scoring, alpha=alpha, **options
        )
        records.append((name, scored.c_nl, scored.c_m))
    return _frame(records, FLOOR_COLUMNS)


def merge(paths: Iterable[str | Path]) -> pd.DataFrame:
    """The rows of several tables with the same columns, such as one table of each setup.

    Raises:
        ValueError: no table, or tables whose columns are not the same.
    """
    frames = {Path(path): read(path) for path in paths}
    if not frames:
        raise ValueError("there is no table to merge; give at least one path")
    (first, head), *others = frames.items()
    for path, frame in others:
        if list(frame.columns) != list(head.columns):
            raise ValueError(
                f"{path} has the columns {', '.join(frame.columns)} but {first} has "
                f"{', '.join(head.columns)}; merge tables of one kind only"
            )
    filled = [frame for frame in frames.values() if len(frame)] or [head]
    return _sorted(pd.concat(filled, ignore_index=True))


def write(frame: pd.DataFrame, path: str | Path) -> None:
    """Write a table as CSV: same frame, same bytes, however its rows were ordered."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(path.name + ".partial")
    # encoding and newline are fixed because both would follow the machine
    with partial.open("w", encoding="utf-8", newline="") as file:
        _sorted(frame).to_csv(file, index=False, float_format=FLOAT_FORMAT, lineterminator="\n")
    partial.replace(path)  # a killed job leaves no half table under the right name


def read(path: str | Path) -> pd.DataFrame:
    """The table that `write` wrote; an empty cell is NaN."""
    return pd.read_csv(path)


def _read_run(given):
    """(Scene, capacity Dataset) of one capacity file or of what it would hold."""
    scored = dataset.load(given) if isinstance(given, (str, Path)) else given
    return Scene.from_json(scored.attrs["scene"]), scored


def _row(scene: Scene, scored, extra: dict[str, object]) -> dict:
    row = {
        "setup": scene.setup,
        "topology": scene.network.topology,
        "n": scene.network.n,
        "spacing_m": scene.network.spacing,
        "force_N": scene.force,
        "tension_N": scene.tension,
        "buckling_number": scene.buckling_number,
        "status": scored.attrs["status"],
        "run": scored.attrs["run"],
    }
    row |= {name: float(scored[name]) for name in SCALARS}
    for name, value in extra.items():
        row[name] = value(scene, scored) if callable(value) else value
    return row


def _frame(records: list, columns: tuple[str, ...]) -> pd.DataFrame:
    return _sorted(pd.DataFrame(records, columns=list(columns)))


def _sorted(frame: pd.DataFrame) -> pd.DataFrame:
    """Rows in the order of `SORTED_BY`; rows that are equal in it keep theirs."""
    keys = [name for name in SORTED_BY if name in frame.columns]
    return frame.sort_values(keys, kind="stable", ignore_index=True) if keys else frame
