"""What the capacities of one run rest on."""

from logs import to_log

from fiberweb import origin, products
from fiberweb.validation.certificate import certificate

to_log(snakemake)
print("run", snakemake.wildcards.run)

response = products.read(snakemake.input[0])
products.write(certificate(response, **snakemake.params.scoring), snakemake.output[0])
origin.write(snakemake.output[0], snakemake.input, snakemake.params.recipe)
