"""The figure of the NARMA task in one setup."""

from logs import to_log

from fiberweb.scoring.tables import read
from fiberweb.simulation.dataset import load
from fiberweb.studies.narma.figure import draw

to_log(snakemake.log[0])
source = snakemake.input
draw(read(source.table), load(source.errors), snakemake.params.setup, snakemake.output.png)
