"""What a run and its scoring need of memory, known before either starts."""

from __future__ import annotations

import contextlib
import os
from functools import cache
from pathlib import Path

from fiberweb.model.authors import ELEMENT, KNOTS
from fiberweb.model.scene import Scene

# Bytes. A displacement in double precision, two axes, held once by the engine and twice more while
# a response is made of it, saved and scored; a knot of the input with its spline; a node with all
# that an engine and its limit lay out about it.
A_READOUT, A_KNOT, A_NODE = 3 * 2 * 8, 200, 3000

CGROUP = Path("/sys/fs/cgroup/memory.max")  # as a container sees its own


def needed(scene: Scene, elements_per_section: int | None) -> dict[str, float]:
    """Bytes that a run needs, about, by what they are for, with what would make them fewer.

    elements_per_section None is the authors' mesh.
    """
    network, seconds = scene.network, scene.duration
    length = ELEMENT / 2 if elements_per_section is None else network.spacing / elements_per_section
    nodes = float(network.fibre_lengths.sum()) / length + len(network.fibres)
    read = network.readouts + (nodes if scene.centre_lines else 0)
    recording = f"duration = {seconds:g} s at sample_rate = {scene.sample_rate:g} Hz"
    return {
        f"{recording}: {read:.0f} readouts": A_READOUT * seconds * scene.sample_rate * read,
        f"duration = {seconds:g} s at drive_rate = {scene.drive_rate:g} Hz: an input of as many "
        "knots": A_KNOT * max(KNOTS, seconds * scene.drive_rate),
        f"elements_per_section = {elements_per_section}: {nodes:.3g} nodes": A_NODE * nodes,
    }


def check(scene: Scene, elements_per_section: int | None) -> None:
    """Raise ValueError, one sentence, if a run needs more memory than it may take."""
    parts = needed(scene, elements_per_section)
    if (total := sum(parts.values())) > of_this_machine():
        largest = max(parts, key=parts.get)
        raise ValueError(
            f"{largest} need some {1e-9 * total:.3g} GB of memory, and a job here may take "
            f"{1e-9 * of_this_machine():.3g} GB; take less of them"
        )


@cache
def of_this_machine() -> int:
    """Bytes of memory that there are, or that a cluster's job or a container may have of them."""
    import psutil

    found = [psutil.virtual_memory().total]
    if megabytes := os.environ.get("SLURM_MEM_PER_NODE"):
        found.append(int(megabytes) << 20)
    with contextlib.suppress(OSError, ValueError):  # there is none, or it says "max"
        found.append(int(CGROUP.read_text()))
    return min(found)
