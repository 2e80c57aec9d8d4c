"""Where the capacities of the ridge drop, and where they are best."""

from logs import to_log

from fiberweb.onset import onsets
from fiberweb.tables import read, write

to_log(snakemake.log[0])
write(onsets(read(snakemake.input.ridge)), snakemake.output[0])
