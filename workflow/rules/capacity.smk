# Responses to capacities, and what these rest on.


rule capacity:
    input:
        "<results>/runs/{run}/response.nc",
    output:
        "<results>/runs/{run}/capacity.nc",
    log:
        "<logs>/capacity/{run}.log",
    conda:
        "../../envs/environment.yaml"
    params:
        scoring=lambda wildcards: RUNS[wildcards.run].scoring,
        recipe=lambda wildcards: RECIPES.capacity(wildcards.run),
    message:
        "Scoring {wildcards.run}"
    script:
        "../scripts/capacity.py"


rule certificate:
    input:
        "<results>/runs/{run}/response.nc",
    output:
        "<results>/runs/{run}/certificate.csv",
    log:
        "<logs>/certificate/{run}.log",
    conda:
        "../../envs/environment.yaml"
    params:
        scoring=lambda wildcards: RUNS[wildcards.run].scoring,
        recipe=lambda wildcards: RECIPES.certificate(wildcards.run),
    message:
        "Running {wildcards.run} again with what is no physics changed"
    script:
        "../scripts/certificate.py"
