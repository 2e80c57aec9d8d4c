"""Animations of the networks about B = 1."""

from logs import to_log

from fiberweb import products
from fiberweb.studies.buckling.figure import animate

to_log(snakemake)
responses = [products.read(path) for path in snakemake.input]
params = snakemake.params
animate(responses, params.seconds, params.frame_rate, snakemake.output)
