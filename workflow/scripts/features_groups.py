"""What each group of readouts scores in one setup, and the floors beneath it."""

from logs import to_log

from fiberweb.scoring import tables
from fiberweb.studies.features import tables as features

to_log(snakemake.log[0])
source, asked = snakemake.input, snakemake.params
made = features.group_table(
    source.capacities, source.responses, asked.choices, asked.alpha, asked.verdict_force
)
tables.write(made, snakemake.output.table)
tables.write(tables.floors(source.responses[0], asked.alpha), snakemake.output.floors)
