"""The paper's claims against the tables of one setup."""

from pathlib import Path

from logs import to_log

from fiberweb import origin, products
from fiberweb.claims.judge import evaluate

to_log(snakemake, "holds the paper's claims against the tables of a setup", "a second")
print("of:", *snakemake.input.tables)
tables = {Path(path).stem: products.read(path) for path in snakemake.input.tables}
params = snakemake.params
table = evaluate(tables, snakemake.wildcards.setup, params.modules, params.published_tables)
print(table[["id", "verdict", "value"]].to_string())
products.write(table, snakemake.output[0])
origin.write(snakemake.output[0], snakemake.input, params.recipe)
