"""`python -m fiberweb.tools.hours`: simulations and core-hours of each target, before any of them
runs, by the config of the paper.

Of the simulations alone: their kernels are nearly all of what a target takes. Where the forces of a
study are those that the ridge finds best, as many of those that it may find are counted, and not
the same for C_nl and for C_m.
"""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from fiberweb import studies
from fiberweb.config import Config, lab, load
from fiberweb.model.scene import SETUPS
from fiberweb.runs import Run, runs
from fiberweb.studies.base import CHOICES

CONFIG = Path(__file__).parents[2] / "config" / "config.yaml"
TARGETS = {"described": "figures", "published": "published", "compliant": "compliant"}


def wanted(config: Config, study: str, setup: str) -> list[Run]:
    """The runs of a study in a setup, with forces that the ridge may find best."""
    best = {
        (choice, spacing): found[max(-1 - CHOICES.index(choice), -len(found))]
        for (choice, spacing), found in lab(config, setup).map.best.items()
        if found
    }
    return runs(config, study, setup, best)


def hours() -> pd.DataFrame:
    """Simulations, core-hours and the longest simulation, s, of each target."""
    paper, all_of_it = load(CONFIG), load(CONFIG, {"published_all": True})
    asked = {TARGETS[setup]: (paper, setup) for setup in SETUPS}
    asked["published_all"] = (all_of_it, "published")
    rows = []
    for target, (config, setup) in asked.items():
        taking_part = [name for name in studies.STUDIES if setup in studies.setups(name)]
        found = {run.name: run for name in taking_part for run in wanted(config, name, setup)}
        taken = [run.expected_seconds for run in found.values()]
        rows.append((target, len(taken), sum(taken) / 3600, max(taken)))
    return pd.DataFrame(rows, columns=["target", "simulations", "core-hours", "longest, s"])


if __name__ == "__main__":
    print(hours().round(2).to_string(index=False))
