"""Largest stable steps, predicted and found, and how well energy is kept."""

from logs import to_log

from fiberweb.tables import write
from fiberweb.validation.limits import drift, stability

to_log(snakemake)
limits = snakemake.params.limits
write(stability(limits["box"], limits["steps"]), snakemake.output.limits)
write(drift(limits["drift_steps"]), snakemake.output.drift)
