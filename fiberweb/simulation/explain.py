"""What an accuracy means for a scene, in words: what is chosen, how far off it is, what is left
out and why, and what it costs."""

from __future__ import annotations

from fiberweb.model.scene import Scene
from fiberweb.simulation.plan import ACCURACIES, resolve, safety

# Measured by `make accuracy`, described 4x4 and 8x8 of 0.5 m at B = 0.8, the worse of
# both: rms error of the trajectories over 1 s, and the larger of the errors of C_nl and C_m over
# 50 s; by elements per section.
TRAJECTORY = {2: 0.14, 4: 0.016, 8: 0.0017, 16: 0.0002}
CAPACITY = {2: 0.015, 4: 0.002, 8: 0.0005, 16: 0.0003}
# Measured by the same (model_ladder): dropping shear and rotary inertia at s/d = 50 changes
# trajectories by this much; it falls as (d/s)^2.
SHEAR, SHEAR_AT = 2.3e-3, 50.0
NANOSECONDS = {"kirchhoff": 3.0, "cosserat": 4.0, "elastica": 500.0}  # an element and step
CHAOS = 1.5  # buckling number above which twins part, by the study `chaos`
PLANE = 0.5  # buckling number above which a push that stays turns fibres out of the plane
STUBBY = 10.0  # spacing in diameters below which shear is no longer small
BREAKING = 0.1  # of EA: larger forces strain a fibre more than a beam can be


def explain(scene: Scene, accuracy: str | None = None, **numerics) -> str:
    """Explain in a few lines how a scene is integrated.

    Args:
        scene: to be run.
        accuracy, **numerics: as for `fiberweb.simulate`.

    Returns:
        Lines of text: the choice, its error, what is left out, the step, the cost, and what to
        beware of.

    Raises:
        ValueError: one sentence, as from `fiberweb.simulate`.
    """
    from fiberweb.engines.base import steps_per_sample
    from fiberweb.engines.stability import largest_step
    from fiberweb.model.mesh import build

    chosen = resolve(scene, accuracy, **numerics)
    mesh = build(scene, chosen.elements_per_section)
    limit = largest_step(mesh, chosen.engine)
    per_sample = steps_per_sample(scene, chosen.time_step)
    step = 1.0 / (scene.sample_rate * per_sample)
    steps = per_sample * (scene.samples - 1)
    seconds = 1e-9 * NANOSECONDS[chosen.engine] * steps * mesh.elements
    lines = [
        f"choice: {_choice(scene, accuracy, chosen)}",
        f"error: {_error(scene, chosen)}",
        f"left out: {_left_out(scene, chosen.engine)}",
        f"step: {1e6 * step:.3g} us, {_against(step, limit, scene)}",
        f"cost: {steps:.3g} steps x {mesh.elements} elements, about {_duration(seconds)}",
    ]
    return "\n".join(lines + [f"beware: {text}" for text in _warnings(scene)])


def _choice(scene: Scene, accuracy: str | None, chosen) -> str:
    elements = chosen.elements_per_section
    mesh = "the authors' mesh" if elements is None else f"{elements} elements a section"
    if scene.setup == "published":
        why = "the published setup fixes mesh and step"
    elif accuracy or elements == ACCURACIES["standard"]:
        why = f"accuracy {accuracy or 'standard'}"
    else:
        why = "as asked for"
    return f"{chosen.engine} engine, {mesh} ({why})"


def _error(scene: Scene, chosen) -> str:
    elements = chosen.elements_per_section
    if scene.setup == "published":
        return "none against the authors' own numbers: their mesh, step and filter are the model"
    if chosen.engine != "kirchhoff" or elements not in TRAJECTORY:
        return "not on record for this mesh; see the speed_accuracy table"
    return (
        f"{100 * TRAJECTORY[elements]:.2g} % of the trajectories' rms at B = 0.8, "
        f"{CAPACITY[elements]:.1g} in C_nl and C_m (measured, 4x4 and 8x8 crosshatch)"
    )


def _left_out(scene: Scene, engine: str) -> str:
    if engine == "elastica":
        return "nothing of PyElastica's rods"
    parts = [f"out-of-plane motion (B = {scene.buckling_number:.2g}; it starts near {PLANE:g})"]
    if engine == "kirchhoff":
        slender = scene.network.spacing / scene.diameter
        effect = SHEAR * (SHEAR_AT / slender) ** 2
        parts.append(
            f"shear and rotary inertia (s/d = {slender:.3g}: about {100 * effect:.2g} % of the "
            "trajectories)"
        )
    return ", ".join(parts)


def _against(step: float, limit: float, scene: Scene) -> str:
    if step > limit and scene.filter_order:
        return f"above the limit of {1e6 * limit:.3g} us without the filter, which damps the excess"
    if step > limit:
        return f"above the limit of {1e6 * limit:.3g} us: the run will most likely blow up"
    return (
        f"{step / limit:.2f} of the limit of {1e6 * limit:.3g} us (at most {safety(scene):g} by "
        "itself; rounded down to divide the sample period)"
    )


def _duration(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.2g} s of one core"
    hours = seconds / 3600
    return f"{hours:.2g} hours of one core" if hours > 1 else f"{seconds / 60:.0f} min of one core"


def _warnings(scene: Scene) -> list[str]:
    """What no mesh mends."""
    found = []
    if scene.buckling_number > CHAOS:
        found.append(
            f"B = {scene.buckling_number:.2g} is past buckling: trajectories are chaotic, so "
            "compare capacities and never trajectories"
        )
    slender = scene.network.spacing / scene.diameter
    if slender < STUBBY:
        found.append(f"s/d = {slender:.2g}: a fibre this stout is a poor beam")
    for name, force in (("force", scene.force), ("tension", scene.tension)):
        if force > BREAKING * scene.axial_stiffness:
            found.append(
                f"{name} = {force:.3g} N is {force / scene.axial_stiffness:.2g} of EA: strains "
                "are not small, and no step may be small enough"
            )
    return found
