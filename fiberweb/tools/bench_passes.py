"""`python -m fiberweb.tools.bench_passes`: cost of each pass of the planar kernels, and the least.

ns per element, the minimum of several repeats, over chains of several lengths; in brackets the
least on this machine: what as many loads and stores cost in a loop that only adds (measured),
or as many square roots and divisions (measured), whichever is more.
"""

from __future__ import annotations

import timeit
from functools import cache

import numpy as np
from numba import njit

from fiberweb.engines import authors_rotations, laplace
from fiberweb.engines import cosserat_passes as cosserat
from fiberweb.engines import kirchhoff_passes as kirchhoff
from fiberweb.engines.jit import kernel
from fiberweb.engines.layout import packed

SIZES = (160, 300, 600, 1200, 2000)
INNER, REPEATS = 2000, 9
STEP = 1e-9
# pass, arrays, scalars after them, then loads, stores, roots, divisions an element
PASSES = {
    "kirchhoff": [
        ("stretch", kirchhoff.stretch_pass, 8, (), 5, 4, 0, 0),
        ("turn", kirchhoff.turn_pass, 7, (), 5, 2, 0, 0),
        ("tension", kirchhoff.tension_pass, 8, (0.5,), 6, 2, 0, 0),
        ("moment", kirchhoff.moment_pass, 13, (), 13, 1, 0, 0),
        ("force", kirchhoff.force_pass, 7, (), 6, 2, 0, 0),
        ("kick and drift x", kirchhoff.kick_pass, 6, (0.99, STEP), 6, 2, 0, 0),
        ("kick and drift y", kirchhoff.kick_pass, 6, (0.99, STEP), 6, 2, 0, 0),
    ],
    "cosserat": [
        ("stress", cosserat.stress_pass, 19, (), 15, 4, 1, 1),
        ("couple", cosserat.couple_pass, 7, (), 6, 1, 0, 1),
        ("kick x", cosserat.velocity_pass, 5, (0.99,), 5, 1, 0, 0),
        ("kick y", cosserat.velocity_pass, 5, (0.99,), 5, 1, 0, 0),
        ("spin", cosserat.spin_pass, 9, (STEP,), 9, 1, 0, 0),
        ("drift x", cosserat.drift_pass, 2, (STEP,), 2, 1, 0, 0),
        ("drift y", cosserat.drift_pass, 2, (STEP,), 2, 1, 0, 0),
        ("rotate", cosserat.rotate_pass, 4, (STEP,), 4, 3, 0, 0),
    ],
    "the authors' rotations instead": [
        ("couple", authors_rotations.couple_pass, 9, (), 8, 1, 0, 1),
        ("rotate", authors_rotations.rotate_pass, 4, (STEP,), 4, 3, 0, 0),
    ],
    "Laplace filter, of x, y and angle": [
        ("difference", laplace.difference_pass, 5, (), 4, 1, 0, 0),
        ("stencil", laplace.stencil_pass, 13, (1.0,) * 6, 13, 1, 0, 0),
    ]
    * 3,
}


@kernel
def add_eight(a, b, c, d, e, f, g, h, out):
    """Eight loads and a store an element."""
    for i in range(out.shape[0]):
        out[i] = ((a[i] + b[i]) + (c[i] + d[i])) + ((e[i] + f[i]) + (g[i] + h[i]))


@kernel
def scale(a, out):
    """A load and a store an element."""
    for i in range(out.shape[0]):
        out[i] = 1.5 * a[i]


@kernel
def root(a, out):
    """A square root an element, with a load and a store."""
    for i in range(out.shape[0]):
        out[i] = np.sqrt(a[i])


@kernel
def divide(a, out):
    """A division an element, with a load and a store."""
    for i in range(out.shape[0]):
        out[i] = 1.0 / a[i]


def main() -> None:
    """Print a table for each kernel."""
    print(__doc__)
    unit = {size: _units(size) for size in SIZES}
    for title, passes in PASSES.items():
        print(f"{title:<34}" + "".join(f"{size:>8} elements" for size in SIZES))
        total = np.zeros((len(SIZES), 2))
        for name, function, count, scalars, *counts in passes:
            row = []
            for size in SIZES:
                cost = _time(function, (*_arrays(size, count), *scalars), size)
                row.append((cost, least(unit[size], *counts)))
            total += np.array(row)
            print(f"  {name:<32}" + "".join(f"{a:>10.2f} ({b:4.2f})" for a, b in row))
        print(f"  {'sum':<32}" + "".join(f"{a:>10.2f} ({b:4.2f})" for a, b in total) + "\n")


def least(unit, loads: int, stores: int, roots: int, divisions: int) -> float:
    """ns per element of the memory traffic, or of roots and divisions, whichever is more."""
    load, store, root_time, divide_time = unit
    return max(loads * load + stores * store, roots * root_time + divisions * divide_time)


def _units(size: int) -> tuple[float, float, float, float]:
    """ns of a load, a store, a square root and a division per element."""
    eight = _time(add_eight, _arrays(size, 9), size)
    one = _time(scale, _arrays(size, 2), size)
    load = max((eight - one) / 7.0, 0.0)
    times = (_time(function, _arrays(size, 2), size) for function in (root, divide))
    return load, max(one - load, 0.0), *times


def _arrays(size: int, count: int) -> tuple[np.ndarray, ...]:
    return packed(*(np.random.RandomState(k).rand(size) for k in range(count)))


def _time(function, arguments, size: int) -> float:
    """ns per element of one pass, without the cost of calling it from Python."""
    repeated = _repeated(len(arguments))
    repeated(function, 1, *arguments)
    calls = max(10, INNER * 100 // size)
    times = timeit.repeat(lambda: repeated(function, calls, *arguments), number=1, repeat=REPEATS)
    return 1e9 * min(times) / calls / size


@cache
def _repeated(count: int):
    """A compiled loop that calls a pass with `count` arguments again and again."""
    names = ", ".join(f"a{i}" for i in range(count))
    code = f"def loop(f, calls, {names}):\n    for _ in range(calls):\n        f({names})\n"
    scope: dict = {}
    exec(code, scope)
    return njit(scope["loop"], error_model="numpy")


if __name__ == "__main__":
    main()
