"""How fast twins part, and how consistent they stay, in one setup."""

from logs import to_log

from fiberweb.scoring import tables
from fiberweb.studies.chaos import tables as chaos

to_log(snakemake.log[0])
source = snakemake.input
tables.write(chaos.rates(tables.read(source.table), source.responses), snakemake.output.rates)
tables.write(chaos.separations(source.responses), snakemake.output.separations)
