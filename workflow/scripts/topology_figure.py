"""Fig. 1 in one setup."""

from logs import to_log

from fiberweb.scoring.tables import read
from fiberweb.simulation.dataset import load
from fiberweb.studies.topology.figure import draw

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
