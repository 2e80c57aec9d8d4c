"""What a capacity rests on: the run again, each time with one thing changed that is no physics.

    print(certify(Scene(crosshatch(8, length=0.5))))

A capacity that follows the step, the mesh, a filter or the last bit of the start says something of
the code and not of the web. What is changed, and the verdict if a capacity follows it:

- half the step: "step"; twice the mesh, its step the stability limit's again: "mesh";
- another start, one rounding error away: "one realisation of chaos";
- without the Laplace filter: "filter"; with exact rotations, so without dead band: "rounding";
- the other planar engine, for one that leaves out shear and rotary inertia: "shear". These limit
  the step of the cosserat engine. Both grow as the square of a fibre's stoutness, so they are made
  as much larger as its step would be too short, and a capacity's change as much smaller.

If nothing does, it is "physics": of the model, and of one input. Steps and meshes are compared on
the first part of the recording, both runs scored on the same part, so that all of it costs less
than six times what the run did.
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
from fiberweb.model.authors import ELEMENT
from fiberweb.model.mesh import Mesh, build
from fiberweb.model.scene import Scene
from fiberweb.scoring.capacity import score
from fiberweb.scoring.limits import check_frames
from fiberweb.simulation.plan import SAFETY, plan
from fiberweb.simulation.simulate import run

TOLERANCE = 0.005  # change of a capacity that counts; the paper's tables have three digits
SCATTER = 3.0  # a cause counts only if it does so much more than another start
SHARE = 0.45  # of the recording, on which steps, meshes and engines are compared, at most
BUDGET = {"mesh": 1.8, "shear": 0.65}  # in runs: they take a smaller share rather than more
TIED = 1e4  # N/m: a crossing to engines that cannot make it one point; gives 5 um at 0.05 N
CHAOS, PHYSICS = "one realisation of chaos", "physics"
ARTEFACTS = ("filter", "rounding")
CAPACITIES = ("c_nl", "c_m")
COLUMNS = ("capacity", "changed", "share", "cost", "before", "after", "change", "verdict")


@dataclass(frozen=True)
class Variant:
    """The run with one thing changed.

    Attributes:
        changed: what it is, in words.
        cause: verdict on a capacity that follows it; "" if it explains nothing by itself.
        mesh, numerics: as an engine takes them.
        share: of the recording, from its start.
        exaggerated: by how much what it shows is too large.
    """

    changed: str
    cause: str
    mesh: Mesh
    numerics: Numerics
    share: float = 1.0
    exaggerated: float = 1.0


def certify(scene: Scene, accuracy: str | None = None, **numerics) -> pd.DataFrame:
    """Run a scene, and again with each of the changes; arguments and errors as for
    `fiberweb.simulate`, result as of `certificate`."""
    return certificate(run(plan(scene, accuracy, **numerics)))


def certificate(response: xr.Dataset, **scoring) -> pd.DataFrame:
    """What the capacities of a run rest on.

    Args:
        response: of `fiberweb.simulate`.
        **scoring: as for `fiberweb.score`.

    Returns:
        A row for each change and capacity: capacity ("c_nl" or "c_m"), changed, share of the
        recording, cost (in element-steps of the run, weighed by engine), before and after (NaN of
        an unstable run), change, and verdict on the capacity, the same in all of its rows:
        "physics", or what it follows by more than `TOLERANCE`, joined by " and ".
    """
    before = {}
    records = []
    for variant in variants(response):
        part = response.isel(time=slice(0, frames(response, variant.share, scoring)))
        if part.sizes["time"] not in before:
            before[part.sizes["time"]] = _capacities(part, scoring)
        at = before[part.sizes["time"]]
        after = _capacities(_again(part, variant), scoring)
        share, cost = part.sizes["time"] / response.sizes["time"], _cost(variant, response)
        for name in CAPACITIES:
            change = (after[name] - at[name]) / variant.exaggerated
            records.append(
                (name, variant.changed, share, share * cost, at[name], at[name] + change, change,
                 variant.cause)
            )  # fmt: skip
    table = pd.DataFrame(records, columns=list(COLUMNS))
    for name in CAPACITIES:
        rows = table["capacity"] == name
        found = table.loc[rows, "verdict"], table.loc[rows, "change"]
        stable = response.attrs["status"] == "ok"
        table.loc[rows, "verdict"] = verdict(dict(zip(*found))) if stable else "unstable"
    return table


def verdict(changes: dict[str, float]) -> str:
    """What a capacity is, by its change (NaN: that run was unstable) for each cause.

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
        physics = plan(Scene(scene.network, **_drive_and_material(scene)), "standard")
        yield Variant("described setup", "", physics.mesh, physics.numerics)


def _finer(mesh: Mesh, numerics: Numerics) -> Variant:
    """Twice as many elements. The authors' step is not limited by the mesh and stays."""
    scene = mesh.scene
    per_section = numerics.elements_per_section or round(scene.network.spacing / ELEMENT)
    finer = build(scene, 2 * per_section)
    step = numerics.time_step
    if scene.setup != "published":
        step = min(step, SAFETY * load(numerics.engine).largest_step(finer))
    variant = Variant(
        "twice the mesh", "mesh", finer, Numerics(numerics.engine, 2 * per_section, step)
    )
    return _within_budget(variant, mesh, numerics)


def _stouter(mesh: Mesh, numerics: Numerics) -> Iterator[Variant]:
    """In the cosserat engine with as much shear and rotary inertia as the run's step can take."""
    scene, engine = mesh.scene, load("cosserat")
    if math.isinf(scene.crossing_stiffness):
        scene = replace(scene, crossing_stiffness=TIED)
    mesh = build(scene, numerics.elements_per_section)
    if not accepts("cosserat", mesh):
        return
    short = numerics.time_step / (SAFETY * engine.largest_step(mesh))
    mesh = replace(mesh, stoutness=max(1.0, short))
    step = min(numerics.time_step, SAFETY * engine.largest_step(mesh))
    changed = numerics._replace(engine="cosserat", time_step=step)
    variant = Variant("shear", "shear", mesh, changed, exaggerated=mesh.stoutness)
    yield _within_budget(variant, mesh, numerics)


def _within_budget(variant: Variant, mesh: Mesh, numerics: Numerics) -> Variant:
    price = _price(variant.mesh, variant.numerics) / _price(mesh, numerics)
    return replace(variant, share=min(SHARE, BUDGET[variant.cause] / price))


def _drive_and_material(scene: Scene) -> dict:
    """What a setup does not decide."""
    names = ("force", "tension", "duration", "seed", "sample_rate", "drive_rate", "diameter",
             "youngs_modulus", "density", "tension_ramp")  # fmt: skip
    return {name: getattr(scene, name) for name in names}


def _price(mesh: Mesh, numerics: Numerics) -> float:
    """CPU time of a second of a run, about, s."""
    return 1e-9 * load(numerics.engine).NANOSECONDS * mesh.elements / numerics.time_step


def _cost(variant: Variant, response: xr.Dataset) -> float:
    price = 1e-9 * load(response.attrs["engine"]).NANOSECONDS * response.attrs["elements"]
    return _price(variant.mesh, variant.numerics) / (price / float(response.attrs["time_step"]))


def _again(part: xr.Dataset, variant: Variant) -> xr.Dataset:
    """Part of a response with a variant's motion in place of its own."""
    # the drive was laid out for the whole recording: its spline must not end earlier
    scene = replace(variant.mesh.scene, duration=part.sizes["time"] / part.attrs["sample_rate"])
    mesh = replace(variant.mesh, scene=scene)
    recording = load(variant.numerics.engine).integrate(mesh, variant.numerics)
    motion = part["displacement"].copy(data=recording.displacement)
    status = "ok" if recording.unstable_at is None else "unstable"
    return part.assign(displacement=motion).assign_attrs(status=status)


def _capacities(part: xr.Dataset, scoring: dict) -> dict[str, float]:
    scored = score(part, **scoring)
    return {name: float(scored[name]) for name in CAPACITIES}
