# The paper's claims: judged in each setup by its tables, and side by side.


rule setup_claims:
    input:
        tables=lambda wildcards: [
            FILES.table(file, wildcards.setup) for file in studies.judged_by(wildcards.setup)
        ],
        published=tables_in(CONFIG.published_tables),
    output:
        "<results>/tables/{setup}/claims.csv",
    log:
        "<logs>/claims/{setup}.log",
    localrule: True
    conda:
        "../../envs/environment.yaml"
    params:
        modules=studies.claims(),
        published_tables=CONFIG.published_tables,
        recipe=lambda wildcards: RECIPES.claims(wildcards.setup),
    message:
        "Holding the paper's claims against the tables, {wildcards.setup}"
    script:
        "../scripts/claims.py"


rule claims:
    input:
        [f"<results>/tables/{setup}/claims.csv" for setup in SETUPS],
    output:
        report("<results>/tables/claims.csv", caption="../report/claims.rst", category="Claims"),
    log:
        "<logs>/claims/joined.log",
    localrule: True
    conda:
        "../../envs/environment.yaml"
    params:
        recipe=lambda wildcards: RECIPES.joined_claims(),
    message:
        "The claims of all setups side by side"
    script:
        "../scripts/join_claims.py"
