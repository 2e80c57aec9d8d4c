"""The studies: which scenes each simulates, and why at that force.

A study is a section of the config and a function here that yields its points. Two of them need
what another has found: size and pretension start from the best unbuckled force of each spacing,
given as `best`; while that is unknown they yield all that it could be.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import product

from fiberweb.config import Config
from fiberweb.model.buckling import critical_force
from fiberweb.model.network import Network, crosshatch, polygon
from fiberweb.model.scene import SETUPS, Scene

# (choice, spacing in m) -> force in N; choice is "best_c_nl" or "best_c_m"
Best = Mapping[tuple[str, float], float]
CHOICES = ("best_c_nl", "best_c_m")
AUTHORS = SETUPS["published", "crosshatch"]


@dataclass(frozen=True)
class Point:
    """One run of a study.

    Attributes:
        scene: the physics.
        choice: where its force comes from: "eq3", "grid", "best_c_nl", "best_c_m",
            "authors_c_nl", "authors_c_m", "authors", "text" or "buckling".
        numerics: keyword arguments of `fiberweb.simulate` instead of the config's; None for those.
    """

    scene: Scene
    choice: str
    numerics: dict | None = field(default=None, hash=False)


def topology(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """Crosshatches and polygons of one outer length and rising N (Fig. 1)."""
    section = config.topology
    for n in section.crosshatch:
        yield Point(scene(config, setup, _hatch(n, section.length)), "eq3")
    for n in section.polygon:
        diagonals = getattr(section.diagonals, setup)
        yield Point(scene(config, setup, _polygon(n, section.length, diagonals)), "eq3")


def ridge(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """Every force at every spacing (Fig. 2a, b); thinned in the published setup unless full."""
    section = config.ridge
    for spacing in section.spacing:
        network = _spaced(section.n, spacing)
        forces = sorted(section.force)
        if setup == "published" and not full:
            forces = about(forces, _critical(config, setup, spacing), section.published_forces)
        for force in forces:
            yield Point(scene(config, setup, network, force=force), "grid")


def size(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """Every N at the best force of each spacing (Fig. 2c).

    In the published setup: the authors' forces, at their step and at a stable one.
    """
    section = config.size
    if setup == "described":
        for choice, spacing, force in _chosen(config, config.ridge.spacing, best):
            for n in section.n:
                yield Point(scene(config, setup, _spaced(n, spacing), force=force), choice)
        return
    forces = {
        "authors_c_nl": section.published_c_nl_force, "authors_c_m": section.published_c_m_force
    }  # fmt: skip
    sizes = section.n if full else section.published_n
    for (choice, listed), n in product(forces.items(), sizes):
        for spacing, force in zip(config.ridge.spacing, listed):
            made = scene(
                config, setup, _spaced(n, spacing), force=force,
                duration=min(section.published_duration, config.scene.duration),
            )  # fmt: skip
            yield Point(made, choice)
            if n in section.published_n:
                yield Point(made, choice, {"time_step": section.stable_step})


def pretension(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """Every tension at the best force of each spacing (Fig. 3)."""
    section = config.pretension
    if setup == "described":
        chosen = [
            (c, s, f) for c, s, f in _chosen(config, section.spacing, best) if c == CHOICES[1]
        ]
    else:
        chosen = [("authors", *pair) for pair in zip(section.spacing, section.published_force)]
    for (choice, spacing, force), tension in product(chosen, section.tension):
        network = _spaced(config.ridge.n, spacing)
        yield Point(scene(config, setup, network, force=force, tension=tension), choice)


def features(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """The network whose readouts are grouped (Fig. 4)."""
    section = config.features
    for force in section.force:
        yield Point(scene(config, setup, _hatch(section.n, section.length), force=force), "grid")


def memory_origin(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """What could carry memory, one at a time: crossings, damping of fibres, the Laplace filter.

    Of the published setup: the authors' networks, with their filter and without it.
    """
    section = config.memory_origin
    for n in section.n:
        at = _hatch(n, section.length)
        if setup == "published":
            for order in (AUTHORS["filter_order"], 0):
                yield Point(scene(config, setup, at, filter_order=order), "eq3")
            continue
        sweeps = {
            "crossing_stiffness": section.crossing_stiffness,
            "crossing_damping": section.crossing_damping,
            "damping": section.damping,
        }
        for name, values in sweeps.items():
            for value in values:
                yield Point(scene(config, setup, at, **{name: value}), "eq3")
        own = scene(config, setup, at).damping
        for rate in dict.fromkeys([own, *section.damping]):
            pinned = {"crossing_stiffness": math.inf, "crossing_damping": 0.0, "damping": rate}
            yield Point(scene(config, setup, at, **pinned), "eq3")
        yield from _filtered(config, at)


def _filtered(config: Config, network: Network) -> Iterator[Point]:
    """The Laplace filter over the authors' crossings on several meshes and at several steps,
    because its strength is of those, and no filter on the same meshes."""
    section = config.memory_origin
    elements, steps = section.filter_element, section.filter_step
    meshes = [(element, steps[0]) for element in elements]
    finer = [(elements[0], step) for step in steps[1:]]
    crossings = {key: AUTHORS[key] for key in ("crossing_stiffness", "crossing_damping")}
    off, on = (
        scene(config, "described", network, filter_order=order, **crossings)
        for order in (0, AUTHORS["filter_order"])
    )
    for made, (element, step) in [*product((off, on), meshes), *product([on], finer)]:
        per_section = max(1, round(network.spacing / element))
        numerics = {
            "engine": "cosserat", "elements_per_section": per_section, "time_step": step
        }  # fmt: skip
        yield Point(made, "eq3", numerics)


def calibration(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """The grid of unreported parameters."""
    section = config.calibration
    if setup == "published":
        return
    grid = product(section.crossing_stiffness, section.crossing_damping, section.damping)
    for (k, nu, rate), n in product(grid, section.n):
        changes = {"crossing_stiffness": k, "crossing_damping": nu, "damping": rate}
        yield Point(scene(config, setup, _hatch(n, section.length), **changes), "eq3")


def noise(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """The networks whose readouts get noise."""
    yield from _plain(config, setup, config.noise)


def chaos(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """Twins over forces about buckling: the second starts disturbed twice as far as the first.

    Both are disturbed because responses of disturbed scenes alone keep every digit.
    """
    section = config.chaos
    if setup == "published":
        return
    network = _spaced(section.n, section.spacing)
    for b in section.buckling:
        force = b * _critical(config, setup, section.spacing)
        one = scene(config, setup, network, force=force)
        for times in (1, 2):
            yield Point(replace(one, disturbance=times * section.disturbance), "buckling")


def robustness(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """Other inputs of the same kind."""
    section = config.robustness
    if setup == "published":
        return
    for n, seed in product(section.n, section.seed):
        yield Point(scene(config, setup, _hatch(n, section.length), seed=seed), "eq3")


def narma(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """The networks that are given the task."""
    yield from _plain(config, setup, config.narma)


def buckling(config: Config, setup: str, best: Best | None, full: bool) -> Iterator[Point]:
    """Just below and just above B = 1, with the centre lines kept."""
    section = config.buckling
    if setup == "published":
        return
    for b in section.buckling:
        force = b * _critical(config, setup, section.spacing)
        network = _spaced(section.n, section.spacing)
        yield Point(scene(config, setup, network, force=force, centre_lines=True), "buckling")


STUDIES: dict[str, Callable[[Config, str, Best | None, bool], Iterator[Point]]] = {
    study.__name__: study
    for study in (
        topology, ridge, size, pretension, features, memory_origin, calibration, noise, chaos,
        robustness, narma, buckling,
    )
}  # fmt: skip


def scene(config: Config, setup: str, network: Network, **changes) -> Scene:
    """A network with the config's physics in one setup; changes win over the config."""
    overrides = getattr(config.setups, setup).model_dump()
    return Scene(network, setup, **config.scene.model_dump() | overrides | changes)


def about(forces: list[float], critical: float, count: int) -> list[float]:
    """As many of the sorted forces as asked for, half of them on either side of the critical one;
    fewer where the list ends."""
    below = [force for force in forces if force < critical]
    above = [force for force in forces if force >= critical]
    return below[-(count // 2) :] + above[: count // 2]


def _chosen(config: Config, spacings, best: Best | None):
    """(choice, spacing, force) of each spacing; every unbuckled force while best is unknown."""
    for choice, spacing in product(CHOICES, spacings):
        if best is None:
            critical = _critical(config, "described", spacing)
            yield from ((choice, spacing, f) for f in config.ridge.force if f < critical)
            continue
        for (chosen_for, at), force in best.items():
            if chosen_for == choice and math.isclose(at, spacing, rel_tol=1e-9):
                # the config's own number: a table keeps ten digits, the name of a run all
                yield choice, spacing, min(config.ridge.force, key=lambda f: abs(f - force))


def _plain(config: Config, setup: str, section) -> Iterator[Point]:
    if setup == "published":
        return
    for n in section.n:
        yield Point(scene(config, setup, _hatch(n, section.length)), "eq3")


def _critical(config: Config, setup: str, spacing: float) -> float:
    """F_max (N) at which B = 1."""
    return critical_force(spacing, config.scene.diameter, config.scene.youngs_modulus)


@cache
def _hatch(n: int, length: float) -> Network:
    return crosshatch(n, length=length)


@cache
def _polygon(n: int, length: float, diagonals: str) -> Network:
    return polygon(n, length, diagonals)


@cache
def _spaced(n: int, spacing: float) -> Network:
    return crosshatch(n, spacing=spacing)
