# Animations about B = 1: drawn from responses, for they need every instant.


rule animation:
    input:
        lambda wildcards: of_runs("response.nc", study_runs("buckling", "described")),
    output:
        report(FILES.animations, caption="../report/figure.rst", category="Figures"),
    log:
        "<logs>/figures/animations.log",
    conda:
        "../../envs/environment.yaml"
    params:
        seconds=CONFIG.buckling.seconds,
        frame_rate=CONFIG.buckling.frame_rate,
        caption=studies.caption("buckling", "described"),
        recipe=lambda wildcards: digest_of(
            code("animation", "fiberweb.studies.buckling.figure", "fiberweb.products"),
            (CONFIG.buckling.seconds, CONFIG.buckling.frame_rate),
            RECIPES.responses("buckling", "described"),
        ),
    message:
        "Drawing the animations"
    script:
        "../scripts/animation.py"
