# What joins the studies: one table a study with both setups, and the paper's claims.


rule merge:
    input:
        code=code("tables.py"),
        tables=tables_at_hand,
    output:
        "<results>/tables/{table}.csv",
    log:
        "<logs>/merge/{table}.log",
    benchmark:
        "<benchmarks>/merge/{table}.tsv"
    wildcard_constraints:
        table="|".join(all_tables()),
    localrule: True
    conda:
        "../../envs/environment.yaml"
    message:
        "Writing {output}"
    script:
        "../scripts/merge.py"


rule claims:
    input:
        code=code("buckling.py", "claims*.py", "claims.yaml", "tables.py"),
        tables=lambda wildcards: merged(),
        published=authors_tables(),
    output:
        report("<results>/tables/claims.csv", caption="../report/claims.rst", category="Claims"),
    log:
        "<logs>/claims.log",
    benchmark:
        "<benchmarks>/claims.tsv"
    localrule: True
    conda:
        "../../envs/environment.yaml"
    params:
        published_tables=CONFIG.published_tables,
    message:
        "Holding the paper's claims against the tables"
    script:
        "../scripts/claims.py"
