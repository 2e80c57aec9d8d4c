"""One call from a scene to its response."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fiberweb.model.scene import Scene
from fiberweb.simulation.plan import resolve

if TYPE_CHECKING:
    import xarray


def simulate(
    scene: Scene,
    accuracy: str | None = None,
    *,
    engine: str | None = None,
    elements_per_section: int | None = None,
    time_step: float | None = None,
    force_time_step: bool = False,
) -> xarray.Dataset:
    """Run a scene.

    Args:
        scene: the physics.
        accuracy: "draft", "standard" (the default of the described setup), "fine" or
            "reference"; or choose the numerics yourself with the rest.
        engine: "kirchhoff", "cosserat" or "elastica".
        elements_per_section: elements on a section as long as the network's spacing.
        time_step: s.
        force_time_step: accept a step above the stability limit; the run then most likely
            ends with status "unstable".

    Returns:
        See `fiberweb.simulation.response.response`. A run that blows up is a response with status
        "unstable", NaN from then on.

    Raises:
        ValueError: one sentence naming the argument, its value and what would be right.
    """
    from fiberweb import engines
    from fiberweb.model.mesh import build
    from fiberweb.simulation.response import response

    numerics = resolve(scene, accuracy, engine, elements_per_section, time_step, force_time_step)
    mesh = build(scene, numerics.elements_per_section)
    return response(mesh, numerics, engines.load(numerics.engine).integrate(mesh, numerics))
