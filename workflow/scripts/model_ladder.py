"""What each simplification changes, and growth out of the plane."""

from logs import to_log

from fiberweb.tables import write
from fiberweb.validation.accuracy import ladder
from fiberweb.validation.limits import out_of_plane

to_log(snakemake)
write(ladder(**snakemake.params.about, workers=snakemake.threads), snakemake.output.ladder)
write(out_of_plane(**snakemake.params.plane), snakemake.output.plane)
