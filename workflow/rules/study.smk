# Every study's tables and figures, by what `fiberweb.studies` says of them, and a target of each
# study's name.


rule table:
    input:
        unpack(table_input),
    output:
        "<results>/tables/{setup}/{table}",
    log:
        "<logs>/tables/{setup}-{table}.log",
    conda:
        "../../envs/environment.yaml"
    params:
        make=lambda wildcards: table_made(wildcards)[1].make,
        single=lambda wildcards: table_made(wildcards)[1].single,
        options=table_options,
        recipe=lambda wildcards: RECIPES.table(wildcards.table, wildcards.setup),
    message:
        "Making {output}"
    script:
        "../scripts/table.py"


checkpoint ridge_best:
    input:
        tables="<results>/tables/{setup}/ridge.csv",
    output:
        "<results>/tables/{setup}/ridge_best.csv",
    log:
        "<logs>/tables/{setup}-ridge_best.csv.log",
    conda:
        "../../envs/environment.yaml"
    params:
        make="fiberweb.studies.ridge.best:best_unbuckled",
        single=False,
        options={},
        recipe=lambda wildcards: RECIPES.table(BEST, wildcards.setup),
    message:
        "Looking for the best unbuckled force of each spacing, {wildcards.setup}"
    script:
        "../scripts/table.py"


rule figure:
    input:
        unpack(figure_input),
    output:
        png=report(
            "<results>/figures/{figure}{suffix}.png",
            caption="../report/figure.rst",  # shows params.caption
            category=lambda wildcards: figure_made(wildcards)[1].category,
            labels={"figure": "{figure}{suffix}"},
        ),
        pdf="<results>/figures/{figure}{suffix}.pdf",
    log:
        "<logs>/figures/{figure}{suffix}.log",
    conda:
        "../../envs/environment.yaml"
    params:
        draw=lambda wildcards: figure_made(wildcards)[1].draw,
        setup=lambda wildcards: SETUP_OF[wildcards.suffix],
        options=figure_options,
        caption=lambda wildcards: studies.caption(wildcards.figure, SETUP_OF[wildcards.suffix]),
        recipe=lambda wildcards: RECIPES.figure(wildcards.figure, SETUP_OF[wildcards.suffix]),
    message:
        "Drawing {output.png}"
    script:
        "../scripts/figure.py"
