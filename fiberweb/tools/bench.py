"""`make bench`: PyElastica and ours on the same scenes, in one run on one machine.

Every figure is CPU time of one process on one core, from windows of both engines taken in
turn, so that a ratio compares moments next to each other; medians are printed. Errors are of
displacement over the first second, rms over the rms of the converged answer (kirchhoff, 16
elements a section); PyElastica's is that of `cosserat` on the same mesh and step, which equals
it to round-off (tests/engines/test_equality.py). Ours comes twice where the meshes differ: on the
coarsest mesh that is no worse than PyElastica's, and at the accuracy that runs have by default.
Then our kernels over the sizes of a network, the scoring of the largest run (912 signals, 25 000
samples, 261 targets; noise for readouts), and what a job costs beside its physics.
"""

from __future__ import annotations

import os
import subprocess
import sys
import time
from dataclasses import replace
from statistics import median

import numpy as np
from elastica import PositionVerlet

from fiberweb import Scene, crosshatch, engines
from fiberweb.engines import elastica
from fiberweb.engines.base import Numerics, steps_per_sample
from fiberweb.model import authors
from fiberweb.model.mesh import build
from fiberweb.simulation.plan import ACCURACIES, plan
from fiberweb.validation.accuracy import difference, modelled

WINDOWS = 5  # odd, for a median
OLD_STEPS = 300  # of PyElastica in a window
NEW_SECONDS = 5.0  # simulated by ours in a window
SECONDS = 100.0  # of a run of the paper
SIZES = (2, 4, 6, 8, 10, 12, 16)  # N of the networks whose kernels are timed
FINEST = 16  # elements a section of the converged answer
HEADER = (
    f"{'setup':<10} {'network':<8} {'engine':<10} {'elements':>8} {'step us':>8} {'us/step':>9} "
    f"{'ns/el-step':>10} {'s/100 s':>9} {'error %':>8} {'ratio':>7}"
)


def main() -> None:
    """Print the table."""
    print(__doc__)
    print(HEADER)
    for setup, n, engine in (
        ("described", 4, "kirchhoff"),
        ("described", 8, "kirchhoff"),
        ("published", 4, "cosserat"),
    ):
        scene = Scene(crosshatch(n, length=0.5), setup)
        for elements in meshes(scene):
            compare(scene, engine, elements)
    print("\nkernels, ns an element and step (elements):")
    for label, setup, changes in (
        ("described", "described", {}),
        ("published", "published", {}),
        ("no band", "published", {"dead_band": False}),
    ):
        print(f"  {label:<10}" + "".join(f"{kernel(n, setup, **changes):>16}" for n in SIZES))
    print()
    for scoring in ("clean", "published"):
        seconds, memory = scored(scoring)
        print(f"{scoring} scoring of 12x12: {seconds:.1f} s, {memory:.2f} GB")
    print(f"\nstart, import, load compiled kernels, write: {job_overhead():.2f} s a run")


def meshes(scene: Scene) -> list[int | None]:
    """Elements per section to compare with PyElastica; None for the authors' own mesh."""
    if scene.setup == "published":
        return [None]
    exact = displacement(scene, "kirchhoff", FINEST)
    allowed = difference(authors_displacement(scene), exact)
    fair = next(
        n
        for n in range(2, FINEST)
        if difference(displacement(scene, "kirchhoff", n), exact) <= allowed
    )
    return list(dict.fromkeys([fair, ACCURACIES["standard"]]))


def compare(scene: Scene, engine: str, elements: int | None) -> None:
    """PyElastica on the authors' mesh and step against ours on a mesh of ours."""
    old = Numerics("elastica", None, authors.STEP)
    new = plan(scene, engine=engine, elements_per_section=elements).numerics
    old_mesh = modelled("elastica", scene, None)
    new_mesh = build(scene, new.elements_per_section)
    simulator, _, step, per_sample = elastica.assemble(old_mesh, old)
    stepper, now = PositionVerlet(), 0.0
    now = elastica.run_steps(simulator, stepper, now, step, OLD_STEPS)  # compiles
    window = build(replace(scene, duration=NEW_SECONDS), new.elements_per_section)
    new_steps = steps_per_sample(scene, new.time_step)
    ours = engines.load(engine)
    ours.integrate(window, new)
    old_times, new_times = [], []
    for _ in range(WINDOWS):
        start = time.process_time()
        now = elastica.run_steps(simulator, stepper, now, step, OLD_STEPS)
        old_times.append((time.process_time() - start) / OLD_STEPS)
        start = time.process_time()
        ours.integrate(window, new)
        new_times.append((time.process_time() - start) / (new_steps * window.scene.samples))
    old_rate = SECONDS * scene.sample_rate * per_sample
    new_rate = SECONDS * scene.sample_rate * new_steps
    ratio = median(a * old_rate / (b * new_rate) for a, b in zip(old_times, new_times))
    old_error = new_error = np.nan  # mesh and step are part of the published setup's definition
    if elements is not None:
        exact = displacement(scene, "kirchhoff", FINEST)
        old_error = difference(authors_displacement(scene), exact)
        new_error = difference(displacement(scene, engine, elements), exact)
    _row(scene, "elastica", old_mesh, old_rate, median(old_times), old_error, 1.0)
    _row(scene, engine, new_mesh, new_rate, median(new_times), new_error, ratio)


def displacement(scene: Scene, engine: str, elements: int, step: float | None = None) -> np.ndarray:
    """Of every readout over the first second, shape (samples, readouts, 2), m."""
    short = replace(scene, duration=1.0)
    if step is None:
        step = plan(short, engine=engine, elements_per_section=elements).numerics.time_step
    numerics = Numerics(engine, elements, step)
    return engines.load(engine).integrate(modelled(engine, short, elements), numerics).displacement


def authors_displacement(scene: Scene) -> np.ndarray:
    """The same on PyElastica's mesh with crossings on nodes: 10 mm is not a whole part of every
    section."""
    return displacement(
        scene, "cosserat", round(scene.network.spacing / authors.ELEMENT), authors.STEP
    )


def _row(scene, engine, mesh, steps, per_step, error, ratio) -> None:
    n = scene.network.n
    print(
        f"{scene.setup:<10} {f'{n}x{n}':<8} {engine:<10} {mesh.elements:>8} "
        f"{1e6 * SECONDS / steps:>8.2f} {1e6 * per_step:>9.2f} "
        f"{1e9 * per_step / mesh.elements:>10.2f} {per_step * steps:>9.2f} "
        f"{100 * error:>8.2f} {ratio:>7.0f}",
        flush=True,
    )


def kernel(n: int, setup: str, **changes) -> str:
    """ns an element and step of a whole run with the setup's own engine and mesh, median."""
    scene = Scene(crosshatch(n, length=0.5), setup, duration=2 * NEW_SECONDS / n, **changes)
    numerics = plan(scene).numerics
    mesh, engine = build(scene, numerics.elements_per_section), engines.load(numerics.engine)
    engine.integrate(mesh, numerics)
    times = []
    for _ in range(WINDOWS):
        start = time.process_time()
        engine.integrate(mesh, numerics)
        times.append(time.process_time() - start)
    steps = steps_per_sample(scene, numerics.time_step) * scene.samples
    return f"{1e9 * median(times) / steps / mesh.elements:.2f} ({mesh.elements})"


def scored(scoring: str) -> tuple[float, float]:
    """CPU seconds (median) and peak memory (GB) of a process that scores the largest run."""
    code = (
        "import resource, time\n"
        "import numpy as np\n"
        "from fiberweb.scoring.capacity import score_arrays\n"
        "from fiberweb.model.drive import spline\n"
        "time_s = np.arange(25_000) / 250.0\n"
        "readouts = np.random.default_rng(0).standard_normal((25_000, 912), dtype=np.float32)\n"
        "start = time.process_time()\n"
        f"score_arrays(spline(1234, 100.0, 5.0)(time_s), readouts, 250.0, scoring={scoring!r})\n"
        "taken = time.process_time() - start\n"
        "print(taken, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
    )
    outputs = [
        subprocess.run(
            [sys.executable, "-c", code], check=True, capture_output=True, text=True,
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
        ).stdout.split()
        for _ in range(3)
    ]  # fmt: skip
    seconds, kilobytes = zip(*outputs)
    return median(map(float, seconds)), 1e-6 * max(map(float, kilobytes))


def job_overhead() -> float:
    """Wall seconds of a job beyond its physics: a run of two samples, start to file, median."""
    code = (
        "import tempfile\n"
        "from fiberweb import Scene, crosshatch, simulate\n"
        "from fiberweb.simulation.dataset import save\n"
        "save(simulate(Scene(crosshatch(4, length=0.5), duration=0.008)),"
        " tempfile.mkdtemp() + '/r.nc')"
    )
    times = []
    for _ in range(WINDOWS):
        start = time.perf_counter()
        subprocess.run([sys.executable, "-c", code], check=True)
        times.append(time.perf_counter() - start)
    return median(times)


if __name__ == "__main__":
    main()
