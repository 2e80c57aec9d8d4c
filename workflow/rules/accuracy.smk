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
PLANE = {"buckling": SECTION.plane, "seconds": SECTION.plane_seconds}
LIMITS = {
    "box": SECTION.stability.model_dump(),
    "steps": SECTION.steps,
    "drift_steps": SECTION.drift_steps,
}
RECIPES.own["exudyn.csv"] = code(
    "exudyn_table", "fiberweb.validation.exudyn_check", "fiberweb.tables"
)
RECIPES.own["speed_accuracy.csv"] = digest_of(
    code("speed_accuracy", "fiberweb.validation.accuracy", "fiberweb.tables"),
    (SECTION.networks, ABOUT),
    RECIPES.own["exudyn.csv"],
)
RECIPES.own["model_ladder.csv"] = RECIPES.own["out_of_plane.csv"] = digest_of(
    code(
        "model_ladder",
        "fiberweb.validation.accuracy",
        "fiberweb.validation.limits",
        "fiberweb.tables",
    ),
    (ABOUT, PLANE),
)
RECIPES.own["stability.csv"] = RECIPES.own["energy_drift.csv"] = digest_of(
    code("stability", "fiberweb.validation.limits", "fiberweb.tables"), LIMITS
)
# not every platform has a wheel of it; then the tables are made without
EXUDYN = ["<results>/tables/exudyn.csv"] if find_spec("exudyn") else []


rule accuracy:
    input:
        [figure(name, "described") for name in studies.load("accuracy").FIGURES],
        "<results>/tables/energy_drift.csv",
        EXUDYN,


rule exudyn:
    input:
        compiled=[compiled(engine) for engine in ENGINES],
    output:
        "<results>/tables/exudyn.csv",
    log:
        "<logs>/accuracy/exudyn.log",
    benchmark:
        "<benchmarks>/accuracy/exudyn.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        recipe=RECIPES.own["exudyn.csv"],
    message:
        "Comparing both planar engines with Exudyn"
    script:
        "../scripts/exudyn_table.py"


rule speed_accuracy:
    input:
        compiled=[compiled(engine) for engine in ENGINES],
        exudyn=EXUDYN,
    output:
        "<results>/tables/speed_accuracy.csv",
    log:
        "<logs>/accuracy/speed_accuracy.log",
    benchmark:
        "<benchmarks>/accuracy/speed_accuracy.tsv"
    conda:
        "../../envs/environment.yaml"
    threads: all_cores
    params:
        about={"networks": SECTION.networks} | ABOUT,
        recipe=RECIPES.own["speed_accuracy.csv"],
    message:
        "Measuring error against cost"
    script:
        "../scripts/speed_accuracy.py"


rule model_ladder:
    input:
        compiled=[compiled(engine) for engine in ENGINES],
    output:
        ladder="<results>/tables/model_ladder.csv",
        plane="<results>/tables/out_of_plane.csv",
    log:
        "<logs>/accuracy/model_ladder.log",
    benchmark:
        "<benchmarks>/accuracy/model_ladder.tsv"
    conda:
        "../../envs/environment.yaml"
    threads: all_cores
    params:
        about=ABOUT,
        plane=PLANE,
        recipe=RECIPES.own["model_ladder.csv"],
    message:
        "Measuring what each simplification changes"
    script:
        "../scripts/model_ladder.py"


rule stability:
    input:
        compiled=[compiled(engine) for engine in ENGINES],
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
        limits=LIMITS,
        recipe=RECIPES.own["stability.csv"],
    message:
        "Looking for the largest stable steps"
    script:
        "../scripts/stability.py"
