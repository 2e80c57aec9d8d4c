"""The engines: one file each, all offering what `fiberweb.engines.base.Engine` asks for."""

from __future__ import annotations

from importlib import import_module

# one line an engine; each is imported only when needed, since each has its own weight
ENGINES = {
    "kirchhoff": "fiberweb.engines.kirchhoff",
    "cosserat": "fiberweb.engines.cosserat",
    "elastica": "fiberweb.engines.elastica",
}


def load(name: str):
    """The module of an engine, which is an `fiberweb.engines.base.Engine`."""
    return import_module(ENGINES[name])


def warmup() -> None:
    """Compile every kernel into the persistent cache, by running each engine for an instant."""
    from fiberweb.engines.base import Numerics
    from fiberweb.model.mesh import build
    from fiberweb.model.network import crosshatch
    from fiberweb.model.scene import Scene

    for setup, engine in (
        ("described", "kirchhoff"),
        ("published", "cosserat"),
        ("published", "elastica"),
    ):
        scene = Scene(crosshatch(2, spacing=0.1), setup=setup, duration=0.01)
        load(engine).integrate(build(scene, 4), Numerics(engine, 4, 4e-6))
