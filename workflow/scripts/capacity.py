"""One response to its capacities."""

from logs import to_log

from fiberweb.scoring.capacity import score
from fiberweb.simulation.dataset import load, save

to_log(
    snakemake,
    "scores a response: ridge regression of Legendre polynomials and of recalled input",
    "up to 3 s of one core",
)
scored = score(load(snakemake.input[0]), **snakemake.params.scoring)
for name in ("status", "scoring", "alpha", "horizon", "split", "skip", "n_signals"):
    print(f"{name}: {scored.attrs[name]}")
print(f"C_nl {float(scored.c_nl):.4f}, C_m {float(scored.c_m):.4f}")
save(scored, snakemake.output[0])
