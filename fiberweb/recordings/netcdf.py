"""NetCDF: what a simulation writes, or arrays by name."""

from __future__ import annotations

from pathlib import Path

from fiberweb.recordings import arrays, hdf5
from fiberweb.recordings.base import LENGTHS, Raw
from fiberweb.recordings.options import Reading
from fiberweb.simulation import dataset

DEFAULTS = {"time": "time", "input": "input", "markers": "displacement"}


def recognises(path: Path, head: bytes) -> bool:
    return head.startswith((b"CDF", hdf5.MAGIC))


def read(path: Path, options: Reading) -> Raw:
    """Read a NetCDF file; errors as `fiberweb.recordings.arrays.recording` has them."""
    try:
        data = dataset.load(path)
    except ValueError:
        raise
    except Exception as error:  # of broken attributes, whatever they lead to
        raise ValueError(f"{path} cannot be read ({error}): it may be damaged") from None
    named = {key: getattr(options, key) or value for key, value in DEFAULTS.items()}

    def get(name: str):
        values = data[name]
        return values.transpose("time", ...) if "time" in values.dims else values

    raw = arrays.recording(path, options.model_copy(update=named), get, [*data.variables])
    units = data[named["markers"]].attrs.get("units", "")
    raw.units = units if units in LENGTHS else ""
    return raw
