"""Error against cost of every engine, and how far Exudyn is from ours."""

import pandas as pd
from logs import to_log

from fiberweb.tables import write
from fiberweb.validation.accuracy import exudyn_rows, speed_accuracy

to_log(snakemake)
table = speed_accuracy(**snakemake.params.about, workers=snakemake.threads)
exudyn = [exudyn_rows(pd.read_csv(path)) for path in snakemake.input.exudyn]
write(pd.concat([table, *exudyn]), snakemake.output[0])
