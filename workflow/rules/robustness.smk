# Capacities against the ridge penalty, of the first seed's runs.

TABLES["robustness"] = ["robustness", "robustness_alpha"]


rule robustness_alpha:
    input:
        code=code(
            "buckling.py",
            "capacity.py",
            "dataset.py",
            "network.py",
            "ridge.py",
            "robustness.py",
            "scene.py",
            "tables.py",
        ),
        responses=lambda wildcards: [response(run) for run in first_seed(wildcards.setup)],
    output:
        "<results>/tables/{setup}/robustness_alpha.csv",
    log:
        "<logs>/robustness/alpha-{setup}.log",
    benchmark:
        "<benchmarks>/robustness/alpha-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        choices=lambda wildcards: [run.choice for run in first_seed(wildcards.setup)],
        alpha=CONFIG.robustness.alpha,
    message:
        "Scoring with other ridge penalties, {wildcards.setup}"
    script:
        "../scripts/robustness_alpha.py"
