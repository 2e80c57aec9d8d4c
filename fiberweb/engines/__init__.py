"""The engines: one file each, all offering what `fiberweb.engines.base.Engine` asks for."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fiberweb.engines.base import Engine
    from fiberweb.model.mesh import Mesh

# one line an engine; each is imported only when needed, since each has its own weight
ENGINES = {
    "kirchhoff": "fiberweb.engines.kirchhoff",
    "cosserat": "fiberweb.engines.cosserat",
    "elastica": "fiberweb.engines.elastica",
}


def load(name: str) -> Engine:
    """The module of an engine."""
    return import_module(ENGINES[name])


def accepts(name: str, mesh: Mesh) -> bool:
    """Whether an engine models all that a mesh needs."""
    try:
        load(name).refuse(mesh)
    except ValueError:
        return False
    return True


def warmup(name: str) -> None:
    """Compile the kernels of an engine into the persistent cache, by running it for an instant."""
    from fiberweb.engines.base import Numerics
    from fiberweb.model.authors import STEP
    from fiberweb.model.mesh import build
    from fiberweb.model.network import crosshatch
    from fiberweb.model.scene import Scene

    # the first that the engine can run: the published one has the filter
    setups = ("published", "described", "compliant")
    scenes = [Scene(crosshatch(2, spacing=0.1), setup, duration=0.01) for setup in setups]
    mesh = next(mesh for mesh in (build(scene, 4) for scene in scenes) if accepts(name, mesh))
    load(name).integrate(mesh, Numerics(name, 4, STEP))
