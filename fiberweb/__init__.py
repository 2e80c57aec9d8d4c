"""Networks of slender fibres as physical reservoirs: simulate them, score what they compute.

from fiberweb import Scene, baselines, crosshatch, score, simulate
response = simulate(Scene(crosshatch(4, length=0.5), duration=20.0))
print(score(response).c_nl, baselines(response))
"""

from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.scene import Scene
from fiberweb.simulation.explain import explain
from fiberweb.simulation.simulate import simulate

__all__ = [
    "Scene", "baselines", "certify", "crosshatch", "explain", "polygon", "score", "simulate",
]  # fmt: skip


def __getattr__(name):
    # scoring needs packages that a simulation need not load
    if name == "score":
        from fiberweb.scoring.capacity import score

        return score
    if name == "baselines":
        from fiberweb.scoring.tables import baselines

        return baselines
    if name == "certify":
        from fiberweb.validation.certificate import certify

        return certify
    raise AttributeError(f"module 'fiberweb' has no attribute {name!r}")
