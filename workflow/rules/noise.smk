# Capacities against readout noise. The runs are those of the topology study.

TABLES["noise"] = ["noise"]


rule noise_table:
    input:
        code=code(
            "buckling.py",
            "capacity.py",
            "dataset.py",
            "network.py",
            "noise.py",
            "ridge.py",
            "scene.py",
            "tables.py",
        ),
        responses=lambda wildcards: responses("noise", wildcards.setup),
    output:
        "<results>/tables/{setup}/noise.csv",
    log:
        "<logs>/noise/table-{setup}.log",
    benchmark:
        "<benchmarks>/noise/table-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        choices=lambda wildcards: [run.choice for run in study_runs("noise", wildcards.setup)],
        noise=CONFIG.noise.noise,
        seeds=CONFIG.noise.seeds,
        alpha=CONFIG.scoring.alpha,
    message:
        "Scoring noisy readouts, {wildcards.setup}"
    script:
        "../scripts/noise_table.py"
