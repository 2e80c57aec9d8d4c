"""The tables of one job of the study of accuracy."""

from logs import to_log

from fiberweb import origin, products

to_log(snakemake, "measures error and cost, or limits of the step", "up to some minutes")
given = [products.read(path) for path in snakemake.input.tables]
for (make, options, threaded), path in zip(snakemake.params.calls, snakemake.output, strict=True):
    workers = {"workers": snakemake.threads} if threaded else {}
    print(make, options, workers or "")
    products.write(products.function(make)(*given, **options, **workers), path)
    origin.write(path, snakemake.input.tables, snakemake.params.recipe)
