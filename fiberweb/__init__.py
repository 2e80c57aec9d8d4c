"""Networks of slender fibres as physical reservoirs: simulate or film them, score them.

from fiberweb import Scene, baselines, crosshatch, score, simulate
response = simulate(Scene(crosshatch(4, length=0.5), duration=20.0))
print(score(response).c_nl, baselines(response))
"""

from importlib import import_module

from fiberweb.model.network import crosshatch, polygon, web
from fiberweb.model.scene import Scene
from fiberweb.simulation.explain import explain
from fiberweb.simulation.simulate import simulate

__all__ = [
    "Scene", "baselines", "card", "certify", "crosshatch", "explain", "polygon", "read_recording",
    "score", "simulate", "web",
]  # fmt: skip

# scoring and readers need packages that a simulation need not load
_LATER = {
    "score": "fiberweb.scoring.capacity",
    "baselines": "fiberweb.scoring.tables",
    "card": "fiberweb.scoring.card",
    "certify": "fiberweb.validation.certificate",
    "read_recording": "fiberweb.recordings",
}


def __getattr__(name):
    if name in _LATER:
        return getattr(import_module(_LATER[name]), name)
    raise AttributeError(f"module 'fiberweb' has no attribute {name!r}")
