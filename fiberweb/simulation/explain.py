"""What an accuracy means for a scene, in words: what is chosen, how far off it is, what is left
out and why, and what it costs."""

from __future__ import annotations

from fiberweb.engines import load
from fiberweb.model.scene import Scene
from fiberweb.simulation.plan import ACCURACIES, Plan, nanoseconds, plan, safety

# Shear and rotary inertia left out change trajectories by this much at so many diameters of
# spacing, and by less as the inverse square. Source: model_ladder.csv.
SHEAR, SHEAR_AT = 2.3e-3, 50.0
CHAOS = 2.0  # buckling number above which perturbed pairs part; source: chaos_rates.csv
PLANE = 0.5  # buckling number above which a push turns fibres out; source: out_of_plane.csv
STUBBY = 10.0  # spacing in diameters below which shear costs over 0.05; source: as for SHEAR
# Share of EA above which a force strains a fibre more than a beam can be: there networks were torn
# at any step. Source: the corners of the box in tests/engines/test_limits.py.
BREAKING = 0.1


def explain(scene: Scene, accuracy: str | None = None, **numerics) -> str:
    """Explain in a few lines how a scene is integrated.

    Args:
        scene: to be run.
        accuracy, **numerics: as for `fiberweb.simulate`.

    Returns:
        See `describe`.

    Raises:
        ValueError: one sentence, as from `fiberweb.simulate`.
    """
    return describe(plan(scene, accuracy, **numerics))


def describe(plan: Plan) -> str:
    """A plan in words: the choice, its error, what is left out, the step, the cost, and what to
    beware of; one line each."""
    from fiberweb.engines.base import steps_per_sample

    scene, elements = plan.scene, plan.mesh.elements
    per_sample = steps_per_sample(scene, plan.numerics.time_step)
    step = 1.0 / (scene.sample_rate * per_sample)
    steps = per_sample * (scene.samples - 1)
    seconds = 1e-9 * nanoseconds(scene, plan.engine) * steps * elements
    lines = [
        f"choice: {_choice(plan)}",
        f"error: {_error(plan)}",
        f"left out: {_left_out(plan)}",
        f"step: {1e6 * step:.3g} us, {_against(step, plan.limit, scene)}",
        f"damping: {_damping(scene, step)}",
        f"cost: {steps:.3g} steps x {elements} elements, "
        f"about {_duration(seconds)} of a fast core, up to three times that of a slow one",
    ]
    return "\n".join(lines + [f"beware: {text}" for text in _warnings(scene)])


def _choice(plan: Plan) -> str:
    elements = plan.elements_per_section
    mesh = "the authors' mesh" if elements is None else f"{elements} elements per section"
    if plan.scene.setup == "published":
        why = "the published setup fixes mesh and step"
    elif plan.accuracy or elements == ACCURACIES["standard"]:
        why = f"accuracy {plan.accuracy or 'standard'}"
    else:
        why = "as asked for"
    return f"{plan.engine} engine, {mesh} ({why})"


def _error(plan: Plan) -> str:
    if plan.scene.setup == "published":
        return "none against the authors' own numbers: their mesh, step and filter are the model"
    errors = load(plan.engine).MESH_ERRORS
    if plan.elements_per_section not in errors:
        return "not on record for this mesh; see the speed_accuracy table"
    trajectory, capacity = errors[plan.elements_per_section]
    return (
        f"{100 * trajectory:.2g} % of the trajectories' rms at B = 0.8, "
        f"{capacity:.1g} in C_nl and C_m (measured, 4x4 and 8x8 crosshatch)"
    )


def _left_out(plan: Plan) -> str:
    scene, engine = plan.scene, load(plan.engine)
    parts = []
    if engine.PLANAR:
        at = "a stroke has no B" if scene.stroke else f"B = {scene.buckling_number:.2g}"
        parts.append(f"out-of-plane motion ({at}; it starts near B = {PLANE:g})")
    if not engine.MODELS_SHEAR:
        slender = scene.network.spacing / scene.thickest
        effect = SHEAR * (SHEAR_AT / slender) ** 2
        parts.append(
            f"shear and rotary inertia (s/d = {slender:.3g}: about {100 * effect:.2g} % of the "
            "trajectories)"
        )
    return ", ".join(parts) or "nothing of PyElastica's rods"


def _against(step: float, limit: float, scene: Scene) -> str:
    stated = f"the stability limit of {1e6 * limit:.3g} us"
    if step > limit and scene.filter_order:
        return f"above {stated} without the filter, which damps the excess"
    if step > limit:
        return f"above {stated}: the run will most likely blow up"
    return (
        f"{step / limit:.2f} of {stated} (at most {safety(scene):g} by itself; rounded down to "
        "divide the sample period)"
    )


def _damping(scene: Scene, step: float) -> str:
    if scene.setup == "published":
        short = 100 * 0.5 * scene.damping * step
        return (
            f"{scene.damping:g} /s after the kick, as PyElastica's: forces act {short:.2g} % short"
        )
    uniform = f"{scene.damping:g} /s, exact at any step"
    if scene.loss_factor:
        return (
            f"{uniform}; of the material tan(delta) = {scene.loss_factor:g} at "
            f"{scene.loss_frequency:g} Hz, implicit: no limit of the step"
        )
    return f"{uniform} ({scene.damping * step:.2g} decay times a step)"


def _duration(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.2g} s"
    hours = seconds / 3600
    return f"{hours:.2g} hours" if hours > 1 else f"{seconds / 60:.0f} min"


def _warnings(scene: Scene) -> list[str]:
    """What no mesh mends."""
    warnings = []
    if scene.buckling_number > CHAOS:
        warnings.append(
            f"B = {scene.buckling_number:.2g} is past buckling: trajectories are chaotic, so "
            "compare capacities and never trajectories"
        )
    slender = scene.network.spacing / scene.thickest
    if slender < STUBBY:
        warnings.append(f"s/d = {slender:.2g}: a fibre this stout is a poor beam")
    for name, force in (("force", scene.force or 0.0), ("tension", scene.tension)):
        if force > BREAKING * scene.axial_stiffness:
            warnings.append(
                f"{name} = {force:.3g} N is {force / scene.axial_stiffness:.2g} of EA: strains "
                "are not small, and no step may be small enough"
            )
    return warnings
