# The features study (Fig. 4): groups of readouts, and the fewest signals that keep a capacity.

TABLES["features"] = ["features", "features_greedy"]
DRAWN.append("features")


rule features:
    input:
        figure("features", "described"),
        [f"<results>/tables/{table}.csv" for table in TABLES["features"]],


rule features_groups:
    input:
        code=code(
            "buckling.py",
            "capacity.py",
            "dataset.py",
            "features.py",
            "groups.py",
            "network.py",
            "ridge.py",
            "scene.py",
            "selection.py",
            "tables.py",
        ),
        capacities=lambda wildcards: capacities("features", wildcards.setup),
        responses=lambda wildcards: responses("features", wildcards.setup),
    output:
        table="<results>/tables/{setup}/features.csv",
        floors="<results>/tables/{setup}/features_floors.csv",
    log:
        "<logs>/features/groups-{setup}.log",
    benchmark:
        "<benchmarks>/features/groups-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        alpha=CONFIG.features.alpha,
        verdict_force=CONFIG.features.verdict_force,
        choices=lambda wildcards: [run.choice for run in study_runs("features", wildcards.setup)],
    message:
        "Scoring groups of readouts, {wildcards.setup}"
    script:
        "../scripts/features_groups.py"


rule features_greedy:
    input:
        code=code(
            "buckling.py",
            "capacity.py",
            "dataset.py",
            "features.py",
            "groups.py",
            "network.py",
            "ridge.py",
            "scene.py",
            "selection.py",
            "tables.py",
        ),
        response=lambda wildcards: verdict_response(wildcards.setup),
    output:
        "<results>/tables/{setup}/features_greedy.csv",
    log:
        "<logs>/features/greedy-{setup}.log",
    benchmark:
        "<benchmarks>/features/greedy-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        alpha=CONFIG.features.alpha,
        share=CONFIG.features.share,
    message:
        "Looking for the fewest signals, {wildcards.setup}"
    script:
        "../scripts/features_greedy.py"


rule features_figure:
    input:
        code=code(
            "groups.py",
            "network.py",
            "plotting/__init__.py",
            "plotting/features.py",
            "plotting/parts.py",
            "plotting/style.py",
            "plotting/sweep.py",
            "tables.py",
        ),
        table=of_setup("features.csv"),
        greedy=of_setup("features_greedy.csv"),
        floors=of_setup("features_floors.csv"),
    output:
        png=report(
            "<results>/figures/features{suffix}.png",
            caption="../report/features.rst",
            category="Figures",
        ),
        pdf="<results>/figures/features{suffix}.pdf",
    log:
        "<logs>/features/figure{suffix}.log",
    benchmark:
        "<benchmarks>/features/figure{suffix}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        setup=lambda wildcards: "published" if wildcards.suffix else "described",
    message:
        "Drawing {output.png}"
    script:
        "../scripts/features_figure.py"
