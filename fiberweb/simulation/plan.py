"""From a scene and an accuracy to an engine, a mesh and a step; and what is refused."""

from __future__ import annotations

from fiberweb.errors import unknown_key
from fiberweb.model.scene import Scene

ENGINES = ("kirchhoff", "cosserat", "elastica")
ACCURACIES = {"draft": 2, "standard": 4, "fine": 8, "reference": 16}  # elements per section
SAFETY = 0.9  # of the linear limit: compression and tension stiffen a fibre a little
# The same above a share of EA in force or tension. Under load steps of 0.87 to 1.0 of the linear
# limit were found to be too long (found_loaded_s of the stability table).
VIOLENT = {1e-3: 0.7, 1e-2: 0.4}
STUBBIEST = 5.0  # spacing in diameters at which leaving out shear costs some 0.2 (see `explain`)


def resolve(
    scene: Scene,
    accuracy: str | None = None,
    engine: str | None = None,
    elements_per_section: int | None = None,
    time_step: float | None = None,
    force_time_step: bool = False,
):
    """The numerics of a run.

    Args:
        scene: to be run.
        accuracy: "draft", "standard" (the default), "fine" or "reference"; of the described
            setup only, and instead of engine, mesh and step.
        engine: "kirchhoff", "cosserat" or "elastica".
        elements_per_section: see `fiberweb.model.mesh.build`.
        time_step: s; by default 0.9 of the limit (see `safety`), or the authors' 5 us in the
            published setup.
        force_time_step: accept a step above the limit, to see it fail.

    Returns:
        `fiberweb.engines.base.Numerics`.

    Raises:
        ValueError: one sentence with the key, its value and what would be right; among others
            for a network of stubby sections if no engine is named.
    """
    from fiberweb.engines import load
    from fiberweb.engines.base import AUTHORS_STEP, Numerics
    from fiberweb.engines.stability import largest_step
    from fiberweb.model.mesh import build

    check(scene, accuracy, engine, elements_per_section, time_step)
    published = scene.setup == "published"
    given = engine is not None
    engine = engine or ("cosserat" if published else "kirchhoff")
    if engine == "kirchhoff" and not given and stubby(scene):
        raise ValueError(
            f"spacing = {scene.network.spacing:g} m: a section shorter than {STUBBIEST:g} "
            f"diameters of {scene.diameter:g} m shears, which the kirchhoff engine leaves out; "
            "take a longer one, or engine = 'cosserat'"
        )
    if not published and elements_per_section is None:
        elements_per_section = ACCURACIES[accuracy or "standard"]
    mesh = build(scene, elements_per_section)
    load(engine).refuse(mesh)
    if published and time_step is None:
        return Numerics(engine, elements_per_section, AUTHORS_STEP)
    limit = largest_step(mesh, engine)
    if time_step is None:
        time_step = safety(scene) * limit
    if time_step > limit and not force_time_step and not scene.filter_order:
        raise ValueError(
            f"time_step = {time_step:.3g} s is above the stability limit of {limit:.3g} s of the "
            f"{engine} engine on this mesh; take a smaller one or leave it out"
        )
    return Numerics(engine, elements_per_section, time_step)


def stubby(scene: Scene) -> bool:
    """Whether shear, and not bending alone, decides how the driven section moves."""
    return scene.network.spacing < STUBBIEST * scene.diameter


def safety(scene: Scene) -> float:
    """Share of the linear limit that the automatic step takes.

    A force or a tension that is no longer small beside EA can fling a fibre about and strain it,
    and then bow and stretch make it stiffer than the straight one that the limit is of.
    """
    strain = max(scene.force, scene.tension) / scene.axial_stiffness
    return min([SAFETY, *(share for least, share in VIOLENT.items() if strain >= least)])


def check(scene: Scene, accuracy, engine, elements_per_section, time_step) -> None:
    """Refuse what can be refused without a mesh; see `resolve`."""
    if scene.tension >= scene.axial_stiffness:
        raise ValueError(
            f"tension = {scene.tension:g} N: no fibre holds a pull of EA = "
            f"{scene.axial_stiffness:g} N or more, so take a smaller one"
        )
    if engine is not None and engine not in ENGINES:
        raise ValueError(f"engine = {engine!r}: {unknown_key(engine, ENGINES)}")
    if accuracy is not None:
        if accuracy not in ACCURACIES:
            raise ValueError(
                f"accuracy = {accuracy!r} does not exist; choose one of {', '.join(ACCURACIES)}"
            )
        if scene.setup == "published":
            raise ValueError(
                f"accuracy = {accuracy!r}: the published setup fixes its own mesh and step, so "
                "leave the accuracy out"
            )
        given = {"engine": engine, "elements_per_section": elements_per_section}
        for key, value in (given | {"time_step": time_step}).items():
            if value is not None:
                raise ValueError(
                    f"{key} = {value!r}: an accuracy chooses it, so give one or the other"
                )
    if time_step is not None and not (isinstance(time_step, (int, float)) and time_step > 0):
        raise ValueError(f"time_step = {time_step!r} must be a positive number of seconds")
