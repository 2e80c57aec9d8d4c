"""Where the workflow's files lie among the results."""

from __future__ import annotations

import inspect
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from fiberweb import studies
from fiberweb.config import Config
from fiberweb.errors import unknown_key
from fiberweb.model.scene import SETUPS
from fiberweb.products import function
from fiberweb.recipes import BEST, SCRIPTS
from fiberweb.runs import Run

CALLS = "report/provenance.html"
SUFFIXES = {setup: f"-{setup}" for setup in SETUPS} | {"described": ""}  # of figures


class Files:
    """The paths under one config.

    Attributes:
        results: folder of all.
        tables, figures: which study makes each, by name.
        animations: what a rule of its own makes of the study `buckling`.

    Raises:
        ValueError: a table or a figure is made of a file that no study makes; one sentence.
    """

    def __init__(self, config: Config):
        self.results = config.results
        self.tables, self.figures = studies.makers("TABLES"), studies.makers("FIGURES")
        self._of_no_setup = {file for job in studies.load("accuracy").JOBS.values() for file in job}
        known = [*self.tables, *self._of_no_setup, BEST]
        for study in map(studies.load, studies.STUDIES):
            used = [file for spec in study.TABLES.values() for file in spec.tables]
            used += [file for spec in study.FIGURES.values() for file in spec.given]
            for file in set(used) - set(known):
                raise ValueError(f"no study makes the table {file}: {unknown_key(file, known)}")
        numbers = dict.fromkeys(config.buckling.buckling)
        self.animations = [f"{self.results}/figures/buckling-B{b:g}.gif" for b in numbers]

    def compiled(self, engine: str) -> str:
        """The mark that an engine is compiled."""
        return f"{self.results}/warmup/{engine}.done"

    def of_run(self, run: Run, file: str) -> str:
        """A file of a run, such as "response.nc"."""
        return f"{self.results}/runs/{run.name}/{file}"

    def table(self, file: str, setup: str) -> str:
        """A file of a study's `TABLES`, of a setup; or, of none, one of the study `accuracy`."""
        return f"{self.results}/tables/{'' if file in self._of_no_setup else f'{setup}/'}{file}"

    def figure(self, name: str, setup: str) -> str:
        """The picture of a figure in a setup."""
        return f"{self.results}/figures/{name}{SUFFIXES[setup]}.png"

    def drawn(self, study: str, setup: str) -> list[str]:
        """All figures and tables of a study in one setup."""
        spec = studies.load(study)
        figures = [self.figure(name, setup) for name in spec.FIGURES]
        tables = [self.table(file, setup) for file in spec.TABLES]
        return figures + tables + (self.animations if study == "buckling" else [])

    def products(self, setup: str) -> list[str]:
        """All figures, tables and claims of one setup."""
        taking_part = [study for study in studies.STUDIES if setup in studies.setups(study)]
        files = [file for study in taking_part for file in self.drawn(study, setup)]
        return [*files, f"{self.results}/tables/{setup}/claims.csv"]

    def reported(self, setup: str) -> list[str]:
        """`products`, and a page for each that the report cannot show as it is."""
        made = self.products(setup)
        waiting = any(studies.waits(study, setup) for study in studies.STUDIES)
        shown = [*made, *([self.table(BEST, setup)] if waiting else [])]
        names = [Path(file).relative_to(self.results).as_posix() for file in shown]
        pages = [f"{self.results}/report/{name}.html" for name in names if name[-4:] != ".png"]
        return made + pages

    def calls(self) -> list[str]:
        """The page of what made the results, if there is one."""
        page = Path(self.results, CALLS)
        return [str(page)] if page.exists() else []

    def about(self, file: str) -> tuple[str, str]:
        """Category and caption of a page, by the path among the results of what it shows; of a
        table, what the function that makes it says of itself first."""
        name = Path(file).name
        if name.endswith(".gif"):
            return "Animations", studies.caption("buckling", "described")
        if name == "claims.csv":
            return "Claims", (SCRIPTS.parent / "report" / "claims.rst").read_text("utf-8")
        make = "fiberweb.studies.ridge.best:best_unbuckled"
        if name != BEST:
            make = studies.load(self.tables[name]).TABLES[name].make
        return "Tables", inspect.getdoc(function(make)).partition("\n\n")[0]

    def counted(self, made: Iterable[str]) -> str:
        """How many of these files lie in each folder; those of all runs are counted as one."""
        runs = Path(self.results, "runs")
        folders = Counter(
            runs if runs in Path(file).parents else Path(file).parent for file in made
        )
        return ", ".join(f"{n} file{'s' * (n > 1)} in {at}" for at, n in sorted(folders.items()))
