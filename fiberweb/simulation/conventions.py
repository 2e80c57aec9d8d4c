"""What the CF conventions ask of a file: a name and a unit for every variable, and what made it.

Time is in seconds from the start, and no date: it has no standard_name, since CF's `time` is one.

A variable keeps the attributes that its maker gave it; `VARIABLES` has those of the rest.
"""

from __future__ import annotations

import xarray as xr

CONVENTIONS = "CF-1.11"
# name to long_name and units; words have no unit
VARIABLES = {
    "time": ("time", "s"),
    "axis": ("direction of a displacement", None),
    "form": ("form of energy, or what was put in or lost since the start", None),
    "kind": ("kind of readout", None),
    "rest_x": ("x of a readout at rest", "m"),
    "rest_y": ("y of a readout at rest", "m"),
    "fibre": ("number of the fibre that a readout is on", "1"),
    "section": ("number of the section along the fibre that a readout is on", "1"),
    "node_rest_x": ("x of a node at rest", "m"),
    "node_rest_y": ("y of a node at rest", "m"),
    "node_fibre": ("number of the fibre that a node is on", "1"),
    "input": ("input u", "1"),
    "displacement": ("displacement from rest", "m"),
    "filled": ("whether a gap in a track was filled", "1"),
    "readout": ("readout, or what made of the input stands for readouts", None),
    # of traces and tasks
    "trace": ("target of a trace: a Legendre polynomial, or recall by so long", None),
    "target": ("target of the readout", "1"),
    "prediction": ("estimate of the target by the readout", "1"),
    "estimate": ("estimate of the target by the readout", "1"),
    "c": ("capacity for the target of a trace, test part", "1"),
    "order": ("order of the NARMA task", "1"),
    "timing": ("whether the same sample is estimated or the next", None),
    "n_signals": ("number of signals", "1"),
    "case": ("run, and how its film was read", None),
    "setup": ("setup, or whose scoring", None),
    "topology": ("topology of the network", None),
    "n": ("size of the network, N", "1"),
    "spacing_m": ("spacing of the fibres", "m"),
    "force_N": ("amplitude of the force, F_max", "N"),
    "angle_deg": ("angle of the motor", "degree"),
    "body": ("simulated network, or twin of the experiment", None),
    "frame_step": ("how many frames of the film make one that is read", "1"),
    "verdict": ("whether claims are judged by it", "1"),
    "status": ("ok, or unstable", None),
    "run": ("name of the run", None),
}


def labelled(data: xr.Dataset) -> xr.Dataset:
    """A Dataset with the attributes that CF asks for; a value of its own stays as it is."""
    labelled = data.copy()
    title = str(data.attrs.get("run", "fibre networks as physical reservoirs"))
    said = {"Conventions": CONVENTIONS, "title": title, "source": "fiberweb"}
    labelled.attrs = said | data.attrs
    for variable in map(str, labelled.variables):
        long_name, units = VARIABLES.get(variable, (None, None))
        known = {"long_name": long_name} | ({"units": units} if units else {})
        labelled[variable].attrs = (known if long_name else {}) | labelled[variable].attrs
    return labelled
