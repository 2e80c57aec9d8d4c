"""A response: what a run gave, as an xarray Dataset."""

from __future__ import annotations

from importlib.metadata import version

import numpy as np
import xarray as xr

from fiberweb.engines import load
from fiberweb.engines.base import Numerics, Recording
from fiberweb.model import drive
from fiberweb.model.mesh import Mesh
from fiberweb.source import source_hash


def response(mesh: Mesh, numerics: Numerics, recording: Recording) -> xr.Dataset:
    """What a run gave, with all that is needed to repeat it.

    Returns:
        `input(time)` dimensionless, and `scored_input(time)` beside it in the published setup
        (`fiberweb.model.drive.scored`); `displacement(time, readout, axis)` in metres;
        `energy(time, form)` in joules, with work and dissipation since the start; coordinates
        time (s), axis (x, y), and for each readout kind, rest_x, rest_y (m), fibre and section;
        if the scene asks for centre lines, `centre_line(time, node, axis)` in metres with
        node_rest_x, node_rest_y (m) and node_fibre for each node, in order along each fibre;
        attributes status ("ok" or "unstable"), unstable_at (s), energy_residual (the largest
        kinetic + elastic + dissipated - work - what was stored at first, over the largest work or
        that), engine, elements_per_section, time_step (s), setup, sample_rate (Hz), versions,
        engine_source (a hash) and the scene as JSON. Nothing in it depends on the clock.
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
            "input": ("time", u, {"long_name": "input u", "units": "1"}),
            "displacement": (
                ("time", "readout", "axis"),
                moved[:, : len(readouts)],
                {"long_name": "displacement from rest", "units": "m"},
            ),
            "energy": (("time", "form"), recording.energy, {"long_name": "energy", "units": "J"}),
        },
        coords={
            "time": ("time", scene.times, {"units": "s"}),
            "axis": ["x", "y"],
            "form": ["kinetic", "elastic", "work", "dissipated"],
            "kind": ("readout", [readout.kind for readout in readouts]),
            "rest_x": ("readout", rest[:, 0], {"units": "m"}),
            "rest_y": ("readout", rest[:, 1], {"units": "m"}),
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
        scored = drive.scored(scene)(scene.times)
        data["scored_input"] = "time", scored, {"long_name": "input of the scoring", "units": "1"}
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
    lines = ("time", "node", "axis"), moved, {"long_name": "displacement of nodes", "units": "m"}
    return xr.Dataset(
        {"centre_line": lines},
        {
            "node_rest_x": ("node", mesh.position[:, 0], {"units": "m"}),
            "node_rest_y": ("node", mesh.position[:, 1], {"units": "m"}),
            "node_fibre": ("node", fibre),
        },
    )
