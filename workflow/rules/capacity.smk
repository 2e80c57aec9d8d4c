# Responses to capacities.


rule capacity:
    input:
        "<results>/runs/{run}/response.nc",
    output:
        "<results>/runs/{run}/capacity.nc",
    log:
        "<logs>/capacity/{run}.log",
    benchmark:
        "<benchmarks>/capacity/{run}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        scoring=lambda wildcards: RUNS[wildcards.run].scoring,
        recipe=lambda wildcards: RECIPES.capacity(wildcards.run),
    message:
        "Scoring {wildcards.run}"
    script:
        "../scripts/capacity.py"
