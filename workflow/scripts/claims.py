"""The paper's claims against the tables."""

from pathlib import Path

from logs import to_log

from fiberweb.claims.judge import evaluate
from fiberweb.scoring.tables import read, write

to_log(snakemake.log[0])
tables = {Path(path).stem: read(path) for path in snakemake.input.tables}
write(evaluate(tables, snakemake.params.published_tables), snakemake.output[0])
