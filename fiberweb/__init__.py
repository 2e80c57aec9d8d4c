"""Networks of slender fibres as physical reservoirs: simulate them, score what they compute.

from fiberweb import crosshatch, Scene, simulate, score
response = simulate(Scene(crosshatch(4, length=0.5), duration=20.0))
print(score(response).c_nl)
"""

from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.scene import Scene
from fiberweb.simulation.explain import explain
from fiberweb.simulation.simulate import simulate

__all__ = ["Scene", "crosshatch", "explain", "polygon", "score", "simulate"]


def __getattr__(name):
    if name == "score":  # scoring needs packages that a simulation need not load
        from fiberweb.scoring.capacity import score

        return score
    raise AttributeError(f"module 'fiberweb' has no attribute {name!r}")
