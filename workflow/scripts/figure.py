"""One figure of a study in one setup."""

from pathlib import Path

from logs import to_log

from fiberweb import products

to_log(snakemake)
source, params = snakemake.input, snakemake.params
given = {Path(path).stem: products.read(path) for path in source.given}
if source.responses:
    given["responses"] = [products.read(path) for path in source.responses]
products.function(params.draw)(given, params.setup, snakemake.output.png, **params.options)
