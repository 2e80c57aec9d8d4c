# The NARMA task on simulated networks (Fig. 6): responses to estimates, a table and a figure.

TABLES["narma"] = ["narma"]
DRAWN.append("narma")


rule narma:
    input:
        figure("narma", "described"),
        [f"<results>/tables/{table}.csv" for table in TABLES["narma"]],


rule narma_tables:
    input:
        code=code(
            "buckling.py",
            "capacity.py",
            "dataset.py",
            "esn.py",
            "narma.py",
            "network.py",
            "ridge.py",
            "scene.py",
            "tables.py",
        ),
        responses=lambda wildcards: responses("narma", wildcards.setup),
        capacities=lambda wildcards: capacities("narma", wildcards.setup),
    output:
        table="<results>/tables/{setup}/narma.csv",
        errors="<results>/tables/{setup}/narma_errors.nc",
    log:
        "<logs>/narma/tables-{setup}.log",
    benchmark:
        "<benchmarks>/narma/tables-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        task={
            "orders": CONFIG.narma.order,
            "rate": CONFIG.narma.rate,
            "alpha": CONFIG.narma.alpha,
        },
        choices=lambda wildcards: [run.choice for run in study_runs("narma", wildcards.setup)],
    message:
        "Tables of the NARMA task, {wildcards.setup}"
    script:
        "../scripts/narma_tables.py"


rule narma_figure:
    input:
        code=code(
            "dataset.py",
            "plotting/__init__.py",
            "plotting/narma.py",
            "plotting/parts.py",
            "plotting/style.py",
            "plotting/sweep.py",
            "tables.py",
        ),
        table=of_setup("narma.csv"),
        errors=of_setup("narma_errors.nc"),
    output:
        png=report(
            "<results>/figures/narma{suffix}.png",
            caption="../report/narma.rst",
            category="Figures",
        ),
        pdf="<results>/figures/narma{suffix}.pdf",
    log:
        "<logs>/narma/figure{suffix}.log",
    benchmark:
        "<benchmarks>/narma/figure{suffix}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        setup=lambda wildcards: "published" if wildcards.suffix else "described",
    message:
        "Drawing {output.png}"
    script:
        "../scripts/narma_figure.py"
