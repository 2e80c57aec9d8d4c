"""One recording, read and looked at."""

from logs import to_log

from fiberweb import origin, products
from fiberweb.recordings import sanity
from fiberweb.recordings.read import attempt

to_log(
    snakemake,
    f"reads {snakemake.params.path} and looks at what is in it",
    "a second, or half a minute for each GB of text",
)
print("options:", snakemake.params.options or "what the file says")
response = attempt(snakemake.params.path, snakemake.params.options)
products.write(response, snakemake.output.response)
products.write(sanity(response), snakemake.output.sanity)
for path in snakemake.output:
    origin.write(path, [], snakemake.params.recipe)
