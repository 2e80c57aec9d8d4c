"""In and out of NetCDF: the only place that does either, and what a file keeps of a motion."""

from __future__ import annotations

import errno
import os
from pathlib import Path
from shutil import disk_usage
from tempfile import TemporaryFile

import netCDF4
import numpy as np
import xarray as xr

from fiberweb import timed
from fiberweb.model.scene import Scene
from fiberweb.simulation.conventions import labelled, unlabelled
from fiberweb.simulation.memory import of_this_machine

MOTIONS = ("displacement", "centre_line")
# A motion is stored as multiples of a power of two between 2^-21 and 2^-20 of its own rms in the
# quietest of so many parts of the run: an error of 1.4e-7 to 2.8e-7 of that rms. A precision taken
# from the value itself, single's for instance, would round the fluctuation on a static stretch.
BITS, PARTS = 20, 10
# with a checksum, by which a damaged file is known when it is read
DEFLATED = {"zlib": True, "complevel": 1, "shuffle": True, "fletcher32": True}
CHUNK = 2**16  # values of one signal that are deflated together


def save(data: xr.Dataset, path: str | Path) -> None:
    """Write a Dataset to NetCDF, deflated, under a temporary name first: a file that exists is
    whole.

    Motions are stored as `rounded` leaves them, except those of a perturbed pair, which differ by
    less than that: of a scene with a disturbance every digit is kept.

    Raises:
        OSError: it cannot be written, one sentence.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.getpid()}")
    if "scene" in data.attrs and not Scene.from_json(data.attrs["scene"]).disturbance:
        data = data.assign({name: _stored(data[name]) for name in MOTIONS if name in data})
    data = labelled(data)
    encoding = {
        name: DEFLATED | _chunks(name, variable) | _filling(data, name)
        for name, variable in data.variables.items()
        if variable.dtype.kind in "iuf" and variable.ndim
    }
    try:
        with timed.part("write"):
            data.to_netcdf(partial, engine="netcdf4", encoding=encoding)
        partial.replace(path)
    except (OSError, RuntimeError) as error:
        reason = _refusal(path, data.nbytes) or error
        raise OSError(f"{path} cannot be written ({reason})") from error
    finally:
        partial.unlink(missing_ok=True)


def _refusal(path: Path, size: int) -> str | None:
    """What the system says of so many bytes beside a path: of a full disk NetCDF says "HDF error",
    or that permission was denied."""
    try:
        if disk_usage(path.parent).free < size:
            return os.strerror(errno.ENOSPC)
        with TemporaryFile(dir=path.parent) as file:
            file.write(bytes(CHUNK))
            os.fsync(file)
    except OSError as error:
        return error.strerror
    return None


def load(path: str | Path) -> xr.Dataset:
    """Read a whole Dataset into memory.

    Raises:
        FileNotFoundError: there is no such file.
        ValueError: it is broken, or larger than memory; one sentence.
    """
    try:
        with timed.part("read"), xr.open_dataset(path, engine="netcdf4") as data:
            if data.nbytes > of_this_machine():  # a file of some bytes may say so
                raise ValueError(
                    f"{path} holds {1e-9 * data.nbytes:.3g} GB, and a job here may take "
                    f"{1e-9 * of_this_machine():.3g} GB of memory; read it on a larger one"
                )
            return unlabelled(data.load())
    except FileNotFoundError:
        raise
    except Exception as error:  # whatever a damaged header or a flipped bit ends in
        raise ValueError(
            f"{path} cannot be read ({error}): if it was cut short, delete it and have it made anew"
        ) from error


def attributes(path: str | Path) -> dict:
    """The attributes of a file, without its values; errors as for `load`."""
    try:
        with netCDF4.Dataset(path) as data:  # a tenth of what xarray takes to open it
            return {name: data.getncattr(name) for name in data.ncattrs()}
    except FileNotFoundError:
        raise
    except OSError as error:
        raise ValueError(
            f"{path} cannot be read ({error}): delete it and have it made anew"
        ) from error


def rounded(moved: np.ndarray) -> np.ndarray:
    """A motion (time, ...), m, each signal to multiples of a power of two well below what it does.

    The unit follows from the rms about the mean in the quietest tenth of the run, so that neither a
    static stretch nor a start that has died away costs the rest any digits. A signal that is still
    in one of the tenths keeps all. What follows an instability (NaN) is left out of account.
    """
    sound = moved[np.isfinite(moved).all(axis=tuple(range(1, moved.ndim)))]
    if len(sound) < 2:
        return moved
    parts = np.array_split(sound, min(PARTS, len(sound) // 2))
    quietest = np.min([part.std(axis=0) for part in parts], axis=0)
    moves = quietest > 0.0
    _, exponent = np.frexp(quietest)  # 2^(exponent - 1) <= rms < 2^exponent
    unit = np.where(moves, np.ldexp(1.0, exponent - 1 - BITS), 1.0)
    result = moved / unit
    np.rint(result, out=result, where=moves)
    result *= unit
    return result


def _stored(motion: xr.DataArray) -> xr.DataArray:
    """A motion as it is written, with a remark on what was rounded."""
    remark = f"rounded to below 2^-{BITS} of each signal's rms in the quietest tenth of the run"
    values = rounded(motion.transpose("time", ...).values)
    stored = motion.transpose("time", ...).copy(data=values).transpose(*motion.dims)
    return stored.assign_attrs(comment=remark)


def _filling(data: xr.Dataset, name: str) -> dict:
    """CF wants no value that stands for a missing one among coordinates of a dimension."""
    return {"_FillValue": None} if name in data.dims else {}


def _chunks(name: str, variable: xr.DataArray) -> dict:
    """Signal by signal, in which neighbours in time are alike and deflate well; several of short
    ones together, since a chunk has a price of its own."""
    if name not in MOTIONS or not variable.size:
        return {}
    sizes = dict(variable.sizes)
    frames = min(sizes.pop("time"), CHUNK)
    lengths = dict.fromkeys(sizes, 1) | {"time": frames}
    across = max(sizes, key=sizes.get)
    lengths[across] = min(sizes[across], max(1, CHUNK // 8 // frames))
    return {"chunksizes": tuple(lengths[dim] for dim in variable.dims)}
