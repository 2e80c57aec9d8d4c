# Animations about B = 1: drawn from responses, for they need every instant.


rule animation:
    input:
        lambda wildcards: of_runs("response.nc", study_runs("buckling", "described")),
    output:
        FILES.animations,
    log:
        "<logs>/figures/animations.log",
    conda:
        "../../envs/environment.yaml"
    params:
        seconds=CONFIG.buckling.seconds,
        frame_rate=CONFIG.buckling.frame_rate,
        recipe=lambda wildcards: RECIPES.animations(),
    message:
        "Drawing the animations"
    script:
        "../scripts/animation.py"
