"""The rows of tables: one row per run, or per point of a run's curve."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from fiberweb import tables
from fiberweb.meanings import explained
from fiberweb.model.scene import Scene
from fiberweb.scoring import arguments, capacity, recording
from fiberweb.scoring.limits import ALPHA
from fiberweb.simulation import dataset

if TYPE_CHECKING:
    import xarray as xr

SCALARS = capacity.TOTALS
PLACE = {
    "setup": "described, published or compliant",
    "topology": "crosshatch or polygon",
    "n": "fibres in each direction, or vertices of the polygon",
}
SCENE = PLACE | {
    "spacing_m": ("length of the driven section: of a crosshatch, its spacing", "m"),
    "force_N": ("amplitude of the force, F_max; empty where a motor carries the point", "N"),
    "tension_N": ("pretension of each fibre", "N"),
    "buckling_number": "B of Eq. 4; fibres buckle at 1",
}
END = {
    "status": "ok, or unstable: then capacities are empty",
    "run": "name of the run: its folder in results/runs",
}
COLUMNS = SCENE | SCALARS | END
CHOICE = {
    "force_choice": (
        "where the force comes from: eq3, grid, buckling (a multiple of the critical one), "
        "best_c_nl or best_c_m (of the ridge, below B = 1), authors..., mesh; of the twin, angle"
    )
}
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
OF_PHYSICS = {
    "crossing_stiffness_N_m": ("of the spring between crossing fibres; inf: one point", "N/m"),
    "crossing_damping_Ns_m": ("of the damper between crossing fibres", "N s/m"),
    "damping_per_s": ("rate at which velocity decays, gamma", "1/s"),
    "loss_factor": "tan(delta) of the material",
    "filter_order": "of the Laplace filter in the authors' code; 0: none",
    "seed": "of the input",
    "disturbance_m": ("by which the driven point starts off its place", "m"),
    "duration_s": ("of the recording", "s"),
}
OF_NUMERICS = {
    "engine": "kirchhoff, cosserat or elastica",
    "elements_per_section": "elements on a section as long as the spacing; authors: their mesh",
    "time_step_s": ("step of the integration", "s"),
}
VERDICTS = {"c_nl": "c_nl_verdict", "c_m": "c_m_verdict"}  # what each capacity is
OF_VERDICTS = {
    column: f"what {name} rests on, if the config asks for certificates: see certificate.csv"
    for name, column in VERDICTS.items()
}
TARGET = {
    "target": "order of a Legendre polynomial, or lag of a recall",
    "at": ("the order, dimensionless; or the lag", "s"),
}
CURVE_COLUMNS = (
    PLACE
    | TARGET
    | {
        "c": "capacity: test part",
        "c_train": "capacity: training part",
        "c_raw": "capacity: test part, nothing replaced or clipped",
        "run": END["run"],
    }
)
READOUT = {
    "readout": "made of the input alone: u; derivatives (u and its first three); powers (to u^3)"
}
BASELINE_COLUMNS = READOUT | {name: SCALARS[name] for name in ("c_nl", "c_m")}


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


@explained(COLUMNS, CHOICE, OF_PHYSICS, OF_NUMERICS, OF_VERDICTS)
def study(
    capacity_paths: Sequence[str | Path],
    choices: Sequence[str],
    certificate_paths: Sequence[str | Path] = (),
) -> pd.DataFrame:
    """One row for each run and choice of its force.

    Columns: `COLUMNS`, force_choice, `PHYSICS`, `NUMERICS`, and `VERDICTS` if there are
    certificates.

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
    return _frame(records, (*COLUMNS, *CHOICE, *PHYSICS, *NUMERICS, *verdicts))


@explained(CURVE_COLUMNS)
def curves(capacity_paths: Iterable[str | Path]) -> pd.DataFrame:
    """Capacity of every single target, long: one row for each run and target.

    Columns: `CURVE_COLUMNS`.
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
    return _frame(records, tuple(CURVE_COLUMNS))


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
    return _frame(records, tuple(BASELINE_COLUMNS))


@explained(BASELINE_COLUMNS)
def input_baselines(response_path: str | Path, **options: object) -> pd.DataFrame:
    """What readouts made of the input alone score, on the input that every run of a study has.

    `baselines` of a response in a file.
    """
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
