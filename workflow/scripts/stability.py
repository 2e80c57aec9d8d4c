"""Largest stable steps, predicted and found, and how well energy is kept."""

from logs import to_log

from fiberweb.tables import write
from fiberweb.validation.limits import drift, stability

to_log(snakemake.log[0])
write(stability(snakemake.params.box, snakemake.params.steps), snakemake.output.limits)
write(drift(snakemake.params.drift_steps), snakemake.output.drift)
