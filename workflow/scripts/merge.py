"""One table of a study out of those of its setups."""

from logs import to_log

from fiberweb.scoring.tables import merge, write

to_log(snakemake.log[0])
write(merge(snakemake.input.tables), snakemake.output[0])
