"""Animations of the networks about B = 1."""

from logs import to_log

from fiberweb import products
from fiberweb.studies.buckling.figure import animate

to_log(snakemake, "draws each run as a film, one frame after the other", "some seconds for each")
responses = [products.read(path) for path in snakemake.input]
params = snakemake.params
print(f"films: {len(responses)}, {params.seconds:g} s at {params.frame_rate:g} frames a second")
animate(responses, params.seconds, params.frame_rate, snakemake.output)
