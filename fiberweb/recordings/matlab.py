"""MATLAB files, version 5 and 7.3: arrays in structs, by paths such as ``trackingData.servoPos``.

`rate` is stated, or read from the struct that holds the markers if that has a field `samplerate`,
`sampleRate`, `fps`, `frameRate` or `framerate`.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable, Collection
from pathlib import Path

import numpy as np
import scipy.io

from fiberweb.recordings import arrays, hdf5
from fiberweb.recordings.base import Raw, check_size, head
from fiberweb.recordings.options import Reading

RATES = ("samplerate", "sampleRate", "fps", "frameRate", "framerate")
# of version 5: bytes before the first part, and what marks one that is packed
FIRST, COMPRESSED = 128, 15
BLOCK = 1 << 20


def recognises(path: Path, head: bytes) -> bool:
    return path.suffix.lower() == ".mat" or head.startswith(b"MATLAB ")


def read(path: Path, options: Reading) -> Raw:
    """Read a MATLAB file; errors as `fiberweb.recordings.arrays.recording` has them."""
    if head(path).startswith((b"MATLAB 7.3", hdf5.MAGIC)):
        with hdf5.opened(path) as file:
            known = {name.replace("/", "."): name for name in hdf5.arrays(file)}
            # MATLAB writes its arrays column by column, so that their axes come in reverse
            return _recording(
                path, options, lambda name: hdf5.read(path, file, known[name]).T, known
            )
    check_size(path, _unpacked(path) / 8)
    leaves = dict(_leaves(_loaded(path)))
    return _recording(path, options, leaves.__getitem__, leaves)


def _recording(path: Path, options: Reading, get: Callable, known: Collection[str]) -> Raw:
    """The recording among named arrays, with the rate that stands beside its markers."""
    raw = arrays.recording(path, options, get, known)
    group = str(options.markers).rpartition(".")[0]
    beside = (f"{group}.{name}" if group else name for name in RATES)
    if (name := next((name for name in beside if name in known), None)) is not None:
        try:
            raw.rate = float(np.squeeze(get(name)))
        except (TypeError, ValueError):
            raise ValueError(f"{path}: {name} is no number: correct it in the file") from None
    return raw


def _unpacked(path: Path) -> int:
    """Bytes of a file of version 5 once its parts are unpacked, as far as it can be read."""
    total = 0
    with path.open("rb") as file:
        order = "<" if file.read(FIRST)[-2:] == b"IM" else ">"
        while len(tag := file.read(8)) == 8:
            kind, count = struct.unpack(f"{order}II", tag)
            total += count
            if kind != COMPRESSED:
                file.seek(count, 1)
                continue
            packed, end = zlib.decompressobj(), file.tell() + count
            try:
                while (left := end - file.tell()) > 0 and (part := file.read(min(left, BLOCK))):
                    total += len(packed.decompress(part, BLOCK))
                    while packed.unconsumed_tail:
                        total += len(packed.decompress(packed.unconsumed_tail, BLOCK))
                        check_size(path, total / 8)
            except zlib.error:
                break
    return total


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
