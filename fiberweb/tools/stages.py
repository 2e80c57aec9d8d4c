"""`python -m fiberweb.tools.stages [results]`: jobs and time of each stage of the workflow.

From the benchmark files that Snakemake leaves: one for each job, the last time that it ran.
Stages are folders there: simulate, capacity, tables, figures, claims, accuracy.
"""

from __future__ import annotations

import sys
from pathlib import Path

import pandas as pd


def stages(results: str | Path) -> pd.DataFrame:
    """Jobs and wall seconds of each stage, the longest first; the last row has all.

    Not CPU seconds: Snakemake samples those as rarely as every 30 s, and short jobs lose half.

    Raises:
        ValueError: there is no benchmark in the folder.
    """
    folder = Path(results) / "benchmarks"
    jobs = []
    for path in sorted(folder.rglob("*.tsv")):
        measured = pd.read_csv(path, sep="\t", na_values="-").iloc[-1]
        stage = path.relative_to(folder).parts[0].removesuffix(".tsv")
        jobs.append((stage, measured["s"]))
    if not jobs:
        raise ValueError(f"{folder} holds no benchmark: run the workflow first")
    frame = pd.DataFrame(jobs, columns=["stage", "wall_s"])
    table = frame.groupby("stage").agg(jobs=("wall_s", "size"), wall_s=("wall_s", "sum"))
    table = table.sort_values("wall_s", ascending=False)
    table.loc["all"] = table.sum()
    return table.astype({"jobs": int})


def main() -> None:
    """Print the table."""
    print(stages(sys.argv[1] if len(sys.argv) > 1 else "results").round(1).to_string())


if __name__ == "__main__":
    main()
