"""From a scene and an accuracy to an engine, a mesh and a step; and what is refused."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from fiberweb.arguments import positive, shown, spelt, true_or_false, whole
from fiberweb.engines import ENGINES, load
from fiberweb.errors import unknown_key
from fiberweb.model.authors import ELEMENT, STEP
from fiberweb.model.scene import Scene
from fiberweb.simulation import memory

if TYPE_CHECKING:
    from fiberweb.engines.base import Numerics
    from fiberweb.model.mesh import Mesh

ACCURACIES = {"draft": 2, "standard": 4, "fine": 8, "reference": 16}  # elements per section
DEFAULT_ENGINE, AUTHORS_ENGINE = "kirchhoff", "cosserat"
# Shares of the stability limit that the automatic step takes, and the smaller ones from a share of
# EA in force or tension on: compression, tension and bow stiffen a fibre beyond the straight one
# that the limit is of. Source: found_loaded_s of stability.csv, where steps of 0.87 to 1.0 of the
# limit were found to be too long under load.
SAFETY = 0.9
SAFETY_BY_STRAIN = {1e-3: 0.7, 1e-2: 0.4}
# Spacing in diameters below which leaving out shear costs more than some 0.2 of the trajectories.
# Source: model_ladder.csv has 0.0023 at 50 diameters, and it grows as the inverse square.
MIN_SLENDERNESS = 5.0
SHORTEST = 0.05  # element in diameters: below one, a finer mesh of a rod says nothing more
MATERIAL_DAMPING = 3.0  # times as long, at most, takes a run whose steps solve a system a fibre
MOST_STEPS = 1e12  # of a run: at a microsecond for each, eleven days


class Request(NamedTuple):
    """What is asked for of a scene: as for `Plan`, and whether a step above the limit is wanted."""

    engine: str
    elements_per_section: int | None
    time_step: float | None
    force_time_step: bool


@dataclass(frozen=True, eq=False)
class Plan:
    """How a scene is integrated: made by `plan`, run by `fiberweb.simulation.simulate.run` and
    put into words by `fiberweb.simulation.explain.describe`.

    Attributes:
        mesh: the scene cut into elements.
        engine: "kirchhoff", "cosserat" or "elastica".
        elements_per_section: None is the authors' mesh.
        time_step: that was asked for, s; None for a share of the limit, see `safety`.
        accuracy: that was asked for, or None.
    """

    mesh: Mesh
    engine: str
    elements_per_section: int | None
    time_step: float | None
    accuracy: str | None = None

    @property
    def scene(self) -> Scene:
        """What is integrated."""
        return self.mesh.scene

    @cached_property
    def limit(self) -> float:
        """Stability limit of the time step without the Laplace filter, s; NaN if there is none."""
        try:
            return load(self.engine).largest_step(self.mesh)
        except RuntimeError:  # ARPACK's, of masses or stiffnesses that overflow
            return math.nan

    @cached_property
    def numerics(self) -> Numerics:
        """What the engine is given beside the mesh."""
        from fiberweb.engines.base import Numerics

        step = safety(self.scene) * self.limit if self.time_step is None else self.time_step
        return Numerics(self.engine, self.elements_per_section, step)


@spelt
def plan(
    scene: Scene,
    accuracy: str | None = None,
    *,
    engine: str | None = None,
    elements_per_section: int | None = None,
    time_step: float | None = None,
    force_time_step: bool = False,
) -> Plan:
    """Choose how to integrate a scene; the mesh is built and, if need be, the limit found.

    Args:
        scene: to be run.
        accuracy: "draft", "standard" (the default), "fine" or "reference"; not of the
            published setup, and instead of engine, mesh and step.
        engine: "kirchhoff", "cosserat" or "elastica".
        elements_per_section: see `fiberweb.model.mesh.build`.
        time_step: s; by default 0.9 of the limit (see `safety`), or the authors' 5 us in the
            published setup.
        force_time_step: accept a step above the limit, to see it fail.

    Raises:
        ValueError: one sentence with the key, its value and what would be right; among others
            for a network of stubby sections if no engine is named.
    """
    from fiberweb.model.mesh import build

    asked = request(
        scene,
        accuracy,
        engine=engine,
        elements_per_section=elements_per_section,
        time_step=time_step,
        force_time_step=force_time_step,
    )
    mesh = build(scene, asked.elements_per_section)
    load(asked.engine).refuse(mesh)
    planned = Plan(mesh, asked.engine, asked.elements_per_section, asked.time_step, accuracy)
    if scene.setup == "published" and time_step is None:
        return planned
    step = planned.numerics.time_step
    if not 0 < step < math.inf:
        raise ValueError(
            f"diameter = {scene.diameter} m, youngs_modulus = {scene.youngs_modulus} Pa and "
            f"density = {scene.density} kg/m^3 give fibres without a stable time step; take "
            "values of a material"
        )
    _refuse_endless(scene, step)
    if not (asked.force_time_step or scene.filter_order) and step > planned.limit:
        raise ValueError(
            f"time_step = {step:.3g} s is above the stability limit of {planned.limit:.3g} s of "
            f"the {asked.engine} engine on this mesh; take a smaller one or leave it out"
        )
    return planned


@spelt
def request(
    scene: Scene,
    accuracy: str | None = None,
    *,
    engine: str | None = None,
    elements_per_section: int | None = None,
    time_step: float | None = None,
    force_time_step: bool = False,
) -> Request:
    """What is asked for, chosen and refused as far as that needs no mesh; see `plan`.

    It takes some microseconds, so that every run of a config can be asked for before one starts.
    """
    if not isinstance(scene, Scene):
        raise ValueError(
            f"scene = {shown(scene)} is not a scene; make one with Scene(crosshatch(...))"
        )
    given = {"engine": engine, "elements_per_section": elements_per_section, "time_step": time_step}
    _check_accuracy(scene, accuracy, given)
    if engine is not None and engine not in [*ENGINES]:
        raise ValueError(f"engine = {shown(engine)}: {unknown_key(engine, ENGINES, kind='engine')}")
    if elements_per_section is not None:
        elements_per_section = whole("elements_per_section", elements_per_section, 1)
        most = max(1, math.floor(scene.network.spacing / (SHORTEST * scene.thickest)))
        if elements_per_section > most:
            raise ValueError(
                f"elements_per_section = {elements_per_section}: elements far shorter than a "
                f"fibre of {scene.thickest:g} m is thick; take at most {most}"
            )
    if time_step is not None:
        time_step = positive("time_step", time_step, " must be a positive number of seconds")
        _refuse_endless(scene, time_step)
    if scene.tension >= scene.axial_stiffness:
        raise ValueError(
            f"tension = {scene.tension:g} N: no fibre holds a pull of EA = "
            f"{scene.axial_stiffness:g} N or more, so take a smaller one"
        )
    default = AUTHORS_ENGINE if scene.setup == "published" else DEFAULT_ENGINE
    chosen = engine or default
    if engine is None and stubby(scene) and not load(chosen).MODELS_SHEAR:
        other = next(name for name in ENGINES if load(name).MODELS_SHEAR)
        tied = " with a finite crossing_stiffness" if math.isinf(scene.crossing_stiffness) else ""
        raise ValueError(
            f"spacing = {scene.network.spacing:g} m: a section shorter than {MIN_SLENDERNESS:g} "
            f"diameters of {scene.thickest:g} m shears, which the {chosen} engine leaves out; "
            f"take a longer one, or engine = {other!r}{tied}"
        )
    if scene.setup == "published":
        time_step = STEP if time_step is None else time_step
    elif elements_per_section is None:
        elements_per_section = ACCURACIES[accuracy or "standard"]
    memory.check(scene, elements_per_section)
    forced = true_or_false("force_time_step", force_time_step)
    return Request(chosen, elements_per_section, time_step, forced)


def expected_seconds(scene: Scene, **numerics) -> float:
    """About how long a run takes, from what is asked for alone: without mesh and stability limit.

    Args:
        scene, **numerics: as for `plan`.
    """
    asked = request(scene, **numerics)
    length = scene.network.spacing / (asked.elements_per_section or 1)
    if asked.elements_per_section is None:
        length = ELEMENT
    step = asked.time_step or safety(scene) * length / scene.wave_speed
    element_steps = scene.network.fibre_lengths.sum() / length * scene.duration / step
    return 1e-9 * nanoseconds(scene, asked.engine) * element_steps


def nanoseconds(scene: Scene, engine: str) -> float:
    """About what an element-step takes a fast core."""
    return load(engine).NANOSECONDS * (MATERIAL_DAMPING if scene.loss_factor else 1.0)


def stubby(scene: Scene) -> bool:
    """Whether shear, and not bending alone, decides how the driven section moves."""
    return scene.network.spacing < MIN_SLENDERNESS * scene.thickest


def safety(scene: Scene) -> float:
    """Share of the stability limit that the automatic step takes.

    A force or a tension that is no longer small beside EA can fling a fibre about and strain it,
    and then bow and stretch make it stiffer than the straight one that the limit is of.
    """
    strain = max(scene.force or 0.0, scene.tension) / scene.axial_stiffness
    if scene.stroke is not None:
        strain += _strain_of_stroke(scene)
    return min([SAFETY, *(share for least, share in SAFETY_BY_STRAIN.items() if strain >= least)])


def _strain_of_stroke(scene: Scene) -> float:
    """About how much a stroke in the middle strains a fibre whose ends are held or sprung."""
    length = scene.network.fibre_lengths[scene.network.driven_fibre]
    longer = 2.0 * scene.stroke**2 / length
    give = scene.axial_stiffness / scene.end_stiffness if scene.end_stiffness else 0.0
    return longer / (length + give)


def _check_accuracy(scene: Scene, accuracy, given: dict) -> None:
    """Refuse an accuracy that does not exist, or beside what it chooses."""
    if accuracy is None:
        return
    if accuracy not in [*ACCURACIES]:
        raise ValueError(
            f"accuracy = {shown(accuracy)} does not exist; choose one of {', '.join(ACCURACIES)}"
        )
    if scene.setup == "published":
        raise ValueError(
            f"accuracy = {accuracy!r}: the published setup fixes its own mesh and step, so "
            "leave the accuracy out"
        )
    for key, value in given.items():
        if value is not None:
            raise ValueError(
                f"{key} = {shown(value)}: an accuracy chooses it, so give one or the other"
            )


def _refuse_endless(scene: Scene, step: float) -> None:
    """Refuse a run that no machine comes to the end of."""
    length = max(scene.duration, 1.0 / scene.sample_rate)  # two samples at least
    if length > MOST_STEPS * step:
        raise ValueError(
            f"duration = {scene.duration:g} s at sample_rate = {scene.sample_rate:g} Hz takes "
            f"{length / step:.1g} steps of {step:.3g} s, more than any machine gets through; take "
            "a shorter one, or larger steps"
        )
