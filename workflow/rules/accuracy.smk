# What accuracy costs and where the steps end. No figure of the paper needs it. The rules that
# time something ask for all cores, so that nothing else runs beside them; a machine that is busy
# with other things still spoils them.

from importlib.util import find_spec

SECTION = CONFIG.accuracy
ABOUT = {
    "length": SECTION.length,
    "buckling": SECTION.buckling,
    "seconds": SECTION.seconds,
    "duration": SECTION.duration,
    "window": SECTION.window,
}
PHYSICS = (
    "buckling.py",
    "drive.py",
    "engines/*.py",
    "mesh.py",
    "network.py",
    "scene.py",
)
# not every platform has a wheel of it; then the tables are made without
EXUDYN = ["<results>/tables/exudyn.csv"] if find_spec("exudyn") else []


rule accuracy:
    input:
        [
            f"<results>/figures/{name}.png"
            for name in ("speed_accuracy", "model_ladder", "stability")
        ],
        "<results>/tables/energy_drift.csv",
        EXUDYN,


rule exudyn:
    input:
        code=code(
            "accuracy.py",
            "capacity.py",
            "dataset.py",
            "exudyn_*.py",
            "ridge.py",
            "simulation.py",
            *PHYSICS,
        ),
        compiled="<results>/warmup.done",
    output:
        "<results>/tables/exudyn.csv",
    log:
        "<logs>/accuracy/exudyn.log",
    benchmark:
        "<benchmarks>/accuracy/exudyn.tsv"
    conda:
        "../../envs/environment.yaml"
    message:
        "Comparing both planar engines with Exudyn"
    script:
        "../scripts/exudyn_table.py"


rule speed_accuracy:
    input:
        code=code("accuracy.py", "capacity.py", "dataset.py", "ridge.py", *PHYSICS),
        compiled="<results>/warmup.done",
        exudyn=EXUDYN,
    output:
        "<results>/tables/speed_accuracy.csv",
    log:
        "<logs>/accuracy/speed_accuracy.log",
    benchmark:
        "<benchmarks>/accuracy/speed_accuracy.tsv"
    conda:
        "../../envs/environment.yaml"
    threads: workflow.cores
    params:
        about={"networks": SECTION.networks} | ABOUT,
    message:
        "Measuring error against cost"
    script:
        "../scripts/speed_accuracy.py"


rule model_ladder:
    input:
        code=code("accuracy.py", "capacity.py", "dataset.py", "limits.py", "ridge.py", *PHYSICS),
        compiled="<results>/warmup.done",
    output:
        ladder="<results>/tables/model_ladder.csv",
        plane="<results>/tables/out_of_plane.csv",
    log:
        "<logs>/accuracy/model_ladder.log",
    benchmark:
        "<benchmarks>/accuracy/model_ladder.tsv"
    conda:
        "../../envs/environment.yaml"
    threads: workflow.cores
    params:
        about=ABOUT,
        plane={"buckling": SECTION.plane, "seconds": SECTION.plane_seconds},
    message:
        "Measuring what each simplification changes"
    script:
        "../scripts/model_ladder.py"


rule stability:
    input:
        code=code("limits.py", *PHYSICS),
        compiled="<results>/warmup.done",
    output:
        limits="<results>/tables/stability.csv",
        drift="<results>/tables/energy_drift.csv",
    log:
        "<logs>/accuracy/stability.log",
    benchmark:
        "<benchmarks>/accuracy/stability.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        box=SECTION.stability.model_dump(),
        steps=SECTION.steps,
        drift_steps=SECTION.drift_steps,
    message:
        "Looking for the largest stable steps"
    script:
        "../scripts/stability.py"


rule accuracy_figure:
    input:
        code=code(
            "plotting/__init__.py",
            "plotting/accuracy.py",
            "plotting/style.py",
            "plotting/sweep.py",
            "tables.py",
        ),
        tables=lambda wildcards: [
            f"<results>/tables/{name}.csv" for name in FIGURES[wildcards.name]
        ],
    output:
        png=report(
            "<results>/figures/{name}.png",
            caption="../report/{name}.rst",
            category="Accuracy",
        ),
        pdf="<results>/figures/{name}.pdf",
    log:
        "<logs>/accuracy/{name}-figure.log",
    benchmark:
        "<benchmarks>/accuracy/{name}-figure.tsv"
    wildcard_constraints:
        name="speed_accuracy|model_ladder|stability",
    conda:
        "../../envs/environment.yaml"
    message:
        "Drawing {output.png}"
    script:
        "../scripts/accuracy_figure.py"


FIGURES = {
    "speed_accuracy": ["speed_accuracy"],
    "model_ladder": ["model_ladder", "out_of_plane"],
    "stability": ["stability", "energy_drift"],
}
