# What the rules of studies and claims take as input and parameters, by what `fiberweb.studies` says.


def all_cores(wildcards):
    """Asked for by the job alone: `--unlock`, `--summary` and others are given no `--cores`."""
    return workflow.cores


def made_in(study, setup):
    """The study; one sentence if it does not run in the setup."""
    if studies.setups(study) and setup not in studies.setups(study):
        raise WorkflowError(f"the study {study} does not run in the {setup} setup")
    return study


def table_spec(file, possible):
    """(the section, the `Table`, those of the study's runs that it is made of)"""
    study = TABLES[file]
    section, spec = getattr(CONFIG, study), studies.load(study).TABLES[file]
    return section, spec, spec.runs(possible, section)


def table_made(wildcards):
    """`table_spec` of the table that a job makes."""
    study = made_in(TABLES[wildcards.table], wildcards.setup)
    return table_spec(wildcards.table, study_runs(study, wildcards.setup))


def table_input(wildcards):
    _, spec, chosen = table_made(wildcards)
    files = {"tables": [table(file, wildcards.setup) for file in spec.tables]}
    files["capacities"] = [capacity(run) for run in chosen] if spec.capacities else []
    files["responses"] = [response(run) for run in chosen] if spec.responses else []
    return files


def table_options(wildcards):
    section, spec, chosen = table_made(wildcards)
    choices = {"choices": [run.choice for run in chosen]} if spec.choices else {}
    return spec.options(section, chosen) | choices


def figure_spec(name, setup):
    study = made_in(FIGURES[name], setup)
    return study, studies.load(study).FIGURES[name]


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


def figure_made(wildcards):
    """`figure_spec` of the figure that a job draws."""
    return figure_spec(wildcards.figure, SETUP_OF[wildcards.suffix])


def figure_options(wildcards):
    study, spec = figure_made(wildcards)
    return spec.options(getattr(CONFIG, study))


def judged(setup):
    """The tables that the rules of the claims read, of the studies that the setup runs."""
    return [
        file
        for study in studies.STUDIES
        if setup in studies.setups(study)
        for file in getattr(studies.load(study), "JUDGED_BY", ())
    ]


def authors_tables():
    folder = CONFIG.published_tables
    return sorted(glob(f"{folder}/*.csv")) if folder else []
