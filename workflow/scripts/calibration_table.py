"""Table of the calibration: one row a run, with the paper's four numbers and their misfit."""

from logs import to_log

from fiberweb.scoring.tables import write
from fiberweb.studies.calibration.tables import table

to_log(snakemake.log[0])
write(table(snakemake.input.capacities), snakemake.output[0])
