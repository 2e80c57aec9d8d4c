"""From a scene, or from a plan of it, to its response."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fiberweb import timed
from fiberweb.arguments import spelt
from fiberweb.engines import load
from fiberweb.model.scene import Scene
from fiberweb.simulation.plan import Plan, plan

if TYPE_CHECKING:
    import xarray


@spelt
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
        accuracy: "draft", "standard" (the default), "fine" or "reference", of every setup but the
            published; or choose the numerics yourself with the rest.
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
    return run(
        plan(
            scene,
            accuracy,
            engine=engine,
            elements_per_section=elements_per_section,
            time_step=time_step,
            force_time_step=force_time_step,
        )
    )


def run(plan: Plan) -> xarray.Dataset:
    """The response of a planned run; see `simulate`."""
    from fiberweb.simulation.response import response  # with xarray, which a plan does not need

    engine = load(plan.engine)
    with timed.part("kernel"):
        recording = engine.integrate(plan.mesh, plan.numerics)
    return response(plan.mesh, plan.numerics, recording)
