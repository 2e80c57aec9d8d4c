"""How the kernels are compiled, and where the result is kept.

Compiled kernels are cached on disk in a folder named by a hash of the engines' sources: Numba
keys a cache entry by the file of the function itself, so an edited callee would otherwise
leave a stale caller behind.
"""

from __future__ import annotations

import os
from pathlib import Path

from fiberweb.source import source_hash


def _cache_folder() -> Path:
    base = os.environ.get("FIBERWEB_CACHE") or Path.home() / ".cache" / "fiberweb"
    return Path(base) / source_hash()


os.environ.setdefault("NUMBA_CACHE_DIR", str(_cache_folder()))

import llvmlite.binding as llvm  # noqa: E402  (the cache folder must be set before Numba loads)
from numba import njit  # noqa: E402

# A pass over n arrays needs up to n^2 checks that none overlap; LLVM gives up at 8 and then
# leaves square roots and divisions scalar.
llvm.set_option("", "-runtime-memory-check-threshold=500")

# Division by zero gives inf, as in numpy: a test in the loop would keep it scalar. Contraction
# allows fused multiply-add and nothing else, so results repeat to the bit.
_HOW = {"cache": True, "error_model": "numpy", "nogil": True}
# What Python calls: the loop over steps.
entry = njit(**_HOW, fastmath={"contract"})
# What that calls. Inlined always: the compiler then takes the checks that arrays do not overlap out
# of the loop over steps, a third of a small network's time; and a process that compiles runs the
# same instructions as one that loads them, so that both give the same bits.
kernel = njit(**_HOW, fastmath={"contract"}, forceinline=True)
# A kernel where rounding is the subject: no contraction.
uncontracted = njit(**_HOW, fastmath=False, forceinline=True)
# A kernel with sums in any order, so that they vectorise: still the same order every time.
summing = njit(**_HOW, fastmath={"contract", "reassoc"}, forceinline=True)
