"""Compile an engine into the cache that all jobs share."""

from logs import to_log

from fiberweb.engines import cache, warmup

to_log(snakemake, "compiles an engine into the cache that all jobs share", "up to a minute, once")
print("cache:", cache.folder())
warmup(snakemake.wildcards.engine)
