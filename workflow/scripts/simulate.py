"""One scene to its response."""

from logs import to_log

from fiberweb import Scene
from fiberweb.simulation.dataset import save
from fiberweb.simulation.explain import describe
from fiberweb.simulation.plan import plan
from fiberweb.simulation.simulate import run

to_log(snakemake, "integrates a scene", "see cost below, and half a second beside it")
print("scene:", snakemake.params.scene)
print("numerics:", snakemake.params.numerics or "the defaults")

planned = plan(Scene.from_json(snakemake.params.scene), **snakemake.params.numerics)
print(describe(planned))
response = run(planned)
response.attrs["run"] = snakemake.wildcards.run
save(response, snakemake.output[0])
print("status:", response.attrs["status"])
