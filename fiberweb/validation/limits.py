"""Where the engines stop being stable: the predicted limit of the step against the one found.

The prediction is that of `fiberweb.engines.stability`; the finding is a bisection over whole
runs, so the two share nothing but the mesh. Also how well undamped runs keep their energy, and
where motion stops being planar.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from fiberweb.engines import accepts, load
from fiberweb.engines.base import Numerics, Recording
from fiberweb.meanings import explained
from fiberweb.model import authors
from fiberweb.model.drive import spline
from fiberweb.model.mesh import Mesh, build
from fiberweb.model.network import crosshatch
from fiberweb.model.scene import Scene
from fiberweb.simulation.plan import SAFETY, safety

PER_SAMPLE = 20  # steps between two looks at a run
GENTLE = 1e-4  # buckling number at which a fibre is as stiff as at rest
HEATED = 1e4  # times: a stable run's heat depends far less than this on its step
KNOTS = 5  # of the input in every run, at least: see `run_for`
BRACKET = (0.7, 1.2)  # of the predicted limit; the search goes on from there in both directions
NEAREST, FURTHEST = 0.05, 20.0  # of the predicted limit, where it ends
LOADED = 10  # times as many steps for a run under the point's own force
# Of the bisection, relative, and times fewer steps: PyElastica's take a hundred times longer.
RESOLUTION, SLOWER = {"elastica": 1e-3}, {"elastica": 3}
FINE = 1e-4  # resolution for the others: a third of what `stability.CAUTION` leaves
STIFF = authors.PHYSICS["crosshatch"]["crossing_stiffness"]  # N/m
STOUT = 10.0  # spacing over diameter of the stoutest corners: the paper's own smallest
# Of EA, at the corners: beyond, strains are not small and runs are torn at any step (see
# tests/engines/test_limits.py).
FORCE_LIMIT, TENSION_LIMIT = 0.1, 0.15
DRIFT_SAMPLES, DRIFT_ELEMENTS = 1000, 2  # few elements, so that a step is long
DRIFT_AFTER = 2.0  # s; the shaking ends after one
PUSHED = 0.05  # s in which the force of the out-of-plane runs grows; a section's period is 40 ms
DISTURBANCE = 1e-6  # m/s out of the plane, of the driven point at the start of these runs
PLANE_ELEMENTS = 4  # per section, as in the standard accuracy

ENGINE = {
    "engine": "kirchhoff, cosserat or elastica",
    "network": "size of the crosshatch",
}
COLUMNS = ENGINE | {
    "spacing_m": ("spacing of the fibres", "m"),
    "diameter_m": ("of the fibres", "m"),
    "tension_N": ("pretension of each fibre", "N"),
    "force_N": ("amplitude of the force, F_max", "N"),
    "crossing_stiffness": ("of the spring between crossing fibres; inf: one point", "N/m"),
    "crossing_damping": ("of the damper between crossing fibres", "N s/m"),
    "elements_per_section": "elements on a section as long as the spacing",
    "predicted_s": ("limit of the step as the engine predicts it", "s"),
    "found_loaded_s": ("smallest unstable step under the point's own force", "s"),
    "found_s": ("smallest unstable step under a gentle force", "s"),
    "ratio": "predicted over found",
    "automatic_step_status": "of a run at the automatic step: ok, unstable or lost (NaN)",
}
PLANE_COLUMNS = {
    "buckling_number": "B of the force",
    "time": ("from the start", "s"),
    "out_of_plane_m": ("largest displacement out of the plane", "m"),
    "in_plane_m": ("largest displacement in the plane", "m"),
}
DRIFT_COLUMNS = ENGINE | {
    "elements": "how many there are in all",
    "time_step": ("step of the integration", "s"),
    "steps": "of the run",
    "energy_J": ("mean of kinetic and elastic energy after the shaking", "J"),
    "drift": "slope of the energy times the run's length, over energy_J",
    "fluctuation": "largest departure of the energy from its mean, over energy_J",
}


@dataclass(frozen=True)
class Point:
    """One place in the box of scenes; SI units, B the buckling number of the force."""

    engine: str = "kirchhoff"
    n: int = 2
    spacing: float = 0.1
    diameter: float = 2e-3
    tension: float = 0.01
    buckling: float = 0.8
    stiffness: float = 70.0
    damping: float = 3.0
    elements: int = 4

    def scene(self, buckling: float | None = None) -> Scene:
        """The scene at this place, with its own or another buckling number."""
        network = crosshatch(self.n, spacing=self.spacing)
        unit = Scene(network, diameter=self.diameter, force=1.0)
        return Scene(
            network,
            "compliant",
            diameter=self.diameter,
            tension=self.tension,
            force=(self.buckling if buckling is None else buckling) / unit.buckling_number,
            crossing_stiffness=self.stiffness,
            crossing_damping=self.damping,
        )


def run_for(mesh: Mesh, engine: str, step: float, steps: int) -> Recording:
    """Integrate for so many steps of exactly this length.

    A run too short for the scene's own input and ramp gets faster ones, so that the whole force
    and the whole tension act in it.
    """
    scene, duration = mesh.scene, steps * step
    rate = max(scene.drive_rate, KNOTS / duration)
    scene = replace(
        scene,
        sample_rate=1.0 / (PER_SAMPLE * step),
        duration=duration,
        tension_ramp=min(scene.tension_ramp, 1.0 / rate),
    )
    drive = np.ascontiguousarray(spline(scene.seed, duration, rate).c.T)
    return load(engine).integrate(
        replace(mesh, scene=scene, drive=drive, drive_rate=rate), Numerics(engine, None, step)
    )


def found_limit(mesh: Mesh, engine: str, predicted: float, steps: int) -> float:
    """The smallest unstable step (s) by bisection; NaN if there is none near the prediction.

    A run is unstable if it leaves the physics, or if it gets hotter than it can be: an
    instability that the geometry limits, as bending does, shakes for ever without leaving.
    """
    low, high = (factor * predicted for factor in BRACKET)
    while (calm := run_for(mesh, engine, low, steps)).unstable_at is not None:
        low, high = BRACKET[0] * low, low
        if low < NEAREST * predicted:
            return np.nan
    hottest = HEATED * heat(calm)

    def unstable(step: float) -> bool:
        recording = run_for(mesh, engine, step, steps)
        return recording.unstable_at is not None or heat(recording) > hottest

    while not unstable(high):
        low, high = high, BRACKET[1] * high
        if high > FURTHEST * predicted:
            return np.nan
    while high - low > RESOLUTION.get(engine, FINE) * predicted:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if unstable(middle) else (middle, high)
    return high


def heat(recording: Recording) -> float:
    """Largest kinetic energy; where an engine keeps no ledger, square of the largest move."""
    kinetic = recording.energy[:, 0].max()
    if np.isfinite(kinetic):
        return float(kinetic)
    return float(np.abs(np.diff(recording.displacement, axis=0)).max() ** 2)


def status(recording: Recording) -> str:
    """As a response's: "ok" or "unstable"; "lost" would be NaN in a run that calls itself ok."""
    if recording.unstable_at is not None:
        return "unstable"
    return "ok" if np.isfinite(recording.displacement).all() else "lost"


def measure(point: Point, steps: int) -> tuple:
    """One row of the stability table: `gently`, and the limit that is found once more under the
    point's own force, which can strain the network."""
    predicted, found, automatic = gently(point, steps)
    mesh, steps = build(point.scene(), point.elements), LOADED * _slower(point, steps)
    loaded = found_limit(mesh, point.engine, predicted, steps)
    return (
        point.engine, f"{point.n}x{point.n}", point.spacing, point.diameter, point.tension,
        mesh.scene.force, point.stiffness, point.damping, point.elements, predicted, loaded,
        found, predicted / found, automatic,
    )  # fmt: skip


def gently(point: Point, steps: int) -> tuple[float, float, str]:
    """The predicted limit (s), the one found with a gentle force, where the network is as stiff as
    at rest and as the prediction has it, and the status of a run under the point's own force with
    the automatic step."""
    steps = _slower(point, steps)
    gentle = build(point.scene(min(GENTLE, point.buckling)), point.elements)
    predicted = load(point.engine).largest_step(gentle)
    found = found_limit(gentle, point.engine, predicted, steps)
    mesh = build(point.scene(), point.elements)
    automatic = run_for(mesh, point.engine, safety(mesh.scene) * predicted, LOADED * steps)
    return predicted, found, status(automatic)


def _slower(point: Point, steps: int) -> int:
    return steps // SLOWER.get(point.engine, 1)


def points(box: dict[str, list[float]]) -> Iterator[Point]:
    """One thing at a time for either planar engine, corners of the box, and PyElastica."""
    for engine in ("kirchhoff", "cosserat"):
        yield Point(engine)
        for field, values in box.items():
            yield from (Point(engine, **{field: value}) for value in values)
        crossings = [(1.0, 0.0), (STIFF, 0.0), (STIFF, 10.0), (np.inf, 0.0)]
        tied = [Point(engine, stiffness=k, damping=nu) for k, nu in crossings]
        yield from (p for p in tied if accepts(engine, build(p.scene(), p.elements)))
        yield from corners(engine, box)
    yield Point("elastica")
    yield Point("elastica", stiffness=STIFF, damping=0.0)


def corners(engine: str, box: dict[str, list[float]]) -> Iterator[Point]:
    """Thin and thick fibres, slack and tight, soft and stiff crossings, at the largest force
    and tension of the box that leave a fibre a fibre."""
    thin, thick = min(box["diameter"]), max(box["diameter"])
    for diameter, spacing in ((thin, max(box["spacing"])), (thick, STOUT * thick)):
        unit = Scene(crosshatch(2, spacing=spacing), diameter=diameter, force=1.0)
        strongest = FORCE_LIMIT * unit.axial_stiffness * unit.buckling_number
        for tension in (0.0, min(max(box["tension"]), TENSION_LIMIT * unit.axial_stiffness)):
            for stiffness, damping in ((1.0, 10.0), (STIFF, 0.0)):
                yield Point(
                    engine, 3, spacing, diameter, tension, min(max(box["buckling"]), strongest),
                    stiffness, damping, max(box["elements"]),
                )  # fmt: skip


@explained(COLUMNS)
def stability(box: dict[str, list[float]], steps: int) -> pd.DataFrame:
    """One row for each point in the box of scenes: predicted and found limits of the step.

    Args:
        box: values of spacing (m), diameter (m), tension (N), buckling (the number B of the
            force) and elements (per section).
        steps: of each run of a bisection; ten times as many for a run under the point's force.
    """
    return pd.DataFrame([measure(point, steps) for point in points(box)], columns=list(COLUMNS))


@explained(DRIFT_COLUMNS)
def drift(steps: int) -> pd.DataFrame:
    """One row for each engine: energy of undamped free motion over many steps.

    A network is shaken for a second and then left to itself. `drift` is the slope of its energy
    (with the tension's potential) times the run's length, `fluctuation` the largest departure
    from the mean; both relative to the mean of kinetic and elastic energy.
    """
    rows = []
    for engine in ("kirchhoff", "cosserat"):
        scene = replace(Point(buckling=0.3).scene(), damping=0.0, crossing_damping=0.0)
        mesh = build(scene, DRIFT_ELEMENTS)
        step = SAFETY * load(engine).largest_step(mesh)
        rate = DRIFT_SAMPLES / (steps * step)
        mesh = build(replace(scene, sample_rate=rate, duration=steps * step), DRIFT_ELEMENTS)
        shaken = mesh.drive * (np.arange(len(mesh.drive)) < scene.drive_rate)[:, None]
        numerics = Numerics(engine, DRIFT_ELEMENTS, step)
        recording = load(engine).integrate(replace(mesh, drive=shaken), numerics)
        kinetic, elastic, work, dissipated = recording.energy[mesh.scene.times > DRIFT_AFTER].T
        balance = kinetic + elastic + dissipated - work
        energy = float(np.mean(kinetic + elastic))
        slope = np.polyfit(np.linspace(0.0, 1.0, len(balance)), balance, 1)[0]
        largest = np.abs(balance - balance.mean()).max()
        rows.append(
            (engine, "2x2", mesh.elements, step, steps, energy, slope / energy, largest / energy)
        )
    return pd.DataFrame(rows, columns=list(DRIFT_COLUMNS))


@explained(PLANE_COLUMNS)
def out_of_plane(buckling: list[float], seconds: float) -> pd.DataFrame:
    """One row for each force and sample of a disturbed 2x2 crosshatch: how far it leaves the plane.

    PyElastica, in space, with a force that grows smoothly within `PUSHED` and then stays.

    Args:
        buckling: numbers B of the force.
        seconds: simulated.

    Returns:
        Columns `PLANE_COLUMNS`.
    """
    import elastica

    engine, rows = load("elastica"), []
    for number in buckling:
        scene = Point(buckling=number).scene()
        timed = {"duration": seconds, "drive_rate": 1.0 / PUSHED, "tension_ramp": PUSHED}
        scene = replace(scene, **timed)
        mesh = build(scene, PLANE_ELEMENTS)
        held = np.zeros((len(mesh.drive), 4))
        held[:, 3] = -1.0  # towards the clamped ends: the fibres that cross are compressed
        held[0] = 2.0 / PUSHED**3, -3.0 / PUSHED**2, 0.0, 0.0
        mesh = replace(mesh, drive=held)
        numerics = Numerics("elastica", PLANE_ELEMENTS, SAFETY * engine.largest_step(mesh))
        simulator, rods, step, per_sample = engine.assemble(mesh, numerics)
        middle = np.abs(mesh.load).sum(axis=1)[mesh.first[1] : mesh.first[2]] > 0
        rods[1].velocity_collection[2, middle] += DISTURBANCE * engine.MM
        stepper, now = elastica.PositionVerlet(), 0.0
        for at in scene.times:
            moved = np.concatenate([rod.position_collection.T for rod in rods]) / engine.MM
            inside = np.abs(moved[:, :2] - mesh.position).max()
            rows.append((number, at, np.abs(moved[:, 2]).max(), inside))
            now = engine.run_steps(simulator, stepper, now, step, per_sample)
    return pd.DataFrame(rows, columns=list(PLANE_COLUMNS))
