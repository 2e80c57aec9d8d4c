"""One of the figures about accuracy."""

from logs import to_log

from fiberweb.scoring.tables import read
from fiberweb.studies.accuracy import figure as accuracy

to_log(snakemake.log[0])
draw = {
    "speed_accuracy": accuracy.draw_speed,
    "model_ladder": accuracy.draw_ladder,
    "stability": accuracy.draw_stability,
}[snakemake.wildcards.name]
draw(*map(read, snakemake.input.tables), snakemake.output.png)
