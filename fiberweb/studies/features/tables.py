"""Tables of the features study (Fig. 4): what each group of signals scores, and greedy choices."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from fiberweb.meanings import explained
from fiberweb.model.readouts import of_signals
from fiberweb.model.scene import Scene
from fiberweb.scoring import capacity, groups, rank, recording, selection, tables
from fiberweb.simulation import dataset

CHRONOLOGICAL, SHUFFLED = "chronological", "shuffled"
GROUP_COLUMNS = {
    "group": "of signals: see `fiberweb.scoring.groups.mask`",
    "split": "chronological, or shuffled: C_nl on a random split, as the authors scored this",
    "scoring": "clean or published",
    "n_signals": "signals in the group",
    "effective_rank": rank.RANKS["effective_rank"],
    "verdict": "whether claims are judged by this force",
}
TOTALS = ("c_nl", "c_m", "c_nl_train", "c_m_train")
GREEDY_COLUMNS = (
    tables.SCENE
    | {
        "target": "what signals are chosen for: c_nl or c_m",
        "n_chosen": "signals that are chosen so far",
        "kind": "of the readout of the signal added last: crossing or a midpoint",
        "fibre": "that it lies on, from 0",
        "section": "number of this crossing or section along the fibre, from 0",
        "axis": "of the signal: x or y",
    }
    | {name: tables.SCALARS[name] for name in TOTALS}
    | {
        "kept": "the target's capacity over that of all signals, test part",
        "share": "of the capacity that is to be kept",
        "needed": "fewest signals from which on kept is at least share",
    }
    | tables.END
)


@explained(
    tables.COLUMNS, tables.CHOICE, tables.OF_PHYSICS, tables.OF_NUMERICS, tables.OF_VERDICTS,
    GROUP_COLUMNS,
)  # fmt: skip
def group_table(
    capacity_paths: Sequence[str | Path],
    response_paths: Sequence[str | Path],
    choices: Sequence[str],
    alpha: float,
    verdict_force: float,
) -> pd.DataFrame:
    """One row for each run, group of signals and split.

    Args:
        capacity_paths, choices: as for `tables.study`.
        response_paths: of the same runs.
        alpha: ridge penalty; the paths' own capacities are not used.
        verdict_force: the force (N) by which claims are judged.

    Returns:
        The columns of `tables.study` and `GROUP_COLUMNS`. split "chronological" is scored as the
        run's setup scores; "shuffled" as the authors scored this study: published scoring, C_nl
        on a random split (which flatters it), C_m on a chronological one. effective_rank: see
        `rank.effective_rank`. Capacities and rank are NaN for an unstable run.
    """
    records = []
    for scored, response_path, choice in zip(capacity_paths, response_paths, choices, strict=True):
        run = tables.study([scored], [choice]).iloc[0].to_dict()
        run["verdict"] = math.isclose(run["force_N"], verdict_force, rel_tol=1e-6)
        response = dataset.load(response_path)
        records += [run | row for row in _groups(response, alpha)]
    table = pd.DataFrame(records)
    return table[[*(name for name in table.columns if name not in GROUP_COLUMNS), *GROUP_COLUMNS]]


@explained(GREEDY_COLUMNS)
def greedy_table(response_path: str | Path, alpha: float, share: float) -> pd.DataFrame:
    """One row for each target and number of signals, in the order of forward selection.

    Args:
        response_path: of the run.
        alpha: ridge penalty.
        share: of a capacity that is to be kept.

    Returns:
        Columns `GREEDY_COLUMNS`, with the clean scoring of all signals so far, in either setup. An
        unstable run has one row for each target, without numbers.
    """
    response = dataset.load(response_path)
    scene = _scene_columns(response) | {"share": share}
    records = []
    for target in selection.TARGETS:
        rows = [{}]
        if response.attrs["status"] == "ok":
            rows = _chosen(response, target, alpha, share)
        records += [scene | {"target": target} | row for row in rows]
    return pd.DataFrame(records, columns=list(GREEDY_COLUMNS))


def _groups(response, alpha: float) -> list[dict]:
    """The rows of one run."""
    network = Scene.from_json(response.attrs["scene"]).network
    stable = response.attrs["status"] == "ok"
    scoring, moved = recording.own_scoring(response), recording.signals(response)
    u, rate = recording.scored_input(response, scoring), recording.sample_rate(response)
    splits = {
        CHRONOLOGICAL: {"scoring": scoring},
        SHUFFLED: {"scoring": "published", "shuffle": True},
    }
    rows = []
    for group in groups.names(network):
        some = moved[:, groups.mask(group, network, response)]
        directions = rank.effective_rank(some) if stable else math.nan
        for split, how in splits.items():
            row = {"group": group, "split": split, "scoring": how["scoring"]}
            row |= {"n_signals": some.shape[1], "effective_rank": directions}
            if stable:
                scored = capacity.score_arrays(u, some, rate, alpha=alpha, **how)
                row |= {name: getattr(scored, name) for name in tables.SCALARS}
            else:
                row |= dict.fromkeys(tables.SCALARS, math.nan)
            rows.append(row)
    return rows


def _chosen(response, target: str, alpha: float, share: float) -> list[dict]:
    """The rows of one target."""
    u, moved = response["input"].values, recording.signals(response)
    order = selection.forward(u, moved, recording.sample_rate(response), target, alpha)
    c = getattr(order, target)
    readout, axis = of_signals(order.signal, response.sizes["readout"])
    rows = pd.DataFrame({name: getattr(order, name) for name in TOTALS})
    for name in ("kind", "fibre", "section"):
        rows[name] = response[name].values[readout]
    rows["axis"] = axis
    rows["n_chosen"] = range(1, len(rows) + 1)
    rows["kept"] = c / c[-1]
    rows["needed"] = selection.needed(c, share)
    return rows.to_dict("records")


def _scene_columns(response) -> dict:
    scene = Scene.from_json(response.attrs["scene"])
    network = scene.network
    values = (
        scene.setup, network.topology, network.n, network.spacing, scene.force, scene.tension,
        scene.buckling_number,
    )  # fmt: skip
    known = dict(zip(tables.SCENE, values, strict=True))
    return known | {name: response.attrs[name] for name in ("status", "run")}
