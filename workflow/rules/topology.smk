# The topology study (Fig. 1): capacities to tables and a figure, for each setup.

TABLES["topology"] = ["topology", "topology_curves"]


rule topology:
    input:
        figure("topology", "described"),
        [f"<results>/tables/{table}.csv" for table in TABLES["topology"]],


rule topology_tables:
    input:
        code=code(
            "buckling.py",
            "capacity.py",
            "dataset.py",
            "network.py",
            "ridge.py",
            "scene.py",
            "tables.py",
        ),
        capacities=lambda wildcards: capacities("topology", wildcards.setup),
        example=lambda wildcards: response(example(runs(CONFIG, "topology", wildcards.setup))),
    output:
        table="<results>/tables/{setup}/topology.csv",
        curves="<results>/tables/{setup}/topology_curves.csv",
        floors="<results>/tables/{setup}/topology_floors.csv",
        traces="<results>/tables/{setup}/topology_traces.nc",
    log:
        "<logs>/topology/tables-{setup}.log",
    benchmark:
        "<benchmarks>/topology/tables-{setup}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        choices=lambda wildcards: [run.choice for run in study_runs("topology", wildcards.setup)],
        scoring=lambda wildcards: example(runs(CONFIG, "topology", wildcards.setup)).scoring,
    message:
        "Tables of the topology study, {wildcards.setup}"
    script:
        "../scripts/topology_tables.py"


rule topology_figure:
    input:
        code=code(
            "buckling.py",
            "dataset.py",
            "network.py",
            "plotting/*.py",
            "scene.py",
            "tables.py",
        ),
        table=of_setup("topology.csv"),
        curves=of_setup("topology_curves.csv"),
        floors=of_setup("topology_floors.csv"),
        traces=of_setup("topology_traces.nc"),
    output:
        png=report(
            "<results>/figures/topology{suffix}.png",
            caption="../report/topology.rst",
            category="Figures",
        ),
        pdf="<results>/figures/topology{suffix}.pdf",
    log:
        "<logs>/topology/figure{suffix}.log",
    benchmark:
        "<benchmarks>/topology/figure{suffix}.tsv"
    conda:
        "../../envs/environment.yaml"
    params:
        setup=lambda wildcards: "published" if wildcards.suffix else "described",
    message:
        "Drawing {output.png}"
    script:
        "../scripts/topology_figure.py"
