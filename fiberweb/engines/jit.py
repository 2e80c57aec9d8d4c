"""How the kernels are compiled; `fiberweb.engines.cache` keeps the result."""

from __future__ import annotations

import llvmlite.binding as llvm
from numba import njit

from fiberweb.engines import cache

cache.use()  # before anything is compiled

# A pass over n arrays needs up to n^2 checks that none overlap; LLVM gives up at 8 and then
# leaves square roots and divisions scalar.
llvm.set_option("", "-runtime-memory-check-threshold=500")

# Division by zero gives inf, as in numpy: a test in the loop would keep it scalar. Contraction
# allows fused multiply-add and nothing else, so results repeat to the bit.
_HOW = {"cache": True, "error_model": "numpy", "nogil": True}
# What no Python calls needs none of the code around it, which takes longer to compile. Called from
# Python all the same, also by `py_func` of another, it ends the process: use `both` there.
_INSIDE = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
# What Python calls: the loop over steps.
entry = njit(**_HOW, fastmath={"contract"})
# What that calls. Inlined always: the compiler then takes the checks that arrays do not overlap out
# of the loop over steps, a third of a small network's time; and a process that compiles runs the
# same instructions as one that loads them, so that both give the same bits.
kernel = njit(**_HOW, **_INSIDE, fastmath={"contract"}, forceinline=True)
# A kernel that Python calls, too.
both = njit(**_HOW, fastmath={"contract"}, forceinline=True)
# A kernel where rounding is the subject: no contraction.
uncontracted = njit(**_HOW, fastmath=False, forceinline=True)
# A kernel with sums in any order, so that they vectorise: still the same order every time.
summing = njit(**_HOW, **_INSIDE, fastmath={"contract", "reassoc"}, forceinline=True)
