"""Where the capacities of the ridge drop, and where they are best."""

from logs import to_log

from fiberweb.scoring.tables import read, write
from fiberweb.studies.ridge.onset import onsets

to_log(snakemake.log[0])
write(onsets(read(snakemake.input.ridge)), snakemake.output[0])
