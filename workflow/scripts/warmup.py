"""Compile an engine into the cache that all jobs share."""

from logs import to_log

from fiberweb.engines import warmup

to_log(snakemake)
warmup(snakemake.wildcards.engine)
