# Snapshots and animations about B = 1: drawn from responses, for they need every instant.

ANIMATIONS = [
    f"{RESULTS}/figures/buckling-B{number:g}.gif"
    for number in dict.fromkeys(CONFIG.buckling.buckling)
]
DRAWN.append("buckling")


rule buckling:
    input:
        figure("buckling", "described"),
        ANIMATIONS,
        [f"<results>/tables/{table}.csv" for table in TABLES["buckling"]],


rule buckling_figure:
    input:
        code=code(
            "buckling.py",
            "centre_lines.py",
            "dataset.py",
            "network.py",
            "plotting/__init__.py",
            "plotting/buckling.py",
            "plotting/film.py",
            "plotting/style.py",
            "scene.py",
        ),
        responses=lambda wildcards: responses("buckling", "described"),
    output:
        png=report(
            "<results>/figures/buckling.png",
            caption="../report/buckling.rst",
            category="Figures",
        ),
        pdf="<results>/figures/buckling.pdf",
        gifs=report(ANIMATIONS, caption="../report/buckling.rst", category="Figures"),
    log:
        "<logs>/buckling/figure.log",
    benchmark:
        "<benchmarks>/buckling/figure.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        seconds=CONFIG.buckling.seconds,
        frame_rate=CONFIG.buckling.frame_rate,
    message:
        "Drawing {output.png} and its animations"
    script:
        "../scripts/buckling_figure.py"
