"""What a capacity rests on: the run again, each time with one thing changed that is no physics.

    print(certify(Scene(crosshatch(8, length=0.5))))

A capacity that follows the step, the mesh, a filter or the last bit of the start says something of
the code and not of the web. What is changed, and the verdict if a capacity follows it:

- half the step: "step"; twice the mesh, its step the stability limit's again: "mesh";
- another start, one rounding error away: "one realisation of chaos";
- without the Laplace filter: "filter"; with exact rotations, so without dead band: "rounding";
- shear and rotary inertia, of an engine that leaves them out: "shear". The cosserat engine has
  them, and its step is as short as they are small. So they are made as much larger as the run's
  step can take, and twice that; what a capacity changes by is as much too large, and is divided.

If nothing does, it is "physics": of the model, and of one input. Steps and meshes are compared on
the first part of the recording, both runs scored on the same part, so that all of it costs less
than six times what the run did. The less a readout is trained on, the more it makes of a small
difference: what is found on a part counts as so much less.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import xarray as xr

from fiberweb.engines import accepts, load
from fiberweb.engines.base import Numerics, fitted_step
from fiberweb.meanings import explained
from fiberweb.model import drive
from fiberweb.model.mesh import Mesh, build
from fiberweb.model.scene import Scene
from fiberweb.scoring.capacity import score
from fiberweb.scoring.limits import check_frames
from fiberweb.simulation.plan import SAFETY, plan
from fiberweb.simulation.simulate import run

TOLERANCE = 0.005  # change of a capacity that counts; the paper's tables have three digits
SCATTER = 3.0  # a cause counts only if it does so much more than another start
SHARE = 0.4  # of the recording, on which steps, meshes and engines are compared, at most
BUDGET = {"mesh": 1.7, "shear": 1.1}  # in runs: they take a smaller share rather than more
TIED = 1e4  # N/m: a crossing to engines that cannot make it one point; gives 5 um at 0.05 N
CHAOS, PHYSICS = "one realisation of chaos", "physics"
ARTEFACTS = ("filter", "rounding")
CAPACITIES = ("c_nl", "c_m")
COLUMNS = {
    "capacity": "c_nl or c_m",
    "changed": "what was changed that is no physics",
    "share": "of the recording, on which both runs are compared",
    "cost": "of the comparison, in runs",
    "before": "the capacity without the change",
    "after": "with it",
    "change": "after - before",
    "verdict": "what the capacity rests on: physics, or what it follows; of all rows together",
}


@dataclass(frozen=True)
class Variant:
    """The run with one thing changed.

    Attributes:
        changed: what it is, in words.
        cause: verdict on a capacity that follows it; "" if it explains nothing by itself.
        mesh, numerics: as an engine takes them.
        share: of the recording, from its start.
        against: what it is held against, if that is not the run itself.
        exaggerated: by how much what it shows is too large.
    """

    changed: str
    cause: str
    mesh: Mesh
    numerics: Numerics
    share: float = 1.0
    against: Variant | None = None
    exaggerated: float = 1.0


def certify(scene: Scene, accuracy: str | None = None, **numerics) -> pd.DataFrame:
    """Run a scene, and again with each of the changes; arguments and errors as for
    `fiberweb.simulate`, result as of `certificate`."""
    return certificate(run(plan(scene, accuracy, **numerics)))


@explained(COLUMNS)
def certificate(response: xr.Dataset, **scoring) -> pd.DataFrame:
    """One row for each change and capacity: what the capacities of a run rest on.

    Args:
        response: of `fiberweb.simulate`.
        **scoring: as for `fiberweb.score`.

    Returns:
        Columns `COLUMNS`: cost in element-steps, weighed by engine; before and after NaN of an
        unstable run; the verdict "physics", or what the capacity follows, change times share, by
        more than `TOLERANCE`, joined by " and ".
    """
    before = {}
    records = []
    for variant in variants(response):
        count = frames(response, variant.share, scoring)
        part = response.isel(time=slice(0, count))
        if variant.against:
            at = _capacities(_again(part, variant.against), scoring)
        else:
            at = before[count] = before.get(count) or _capacities(part, scoring)
        after = _capacities(_again(part, variant), scoring)
        share, cost = count / response.sizes["time"], _cost(variant, response)
        for name in CAPACITIES:
            change = (after[name] - at[name]) / variant.exaggerated
            records.append(
                (name, variant.changed, share, share * cost, at[name], at[name] + change, change,
                 variant.cause)
            )  # fmt: skip
    table = pd.DataFrame(records, columns=list(COLUMNS))
    for name in CAPACITIES:
        rows = table["capacity"] == name
        found = table.loc[rows, "verdict"], table.loc[rows, "change"] * table.loc[rows, "share"]
        stable = response.attrs["status"] == "ok"
        table.loc[rows, "verdict"] = verdict(dict(zip(*found))) if stable else "unstable"
    return table


def verdict(changes: dict[str, float]) -> str:
    """What a capacity is, by its change on the whole recording (NaN: that run was unstable) for
    each cause.

    Where a filter or rounding makes a capacity, it follows mesh and step through them.
    """
    known = {cause: abs(change) for cause, change in changes.items() if cause}
    scatter = known.pop(CHAOS, 0.0)
    least = max(TOLERANCE, SCATTER * scatter)
    found = [cause for cause, change in known.items() if not change <= least]
    found = [cause for cause in found if cause in ARTEFACTS] or found
    return " and ".join(found + [CHAOS] * (not scatter <= TOLERANCE)) or PHYSICS


def frames(response: xr.Dataset, share: float, scoring: dict) -> int:
    """How many frames are a share of a recording; all, if so few could not be scored."""
    samples = response.sizes["time"]
    wanted = math.ceil(share * samples)
    try:
        check_frames(wanted, response.attrs["sample_rate"], skip=scoring.get("skip", 0))
    except ValueError:
        return samples
    return wanted


def variants(response: xr.Dataset) -> Iterator[Variant]:
    """The changes that a run's scene has something to be changed by."""
    scene = replace(Scene.from_json(response.attrs["scene"]), centre_lines=False)
    per_section = response.attrs["elements_per_section"]
    per_section = None if per_section == "authors" else int(per_section)
    step, _ = fitted_step(scene, float(response.attrs["time_step"]))
    numerics = Numerics(response.attrs["engine"], per_section, step)
    mesh = build(scene, per_section)
    yield Variant("half the step", "step", mesh, numerics._replace(time_step=0.5 * step), SHARE)
    yield _finer(mesh, numerics)
    away = scene.disturbance + float(np.spacing(scene.network.length))
    yield Variant("start", CHAOS, build(replace(scene, disturbance=away), per_section), numerics)
    for change, cause, words in (
        ({"filter_order": 0}, "filter", "without the filter"),
        ({"dead_band": False}, "rounding", "exact rotations"),
    ):
        if any(getattr(scene, name) for name in change):
            yield Variant(words, cause, replace(mesh, scene=replace(scene, **change)), numerics)
    engine = load(numerics.engine)
    if engine.PLANAR and not engine.MODELS_SHEAR:
        yield from _stouter(mesh, numerics)
    if scene.setup == "published":
        layout = scene.layout if scene.network.topology == "crosshatch" else "exact"
        physics = Scene(scene.network, layout=layout, **_drive_and_material(scene))
        physics = plan(physics, "standard")
        yield Variant("described setup", "", physics.mesh, physics.numerics)


def _finer(mesh: Mesh, numerics: Numerics) -> Variant:
    """Twice as many elements. The authors' step is not limited by the mesh and stays."""
    scene = mesh.scene
    per_section = numerics.elements_per_section
    per_section = per_section or round(scene.network.spacing / mesh.edges(0)[0])
    finer = build(scene, 2 * per_section)
    step = numerics.time_step
    if scene.setup != "published":
        step = min(step, SAFETY * load(numerics.engine).largest_step(finer))
    variant = Variant(
        "twice the mesh", "mesh", finer, Numerics(numerics.engine, 2 * per_section, step)
    )
    return _within_budget(variant, mesh, numerics)


def _stouter(mesh: Mesh, numerics: Numerics) -> Iterator[Variant]:
    """In the cosserat engine, with some multiple of shear and rotary inertia and twice that."""
    scene, engine = mesh.scene, load("cosserat")
    if math.isinf(scene.crossing_stiffness):
        scene = replace(scene, crossing_stiffness=TIED)
    mesh = build(scene, numerics.elements_per_section)
    if not accepts("cosserat", mesh):
        return
    short = numerics.time_step / (SAFETY * engine.largest_step(mesh))
    stout = replace(mesh, stoutness=max(1.0, short))
    step = min(numerics.time_step, SAFETY * engine.largest_step(stout))
    changed = numerics._replace(engine="cosserat", time_step=step)
    against = Variant("", "", stout, changed)
    stouter = replace(mesh, stoutness=2.0 * stout.stoutness)
    variant = Variant("shear", "shear", stouter, changed, 1.0, against, stout.stoutness)
    yield _within_budget(variant, mesh, numerics)


def _within_budget(variant: Variant, mesh: Mesh, numerics: Numerics) -> Variant:
    price = _price(variant) / _price(Variant("", "", mesh, numerics))
    return replace(variant, share=min(SHARE, BUDGET[variant.cause] / price))


def _drive_and_material(scene: Scene) -> dict:
    """What a setup does not decide."""
    names = ("force", "tension", "duration", "seed", "sample_rate", "drive_rate", "diameter",
             "youngs_modulus", "density", "tension_ramp", "lowest_knot")  # fmt: skip
    return {name: getattr(scene, name) for name in names}


def _price(variant: Variant) -> float:
    """CPU time of a second of a variant and of what it is held against, about, s."""
    engine, step = load(variant.numerics.engine), variant.numerics.time_step
    price = 1e-9 * engine.NANOSECONDS * variant.mesh.elements / step
    return price + (_price(variant.against) if variant.against else 0.0)


def _cost(variant: Variant, response: xr.Dataset) -> float:
    """The same, in runs."""
    price = 1e-9 * load(response.attrs["engine"]).NANOSECONDS * response.attrs["elements"]
    return _price(variant) / (price / float(response.attrs["time_step"]))


def _again(part: xr.Dataset, variant: Variant) -> xr.Dataset:
    """Part of a response with a variant's motion in place of its own."""
    # the drive was laid out for the whole recording: its spline must not end earlier
    scene = replace(variant.mesh.scene, duration=part.sizes["time"] / part.attrs["sample_rate"])
    mesh = replace(variant.mesh, scene=scene)
    recording = load(variant.numerics.engine).integrate(mesh, variant.numerics)
    motion = part["displacement"].copy(data=recording.displacement)
    if scene.setup != part.attrs["setup"]:  # each end their input in a way of their own
        u = drive.of_scene(variant.mesh.scene)(part["time"].values)
        part = part.drop_vars("scored_input").assign(input=("time", u))
    status = "ok" if recording.unstable_at is None else "unstable"
    return part.assign(displacement=motion).assign_attrs(status=status)


def _capacities(part: xr.Dataset, scoring: dict) -> dict[str, float]:
    scored = score(part, **scoring)
    return {name: float(scored[name]) for name in CAPACITIES}
