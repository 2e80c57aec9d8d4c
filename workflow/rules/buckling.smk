# Animations about B = 1: drawn from responses, for they need every instant.

ANIMATIONS = [
    f"{RESULTS}/figures/buckling-B{number:g}.gif"
    for number in dict.fromkeys(CONFIG.buckling.buckling)
]
FURTHER["buckling"] = ANIMATIONS


rule animation:
    input:
        lambda wildcards: [response(run) for run in study_runs("buckling", "described")],
    output:
        report(ANIMATIONS, caption="../report/figure.rst", category="Figures"),
    log:
        "<logs>/figures/animations.log",
    benchmark:
        "<benchmarks>/figures/animations.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        seconds=CONFIG.buckling.seconds,
        frame_rate=CONFIG.buckling.frame_rate,
        caption=caption("buckling", studies.load("buckling").FIGURES["buckling"], "described"),
        recipe=lambda wildcards: digest_of(
            code("animation", "fiberweb.studies.buckling.figure", "fiberweb.products"),
            (CONFIG.buckling.seconds, CONFIG.buckling.frame_rate),
            RECIPES.responses("buckling", "described"),
        ),
    message:
        "Drawing the animations"
    script:
        "../scripts/animation.py"
