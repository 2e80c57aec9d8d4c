"""In and out of NetCDF: the only place that does either."""

from __future__ import annotations

import os
from pathlib import Path

import xarray as xr


def save(data: xr.Dataset, path: str | Path) -> None:
    """Write a Dataset to NetCDF, deflated, under a temporary name first: a file that exists is
    whole."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.getpid()}")
    encoding = {
        name: {"zlib": True, "complevel": 1, "shuffle": True}
        for name, variable in data.data_vars.items()
        if variable.dtype.kind == "f" and variable.ndim
    }
    try:
        data.to_netcdf(partial, engine="netcdf4", encoding=encoding)
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def load(path: str | Path) -> xr.Dataset:
    """Read a whole Dataset into memory.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: it is broken, one sentence.
    """
    try:
        with xr.open_dataset(path, engine="netcdf4") as data:
            return data.load()
    except FileNotFoundError:
        raise
    except (OSError, RuntimeError) as error:
        raise ValueError(
            f"{path} cannot be read ({error}): if it was cut short, delete it and have it made anew"
        ) from error
