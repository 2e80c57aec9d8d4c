"""What the capacities of one run rest on."""

from logs import to_log

from fiberweb import origin, products
from fiberweb.validation.certificate import certificate

to_log(
    snakemake,
    "runs a scene again with what is no physics changed, one thing after the other",
    "less than six times what the run took: see its log in logs/simulate",
)
print("scoring:", snakemake.params.scoring)
response = products.read(snakemake.input[0])
made = certificate(response, **snakemake.params.scoring)
print(made.to_string())
products.write(made, snakemake.output[0])
origin.write(snakemake.output[0], snakemake.input, snakemake.params.recipe)
