"""`python -m fiberweb.tools.hours`: simulations and core-hours of each target, before any of them
runs, by the config of the paper; and hours until a cluster has done them.

Of the simulations alone: their kernels are nearly all of what a target takes. Where the forces of a
study are those that the ridge finds best, as many of those that it may find are counted, and not
the same for C_nl and for C_m. On a cluster they are one after another in groups as large as
`profiles/slurm/` has them, each on one core; no job waits in a queue, and none for the ridge.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from pathlib import Path

import pandas as pd
import yaml

from fiberweb import studies
from fiberweb.config import Config, lab, load
from fiberweb.model.scene import SETUPS
from fiberweb.runs import Run, runs
from fiberweb.studies.base import CHOICES

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "config" / "config.yaml"
PROFILE = ROOT / "profiles" / "slurm" / "config.yaml"
TARGETS = {"described": "figures", "published": "published", "compliant": "compliant"}
AT_ONCE = (1, 2, 8, 32)  # jobs


def wanted(config: Config, study: str, setup: str) -> list[Run]:
    """The runs of a study in a setup, with forces that the ridge may find best."""
    best = {
        (choice, spacing): found[max(-1 - CHOICES.index(choice), -len(found))]
        for (choice, spacing), found in lab(config, setup).map.best.items()
        if found
    }
    return runs(config, study, setup, best)


def runs_a_group() -> int:
    """How many runs are one job on a cluster."""
    components = yaml.safe_load(PROFILE.read_text(encoding="utf-8"))["group-components"]
    return int(dict(each.split("=") for each in components)["runs"])


def until_done(seconds: Sequence[float], at_once: int, together: int) -> float:
    """When the last of some jobs ends, s, each of so many runs together in the order given, and
    begun as soon as one of those at work has ended."""
    ends = [0.0] * at_once
    for first in range(0, len(seconds), together):
        heapq.heapreplace(ends, ends[0] + sum(seconds[first : first + together]))
    return max(ends)


def hours() -> pd.DataFrame:
    """Simulations, core-hours and the longest simulation, s, of each target, and its wall time, h,
    by how many jobs of a cluster there are at once."""
    paper, all_of_it = load(CONFIG), load(CONFIG, {"published_all": True})
    asked = {TARGETS[setup]: (paper, setup) for setup in SETUPS}
    asked["published_all"] = (all_of_it, "published")
    rows, together = [], runs_a_group()
    for target, (config, setup) in asked.items():
        taking_part = [name for name in studies.STUDIES if setup in studies.setups(name)]
        found = {run.name: run for name in taking_part for run in wanted(config, name, setup)}
        taken = [run.expected_seconds for run in found.values()]
        wall = [until_done(taken, jobs, together) / 3600 for jobs in AT_ONCE]
        rows.append((target, len(taken), sum(taken) / 3600, max(taken), *wall))
    counted = ["target", "simulations", "core-hours", "longest, s"]
    return pd.DataFrame(rows, columns=[*counted, *(f"{jobs} at once" for jobs in AT_ONCE)])


if __name__ == "__main__":
    print(hours().round(2).to_string(index=False))
