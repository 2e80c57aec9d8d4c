"""Fig. 1 in one setup."""

from logs import to_log

from fiberweb.dataset import load
from fiberweb.plotting.topology import draw
from fiberweb.tables import read

to_log(snakemake.log[0])
source = snakemake.input
traces = load(source.traces)
draw(
    read(source.table),
    read(source.curves),
    read(source.floors),
    traces if traces.data_vars else None,
    snakemake.params.setup,
    snakemake.output.png,
)
