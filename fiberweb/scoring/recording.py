"""A response as the arrays that are scored: input, signals, and the rate that its time says."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fiberweb.arguments import shown
from fiberweb.model.readouts import AXES, as_signals

if TYPE_CHECKING:
    import xarray as xr

JITTER = 0.01  # of a frame, by which a frame may be off: what single precision makes of 100 s

SECONDS = ("s", "sec", "second", "seconds")


def own_scoring(response: xr.Dataset) -> str:
    """The scoring of a response's own setup: 'published' for that one, 'clean' for the others."""
    return "published" if response.attrs["setup"] == "published" else "clean"


def signals(response: xr.Dataset) -> np.ndarray:
    """Displacements (T, 2m) of a response, m, ordered as by `fiberweb.model.readouts`."""
    moved = response["displacement"].transpose("time", "readout", "axis")
    return as_signals(*(moved.sel(axis=a).values for a in AXES))


def scored_input(response: xr.Dataset, scoring: str) -> np.ndarray:
    """The input (T,) that estimates are compared with: in the published scoring of a published run
    that of the authors' scoring, see `fiberweb.model.drive.scored`."""
    theirs = scoring == "published" and "scored_input" in response
    return response["scored_input" if theirs else "input"].values


def seconds(response: xr.Dataset) -> np.ndarray:
    """Time of the frames, s; ValueError, one sentence, if it is none."""
    if "time" not in response.coords:
        raise ValueError("response has no coordinate 'time'; give its frames their time in s")
    time = response["time"].values
    if time.dtype.kind in "mM":  # what xarray makes of some units
        return (time - time[:1]) / np.timedelta64(1, "s")
    if (units := response["time"].attrs.get("units", "s")) not in SECONDS:
        raise ValueError(f"response has time in {units!r}; give it in s, and leave units at 's'")
    if time.dtype.kind not in "iuf" or not np.isfinite(time).all():
        raise ValueError(f"response has time = {shown(time)}, where numbers of seconds are needed")
    return time.astype(float)


def sample_rate(response: xr.Dataset) -> float:
    """Frames per second (Hz), from the time coordinate.

    The attribute ``sample_rate`` is that of the recording, which may have been thinned, averaged or
    interpolated since. ValueError, one sentence, unless frames follow each other evenly.
    """
    time = seconds(response)
    if len(time) < 2:
        raise ValueError(f"response has {len(time)} frames; give a recording of some seconds")
    rate = (len(time) - 1) / (time[-1] - time[0]) if time[-1] != time[0] else math.inf
    if not 0.0 < rate < math.inf:
        raise ValueError(
            f"response has time from {time[0]:g} s to {time[-1]:g} s; sort its frames, "
            "response.sortby('time')"
        )
    off = (time - time[0]) * rate - np.arange(len(time))
    if np.abs(off).max() > JITTER:
        gap = np.argmax(np.abs(np.diff(off)))
        raise ValueError(
            f"response has uneven time: {time[gap + 1] - time[gap]:g} s from frame {gap} to the "
            f"next, {1.0 / rate:g} s on average; cut out an even stretch or interpolate it"
        )
    stated = response.attrs.get("sample_rate")
    if isinstance(stated, (int, float)) and math.isclose(rate, stated, rel_tol=JITTER / len(time)):
        return float(stated)  # without the round-off of the quotient
    return rate
