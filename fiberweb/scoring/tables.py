"""The rows of tables: one row per run, or per point of a run's curve."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from fiberweb import tables
from fiberweb.model.scene import Scene
from fiberweb.scoring import arguments, capacity, recording
from fiberweb.scoring.limits import ALPHA
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
    "loss_factor": lambda scene, _: scene.loss_factor,
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
VERDICTS = {"c_nl": "c_nl_verdict", "c_m": "c_m_verdict"}  # what each capacity is
CURVE_COLUMNS = ("setup", "topology", "n", "target", "at", "c", "c_train", "c_raw", "run")
BASELINE_COLUMNS = ("readout", "c_nl", "c_m")


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


def study(
    capacity_paths: Sequence[str | Path],
    choices: Sequence[str],
    certificate_paths: Sequence[str | Path] = (),
) -> pd.DataFrame:
    """One row per run and choice of its force: scene, capacities with their standard errors, and
    numerics (`COLUMNS`, force_choice, `PHYSICS`, `NUMERICS`, and `VERDICTS` of certificates).

    Args:
        capacity_paths: as for `rows`; a run that two choices agree on comes twice.
        choices: of each path, see `fiberweb.studies.base.Point`.
        certificate_paths: of each path, see `fiberweb.validation.certificate`; or none.
    """
    records = []
    for path, choice in zip(capacity_paths, choices, strict=True):
        scene, scored = _read_run(path)
        records.append(_row(scene, scored, {"force_choice": choice} | PHYSICS | NUMERICS))
    for record, path in zip(records, certificate_paths):
        verdicts = tables.read(path).groupby("capacity")["verdict"].first()
        record |= {column: verdicts[name] for name, column in VERDICTS.items()}
    verdicts = VERDICTS.values() if certificate_paths else ()
    return _frame(records, (*COLUMNS, "force_choice", *PHYSICS, *NUMERICS, *verdicts))


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


def baselines(
    response: xr.Dataset, alpha: float = ALPHA, scoring: str | None = None, **options: object
) -> pd.DataFrame:
    """Input-only baselines: what readouts made of the input alone score.

    Args:
        response: of it only the input and its time are used.
        alpha, scoring, **options: as for `capacity.score_arrays`; scoring None is the one of
            the response's setup.

    Returns:
        A frame of `BASELINE_COLUMNS`, readout being "u", "derivatives" or "powers".
    """
    arguments.check_input(response, scoring, options)
    scoring = scoring or recording.own_scoring(response)
    sample_rate = recording.sample_rate(response)
    u = recording.scored_input(response, scoring)  # whole even in an unstable run
    records = []
    for name, readouts in capacity.trivial_readouts(u, sample_rate).items():
        scored = capacity.score_arrays(
            u, readouts, sample_rate, scoring=scoring, alpha=alpha, **options
        )
        records.append((name, scored.c_nl, scored.c_m))
    return _frame(records, BASELINE_COLUMNS)


def input_baselines(response_path: str | Path, **options: object) -> pd.DataFrame:
    """What readouts made of the input alone score, without a network, on the input that every run
    of the study has (`baselines` of a response in a file)."""
    return baselines(dataset.load(response_path), **options)


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
        "force_N": float("nan") if scene.force is None else scene.force,
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
    return tables.ordered(pd.DataFrame(records, columns=list(columns)))
