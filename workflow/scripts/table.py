"""One table of a study in one setup."""

from logs import to_log

from fiberweb import origin, products

source, params = snakemake.input, snakemake.params
again = source.get("responses")
takes = f"some seconds for each of {len(again)} responses, at most" if again else "a second or two"
to_log(snakemake, f"makes a table with {params.make}", takes)
given = dict(params.options)
if capacities := source.get("capacities"):
    given["capacity_paths"] = list(capacities)
if certificates := source.get("certificates"):
    given["certificate_paths"] = list(certificates)
if again:
    given |= {"response_path": again[0]} if params.single else {"response_paths": list(again)}
tables = source.tables if isinstance(source.tables, list) else [source.tables]
print("of:", *map(str, tables), f"{len(capacities or [])} capacities, {len(again or [])} responses")
print("options:", params.options or "none")
made = products.function(params.make)(*map(products.read, tables), **given)
products.write(made, snakemake.output[0])
origin.write(snakemake.output[0], source, params.recipe)
