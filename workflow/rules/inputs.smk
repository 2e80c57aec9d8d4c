# What the rules of studies, claims and recordings take as input and parameters, by what
# `fiberweb.studies` and the config say.


def all_cores(wildcards):
    """Asked for by the job alone: `--unlock`, `--summary` and others are given no `--cores`."""
    return workflow.cores


def made_in(study, setup):
    """The study; one sentence if it does not run in the setup."""
    if studies.setups(study) and setup not in studies.setups(study):
        raise WorkflowError(f"the study {study} does not run in the {setup} setup")
    return study


def of_runs(file, runs):
    return [FILES.of_run(run, file) for run in runs]


def table_made(wildcards):
    """(the section, the `Table`, the runs that it is made of)"""
    study = made_in(FILES.tables[wildcards.table], wildcards.setup)
    section, spec = getattr(CONFIG, study), studies.load(study).TABLES[wildcards.table]
    return section, spec, spec.runs(study_runs(study, wildcards.setup), section)


def table_input(wildcards):
    _, spec, chosen = table_made(wildcards)
    certified = RECIPES.certified(spec, chosen)
    return {
        "tables": [FILES.table(file, wildcards.setup) for file in spec.tables],
        "capacities": of_runs("capacity.nc", chosen if spec.capacities else []),
        "certificates": of_runs("certificate.csv", certified),
        "responses": of_runs("response.nc", chosen if spec.responses else []),
    }


def table_options(wildcards):
    section, spec, chosen = table_made(wildcards)
    choices = {"choices": [run.choice for run in chosen]} if spec.choices else {}
    return spec.options(section, chosen) | choices


def figure_made(wildcards):
    """(the study, the `Figure`, the setup)"""
    setup = SETUP_OF[wildcards.suffix]
    study = made_in(FILES.figures[wildcards.figure], setup)
    return study, studies.load(study).FIGURES[wildcards.figure], setup


def figure_input(wildcards):
    study, spec, setup = figure_made(wildcards)
    return {
        "given": [FILES.table(file, setup) for file in spec.given],
        "responses": of_runs("response.nc", study_runs(study, setup) if spec.responses else []),
    }


def figure_options(wildcards):
    study, spec, _ = figure_made(wildcards)
    return spec.options(getattr(CONFIG, study))


def cards(wildcards):
    """All that is made of the recordings."""
    if not RECORDED:
        raise WorkflowError("the config lists no recordings: docs/recordings.md says how it does")
    files = ("sanity.csv", "card.csv", "card.json", "card.png")
    return [f"{RESULTS}/recordings/{name}/{file}" for name in RECORDED for file in files]


def recorded_file(wildcards):
    """The file of a recording; none where it is not there, which the job then says."""
    path = RECORDED[wildcards.recording].path
    return [*make_whole(wildcards), *([str(path)] if path.exists() else [])]
