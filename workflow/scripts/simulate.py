"""One scene to its response."""

from logs import to_log

from fiberweb import Scene, explain, simulate
from fiberweb.simulation.dataset import save

to_log(snakemake.log[0])
print("run", snakemake.wildcards.run)
print("scene", snakemake.params.scene)
print("numerics", snakemake.params.numerics)

scene = Scene.from_json(snakemake.params.scene)
print(explain(scene, **snakemake.params.numerics))
response = simulate(scene, **snakemake.params.numerics)
response.attrs["run"] = snakemake.wildcards.run
save(response, snakemake.output[0])
print("status", response.attrs["status"])
