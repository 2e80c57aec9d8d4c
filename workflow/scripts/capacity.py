"""One response to its capacities."""

from logs import to_log

from fiberweb.scoring.capacity import score
from fiberweb.simulation.dataset import load, save

to_log(snakemake)
print("run", snakemake.wildcards.run)

save(score(load(snakemake.input[0]), **snakemake.params.scoring), snakemake.output[0])
