"""Figure and animations of the networks about B = 1."""

from logs import to_log

from fiberweb.simulation.dataset import load
from fiberweb.studies.buckling.figure import animate, draw

to_log(snakemake.log[0])
responses = [load(path) for path in snakemake.input.responses]
draw(responses, snakemake.params.seconds, snakemake.output.png)
animate(responses, snakemake.params.seconds, snakemake.params.frame_rate, snakemake.output.gifs)
