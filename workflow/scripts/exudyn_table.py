"""The planar engines against Exudyn."""

from logs import to_log

from fiberweb.exudyn_check import table
from fiberweb.tables import write

to_log(snakemake.log[0])
write(table(), snakemake.output[0])
