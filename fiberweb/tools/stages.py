"""`python -m fiberweb.tools.stages [results]`: jobs and CPU time of each stage of the workflow.

From the last lines of the jobs' logs: one job a log, as it last ran. Stages are folders there:
simulate, capacity, tables, figures, claims, accuracy; `forks` is the process that jobs are forks
of, and `snakemake` the workflow's own. Of a job, `kernel` is the integration, `solve` the ridge
regression with its standard errors, and `rest` all that is none of the others. `longest` is the CPU
time of a stage's longest job and `MB` the memory of its largest, as a cluster's queue asks for.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pandas as pd

from fiberweb import timed

PHYSICS = ["kernel", "solve"]
PARTS = ["start", *PHYSICS, "read", "write", "rest"]
LARGEST = ["longest", "MB"]


def stages(results: str | Path) -> pd.DataFrame:
    """Jobs and CPU seconds of each stage by part, the longest first, with its longest job, s, and
    its largest, MB; the last row has all.

    Raises:
        ValueError: there is no job's log in the folder.
    """
    folder = Path(results) / "logs"
    rows = []
    for path in sorted(folder.rglob("*.log")):
        log = path.read_text(encoding="utf-8", errors="replace")
        if spent := timed.read(log):
            stage = path.relative_to(folder).parts[0].removesuffix(".log")
            largest = {"longest": sum(spent.values()), "MB": timed.memory(log)}
            rows.append({"stage": stage, "jobs": 1, **spent, **largest})
    if not rows:
        raise ValueError(f"{folder} holds no log of a job: run the workflow first")
    every = pd.DataFrame(rows, columns=["stage", "jobs", *PARTS, *LARGEST]).groupby("stage")
    table, largest = every[["jobs", *PARTS]].sum(), every[LARGEST].max()
    table["all"] = table[PARTS].sum(axis=1)
    table = table.join(largest).sort_values("all", ascending=False)
    table.loc["all"] = pd.concat([table.drop(columns=LARGEST).sum(), largest.max()])
    return table.astype({"jobs": int})


def main() -> None:
    """Print the table, and how much of the time is neither kernel nor ridge solve."""
    table = stages(sys.argv[1] if len(sys.argv) > 1 else "results")
    print(table.round(1).to_string())
    everything = table.loc["all"]
    share = 1.0 - everything[PHYSICS].sum() / everything["all"]
    print(f"neither kernel nor solve: {share:.1%} of the CPU time")


if __name__ == "__main__":
    main()
