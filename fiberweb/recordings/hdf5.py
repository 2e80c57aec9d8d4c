"""HDF5 files as MATLAB 7.3 and OpenPRC write them: arrays by their paths."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np

from fiberweb.recordings.base import check_size

MAGIC = b"\x89HDF\r\n\x1a\n"


@contextmanager
def opened(path: Path) -> Iterator[h5py.File]:
    """A file to read from; ValueError, one sentence, if it is broken."""
    try:
        with h5py.File(path, "r") as file:
            yield file
    except ValueError:
        raise
    except Exception as error:  # of what is broken further inside, whatever the bytes lead to
        raise ValueError(f"{path} cannot be read ({error}): it may have been cut short") from None


def read(path: Path, file: h5py.File, name: str) -> np.ndarray:
    """An array of numbers.

    Raises:
        KeyError: there is no array of this name.
        ValueError: it holds something else, does not fit in memory, or is kept in another file,
            which may be any file of this machine.
    """
    node = file[name]
    if not isinstance(node, h5py.Dataset):
        raise KeyError(name)
    if node.external or node.is_virtual or node.file.filename != file.filename:
        raise ValueError(f"{path}: {name!r} is kept in another file: copy it into this one")
    if node.dtype.kind not in "fiub":
        raise ValueError(f"{path}: {name!r} holds {node.dtype} and no numbers")
    check_size(path, node.size or 0)
    return np.asarray(node)


def arrays(file: h5py.File) -> list[str]:
    """The paths of all arrays."""
    found = []
    file.visititems(lambda name, node: found.append(name) if hasattr(node, "shape") else None)
    return [name for name in found if not name.startswith("#")]
