"""What every engine takes and gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from fiberweb.model.mesh import Mesh
from fiberweb.model.scene import Scene

CHUNK = 250  # samples between two returns to Python: a second of a run, in which Ctrl-C waits
# A node faster than this many axial wave speeds has left the physics: a wave of that speed
# strains its fibre by 1.
RUNAWAY = 1.0


class Numerics(NamedTuple):
    """How a scene is integrated.

    Attributes:
        engine: "kirchhoff", "cosserat" or "elastica".
        elements_per_section: see `fiberweb.model.mesh.build`; None is the authors' mesh.
        time_step: s.
    """

    engine: str
    elements_per_section: int | None
    time_step: float


@dataclass(frozen=True)
class Recording:
    """What an engine gives back.

    Attributes:
        displacement: of each readout, shape (samples, readouts, 2), m; NaN once unstable.
        energy: kinetic, elastic, work done so far, dissipated so far, shape (samples, 4), J;
            NaN once unstable, and throughout for an engine that keeps no ledger.
        unstable_at: when the run left the physics (s), or None.
    """

    displacement: np.ndarray
    energy: np.ndarray
    unstable_at: float | None


class Engine(Protocol):
    """What the module of an engine offers.

    Attributes:
        PACKAGES: distributions whose versions a response records.
        NANOSECONDS: CPU time of an element and step, to foretell a run's cost.
        PLANAR: whether it leaves out motion out of the plane.
        MODELS_SHEAR: whether it has shear and rotary inertia.
        MESH_ERRORS: by elements per section in the described setup, rms error of the
            trajectories over their rms, and error of C_nl and C_m; what is on record.
    """

    PACKAGES: tuple[str, ...]
    NANOSECONDS: float
    PLANAR: bool
    MODELS_SHEAR: bool
    MESH_ERRORS: dict[int, tuple[float, float]]

    def refuse(self, mesh: Mesh) -> None:
        """Raise ValueError if the scene needs what this engine does not model."""

    def largest_step(self, mesh: Mesh) -> float:
        """The largest stable step (s), without the Laplace filter (which lets larger steps
        through by wiping out the modes they excite)."""

    def integrate(self, mesh: Mesh, numerics: Numerics) -> Recording:
        """Integrate a mesh; raises ValueError for what `refuse` does."""


def steps_per_sample(scene: Scene, time_step: float) -> int:
    """Whole steps between two samples; the step is shortened to fit."""
    return max(1, int(np.ceil(1.0 / (scene.sample_rate * time_step) - 1e-9)))


def fitted_step(scene: Scene, time_step: float) -> tuple[float, int]:
    """The step that is taken (s), and how many make a sample."""
    per_sample = steps_per_sample(scene, time_step)
    return 1.0 / (scene.sample_rate * per_sample), per_sample


def readout_arrays(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of the readouts, both of shape (readouts, 4)."""
    nodes = np.array([readout.nodes for readout in mesh.readouts], dtype=np.int64)
    return nodes, np.array([readout.weights for readout in mesh.readouts])


def record_in_chunks(scene: Scene, readouts: int, advance) -> Recording:
    """Call a kernel chunk by chunk, so that an interrupt is seen between two of them.

    Args:
        scene: how long and how often.
        readouts: how many.
        advance: function of the first sample, and of the parts of displacement and energy to
            fill; returns how many samples were good.
    """
    displacement = np.full((scene.samples, readouts, 2), np.nan)
    energy = np.full((scene.samples, 4), np.nan)
    for first in range(0, scene.samples, CHUNK):
        part = slice(first, first + CHUNK)
        good = advance(first, displacement[part], energy[part])
        if good < len(displacement[part]):
            displacement[first + good :] = np.nan
            energy[first + good :] = np.nan
            return Recording(displacement, energy, (first + good) / scene.sample_rate)
    return Recording(displacement, energy, None)
