"""What each file of the workflow rests on, as one digest: the code and the options that make it,
and the same of all that it is made of.

Each rule has this digest among its params, so that a file is made again when anything changed that
it hangs on, however far away. Snakemake's own records do not see to that: of a job that dies they
keep the new inputs as if it had ended, and its output is deleted; what hangs on a change only
through the deleted file then looks up to date, and the old figure stays.
"""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from fiberweb import source, studies
from fiberweb.config import Config
from fiberweb.folders import tables_in
from fiberweb.model.scene import SETUPS
from fiberweb.runs import Run, runs
from fiberweb.studies.base import Table

SCRIPTS = source.ROOT.parent / "workflow" / "scripts"
BEST = "ridge_best.csv"  # of a setup, like a study's table, but made by a checkpoint


def digest_of(*parts: object) -> str:
    """Digest of what is the same whenever it prints the same."""
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:16]


@cache
def code(script: str, *names: str) -> str:
    """Digest of a script and of the code that modules or functions depend on; a comment or the
    layout of code does not change it."""
    return source.digest(*names, script=SCRIPTS / f"{script}.py")


def of_recording() -> str:
    """Of any recording, whose file and options are looked at beside it."""
    return code("recording", "fiberweb.recordings.read", "fiberweb.products")


def of_card(read: dict) -> str:
    """Of the score card of a recording that was read with these options."""
    made_by = code("card", "fiberweb.scoring.card", "fiberweb.figures.card", "fiberweb.products")
    return digest_of(made_by, of_recording(), read)


class Recipes:
    """The digests under one config."""

    def __init__(self, config: Config, table: dict[str, Run]):
        self._config, self._runs = config, table
        self._makers = {kind: studies.makers(kind) for kind in ("TABLES", "FIGURES")}
        self._jobs = studies.load("accuracy").JOBS
        # of hundreds of runs, each asked for by several tables
        self.response, self.capacity = cache(self.response), cache(self.capacity)
        self.certificate = cache(self.certificate)
        self.possible = cache(self.possible)

    def possible(self, study: str, setup: str) -> list[Run]:
        """The runs of a study, with every force that the ridge may find best: these are known
        before the checkpoint is there."""
        return runs(self._config, study, setup)

    def response(self, run: str) -> str:
        """Of a run by its name."""
        made_by = code("simulate", source.RUN, "fiberweb.simulation.dataset")
        return digest_of(made_by, self._runs[run].request)

    def capacity(self, run: str) -> str:
        """Of a run by its name."""
        made_by = code("capacity", "fiberweb.scoring.capacity", "fiberweb.simulation.dataset")
        return digest_of(made_by, self._runs[run].scoring, self.response(run))

    def certified(self, spec: Table, chosen: Sequence[Run]) -> Sequence[Run]:
        """Those of a table's runs whose certificates it is given."""
        return chosen if spec.certificates and self._config.certify else []

    def certificate(self, run: str) -> str:
        """Of a run by its name."""
        made_by = code("certificate", "fiberweb.validation.certificate", "fiberweb.products")
        return digest_of(made_by, self._runs[run].scoring, self.response(run))

    def table(self, file: str, setup: str) -> str:
        """Of any table, by its file name."""
        if file == BEST:
            made_by = code("table", "fiberweb.studies.ridge.best", "fiberweb.products")
            return digest_of(made_by, self.table("ridge.csv", setup))
        for job, made in self._jobs.items():
            if file in made:
                return self.measured(job)
        study = self._makers["TABLES"][file]
        section, spec = getattr(self._config, study), studies.load(study).TABLES[file]
        chosen = spec.runs(self.possible(study, setup), section)
        names = [run.name for run in chosen]
        return digest_of(
            code("table", spec.make, "fiberweb.products"),
            (spec.make, spec.single, spec.options(section, chosen)),
            [run.choice for run in chosen] if spec.choices else [],
            self._choice(study, setup),
            [self.table(given, setup) for given in spec.tables],
            [self.capacity(name) for name in names] if spec.capacities else [],
            [self.response(name) for name in names] if spec.responses else [],
            [self.certificate(run.name) for run in self.certified(spec, chosen)],
        )

    def measured(self, job: str) -> str:
        """Of the tables of a job of the study `accuracy`, by its name."""
        tables = self._jobs[job].values()
        return digest_of(
            code("measure", *[spec.make for spec in tables], "fiberweb.products"),
            [(spec.make, spec.options(self._config.accuracy, [])) for spec in tables],
            [self.table(given, "") for spec in tables for given in spec.tables],
        )

    def figure(self, name: str, setup: str) -> str:
        """Of a figure."""
        study = self._makers["FIGURES"][name]
        spec = studies.load(study).FIGURES[name]
        return digest_of(
            code("figure", spec.draw, "fiberweb.products"),
            (spec.draw, spec.options(getattr(self._config, study))),
            [self.table(file, setup) for file in spec.given],
            self.responses(study, setup) if spec.responses else "",
        )

    def responses(self, study: str, setup: str) -> str:
        """Of all responses of a study."""
        names = [run.name for run in self.possible(study, setup)]
        return digest_of(self._choice(study, setup), [self.response(name) for name in names])

    def claims(self, setup: str) -> str:
        """Of the claims of a setup."""
        published = tables_in(self._config.published_tables)
        return digest_of(
            code("claims", "fiberweb.claims.judge", "fiberweb.products", *studies.claims()),
            [self.table(file, setup) for file in studies.judged_by(setup)],
            [hashlib.sha256(Path(path).read_bytes()).hexdigest() for path in published],
        )

    def joined_claims(self) -> str:
        """Of the claims of all setups side by side."""
        return digest_of(
            code("join_claims", "fiberweb.claims.judge", "fiberweb.products"),
            [self.claims(setup) for setup in SETUPS],
        )

    def animations(self) -> str:
        """Of the animations of the study `buckling`."""
        section = self._config.buckling
        return digest_of(
            code("animation", "fiberweb.studies.buckling.figure", "fiberweb.products"),
            (section.seconds, section.frame_rate),
            self.responses("buckling", "described"),
        )

    def page(self, file: str) -> str:
        """Of a page of the report, by the path among the results of what it shows."""
        _, *setup, name = file.split("/")
        if name.endswith(".gif"):
            shown = self.animations()
        else:
            shown = self.claims(*setup) if name == "claims.csv" else self.table(name, *setup)
        return digest_of(code("page", "fiberweb.pages"), shown)

    def _choice(self, study: str, setup: str) -> str:
        """Of what chooses a study's runs from the possible ones."""
        if not studies.waits(study, setup):
            return ""
        return digest_of(code("table", f"fiberweb.studies.{study}"), self.table(BEST, setup))
