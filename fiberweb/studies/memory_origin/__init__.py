"""What carries memory: the crossings, damping of fibres, that of their material, or the Laplace
filter, one at a time."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product

from fiberweb.model.authors import ELEMENT, STEP
from fiberweb.model.network import Network
from fiberweb.model.scene import SETUPS as OF_SETUPS
from fiberweb.sections import NotNegative, Positive, PositiveOrPinned, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, crosshatch, input_baselines, one_row_per_run

AUTHORS = OF_SETUPS["published"]["crosshatch"]
SETUPS = ("compliant", "published")
# the material is a carrier of its own, which a config's loss would add to all of them
LOSSLESS = {"loss_factor": 0.0, "loss_frequency": 10.0}


class MemoryOriginSection(Section):
    """What carries memory: the filter, the crossings or the fibres' damping."""

    n: Some[Size] = key([2, 4, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    crossing_stiffness: Some[PositiveOrPinned] = key(
        [10.0, 30.0, 70.0, 300.0, 1000.0, 1e6], "springs between fibres", "N/m"
    )
    crossing_damping: Some[NotNegative] = key(
        [0.0, 1.0, 3.0, 10.0], "dampers beside the spring", "N s/m"
    )
    damping: Some[NotNegative] = key(
        [1.0, 10.0, 100.0, 300.0, 1000.0, 3000.0], "rates of velocity damping", "1/s"
    )
    loss_factor: Some[Positive] = key(
        [0.02, 0.05, 0.1, 0.2, 0.3, 1.0],
        "tan(delta) of the fibres' material at 10 Hz, with pinned crossings; no other run of the "
        "study has any",
    )  # fmt: skip
    filter_element: Some[Positive] = key(
        [ELEMENT, 2 * ELEMENT, ELEMENT / 2],
        "lengths of the elements of runs with the Laplace filter, and of the same without",
        "m",
    )
    filter_step: Some[Positive] = key(
        [STEP, STEP / 2], "steps with it: the first on every mesh, others on the first", "s"
    )


SECTION = MemoryOriginSection


def points(section: MemoryOriginSection, lab: Lab) -> Iterator[Point]:
    """Sweeps of each carrier; of the published setup the authors' networks, with their filter and
    without it."""
    lab = replace(lab, defaults=lab.defaults | LOSSLESS)
    sweeps = {
        "crossing_stiffness": section.crossing_stiffness,
        "crossing_damping": section.crossing_damping,
        "damping": section.damping,
    }
    for n in section.n:
        network = crosshatch(n, length=section.length)
        if lab.setup == "published":
            for order in (AUTHORS["filter_order"], 0):
                yield Point(lab.scene(network, filter_order=order), "eq3")
            continue
        for name, values in sweeps.items():
            for value in values:
                yield Point(lab.scene(network, **{name: value}), "eq3")
        own = lab.scene(network).damping
        for rate in dict.fromkeys([own, *section.damping]):
            pinned = {"crossing_stiffness": math.inf, "crossing_damping": 0.0, "damping": rate}
            yield Point(lab.scene(network, **pinned), "eq3")
        pinned["damping"] = own
        for loss in section.loss_factor:
            yield Point(lab.scene(network, **pinned, loss_factor=loss), "eq3")
        yield from _filtered(section, lab, network)


def _filtered(section: MemoryOriginSection, lab: Lab, network: Network) -> Iterator[Point]:
    """The Laplace filter over the authors' crossings on several meshes and at several steps,
    because its strength is of those, and no filter on the same meshes."""
    elements, steps = section.filter_element, section.filter_step
    meshes = [(element, steps[0]) for element in elements]
    finer = [(elements[0], step) for step in steps[1:]]
    crossings = {key: AUTHORS[key] for key in ("crossing_stiffness", "crossing_damping")}
    off, on = (
        lab.scene(network, filter_order=order, **crossings)
        for order in (0, AUTHORS["filter_order"])
    )
    for scene, (element, step) in [*product((off, on), meshes), *product([on], finer)]:
        per_section = max(1, round(network.spacing / element))
        numerics = {
            "engine": "cosserat", "elements_per_section": per_section, "time_step": step
        }  # fmt: skip
        yield Point(scene, "eq3", numerics)


TABLES = {"memory_origin.csv": one_row_per_run(), "memory_origin_baselines.csv": input_baselines()}
FIGURES = {"memory_origin": Figure("fiberweb.studies.memory_origin.figure:draw", tuple(TABLES))}
