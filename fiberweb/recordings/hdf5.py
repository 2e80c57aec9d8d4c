"""HDF5 files as MATLAB 7.3 and OpenPRC write them: arrays by their paths."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py

MAGIC = b"\x89HDF\r\n\x1a\n"


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """A file to read from; ValueError, one sentence, if it is broken."""
    try:
        with h5py.File(path, "r") as file:
            yield file
    except (OSError, RuntimeError) as error:  # the latter for what is broken further inside
        raise ValueError(f"{path} cannot be read ({error}): it may have been cut short") from None


def arrays(file: h5py.File) -> list[str]:
    """The paths of all arrays."""
    found = []
    file.visititems(lambda name, node: found.append(name) if hasattr(node, "shape") else None)
    return [name for name in found if not name.startswith("#")]
