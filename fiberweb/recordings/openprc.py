"""OpenPRC's HDF5: `time_series/time`, `.../actuation_signals/<n>`, `.../nodes/positions`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fiberweb.recordings import arrays, hdf5
from fiberweb.recordings.base import Raw
from fiberweb.recordings.options import Reading

TIME = "time_series/time"
DEFAULTS = {
    "time": TIME,
    "input": "time_series/actuation_signals/0",
    "markers": "time_series/nodes/positions",
}


def recognises(path: Path, head: bytes) -> bool:
    if not head.startswith(hdf5.MAGIC):
        return False
    with hdf5.opened(path) as file:
        return TIME in file


def read(path: Path, options: Reading) -> Raw:
    """Read an OpenPRC file; errors as `fiberweb.recordings.arrays.recording` has them."""
    named = {key: getattr(options, key) or value for key, value in DEFAULTS.items()}
    with hdf5.opened(path) as file:

        def get(name: str) -> np.ndarray:
            return hdf5.read(path, file, name)

        chosen = options.model_copy(update=named)
        raw = arrays.recording(path, chosen, get, hdf5.arrays(file))
        raw.rate = float(file.attrs["fps"]) if "fps" in file.attrs else None
    return raw
