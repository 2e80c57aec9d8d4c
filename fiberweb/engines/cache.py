"""Where compiled kernels are kept, and what happens where that is broken.

They are kept in a folder named by a hash of the engines' sources: Numba keys an entry by the file
of the function itself, so an edited callee would otherwise leave a stale caller behind. This folder
lies in `$FIBERWEB_CACHE`, in `$NUMBA_CACHE_DIR`, which clusters set, or in the home folder; if
nothing can be written there, in the temporary one.
"""

from __future__ import annotations

import os
import tempfile
import warnings
from functools import wraps
from pathlib import Path

import numba
from numba.core.caching import Cache, CacheImpl, UserProvidedCacheLocator

from fiberweb.source import ROOT, source_hash


def folder() -> Path:
    """The folder of this state of the sources; it exists and can be written."""
    named = os.environ.get("FIBERWEB_CACHE") or os.environ.get("NUMBA_CACHE_DIR")
    wanted = Path(named or "~/.cache/fiberweb", source_hash())
    try:
        return _writable(wanted.expanduser().absolute())
    except (OSError, RuntimeError) as error:  # the latter where there is no home folder
        reason = getattr(error, "strerror", error)
        instead = _temporary() / source_hash()
        warnings.warn(
            f"compiled kernels cannot be kept in {wanted} ({reason}): {instead} has them "
            "until it is cleared; set FIBERWEB_CACHE to a folder that can be written",
            stacklevel=2,
        )
        return _writable(instead)


def _writable(path: Path) -> Path:
    path.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryFile(dir=path):
        return path


def _temporary() -> Path:
    """A folder of this user alone: whoever can write it decides what is run."""
    user = os.getuid() if hasattr(os, "getuid") else ""
    path = Path(tempfile.gettempdir(), f"fiberweb-{user}")
    path.mkdir(mode=0o700, exist_ok=True)
    if user == "" or (path.stat().st_uid == user and not path.stat().st_mode & 0o022):
        return path
    return Path(tempfile.mkdtemp(prefix="fiberweb-"))


def _or_none(load):
    """`Cache.load_overload`, with None, so that it is compiled, in place of a file cut short."""

    @wraps(load)
    def loaded(self, sig, target_context):
        try:
            return load(self, sig, target_context)
        except Exception as error:  # whatever reading half a pickle may end in
            self.flush()
            what = f"a compiled kernel in {self.cache_path} cannot be read"
            warnings.warn(f"{what} ({error!r}): it is compiled anew", stacklevel=2)
            return None

    return loaded


class _OfAnyClone(UserProvidedCacheLocator):
    """Where a kernel of this package is kept: not by the path of its file, as Numba's own do, so
    that clones of the same sources share what is compiled."""

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        if Path(py_file).is_relative_to(ROOT):
            return Path(py_file).parent.name
        return super().get_suitable_cache_subpath(py_file)


def use() -> None:
    """Have Numba keep what is compiled from now on in `folder`.

    In Numba's config and not in its variable: that is read when Numba is first imported, which may
    be long ago, and is handed down to processes that would put a folder into this one.
    """
    numba.config.CACHE_DIR = str(folder())
    CacheImpl._locator_classes = [_OfAnyClone, *CacheImpl._locator_classes]
    Cache.load_overload = _or_none(Cache.load_overload)
