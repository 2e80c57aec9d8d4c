"""Error against cost of every engine."""

from logs import to_log

from fiberweb.accuracy import speed_accuracy
from fiberweb.tables import write

to_log(snakemake.log[0])
table = speed_accuracy(**snakemake.params.about, workers=snakemake.threads)
write(table, snakemake.output[0])
