"""A response: what a run gave, as an xarray Dataset."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np
import xarray as xr

from fiberweb.engines import load
from fiberweb.engines.base import Numerics, Recording
from fiberweb.meanings import RUN, explained
from fiberweb.model import drive
from fiberweb.model.mesh import Mesh
from fiberweb.source import source_hash

VARIABLES = {
    "time": ("time from the start", "s"),
    "input": "input u",
    "scored_input": "input of the scoring, in the published setup",
    "displacement": ("displacement of a readout from rest", "m"),
    "energy": ("energy: kinetic and elastic; work and dissipation since the start", "J"),
    "axis": "x or y",
    "form": "kinetic, elastic, work or dissipated",
    "kind": "of a readout: crossing, or midpoint of a section",
    "rest_x": ("x of a readout at rest", "m"),
    "rest_y": ("y of a readout at rest", "m"),
    "fibre": "fibre that a readout lies on, from 0; of a crossing the first",
    "section": "of a readout: number of the crossing, or of the section, along its fibre, from 0",
    "centre_line": ("displacement of a node from rest, if the scene asks for centre lines", "m"),
    "node_rest_x": ("x of a node at rest", "m"),
    "node_rest_y": ("y of a node at rest", "m"),
    "node_fibre": "fibre that a node belongs to, from 0; nodes are in order along it",
}
ATTRIBUTES = RUN | {
    "energy_residual": (
        "largest kinetic + elastic + dissipated - work - what was stored at first, over the "
        "largest work or that"
    ),
    "elements": "how many there are in all",
}


@explained(VARIABLES, attributes=ATTRIBUTES)
def response(mesh: Mesh, numerics: Numerics, recording: Recording) -> xr.Dataset:
    """What a run gave, with all that is needed to repeat it.

    Returns:
        `VARIABLES`: `input(time)` and, in the published setup, `scored_input(time)`
        (`fiberweb.model.drive.scored`); `displacement(time, readout, axis)`; `energy(time, form)`;
        coordinates time, axis, and for each readout kind, rest_x, rest_y, fibre and section; if
        the scene asks for centre lines, `centre_line(time, node, axis)` with node_rest_x,
        node_rest_y and node_fibre for each node. And `ATTRIBUTES`. Nothing in it depends on the
        clock.
    """
    scene = mesh.scene
    # nodes of centre lines are no readouts: they are drawn and never scored
    readouts = [readout for readout in mesh.readouts if readout.kind != "node"]
    nodes = np.array([readout.nodes for readout in readouts])
    weights = np.array([readout.weights for readout in readouts])
    rest = np.einsum("rk,rkc->rc", weights, mesh.position[nodes])
    moved = recording.displacement
    unstable = recording.unstable_at is not None
    packages = load(numerics.engine).PACKAGES
    u = drive.of_scene(scene)(scene.times)
    data = xr.Dataset(
        {
            "input": ("time", u),
            "displacement": (("time", "readout", "axis"), moved[:, : len(readouts)]),
            "energy": (("time", "form"), recording.energy),
        },
        coords={
            "time": scene.times,
            "axis": ["x", "y"],
            "form": ["kinetic", "elastic", "work", "dissipated"],
            "kind": ("readout", [readout.kind for readout in readouts]),
            "rest_x": ("readout", rest[:, 0]),
            "rest_y": ("readout", rest[:, 1]),
            "fibre": ("readout", [readout.fibre for readout in readouts]),
            "section": ("readout", [readout.section for readout in readouts]),
        },
        attrs={
            "status": "unstable" if unstable else "ok",
            "setup": scene.setup,
            "scene": scene.to_json(),
            "engine": numerics.engine,
            "elements": mesh.elements,
            "elements_per_section": numerics.elements_per_section or "authors",
            "time_step": numerics.time_step,
            "sample_rate": scene.sample_rate,
            "engine_source": source_hash(),
            "versions": ", ".join(f"{name} {version(name)}" for name in packages),
        },
    )
    if scene.setup == "published":
        data["scored_input"] = "time", drive.scored(scene)(scene.times)
    if scene.centre_lines:
        data = data.merge(_centre_lines(mesh, moved[:, len(readouts) :]))
    if unstable:
        data.attrs["unstable_at"] = recording.unstable_at
    kinetic, elastic, work, dissipated = recording.energy.T
    one, other = mesh.position[mesh.joints.T]
    gaps = np.abs(one - other).max(initial=0.0) > 1e-9
    stored = elastic[0] if gaps else 0.0  # the springs across them
    if (most := max(np.nanmax(np.abs(work), initial=0.0), stored)) > 0.0:
        residual = np.abs(kinetic + elastic + dissipated - work - stored)
        data.attrs["energy_residual"] = float(np.nanmax(residual) / most)
    return data


def _centre_lines(mesh: Mesh, moved: np.ndarray) -> xr.Dataset:
    """Displacement of every node, shape (time, node, 2), m, with where each node belongs."""
    fibre = np.repeat(np.arange(len(mesh.first) - 1), np.diff(mesh.first))
    return xr.Dataset(
        {"centre_line": (("time", "node", "axis"), moved)},
        {
            "node_rest_x": ("node", mesh.position[:, 0]),
            "node_rest_y": ("node", mesh.position[:, 1]),
            "node_fibre": ("node", fibre),
        },
    )
