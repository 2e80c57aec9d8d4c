# Every study's tables and figures, by what `fiberweb.studies` says of them, and a target of each
# study's name.


def table_spec(wildcards):
    """(the section, the `Table`, the runs that it is made of)"""
    study = TABLES[wildcards.table]
    section, spec = getattr(CONFIG, study), studies.load(study).TABLES[wildcards.table]
    return section, spec, spec.runs(study_runs(study, wildcards.setup), section)


def table_input(wildcards):
    _, spec, chosen = table_spec(wildcards)
    files = {"code": code(spec.make, "fiberweb.products")}
    files["tables"] = [table(file, wildcards.setup) for file in spec.tables]
    files["capacities"] = [capacity(run) for run in chosen] if spec.capacities else []
    files["responses"] = [response(run) for run in chosen] if spec.responses else []
    return files


def table_options(wildcards):
    section, spec, chosen = table_spec(wildcards)
    choices = {"choices": [run.choice for run in chosen]} if spec.choices else {}
    return spec.options(section, chosen) | choices


rule table:
    input:
        unpack(table_input),
    output:
        "<results>/tables/{setup}/{table}",
    log:
        "<logs>/tables/{setup}-{table}.log",
    benchmark:
        "<benchmarks>/tables/{setup}-{table}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        make=lambda wildcards: table_spec(wildcards)[1].make,
        single=lambda wildcards: table_spec(wildcards)[1].single,
        options=table_options,
    message:
        "Making {output}"
    script:
        "../scripts/table.py"


checkpoint ridge_best:
    input:
        code=code("fiberweb.studies.ridge.best", "fiberweb.products"),
        tables="<results>/tables/{setup}/ridge.csv",
    output:
        "<results>/tables/{setup}/ridge_best.csv",
    log:
        "<logs>/tables/{setup}-ridge_best.csv.log",
    benchmark:
        "<benchmarks>/tables/{setup}-ridge_best.csv.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        make="fiberweb.studies.ridge.best:best_unbuckled",
        single=False,
        options={},
    message:
        "Looking for the best unbuckled force of each spacing, {wildcards.setup}"
    script:
        "../scripts/table.py"


def figure_spec(wildcards):
    study = FIGURES[wildcards.figure]
    return study, studies.load(study).FIGURES[wildcards.figure]


def caption(study, spec, setup):
    """What the report says beneath a figure."""
    text = Path(studies.load(study).__file__).with_name(spec.caption).read_text()
    return text.replace("{{ setup }}", setup)


def figure_input(wildcards):
    study, spec = figure_spec(wildcards)
    setup = SETUP_OF[wildcards.suffix]
    return {
        "code": code(spec.draw, "fiberweb.products"),
        "given": [table(file, setup) for file in spec.given],
        "responses": [response(run) for run in study_runs(study, setup)] if spec.responses else [],
    }


rule figure:
    input:
        unpack(figure_input),
    output:
        png=report(
            "<results>/figures/{figure}{suffix}.png",
            caption="../report/figure.rst",  # shows params.caption
            category=lambda wildcards: figure_spec(wildcards)[1].category,
        ),
        pdf="<results>/figures/{figure}{suffix}.pdf",
    log:
        "<logs>/figures/{figure}{suffix}.log",
    benchmark:
        "<benchmarks>/figures/{figure}{suffix}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        draw=lambda wildcards: figure_spec(wildcards)[1].draw,
        setup=lambda wildcards: SETUP_OF[wildcards.suffix],
        options=lambda wildcards: figure_spec(wildcards)[1].options(
            getattr(CONFIG, FIGURES[wildcards.figure])
        ),
        caption=lambda wildcards: caption(*figure_spec(wildcards), SETUP_OF[wildcards.suffix]),
    message:
        "Drawing {output.png}"
    script:
        "../scripts/figure.py"
