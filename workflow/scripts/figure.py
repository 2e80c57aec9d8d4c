"""One figure of a study in one setup."""

from pathlib import Path

from logs import to_log

from fiberweb import products

source, params = snakemake.input, snakemake.params
to_log(snakemake, f"draws with {params.draw}", "up to half a minute")
print("setup:", params.setup)
print("of:", *source.given, f"and {len(source.responses)} responses" if source.responses else "")
print("options:", params.options or "none")
given = {Path(path).stem: products.read(path) for path in source.given}
if source.responses:
    given["responses"] = [products.read(path) for path in source.responses]
products.function(params.draw)(given, params.setup, snakemake.output.png, **params.options)
