# The paper's claims: judged in each setup by its tables, and side by side.


rule setup_claims:
    input:
        code=code("claims", "fiberweb.claims.judge", "fiberweb.products", *studies.claims()),
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
        code=code("join_claims", "fiberweb.claims.judge", "fiberweb.products"),
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
        "The claims of all setups side by side"
    script:
        "../scripts/join_claims.py"
