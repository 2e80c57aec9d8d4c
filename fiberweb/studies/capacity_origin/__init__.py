"""What makes the published capacities: the Laplace filter and the dead band, each on and off."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from fiberweb.model.authors import ELEMENT, LISTED_AT_100MM, PHYSICS, STEP
from fiberweb.model.scene import Scene
from fiberweb.sections import Positive, Section, Size, Some, key
from fiberweb.studies.base import (
    Figure,
    Lab,
    Point,
    Table,
    crosshatch,
    every,
    input_baselines,
    scoring_of,
)

FILTER = PHYSICS["crosshatch"]["filter_order"]
BOTH = {"filter_order": FILTER, "dead_band": True}
FILTER_ALONE, BAND_ALONE = BOTH | {"dead_band": False}, BOTH | {"filter_order": 0}
NEITHER = {"filter_order": 0, "dead_band": False}


class CapacityOriginSection(Section):
    """What makes the published capacities: the filter and the dead band, each on and off."""

    n: Some[Size] = key([2, 4, 6, 8, 10, 12], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    force_n: Size = key(4, "size of the crosshatch whose force is varied")
    force: Some[Positive] = key(
        list(LISTED_AT_100MM)[::3], "amplitudes of the force, of the authors' list", "N"
    )
    element: Some[Positive] = key(
        [ELEMENT, 2 * ELEMENT, ELEMENT / 2],
        "lengths of the elements of runs with filter or band alone, of the same network",
        "m",
    )
    step: Some[Positive] = key(
        [STEP, STEP / 2], "their steps: the first on every mesh, others on the first", "s"
    )
    look_every: Positive = key(
        1.0, "time between two looks at the directors, at least 250 samples of the recording", "s"
    )


SECTION = CapacityOriginSection
SETUPS = ("published",)


def points(section: CapacityOriginSection, lab: Lab) -> Iterator[Point]:
    """Both artefacts on and off over size and over force, and the same scenes in the described
    setup, in the authors' layout and in the text's; then each artefact alone on several meshes and
    at several steps."""
    for n in section.n:
        yield from _variants(lab, n, section.length, None)
    for force in section.force:
        yield from _variants(lab, section.force_n, section.length, force)
    meshes = [(element, section.step[0]) for element in section.element]
    meshes += [(section.element[0], step) for step in section.step[1:]]
    network = crosshatch(section.force_n, length=section.length)
    for artefact, (element, step) in product((FILTER_ALONE, BAND_ALONE), meshes):
        per_section = max(1, round(network.spacing / element))
        numerics = {"elements_per_section": per_section, "time_step": step}
        yield Point(lab.scene(network, layout="exact", **artefact), "mesh", numerics)


def _variants(lab: Lab, n: int, length: float, force: float | None) -> Iterator[Point]:
    network, choice = crosshatch(n, length=length), "grid" if force else "eq3"
    for artefacts in (BOTH, FILTER_ALONE, BAND_ALONE, NEITHER):
        scene = lab.scene(network, force=force, **artefacts)
        yield Point(scene, choice)
    for layout in ("authors", "exact"):
        # what the setup leaves at None is the described one's own there
        physics = lab.defaults | {"layout": layout, "force": scene.force}
        yield Point(Scene(network, **physics), choice)


def watched(runs, section) -> list:
    """The published network whose force is varied, at the force of Eq. 3."""
    nearest = min(section.n, key=lambda n: abs(n - section.force_n))
    return [
        run for run in runs
        if run.choice == "eq3" and run.scene.network.n == nearest
        and run.scene.dead_band and run.scene.filter_order
    ]  # fmt: skip


TABLES = {
    "capacity_origin.csv": Table(
        "fiberweb.studies.capacity_origin.tables:table",
        responses=every,
        choices=True,
        options=scoring_of,
    ),
    "capacity_origin_baselines.csv": input_baselines(),
    "dead_band_looks.nc": Table(
        "fiberweb.studies.capacity_origin.band:looks",
        responses=watched,
        single=True,
        options=lambda section, _: {"every": section.look_every},
    ),
    "dead_band.csv": Table(
        "fiberweb.studies.capacity_origin.band:growth", tables=("dead_band_looks.nc",)
    ),
    "dead_band_histogram.csv": Table(
        "fiberweb.studies.capacity_origin.band:histogram", tables=("dead_band_looks.nc",)
    ),
}
FIGURES = {
    "capacity_origin": Figure(
        "fiberweb.studies.capacity_origin.figure:draw",
        tuple(file for file in TABLES if file.endswith(".csv")),
    )
}
