"""The NARMA task in one setup: its estimates on the test part, and how far they are off."""

from logs import to_log

from fiberweb import narma, tables
from fiberweb.dataset import save

to_log(snakemake.log[0])
source, params = snakemake.input, snakemake.params
found = narma.of_runs(source.responses, **params.task)
save(found, snakemake.output.errors)
tables.write(narma.table(found, source.capacities, params.choices), snakemake.output.table)
