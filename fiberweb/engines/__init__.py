"""The engines: one file each, one signature `integrate(mesh, numerics) -> Recording`."""

from __future__ import annotations

from importlib import import_module


def load(name: str):
    """The module of an engine; imported only when needed, since each has its own weight."""
    return import_module(f"fiberweb.engines.{name}")


def warmup() -> None:
    """Compile every kernel into the persistent cache, by running each engine for an instant."""
    from fiberweb.engines.base import Numerics
    from fiberweb.mesh import build
    from fiberweb.network import crosshatch
    from fiberweb.scene import Scene

    for setup, engine in (
        ("described", "kirchhoff"),
        ("published", "cosserat"),
        ("published", "elastica"),
    ):
        scene = Scene(crosshatch(2, spacing=0.1), setup=setup, duration=0.01)
        load(engine).integrate(build(scene, 4), Numerics(engine, 4, 4e-6))
