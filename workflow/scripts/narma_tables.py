"""The NARMA task in one setup: its estimates on the test part, and how far they are off."""

from logs import to_log

from fiberweb.scoring import tables
from fiberweb.simulation.dataset import save
from fiberweb.studies.narma import task as narma

to_log(snakemake.log[0])
source, params = snakemake.input, snakemake.params
found = narma.of_runs(source.responses, **params.task)
save(found, snakemake.output.errors)
tables.write(narma.table(found, source.capacities, params.choices), snakemake.output.table)
