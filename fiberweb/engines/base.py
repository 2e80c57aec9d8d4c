"""What every engine takes and gives."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fiberweb.mesh import Mesh
from fiberweb.scene import Scene

AUTHORS_STEP = 5e-6  # s
RUNAWAY = 10.0  # a node faster than this many axial wave speeds has left the physics


class Numerics(NamedTuple):
    """How a scene is integrated.

    Attributes:
        engine: "kirchhoff", "cosserat" or "elastica".
        elements_per_section: see `fiberweb.mesh.build`; None is the authors' mesh.
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
        unstable_at: when the run left the physics (s), or None.
    """

    displacement: np.ndarray
    unstable_at: float | None


def steps_per_sample(scene: Scene, time_step: float) -> int:
    """Whole steps between two samples; the step is shortened to fit."""
    return max(1, int(np.ceil(1.0 / (scene.sample_rate * time_step) - 1e-9)))


def readout_arrays(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of the readouts, both of shape (readouts, 2)."""
    nodes = np.array([readout.nodes for readout in mesh.readouts], dtype=np.int64)
    return nodes, np.array([readout.weights for readout in mesh.readouts])
