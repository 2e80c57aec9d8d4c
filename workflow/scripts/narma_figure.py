"""The figure of the NARMA task in one setup."""

from logs import to_log

from fiberweb.dataset import load
from fiberweb.plotting.narma import draw
from fiberweb.tables import read

to_log(snakemake.log[0])
source = snakemake.input
draw(read(source.table), load(source.errors), snakemake.params.setup, snakemake.output.png)
