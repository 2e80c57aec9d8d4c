"""The figure of one study in one setup."""

from importlib import import_module
from pathlib import Path

from logs import to_log

from fiberweb.scoring.tables import read

to_log(snakemake.log[0])
tables = {Path(path).stem: read(path) for path in snakemake.input.tables}
draw = import_module(f"fiberweb.plotting.{snakemake.wildcards.study}").draw
draw(tables, snakemake.params.setup, snakemake.output.png)
