"""One response to its capacities."""

from logs import to_log

from fiberweb.capacity import score
from fiberweb.dataset import load, save

to_log(snakemake.log[0])
print("run", snakemake.wildcards.run)

save(score(load(snakemake.input.response), **snakemake.params.scoring), snakemake.output[0])
