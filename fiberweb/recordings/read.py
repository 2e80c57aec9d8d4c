"""From a file to the Dataset that a simulation gives."""

from __future__ import annotations

import json
from importlib import import_module
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from pydantic import ValidationError

from fiberweb.arguments import check_names, plain
from fiberweb.errors import on_one_line, sentence
from fiberweb.meanings import RUN, explained
from fiberweb.model.readouts import AXES
from fiberweb.recordings import READERS, checks, clock
from fiberweb.recordings.base import FINDING, LENGTHS, Finding, driven, head
from fiberweb.recordings.options import Reading

MOST = 1e100  # of an input or a position: a card has their powers, and sums of these
VARIABLES = {
    "time": ("time from the first frame", "s"),
    "input": "input, in the file's own unit",
    "displacement": ("displacement of a marker from its place in the first frame", "m or px"),
    "axis": "x or y",
    "readout": "name of the marker",
    "rest_x": ("x of a marker in the first frame", "m or px"),
    "rest_y": ("y of a marker in the first frame", "m or px"),
}
ATTRIBUTES = {name: RUN[name] for name in ("status", "setup", "sample_rate", "run")} | {
    "source": "name of the file that was read",
    "sanity": "what was found in it, as JSON: the rows of sanity.csv",
}


@explained(VARIABLES, attributes=ATTRIBUTES)
def read(path: str | Path, quiet: bool, options: dict) -> xr.Dataset:
    """See `fiberweb.recordings.read_recording`."""
    check_names(options, [*Reading.model_fields, "quiet"])
    path = Path(path)
    try:
        return _read(path, quiet, options)
    except MemoryError:
        raise ValueError(f"{path} does not fit in memory: cut it into shorter files") from None
    except ValueError as error:
        raise ValueError(on_one_line(str(error))) from None


def _read(path: Path, quiet: bool, options: dict) -> xr.Dataset:
    try:
        chosen = Reading(**plain(options))
    except ValidationError as error:
        raise ValueError(sentence(error)) from None
    try:
        raw = _reader(path, chosen).read(path, chosen)
    except ValueError as error:
        if str(path) in str(error):
            raise
        raise ValueError(f"{path} cannot be read ({error})") from None  # a library's own words
    found = list(raw.findings)
    time, rate, more = clock.frames(raw, chosen, path)
    found += more
    _check_magnitudes(raw, path)
    _take_input(raw, chosen, path)
    column = raw.columns.get("input", chosen.input or "input")
    if np.nanmin(raw.input) == np.nanmax(raw.input):
        raise ValueError(
            f"{path}, column {column!r}: the input is {np.nanmin(raw.input):g} in every frame "
            f"({raw.place(0)} on); name an input that varies"
        )
    found += checks.exchanges(raw.positions, raw.names, time)  # before gaps are filled across them
    time, positions, u, more = clock.even(raw, time, rate, chosen, path)
    found += more
    units = chosen.units or raw.units or "px"
    rest = positions[0].copy()
    positions -= rest
    if LENGTHS[units] != 1.0:
        positions *= LENGTHS[units]
        rest *= LENGTHS[units]
    found += checks.look(positions, u, raw.names, rate)
    unit = {"units": "px" if units == "px" else "m"}
    response = xr.Dataset(
        {
            "input": ("time", u),
            "displacement": (("time", "readout", "axis"), positions, unit),
        },
        {
            "time": ("time", time, {"units": "s"}),
            "axis": list(AXES),
            "readout": raw.names,
            "rest_x": ("readout", rest[:, 0], unit),
            "rest_y": ("readout", rest[:, 1], unit),
        },
        {
            "status": "ok", "setup": "recording", "sample_rate": float(rate), "run": path.stem,
            "source": path.name, "sanity": json.dumps(found),
        },
    )  # fmt: skip
    if not quiet:
        lines = (on_one_line(f"  {f.severity:8}{f.name}: {f.sentence}") for f in found)
        print(f"{path}:", *lines, sep="\n")
    return response


@explained(VARIABLES, attributes=ATTRIBUTES)
def attempt(path: str | Path, options: dict) -> xr.Dataset:
    """A recording as the Dataset that a simulation gives.

    What stands for one that is refused has nothing in it but the attributes status 'refused',
    sanity and the names.
    """
    try:
        return read(path, False, options)
    except ValueError as error:
        print(error)
        found = [Finding("file", "refused", str(error))]
        attrs = {"status": "refused", "setup": "recording", "run": Path(path).stem}
        return xr.Dataset(attrs=attrs | {"source": Path(path).name, "sanity": json.dumps(found)})


@explained(FINDING)
def listed(response: xr.Dataset) -> pd.DataFrame:
    """One row for each thing that was looked at in a recording."""
    return pd.DataFrame(json.loads(response.attrs["sanity"]), columns=Finding._fields)


def _reader(path: Path, options: Reading):
    """The module that reads a file; ValueError, one sentence, if no format is recognised."""
    first = head(path)
    if options.format:
        return import_module(READERS[options.format].module)
    for reader in READERS.values():
        if (module := import_module(reader.module)).recognises(path, first):
            return module
    raise ValueError(
        f"{path} is of no format that is known: say format: {', '.join(READERS)}, or export a CSV"
    )


def _check_magnitudes(raw, path: Path) -> None:
    """Raise ValueError, one sentence, for a value whose third power may not be held."""
    columns = {} if raw.input is None else {raw.columns.get("input", "input"): raw.input}
    for number, name in enumerate(raw.names):
        columns |= {f"{name}.{axis}": raw.positions[:, number, n] for n, axis in enumerate(AXES)}
    for name, values in columns.items():
        wrong = np.isfinite(values) & (np.abs(values) > MOST)  # infinity counts as not seen
        if wrong.any():
            at = int(np.argmax(wrong))
            raise ValueError(
                f"{path}, column {name!r}, {raw.place(at)}: {values[at]:g} is beyond {MOST:g} in "
                "magnitude: correct it, or give the column in another unit"
            )


def _take_input(raw, options: Reading, path: Path) -> None:
    """Where the input is the motion of a marker: that marker is driven, and is no readout."""
    if raw.input is not None:
        return
    found = driven(options.input, raw.names, options.plane)
    if found is None:
        names = ", ".join(raw.names[:10])
        raise ValueError(
            f"{path}: input = {options.input!r} names no marker and coordinate: give one such as "
            f"{raw.names[0]}.{options.plane[0]}; the markers are {names}"
        )
    number, axis = found
    raw.input = raw.positions[:, number, axis].copy()
    raw.positions = np.delete(raw.positions, number, axis=1)
    raw.names = [name for name in raw.names if name != raw.names[number]]
    if not raw.names:
        raise ValueError(f"{path}: its only marker is the input; a readout is needed as well")
