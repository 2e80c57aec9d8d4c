"""One table of a study in one setup."""

from logs import to_log

from fiberweb import origin, products

to_log(snakemake)
source, params = snakemake.input, snakemake.params
given = dict(params.options)
if capacities := source.get("capacities"):
    given["capacity_paths"] = list(capacities)
if certificates := source.get("certificates"):
    given["certificate_paths"] = list(certificates)
if responses := source.get("responses"):
    single = {"response_path": responses[0]}
    given |= single if params.single else {"response_paths": list(responses)}
tables = source.tables if isinstance(source.tables, list) else [source.tables]
print(params.make, *map(str, tables))
made = products.function(params.make)(*map(products.read, tables), **given)
products.write(made, snakemake.output[0])
origin.write(snakemake.output[0], source, params.recipe)
