"""`python -m fiberweb.tools.docs [results]`: write the tables of docs/*.md from a run's results.

A table stands between the lines `<!-- table: NAME -->` and `<!-- end -->`. NAME is the path of a
CSV file below results/tables without its suffix, such as `described/topology`; `TABLES` says under
its last part which columns are shown. `claims` is made of the claims.csv of every setup at hand,
and keeps the columns of those that are not. Another block whose table does not exist stays as it
is, and a line says so.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pandas as pd

from fiberweb.claims.judge import join
from fiberweb.model.scene import SETUPS

DOCS = Path(__file__).parents[2] / "docs"
START, END = "<!-- table:", "<!-- end -->"
BLOCK = re.compile(rf"^{START} (\S+) -->\n(.*?)^{END}$", re.MULTILINE | re.DOTALL)
NONE, CAPACITY = "–", "+-"

# Heading of a column to what is in it: a column of the table, how its number is printed, and what
# it is multiplied by. "+-" is a capacity with its standard error; without a format it is text.
BOTH = {"C_nl": "c_nl +-", "C_m": "c_m +-"}
MESH = {"engine": "engine", "elements a section": "elements_per_section",
        "step, us": "time_step .3g 1e6"}  # fmt: skip
TABLES = {
    "topology": {"network": "network", "B": "buckling_number .2f"} | BOTH,
    "baselines": {"readout of the input alone": "readout"} | BOTH,
    "ridge_onset": {
        "spacing, mm": "spacing_m g 1e3", "B where C_nl drops": "onset_B .2f",
        "best C_nl": "best_c_nl .3f", "at B": "best_c_nl_B .2f",
        "best C_m": "best_c_m .3f", "at this B": "best_c_m_B .2f",
    },
    "chaos_rates": {"B": "buckling_number g", "rate, 1/s": "rate_per_s .2f",
                    "its standard error": "rate_se .2f"} | BOTH,
    "robustness": {"network": "network", "seed": "seed g"} | BOTH,
    "calibration_check": {
        "": "role", "k, N/m": "crossing_stiffness_N_m g", "nu, N s/m": "crossing_damping_Ns_m g",
        "velocity damping, 1/s": "damping_per_s g", "c[P4]": "c_p4 .3f", "c[P7]": "c_p7 .3f",
        "recall, 200 ms": "recall_200ms .3f", "recall, 400 ms": "recall_400ms .3f",
        "misfit": "misfit .2f",
    },
    "speed_accuracy": {
        "setup": "setup", "network": "network", **MESH, "CPU s of a run": "seconds_per_run .3g",
        "error of trajectories": "trajectory_error .2g", "of C_nl": "c_nl_error .2g",
        "of C_m": "c_m_error .2g", "PyElastica's time over this": "speedup_vs_pyelastica .3g",
    },
    "model_ladder": {"change": "change", **MESH, "of trajectories": "trajectory_change .2g",
                     "of C_nl": "c_nl_change .2g", "of C_m": "c_m_change .2g"},
    "stability": {"engine": "engine", "points": "points g", "predicted / found": "between",
                  "stable at the automatic step": "stable g"},
    "energy_drift": {"engine": "engine", "steps": "steps .0e", "drift of energy": "drift .1e"},
    "exudyn": {"network": "network", **MESH, "against": "against", "difference": "difference .1e",
               "error of its own mesh": "mesh_error .1e"},
}  # fmt: skip


def cell(row: pd.Series, what: str) -> str:
    """One cell of a row, where `what` is as in `TABLES`; without a value "–" or "unstable"."""
    column, spec, factor = (*what.split(), *["", 1.0][what.count(" ") :])
    value, error = row[column], row.get(f"{column}_se")
    if pd.isna(value):
        return "unstable" if spec == CAPACITY else NONE
    if spec == CAPACITY:
        return f"{value:.3f}" + ("" if pd.isna(error) else f" ± {error:.3f}")
    return format(value * float(factor), spec) if spec else str(value).replace("|", "\\|")


def claims(tables: Path, old: str = "") -> pd.DataFrame | None:
    """Every claim with the value and the verdict in each setup at hand, and as the old table has
    them in the others, which take hours each; None without any at hand."""
    paths = {setup: tables / setup / "claims.csv" for setup in SETUPS}
    given = {setup: pd.read_csv(path, dtype=str) for setup, path in paths.items() if path.exists()}
    if not given:
        return None
    joined = join(given).drop(columns=["figure", "kind"]).set_index("id")
    kept = parsed(old).reindex(index=joined.index)
    if len(kept.columns):  # a verdict on other words is none on these
        kept.loc[kept["statement"] != joined["statement"]] = None
    of_setups = [name for setup in SETUPS for name in (setup, f"{setup}_verdict")]
    columns = {**kept, **joined}
    order = sorted(columns, key=lambda name: of_setups.index(name) if name in of_setups else -1)
    return pd.DataFrame({name: columns[name] for name in order}).reset_index()


def parsed(table: str) -> pd.DataFrame:
    """A written table of claims as what it was written from; empty of an empty one."""
    lines = [line[2:-2] for line in table.splitlines() if line.startswith("|")]
    rows = [re.split(r"(?<!\\) \| ", line) for line in lines]
    if not rows:
        return pd.DataFrame()
    names = [name.replace(" ", "_") for name in rows[0]]
    frame = pd.DataFrame(rows[2:], columns=names).set_index("id")
    return frame.apply(lambda cells: cells.str.replace("\\|", "|")).replace(NONE, None)


def limits(table: pd.DataFrame) -> pd.DataFrame:
    """The table of stable steps as one row an engine: how far the prediction is from the found."""
    engines = table.assign(stable=table["automatic_step_status"] == "ok").groupby("engine")
    made = engines.agg(points=("ratio", "size"), stable=("stable", "sum"))
    spans = zip(engines["ratio"].min(), engines["ratio"].max())
    made["between"] = [f"{least:.3f} to {most:.3f}" for least, most in spans]
    return made.reset_index()


def read(name: str, tables: Path, old: str = "") -> tuple[pd.DataFrame | None, dict[str, str]]:
    """The frame of a block, None if its table does not exist, and its columns as in `TABLES`."""
    last = name.rsplit("/")[-1]
    if last == "claims":
        frame = claims(tables, old)
        return frame, {} if frame is None else {name.replace("_", " "): name for name in frame}
    kind = "baselines" if last.endswith("_baselines") else last
    if kind not in TABLES:
        raise ValueError(f"table {name!r} is not known; choose one of {', '.join(TABLES)}")
    if not (path := tables / f"{name}.csv").exists():
        return None, {}
    frame = pd.read_csv(path)
    if "topology" in frame:
        n, hatch = frame["n"].astype(str), frame["topology"] == "crosshatch"
        frame["network"] = (n + "x" + n).where(hatch, frame["topology"] + ", N = " + n)
    return limits(frame) if kind == "stability" else frame, TABLES[kind]


def rewrite(page: str, tables: Path) -> tuple[str, list[str]]:
    """A page with its tables anew, and the names of the blocks that were left as they are.

    Raises:
        ValueError: a block without an end, or a table that `TABLES` does not know.
    """
    left = []

    def block(match: re.Match) -> str:
        name, old = match.groups()
        if START in old:
            raise ValueError(f"the block of table {name!r} does not end with a line {END}")
        frame, columns = read(name, tables, old)
        if frame is None:
            left.append(name)
            return match[0]
        rows = [list(columns), ["---"] * len(columns)]
        rows += [[cell(row, what) for what in columns.values()] for _, row in frame.iterrows()]
        lines = "".join(f"| {' | '.join(row)} |\n" for row in rows)
        return f"{START} {name} -->\n\n{lines}\n{END}"

    return BLOCK.sub(block, page), left


def main(results: str = "results", docs: Path = DOCS) -> None:
    """Write every page whose tables changed."""
    tables = Path(results) / "tables"
    for path in sorted(docs.glob("*.md")):
        old = path.read_text(encoding="utf-8")
        new, left = rewrite(old, tables)
        for name in left:
            print(f"{path.name}: {name} stays as it is, because {tables} does not have it")
        if new != old:
            path.write_text(new, encoding="utf-8")
            print(f"{path.name}: written")


if __name__ == "__main__":
    main(*sys.argv[1:2])
