"""Size at the best force of each spacing, Fig. 2c."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

from fiberweb.model.authors import SIZE_C_M_FORCES, SIZE_C_NL_FORCES
from fiberweb.sections import SCALING, Positive, Section, Size, Some, key
from fiberweb.studies.base import Figure, Lab, Point, crosshatch, one_row_per_run


class SizeSection(Section):
    """Size at the best force of each spacing, Fig. 2c."""

    n: Some[Size] = key([2, 4, 6, 8, 10, 12], "sizes of the crosshatch, N", "", SCALING)
    published_n: Some[Size] = key([2], "sizes that the published setup runs")
    published_duration: Positive = key(50.0, "length of the published runs", "s")
    published_c_nl_force: Some[Positive] = key(
        SIZE_C_NL_FORCES, "the authors' best force for C_nl, by spacing of the ridge", "N"
    )
    published_c_m_force: Some[Positive] = key(
        SIZE_C_M_FORCES, "the authors' best force for C_m, by spacing of the ridge", "N"
    )
    stable_step: Positive = key(2.5e-6, "step at which the published runs are repeated", "s")


SECTION = SizeSection
AFTER_RIDGE = True


def points(section: SizeSection, lab: Lab) -> Iterator[Point]:
    """Every N at the best force of each spacing; in the published setup at the authors' forces,
    at their step and at a stable one."""
    if lab.setup != "published":
        for (choice, spacing), forces in lab.map.best.items():
            for force, n in product(forces, section.n):
                yield Point(lab.scene(crosshatch(n, spacing=spacing), force=force), choice)
        return
    listed = {
        "authors_c_nl": section.published_c_nl_force,
        "authors_c_m": section.published_c_m_force,
    }
    duration = min(section.published_duration, lab.defaults["duration"])
    sizes = section.published_n if lab.thinned else section.n
    for (choice, forces), n in product(listed.items(), sizes):
        for spacing, force in zip(lab.map.spacings, forces):
            network = crosshatch(n, spacing=spacing)
            scene = lab.scene(network, force=force, duration=duration)
            yield Point(scene, choice)
            if n in section.published_n:
                yield Point(scene, choice, {"time_step": section.stable_step})


def check(section: SizeSection, lab: Lab) -> None:
    """Raise ValueError if the published runs have no force for a spacing or are too short."""
    lab.check_duration("size.published_duration", section.published_duration)
    spacings = lab.map.spacings
    for name in ("published_c_nl_force", "published_c_m_force"):
        forces = getattr(section, name)
        if len(forces) != len(spacings):
            raise ValueError(
                f"size.{name} lists {len(forces)} forces, but ridge.spacing {len(spacings)} "
                "spacings: list one force for each"
            )


TABLES = {"size.csv": one_row_per_run()}
FIGURES = {"size": Figure("fiberweb.studies.size.figure:draw", ("size.csv", "ridge_baselines.csv"))}
JUDGED_BY = ("size.csv",)
