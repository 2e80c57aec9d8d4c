"""One scene to its response."""

from logs import to_log

from fiberweb import Scene, simulate
from fiberweb.dataset import save

to_log(snakemake.log[0])
print("run", snakemake.wildcards.run)
print("scene", snakemake.params.scene)
print("numerics", snakemake.params.numerics)

response = simulate(Scene.from_json(snakemake.params.scene), **snakemake.params.numerics)
response.attrs["run"] = snakemake.wildcards.run
save(response, snakemake.output[0])
print("status", response.attrs["status"])
