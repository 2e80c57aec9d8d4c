# What Snakemake's own report cannot show as it is: tables, animations and provenance as pages.


rule page:
    input:
        "<results>/{shown}",
    output:
        report(
            "<results>/report/{shown}.html",
            caption="../report/figure.rst",  # shows params.caption
            category=lambda wildcards: FILES.about(wildcards.shown)[0],
            labels={"file": "{shown}"},
        ),
    log:
        "<logs>/report/{shown}.log",
    localrule: True
    conda:
        "../../envs/environment.yaml"
    params:
        caption=lambda wildcards: FILES.about(wildcards.shown)[1],
        recipe=lambda wildcards: RECIPES.page(wildcards.shown),
    message:
        "Showing {input}"
    script:
        "../scripts/page.py"
