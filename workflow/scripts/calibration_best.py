"""The calibration's best point beside the defaults; that they differ is news, not an error."""

from logs import to_log

from fiberweb.scoring.tables import read, write
from fiberweb.studies.calibration.tables import check, verdict

to_log(snakemake.log[0])
made = check(read(snakemake.input.table))
print(verdict(made)[1])
write(made, snakemake.output[0])
