"""The planar engines against Exudyn."""

from logs import to_log

from fiberweb.tables import write
from fiberweb.validation.exudyn_check import table

to_log(snakemake)
write(table(), snakemake.output[0])
