# The paper's claims: judged in each setup by its tables, and side by side.


def claims_tables(wildcards):
    """The tables that the rules of the claims read, of the studies that the setup runs."""
    return [
        table(file, wildcards.setup)
        for study in studies.STUDIES
        if wildcards.setup in studies.setups(study)
        for file in getattr(studies.load(study), "JUDGED_BY", ())
    ]


def authors_tables(wildcards):
    folder = CONFIG.published_tables
    return sorted(glob(f"{folder}/*.csv")) if folder else []


rule setup_claims:
    input:
        code=code("fiberweb.claims.judge", *studies.claims()),
        tables=claims_tables,
        published=authors_tables,
    output:
        report(
            "<results>/tables/{setup}/claims.csv",
            caption="../report/claims.rst",
            category="Claims",
        ),
    log:
        "<logs>/claims/{setup}.log",
    benchmark:
        "<benchmarks>/claims/{setup}.tsv"
    localrule: True
    conda:
        "../../envs/environment.yaml"
    params:
        setup="{setup}",
        modules=studies.claims(),
        published_tables=CONFIG.published_tables,
    message:
        "Holding the paper's claims against the tables, {wildcards.setup}"
    script:
        "../scripts/claims.py"


rule claims:
    input:
        code=code("fiberweb.claims.judge"),
        claims=[f"<results>/tables/{setup}/claims.csv" for setup in SUFFIXES],
    output:
        report("<results>/tables/claims.csv", caption="../report/claims.rst", category="Claims"),
    log:
        "<logs>/claims/joined.log",
    benchmark:
        "<benchmarks>/claims/joined.tsv"
    localrule: True
    conda:
        "../../envs/environment.yaml"
    message:
        "The claims of both setups side by side"
    script:
        "../scripts/join_claims.py"
