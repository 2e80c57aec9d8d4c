"""The paper's claims, what was computed in each setup beside one another."""

from pathlib import Path

from logs import to_log

from fiberweb import origin, products
from fiberweb.claims.judge import join

to_log(snakemake, "puts the claims of all setups side by side", "a second")
print("of:", *snakemake.input)
by_setup = {Path(path).parent.name: products.read(path) for path in snakemake.input}
products.write(join(by_setup), snakemake.output[0])
origin.write(snakemake.output[0], snakemake.input, snakemake.params.recipe)
