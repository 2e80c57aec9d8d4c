"""Tables of the topology study in one setup, and the example computations of Fig. 1d."""

from logs import to_log

from fiberweb.scoring import tables
from fiberweb.scoring.capacity import traces
from fiberweb.simulation.dataset import load, save

to_log(snakemake.log[0])
source, scoring = snakemake.input, snakemake.params.scoring
tables.write(tables.study(source.capacities, snakemake.params.choices), snakemake.output.table)
tables.write(tables.curves(source.capacities), snakemake.output.curves)
tables.write(tables.floors(source.example, **scoring), snakemake.output.floors)
example = load(source.example)
stable = example.attrs["status"] == "ok"  # an unstable run estimates nothing: no variables then
save(traces(example, **scoring) if stable else example[[]], snakemake.output.traces)
