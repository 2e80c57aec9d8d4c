"""The score card of one recording: table, JSON and figure."""

import json
from pathlib import Path

from logs import to_log

from fiberweb import origin, products
from fiberweb.figures.card import draw
from fiberweb.scoring.card import attempt

to_log(snakemake, "scores a recording beside what its input alone scores", "up to some minutes")
print("options:", snakemake.params.options or "the defaults")
card = attempt(products.read(snakemake.input[0]), snakemake.params.options)
print(card)
products.write(card.scores, snakemake.output.table)
origin.write(snakemake.output.table, snakemake.input, snakemake.params.recipe)
Path(snakemake.output.json).write_text(json.dumps(card.as_dict(), indent=1), encoding="utf-8")
draw(card.as_dict(), snakemake.output.png)
