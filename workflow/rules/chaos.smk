# How fast twin runs part, and whether their responses stay functions of the input.

TABLES["chaos"] = ["chaos", "chaos_rates"]


rule chaos_rates:
    input:
        code=code(
            "buckling.py",
            "capacity.py",
            "chaos.py",
            "dataset.py",
            "network.py",
            "ridge.py",
            "scene.py",
            "tables.py",
        ),
        table="<results>/tables/{setup}/chaos.csv",
        responses=lambda wildcards: responses("chaos", wildcards.setup),
    output:
        rates="<results>/tables/{setup}/chaos_rates.csv",
        separations="<results>/tables/{setup}/chaos_separations.csv",
    log:
        "<logs>/chaos/rates-{setup}.log",
    benchmark:
        "<benchmarks>/chaos/rates-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    message:
        "Comparing twin runs, {wildcards.setup}"
    script:
        "../scripts/chaos_rates.py"
