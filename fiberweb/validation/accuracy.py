"""What accuracy costs, and what each simplification changes.

Errors are against the converged solution of the described setup: the fourth-order engine at 16
and 32 elements per section, extrapolated (Richardson). Trajectory error: rms of the difference
over all readouts, directions and instants, over the rms of the reference. Time: of this process's
CPU, in windows of its own.
"""

from __future__ import annotations

import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from fiberweb import timed
from fiberweb.engines import accepts, load
from fiberweb.engines.base import Numerics, fitted_step
from fiberweb.meanings import explained
from fiberweb.model import authors
from fiberweb.model.mesh import Mesh, build
from fiberweb.model.network import crosshatch
from fiberweb.model.scene import Scene
from fiberweb.scoring import capacity
from fiberweb.simulation.plan import ACCURACIES, SAFETY
from fiberweb.simulation.response import response

RUN = 100.0  # s of simulated time that `seconds_per_run` is for
ORDER = 4  # of the reference, in the element length: tests/engines/test_convergence.py
FINEST = 32  # elements per section of the finest run; the error at 16 is 2e-4 already
TIMED = 0.4  # s of CPU in a timing window of a planar engine, at least
REPEATS = 3  # windows; the fastest counts
COMPARED = 20_000  # steps of the cosserat engine against PyElastica, as in that test
SLOW = 8  # N of a crosshatch from which on the slower engines have one mesh only: minutes a run
STAND_IN = {"elastica": "cosserat"}  # to round-off: tests/engines/test_equality.py
STIFF = authors.PHYSICS["crosshatch"]["crossing_stiffness"]  # N/m: far stiffer than the fibres

MESH = {
    "engine": "kirchhoff, cosserat or elastica; or exudyn",
    "elements_per_section": "elements on a section as long as the spacing; authors: their mesh",
    "time_step": ("step of the integration", "s"),
}
COST = {"seconds_per_run": (f"CPU time of a run of {RUN:g} s", "s")}
COLUMNS = {
    "engine": MESH["engine"],
    "setup": "described, published or compliant",
    "network": "size of the crosshatch",
    "elements_per_section": MESH["elements_per_section"],
    "time_step": MESH["time_step"],
    **COST,
    "ns_per_element_step": ("CPU time for each element and step", "ns"),
    "trajectory_error": "rms of the difference from the converged run, over its rms",
    "c_nl_error": "of C_nl, from the converged run",
    "c_m_error": "of C_m, from the converged run",
    "speedup_vs_pyelastica": "CPU time of PyElastica over this",
    "errors_from": "the run that the errors were found by",
}
LADDER_COLUMNS = (
    {"rung": "its name", "change": "against the rung above"}
    | MESH
    | COST
    | {
        "compared_s": ("length of the trajectories that are compared", "s"),
        "trajectory_change": "rms of the difference from the rung above, over its rms",
        "c_nl": "nonlinear capacity: test part",
        "c_nl_change": "of C_nl, from the rung above",
        "c_m": "memory capacity: test part",
        "c_m_change": "of C_m, from the rung above",
    }
)


@dataclass(frozen=True)
class Case:
    """A network and how it is integrated.

    `elements` None is the authors' mesh; `step` is in s, or None for `share` of the limit;
    `order` is that of an engine that has several, None for the highest; `stiff`: crossings are
    springs of `STIFF` and not one point, as they always are to an engine that has only springs.
    """

    engine: str
    n: int
    elements: int | None
    length: float = 0.5
    buckling: float = 0.8
    setup: str = "described"
    share: float = SAFETY
    step: float | None = None
    order: int | None = None
    stiff: bool = False

    def mesh(self, duration: float) -> Mesh:
        """The mesh of a run of this length (s)."""
        scene = Scene(crosshatch(self.n, length=self.length), self.setup, duration=duration)
        if self.setup != "published":
            scene = replace(scene, force=scene.force * self.buckling / scene.buckling_number)
        if self.stiff:
            scene = replace(scene, crossing_stiffness=STIFF)
        return modelled(self.engine, scene, self.elements)

    def numerics(self, mesh: Mesh) -> Numerics:
        """Its numerics, with the step that is really taken."""
        step = self.step or self.share * load(self.engine).largest_step(mesh)
        return Numerics(self.engine, self.elements, fitted_step(mesh.scene, step)[0])

    def run(self, duration: float):
        """Mesh, numerics and recording of a run of this length (s)."""
        mesh = self.mesh(duration)
        numerics = self.numerics(mesh)
        options = {} if self.order is None else {"order": self.order}
        with timed.part("kernel"):
            return mesh, numerics, load(self.engine).integrate(mesh, numerics, **options)

    def trajectory(self, duration: float) -> np.ndarray:
        """Displacements of a run (m)."""
        return self.run(duration)[2].displacement

    def capacities(self, duration: float) -> np.ndarray:
        """C_nl and C_m of a run."""
        scored = capacity.score(response(*self.run(duration)))
        return np.array([float(scored["c_nl"]), float(scored["c_m"])])

    def cost(self, window: int) -> tuple[float, float, float]:
        """Step (s), CPU seconds for `RUN` and ns per element and step, from short windows.

        PyElastica is timed over `window` steps after a tenth as many to compile and settle.
        """
        mesh = self.mesh(RUN)
        numerics = self.numerics(mesh)
        planar, step = load(self.engine).PLANAR, numerics.time_step
        per_step = self._run_time() if planar else _step_time(mesh, numerics, window)
        return step, per_step * RUN / step, 1e9 * per_step / mesh.elements

    def _run_time(self) -> float:
        """CPU seconds a step; the window is doubled until it is long enough to be timed."""
        duration, times = 0.1, []
        while len(times) < REPEATS:
            mesh = self.mesh(duration)
            start = time.process_time()
            numerics = self.run(duration)[1]
            taken = time.process_time() - start
            if taken < TIMED and duration < RUN:
                duration = min(RUN, 2.0 * duration)
                continue
            times.append(taken * numerics.time_step / mesh.scene.duration)
        return min(times)


def _step_time(mesh: Mesh, numerics: Numerics, window: int) -> float:
    """CPU seconds a step of PyElastica, which Python steps one by one."""
    import elastica

    engine = load("elastica")
    simulator, _, step, _ = engine.assemble(mesh, numerics)
    stepper = elastica.PositionVerlet()
    now = engine.run_steps(simulator, stepper, 0.0, step, window // 10)
    start = time.process_time()
    engine.run_steps(simulator, stepper, now, step, window)
    return (time.process_time() - start) / window


def modelled(engine: str, scene: Scene, elements: int | None) -> Mesh:
    """The mesh of a scene as an engine can have it: with springs of `STIFF` where it cannot join
    fibres in one point, and without a dead band where it has none."""
    mesh = build(scene, elements)
    if accepts(engine, mesh):
        return mesh
    stiffness = min(scene.crossing_stiffness, STIFF)
    return build(replace(scene, crossing_stiffness=stiffness, dead_band=False), elements)


def difference(trajectory: np.ndarray, reference: np.ndarray) -> float:
    """Rms of the difference of two trajectories over the rms of the second."""
    return float(np.sqrt(np.mean((trajectory - reference) ** 2) / np.mean(reference**2)))


def extrapolate(coarse: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """Richardson's limit of two results, the second with elements half as long."""
    return fine + (fine - coarse) / (2.0**ORDER - 1.0)


def cases(n: int, length: float, buckling: float) -> list[Case]:
    """The engines, meshes and steps of one network in the described setup."""
    network = {"n": n, "length": length, "buckling": buckling}
    meshes = [4, 8] if n < SLOW else [4]  # elements per section of the slower engines
    return [
        *(Case("kirchhoff", elements=e, **network) for e in ACCURACIES.values()),
        *(Case("kirchhoff", elements=4, share=SAFETY / k, **network) for k in (2, 4)),
        *(Case("cosserat", elements=e, **network) for e in meshes),
        *(Case("elastica", elements=e, step=authors.STEP, **network) for e in meshes),
        *(Case(e, elements=None, step=authors.STEP, **network) for e in ("cosserat", "elastica")),
    ]


def planar(case: Case) -> Case:
    """The case whose errors stand for one: the cosserat engine for PyElastica, and for the
    authors' mesh the nearest with crossings on nodes, whose places 10 mm elements round."""
    elements = case.elements or round(case.mesh(1.0).scene.network.spacing / authors.ELEMENT)
    return replace(case, engine=STAND_IN.get(case.engine, case.engine), elements=elements)


@explained(COLUMNS)
def speed_accuracy(
    *exudyn: pd.DataFrame, networks: list[int], length: float, buckling: float, seconds: float,
    duration: float, window: int, workers: int = 1,
) -> pd.DataFrame:  # fmt: skip
    """One row for each network, engine and mesh: error against cost.

    PyElastica's errors are those of the cosserat engine at the same mesh and step, which follows
    it to round-off (`errors_from` says so; see also `planar`).

    Args:
        exudyn: the table of `fiberweb.validation.exudyn_check`, if there is one.
        networks: N of the crosshatches.
        length: of their fibres (m).
        buckling: number B of the force.
        seconds: of the trajectories.
        duration: of the runs that are scored (s).
        window: steps in which PyElastica is timed.
        workers: threads for the long runs; nothing is timed meanwhile.
    """
    rows = []
    for n in networks:
        timed = cases(n, length, buckling)
        costs = [case.cost(window) for case in timed]
        stand_ins = [planar(case) for case in timed]
        network = {"n": n, "length": length, "buckling": buckling}
        pair = [Case("kirchhoff", elements=e, **network) for e in (FINEST // 2, FINEST)]
        distinct = list(dict.fromkeys(stand_ins + pair))
        with ThreadPoolExecutor(workers) as pool:
            trajectories = pool.map(lambda case: case.trajectory(seconds), distinct)
            capacities = pool.map(lambda case: case.capacities(duration), distinct)
            trajectories = dict(zip(distinct, trajectories))
            capacities = dict(zip(distinct, capacities))
        converged = extrapolate(*(trajectories[case] for case in pair))
        best = extrapolate(*(capacities[case] for case in pair))
        yardstick = costs[-1][1]
        for case, alias, (step, cpu, ns) in zip(timed, stand_ins, costs):
            c_nl, c_m = np.abs(capacities[alias] - best)
            error = difference(trajectories[alias], converged)
            rows.append(
                (case.engine, case.setup, f"{n}x{n}", case.elements or "authors", step, cpu, ns,
                 error, c_nl, c_m, yardstick / cpu, f"{alias.engine}, {alias.elements} a section")
            )  # fmt: skip
        rows += _published(n, length, window)
    return pd.concat([pd.DataFrame(rows, columns=list(COLUMNS)), *map(exudyn_rows, exudyn)])


def exudyn_rows(checked: pd.DataFrame) -> pd.DataFrame:
    """Rows of `speed_accuracy` for Exudyn, on the scenes of its own check and neither timed nor
    scored: the error is its difference from our converged engine.

    Args:
        checked: from `exudyn_check.table`.
    """
    rows = checked[checked["against"] == "kirchhoff"]
    errors = rows[["engine", "network", "elements_per_section", "time_step"]].assign(
        setup="compliant", trajectory_error=rows["difference"], errors_from=rows["engine"]
    )
    return errors.reindex(columns=list(COLUMNS))


def _published(n: int, length: float, window: int) -> list[tuple]:
    """The published setup, which PyElastica defines: its error is zero, and that of the planar
    engine is how far it departs within `COMPARED` steps."""
    setup = {"elements": None, "length": length, "setup": "published", "step": authors.STEP}
    pair = [Case(engine, n, **setup) for engine in ("cosserat", "elastica")]
    compared = COMPARED * authors.STEP
    planar, spatial = (case.trajectory(compared) for case in pair)
    errors = [(difference(planar, spatial), np.nan, np.nan, "elastica"), (0.0, 0.0, 0.0, "itself")]
    costs = [case.cost(window) for case in pair]
    return [
        (case.engine, "published", f"{n}x{n}", "authors", *cost, *error[:3], costs[1][1] / cost[1],
         error[3])
        for case, cost, error in zip(pair, costs, errors)
    ]  # fmt: skip


def rungs(length: float, buckling: float) -> list[tuple[str, str, Case]]:
    """From PyElastica down to the default engine and its crossings, one change at a time."""
    planar = Case("cosserat", 4, 8, length, buckling)
    mesh = planar.mesh(1.0)
    same = planar.numerics(mesh).time_step
    lumped = replace(planar, engine="kirchhoff", order=2, stiff=True)
    fine = replace(lumped, order=None)
    coarse = replace(fine, elements=4)
    return [
        ("elastica", "PyElastica, in space", replace(planar, engine="elastica", step=same)),
        ("planar", "motion in the plane", replace(planar, step=same)),
        ("unshearable", "no shear, no rotary inertia", replace(lumped, step=same)),
        ("step", "the longer step this allows", lumped),
        ("fourth order", "fourth-order bending", fine),
        ("mesh", "4 elements a section, not 8", coarse),
        ("merged", "crossings as one point, not springs", replace(coarse, stiff=False)),
    ]


@explained(LADDER_COLUMNS)
def ladder(
    length: float, buckling: float, seconds: float, duration: float, window: int, workers: int = 1
) -> pd.DataFrame:
    """One row for each simplification: what it changes against the rung above it.

    PyElastica runs for `window` steps only and is not scored. Arguments: see `speed_accuracy`.
    """
    names, changes, steps = zip(*rungs(length, buckling))
    costs = [case.cost(window) for case in steps]
    unknown = np.full(2, np.nan)
    with ThreadPoolExecutor(workers) as pool:
        trajectories = [None, *pool.map(lambda case: case.trajectory(seconds), steps[1:])]
        capacities = [unknown, *pool.map(lambda case: case.capacities(duration), steps[1:])]
    brief = window * costs[0][0]
    rows = []
    for i, case in enumerate(steps):
        compared, moves = (seconds if i else np.nan), np.nan
        if i == 1:
            compared = brief
            moves = difference(case.trajectory(brief), steps[0].trajectory(brief))
        elif i > 1:
            moves = difference(trajectories[i], trajectories[i - 1])
        c_nl, c_m = capacities[i]
        d_nl, d_m = np.abs(capacities[i] - capacities[i - 1]) if i > 1 else unknown
        rows.append(
            (names[i], changes[i], case.engine, case.elements, *costs[i][:2], compared, moves,
             c_nl, d_nl, c_m, d_m)
        )  # fmt: skip
    return pd.DataFrame(rows, columns=list(LADDER_COLUMNS))
