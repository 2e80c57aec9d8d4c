"""Both planar engines against Exudyn, a code that nobody here wrote: do the two agree to within
the errors of their meshes?

The kirchhoff engine is held against slender beams (`exudyn_beams.respond`), the cosserat engine
against beams with all of shear and rotary inertia, and Exudyn against the converged kirchhoff
engine, which the errors of `fiberweb.validation.accuracy` are measured from.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from fiberweb.meanings import explained
from fiberweb.model.network import Network, crosshatch
from fiberweb.model.scene import Scene
from fiberweb.simulation.simulate import simulate
from fiberweb.validation.accuracy import MESH, difference

COLUMNS = (
    {"network": "single fibre, or size of the crosshatch"}
    | MESH
    | {
        "against": "code that it is compared with; slender: without shear and rotary inertia",
        "difference": "rms of the difference from that code, over its rms",
        "mesh_error": "the same from this code's own finest mesh",
        "step_error": "the same from this mesh at twice the step, of Exudyn alone",
    }
)
MESHES = (4, 8, 16)  # elements per section of our engines
CONVERGED = 64  # of their own finest mesh: second order from 16 on leaves a sixteenth of its error
COARSE, YARDSTICK, FINER = 4, 8, 12  # of Exudyn; three nodes each
STEP = 1e-4  # s, of Exudyn; twice as long moves it by less than 2e-4: tests/validation
FULL, SLENDER = "exudyn", "exudyn slender"


def single_fibre(spacing: float = 0.1, sections: int = 3) -> Network:
    """One fibre, read where a crosshatch would have its crossings and midpoints, and driven in
    the middle."""
    length = spacing * sections
    at = spacing * np.arange(1, sections)
    return Network(
        "crosshatch", 1, length, spacing, "",
        np.array([[[0.0, 0.0], [length, 0.0]]]),
        (tuple(enumerate(at.tolist())),),
        np.column_stack([at, np.zeros_like(at)]),
        0, length / 2,
    )  # fmt: skip


FORCE = 0.109  # N: B = 0.7 of the 2x2 network
SCENES = {
    "single fibre": Scene(single_fibre(), "compliant", force=5e-3, duration=0.4, damping=10.0),
    "2x2": Scene(crosshatch(2, spacing=0.1), "compliant", force=FORCE, duration=0.4, damping=10.0),
}


@explained(COLUMNS)
def table() -> pd.DataFrame:
    """One row for each scene, code, mesh and code that it is compared with.

    Differences are of displacement at crossings and midpoints over the whole run.

    Returns:
        Columns `COLUMNS`, some 12 rows for each of `SCENES`. Our engines have no step_error: their
        step falls with their mesh. "exudyn slender" has no mesh finer than the yardstick, because
        its Newton iterations then stall.

    Raises:
        ModuleNotFoundError: Exudyn is not installed.
    """
    rows = [(name, *row) for name, scene in SCENES.items() for row in _rows(scene)]
    return pd.DataFrame(rows, columns=list(COLUMNS))


def _rows(scene: Scene) -> Iterator[tuple]:
    """The rows of one scene, without its name."""
    from fiberweb.validation.exudyn_beams import respond

    coarse, full, finer = (respond(scene, n, STEP) for n in (COARSE, YARDSTICK, FINER))
    hasty = respond(scene, YARDSTICK, 2 * STEP)
    slender = respond(scene, YARDSTICK, STEP, slender=True)
    slender_coarse = respond(scene, COARSE, STEP, slender=True)
    ours = {
        engine: {n: _simulated(scene, engine, n) for n in (*MESHES, CONVERGED)}
        for engine in ("kirchhoff", "cosserat")
    }
    _, best = ours["kirchhoff"][CONVERGED]
    unknown = np.nan
    for engine, elements, trajectory, mesh_error, step_error in (
        (FULL, COARSE, coarse, difference(coarse, finer), unknown),
        (FULL, YARDSTICK, full, difference(full, finer), difference(hasty, full)),
        (SLENDER, COARSE, slender_coarse, difference(slender_coarse, slender), unknown),
        (SLENDER, YARDSTICK, slender, unknown, unknown),
    ):
        apart = difference(trajectory, best)
        yield engine, elements, STEP, "kirchhoff", apart, mesh_error, step_error
    yield SLENDER, YARDSTICK, STEP, FULL, difference(slender, full), unknown, unknown
    for engine, against, yardstick in (("kirchhoff", SLENDER, slender), ("cosserat", FULL, full)):
        _, finest = ours[engine][CONVERGED]
        for elements in MESHES:
            step, trajectory = ours[engine][elements]
            apart, mesh_error = difference(trajectory, yardstick), difference(trajectory, finest)
            yield engine, elements, step, against, apart, mesh_error, unknown


def _simulated(scene: Scene, engine: str, elements: int) -> tuple[float, np.ndarray]:
    """Step (s) and displacement (m) of one of our engines."""
    response = simulate(scene, engine=engine, elements_per_section=elements)
    return response.attrs["time_step"], response["displacement"].values
