"""What the report shows of a table, a dataset or an animation."""

from pathlib import Path

from logs import to_log

from fiberweb.pages import page

to_log(snakemake, "shows a file as a page of the report", "a second")
print("of:", snakemake.input[0])
Path(snakemake.output[0]).write_text(page(snakemake.input[0]), encoding="utf-8")
