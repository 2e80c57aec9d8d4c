# What accuracy costs and where the steps end. No figure of the paper needs it.

ACCURACY = studies.load("accuracy")


rule accuracy:
    input:
        [FILES.figure(name, "described") for name in ACCURACY.FIGURES],
        [FILES.table(file, "described") for file in ("energy_drift.csv", *ACCURACY.EXUDYN)],


for job, tables in ACCURACY.JOBS.items():

    rule:
        name:
            job
        input:
            compiled=[FILES.compiled(engine) for engine in ENGINES],
            tables=[
                FILES.table(file, "described") for spec in tables.values() for file in spec.tables
            ],
        output:
            [FILES.table(file, "described") for file in tables],
        log:
            f"<logs>/accuracy/{job}.log",
        conda:
            "../../envs/environment.yaml"
        # all of them where something is timed, so that nothing else runs beside it
        threads: all_cores if any(spec.workers for spec in tables.values()) else 1
        params:
            calls=[
                (spec.make, spec.options(CONFIG.accuracy, []), spec.workers)
                for spec in tables.values()
            ],
            recipe=RECIPES.measured(job),
        message:
            "Making {output}"
        script:
            "../scripts/measure.py"
