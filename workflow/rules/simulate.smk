# Scenes to responses.


rule warmup:
    input:
        make_whole,
    output:
        touch("<results>/warmup/{engine}.done"),
    log:
        "<logs>/warmup/{engine}.log",
    conda:
        "../../envs/environment.yaml"
    params:
        recipe=code("warmup", "fiberweb.engines"),
    message:
        "Compiling the engine {wildcards.engine}, once"
    script:
        "../scripts/warmup.py"


rule simulate:
    input:
        # not ancient(): where warmup has to run, Snakemake 9.27 then overlooks every simulation
        compiled=lambda wildcards: FILES.compiled(RUNS[wildcards.run].engine),
    output:
        "<results>/runs/{run}/response.nc",
    log:
        "<logs>/simulate/{run}.log",
    conda:
        "../../envs/environment.yaml"
    params:
        scene=lambda wildcards: RUNS[wildcards.run].scene.to_json(),
        numerics=lambda wildcards: RUNS[wildcards.run].numerics,
        recipe=lambda wildcards: RECIPES.response(wildcards.run),
    message:
        "Simulating {wildcards.run}"
    script:
        "../scripts/simulate.py"
