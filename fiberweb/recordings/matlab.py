"""MATLAB files, version 5 and 7.3: arrays in structs, by paths such as ``trackingData.servoPos``.

`rate` is stated, or read from the struct that holds the markers if that has a field `samplerate`,
`sampleRate`, `fps`, `frameRate` or `framerate`.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import scipy.io

from fiberweb.recordings import arrays, hdf5
from fiberweb.recordings.base import Raw, head
from fiberweb.recordings.options import Reading

RATES = ("samplerate", "sampleRate", "fps", "frameRate", "framerate")


def recognises(path: Path, head: bytes) -> bool:
    return path.suffix.lower() == ".mat" or head.startswith(b"MATLAB ")


def read(path: Path, options: Reading) -> Raw:
    """Read a MATLAB file; errors as `fiberweb.recordings.arrays.recording` has them."""
    if head(path).startswith((b"MATLAB 7.3", hdf5.MAGIC)):
        with hdf5.opened(path) as file:
            # MATLAB writes its arrays column by column, so that their axes come in reverse
            leaves = {
                name.replace("/", "."): np.asarray(file[name]).T for name in hdf5.arrays(file)
            }
    else:
        leaves = dict(_leaves(_loaded(path)))
    raw = arrays.recording(path, options, leaves.__getitem__, leaves)
    struct = str(options.markers).rpartition(".")[0]
    beside = (leaves.get(f"{struct}.{name}" if struct else name) for name in RATES)
    rate = next((value for value in beside if value is not None), None)
    raw.rate = float(np.squeeze(rate)) if rate is not None else None
    return raw


def _loaded(path: Path) -> dict:
    try:
        return scipy.io.loadmat(path, simplify_cells=True)
    except Exception as error:  # of a broken file scipy raises whatever the bytes lead to
        raise ValueError(
            f"{path} cannot be read as a MATLAB file ({error or type(error).__name__}): it may "
            "have been cut short"
        ) from None


def _leaves(group: dict, above: str = ""):
    """(path, array) of everything in nested structs."""
    for name, value in group.items():
        if name.startswith("__"):
            continue
        if isinstance(value, dict):
            yield from _leaves(value, f"{above}{name}.")
        else:
            yield f"{above}{name}", value
