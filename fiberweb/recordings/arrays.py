"""Files of named arrays: a recording out of the paths that the options name."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from pathlib import Path

import numpy as np

from fiberweb.errors import unknown_key
from fiberweb.recordings.base import Raw, driven
from fiberweb.recordings.options import Reading

COLUMN = re.compile(r"(.+)\[(\d+)\]")


def recording(
    path: Path, options: Reading, get: Callable[[str], object], known: Iterable[str]
) -> Raw:
    """The recording in a file of arrays.

    Args:
        path: of the file, for what is said of it.
        options: `markers` has to be the path of an array (T, m, 2 or 3); `input` and `time` those
            of arrays (T,), or of one column of an array, as in ``servo[0]``.
        get: the array at a path; KeyError if there is none.
        known: the paths that exist.

    Raises:
        ValueError: one sentence with the file, the key and what would be right.
    """
    known = list(known)

    def array(key: str, name: str) -> np.ndarray:
        column = COLUMN.fullmatch(name)
        try:
            values = np.asarray(get(column[1] if column else name))
        except KeyError:
            raise ValueError(
                f"{path}: {key} = {name!r}: {unknown_key(name, known, kind='path')}"
            ) from None
        if values.dtype.kind not in "fiub":
            raise ValueError(f"{path}: {key} = {name!r} holds {values.dtype} and no numbers")
        if column:
            if not int(column[2]) < values.shape[-1]:
                raise ValueError(
                    f"{path}: {key} = {name!r}: the last axis of {column[1]} {values.shape} ends "
                    f"at {values.shape[-1] - 1}"
                )
            values = values[..., int(column[2])]
        return np.squeeze(values.astype(float))

    if not isinstance(options.markers, str):
        raise ValueError(
            f"{path} is a file of arrays: name one with markers: path; it has {', '.join(known)}"
        )
    positions = array("markers", options.markers)
    if positions.ndim != 3 or positions.shape[2] not in (2, 3):
        raise ValueError(
            f"{path}: markers = {options.markers!r} has shape {positions.shape}; give an array of "
            "(frames, markers, 2 or 3)"
        )
    names = [f"m{number}" for number in range(positions.shape[1])]
    given = time = None
    if not options.input:
        raise ValueError(f"{path}: name the input: a path of {', '.join(known)}, or m0.x")
    if not driven(options.input, names, options.plane):
        given = array("input", options.input)
    if options.time:
        time = array("time", options.time)
    for key, values in (("input", given), ("time", time)):
        if values is not None and values.shape != positions.shape[:1]:
            raise ValueError(
                f"{path}: {key} has shape {values.shape} and markers {positions.shape}: give one "
                f"value a frame"
            )
    return Raw(in_plane(positions, options.plane), names, given, time)


def in_plane(positions: np.ndarray, plane: str) -> np.ndarray:
    """(T, m, 2) of positions (T, m, 2 or 3)."""
    if positions.shape[2] == 2:
        return positions
    return positions[:, :, ["xyz".index(axis) for axis in plane]]
