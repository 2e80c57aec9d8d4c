# What the rules of studies, claims and recordings take as input and parameters, by what
# `fiberweb.studies` and the config say.

import csv


def all_cores(wildcards):
    """Asked for by the job alone: `--unlock`, `--summary` and others are given no `--cores`."""
    return workflow.cores


def made_in(study, setup):
    """The study; one sentence if it does not run in the setup."""
    if studies.setups(study) and setup not in studies.setups(study):
        raise WorkflowError(f"the study {study} does not run in the {setup} setup")
    return study


def table_made(wildcards):
    """(the section, the `Table`, the runs that it is made of)"""
    study = made_in(TABLES[wildcards.table], wildcards.setup)
    section, spec = getattr(CONFIG, study), studies.load(study).TABLES[wildcards.table]
    return section, spec, spec.runs(study_runs(study, wildcards.setup), section)


def table_input(wildcards):
    _, spec, chosen = table_made(wildcards)
    files = {"tables": [table(file, wildcards.setup) for file in spec.tables]}
    files["capacities"] = [capacity(run) for run in chosen] if spec.capacities else []
    files["certificates"] = [certificate(run) for run in RECIPES.certified(spec, chosen)]
    files["responses"] = [response(run) for run in chosen] if spec.responses else []
    return files


def table_options(wildcards):
    section, spec, chosen = table_made(wildcards)
    choices = {"choices": [run.choice for run in chosen]} if spec.choices else {}
    return spec.options(section, chosen) | choices


def figure_made(wildcards):
    """(the study, the `Figure`)"""
    study = made_in(FIGURES[wildcards.figure], SETUP_OF[wildcards.suffix])
    return study, studies.load(study).FIGURES[wildcards.figure]


def caption(study, spec, setup):
    """What the report says beneath a figure."""
    text = Path(studies.load(study).__file__).with_name(spec.caption).read_text()
    return text.replace("{{ setup }}", setup)


def figure_input(wildcards):
    (study, spec), setup = figure_made(wildcards), SETUP_OF[wildcards.suffix]
    return {
        "given": [table(file, setup) for file in spec.given],
        "responses": [response(run) for run in study_runs(study, setup)] if spec.responses else [],
    }


def figure_options(wildcards):
    study, spec = figure_made(wildcards)
    return spec.options(getattr(CONFIG, study))


def authors_tables():
    folder = CONFIG.published_tables
    return sorted(glob(f"{folder}/*.csv")) if folder else []


def cards(wildcards):
    """All that is made of the recordings."""
    if not RECORDED:
        raise WorkflowError("the config lists no recordings: docs/recordings.md says how it does")
    files = ("sanity.csv", "card.csv", "card.json", "card.png")
    return [f"{RESULTS}/recordings/{name}/{file}" for name in RECORDED for file in files]


def recorded_file(wildcards):
    """The file of a recording; none where it is not there, which the job then says."""
    path = RECORDED[wildcards.recording].path
    return [str(path)] if path.exists() else []


def found_in_recordings():
    """What is not in order with the recordings that this call read, a line each; their logs have
    all that was looked at."""
    done = [job for job in workflow.dag.finished_jobs if job.rule.name == "recording"]
    for job in sorted(done, key=lambda job: job.wildcards.recording):
        with open(job.output.sanity, encoding="utf-8", newline="") as file:
            for row in csv.DictReader(file):
                if row["severity"] != "ok":
                    yield f"{job.wildcards.recording}: {row['severity']}: {row['sentence']}"
