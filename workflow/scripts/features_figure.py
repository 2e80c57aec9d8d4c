"""Fig. 4 in one setup."""

from logs import to_log

from fiberweb.scoring.tables import read
from fiberweb.studies.features.figure import draw

to_log(snakemake.log[0])
source = snakemake.input
tables = {
    "features": read(source.table),
    "features_greedy": read(source.greedy),
    "features_floors": read(source.floors),
}
draw(tables, snakemake.params.setup, snakemake.output.png)
