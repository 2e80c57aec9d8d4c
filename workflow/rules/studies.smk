# What most studies have in common: a table out of the capacities of their runs, a figure out of
# their tables, and the checkpoint that finds the best force of each spacing.

SCORED = ("ridge", "size", "pretension", "memory_origin", "chaos", "robustness", "buckling")
TABLES |= {study: [study] for study in SCORED}
TABLES["ridge"] = ["ridge", "ridge_onset"]
TABLES["calibration"] = ["calibration", "calibration_check"]
# which tables each figure is drawn from; every study named here has a module fiberweb.plotting.X
DRAWN_FROM = {
    "ridge": ["ridge", "ridge_onset", "ridge_floors"],
    "size": ["size", "ridge_floors"],
    "pretension": ["pretension", "ridge_floors"],
    "memory_origin": ["memory_origin", "memory_origin_floors"],
    "calibration": ["calibration", "calibration_check", "ridge_floors"],
    "noise": ["noise", "noise_floors"],
    "chaos": ["chaos_rates", "chaos_separations", "chaos_floors"],
    "robustness": ["robustness", "robustness_alpha", "robustness_floors"],
}
DRAWN = ["topology", *DRAWN_FROM]


rule study_table:
    input:
        code=code("buckling.py", "capacity.py", "dataset.py", "network.py", "scene.py", "tables.py"),
        capacities=lambda wildcards: capacities(wildcards.study, wildcards.setup),
    output:
        "<results>/tables/{setup}/{study}.csv",
    log:
        "<logs>/{study}/table-{setup}.log",
    benchmark:
        "<benchmarks>/{study}/table-{setup}.tsv"
    wildcard_constraints:
        study="|".join(SCORED),
    conda:
        "../../envs/environment.yaml"
    params:
        choices=lambda wildcards: [
            run.choice for run in study_runs(wildcards.study, wildcards.setup)
        ],
    message:
        "Table of the study {wildcards.study}, {wildcards.setup}"
    script:
        "../scripts/study_table.py"


rule calibration_table:
    input:
        code=code(
            "buckling.py",
            "calibration.py",
            "capacity.py",
            "claims*.py",
            "claims.yaml",
            "dataset.py",
            "network.py",
            "scene.py",
            "tables.py",
        ),
        capacities=lambda wildcards: capacities("calibration", wildcards.setup),
    output:
        "<results>/tables/{setup}/calibration.csv",
    log:
        "<logs>/calibration/table-{setup}.log",
    benchmark:
        "<benchmarks>/calibration/table-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    message:
        "Table of the study calibration, {wildcards.setup}"
    script:
        "../scripts/calibration_table.py"


rule calibration_best:
    input:
        code=code(
            "buckling.py",
            "calibration.py",
            "claims*.py",
            "claims.yaml",
            "network.py",
            "scene.py",
            "tables.py",
        ),
        table="<results>/tables/{setup}/calibration.csv",
    output:
        "<results>/tables/{setup}/calibration_check.csv",
    log:
        "<logs>/calibration/best-{setup}.log",
    benchmark:
        "<benchmarks>/calibration/best-{setup}.tsv"
    localrule: True
    conda:
        "../../envs/environment.yaml"
    message:
        "Holding the described setup's defaults against the grid's best point"
    script:
        "../scripts/calibration_best.py"


checkpoint ridge_best:
    input:
        code=code("tables.py"),
        ridge="<results>/tables/{setup}/ridge.csv",
    output:
        "<results>/tables/{setup}/ridge_best.csv",
    log:
        "<logs>/ridge/best-{setup}.log",
    benchmark:
        "<benchmarks>/ridge/best-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    message:
        "Looking for the best unbuckled force of each spacing, {wildcards.setup}"
    script:
        "../scripts/ridge_best.py"


rule ridge_onset:
    input:
        code=code("onset.py", "tables.py"),
        ridge="<results>/tables/{setup}/ridge.csv",
    output:
        "<results>/tables/{setup}/ridge_onset.csv",
    log:
        "<logs>/ridge/onset-{setup}.log",
    benchmark:
        "<benchmarks>/ridge/onset-{setup}.tsv"
    localrule: True
    conda:
        "../../envs/environment.yaml"
    message:
        "Looking for where the capacities drop, {wildcards.setup}"
    script:
        "../scripts/ridge_onset.py"


rule study_floors:
    input:
        code=code("capacity.py", "dataset.py", "ridge.py", "tables.py"),
        response=lambda wildcards: responses(wildcards.study, wildcards.setup)[0],
    output:
        "<results>/tables/{setup}/{study}_floors.csv",
    log:
        "<logs>/{study}/floors-{setup}.log",
    benchmark:
        "<benchmarks>/{study}/floors-{setup}.tsv"
    wildcard_constraints:
        study="ridge|memory_origin|noise|chaos|robustness",
    conda:
        "../../envs/environment.yaml"
    params:
        scoring={"alpha": CONFIG.scoring.alpha},
    message:
        "What readouts of the input alone would score, {wildcards.study}, {wildcards.setup}"
    script:
        "../scripts/study_floors.py"


rule study_figure:
    input:
        code=lambda wildcards: code(
            "buckling.py",
            "plotting/__init__.py",
            "plotting/parts.py",
            "plotting/style.py",
            "plotting/sweep.py",
            f"plotting/{wildcards.study}.py",
        ),
        tables=lambda wildcards: [
            f"<results>/tables/{'published' if wildcards.suffix else 'described'}/{table}.csv"
            for table in DRAWN_FROM[wildcards.study]
        ],
    output:
        png=report(
            "<results>/figures/{study}{suffix}.png",
            caption="../report/{study}.rst",
            category="Figures",
        ),
        pdf="<results>/figures/{study}{suffix}.pdf",
    log:
        "<logs>/{study}/figure{suffix}.log",
    benchmark:
        "<benchmarks>/{study}/figure{suffix}.tsv"
    wildcard_constraints:
        study="|".join(DRAWN_FROM),
    conda:
        "../../envs/environment.yaml"
    params:
        setup=lambda wildcards: "published" if wildcards.suffix else "described",
    message:
        "Drawing {output.png}"
    script:
        "../scripts/study_figure.py"
