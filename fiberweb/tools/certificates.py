"""Whom certificates accuse: `python -m fiberweb.tools.certificates described chaos published`.

- described: random scenes of that setup below B = 0.9. Of those converged in mesh (Richardson,
  from a run at twice the mesh and half the step) none should be accused of anything.
- chaos: random scenes past B = 1.75, most of which should be called chaos.
- published: the paper's crosshatches, which should be called filter and rounding.

A line a scene and a count at the end of each; over an hour on two cores.
"""

from __future__ import annotations

import sys
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import partial
from os import cpu_count

import numpy as np

from fiberweb.model.authors import LISTED_AT_500MM
from fiberweb.model.network import crosshatch, polygon
from fiberweb.model.scene import Scene
from fiberweb.scoring.capacity import score
from fiberweb.simulation.simulate import simulate
from fiberweb.validation.certificate import CAPACITIES, CHAOS, PHYSICS, TOLERANCE, certificate

ORDER = 4  # of the kirchhoff engine in the element length: tests/engines/test_convergence.py
SCENES = {"described": range(200), "chaos": range(1000, 1030), "published": [*LISTED_AT_500MM]}
BETWEEN = {"described": (0.05, 0.9), "chaos": (1.75, 3.5)}  # B


def random_scene(number: int, low: float, high: float) -> Scene:
    """A described scene of 100 s with a buckling number between two, by its number."""
    rng = np.random.default_rng(number)
    if rng.random() < 0.75:
        network = crosshatch(int(rng.integers(2, 7)), spacing=rng.uniform(0.05, 0.15))
    else:
        network = polygon(int(rng.choice([6, 8])), diameter=rng.uniform(0.3, 0.6))
    drawn = {"tension": 10.0 ** rng.uniform(-3, -1), "seed": int(rng.integers(2**32))}
    of_one_newton = Scene(network, force=1.0, **drawn).buckling_number  # linear in the force
    return Scene(network, force=rng.uniform(low, high) / of_one_newton, **drawn)


def certified(kind: str, number: int) -> tuple[str, bool | None]:
    """A line about a scene, and whether its certificate is as it should be; None: not asked."""
    if kind == "published":
        scene = Scene(crosshatch(number, length=0.5), kind)
    else:
        scene = random_scene(number, *BETWEEN[kind])
    response = simulate(scene)
    table = certificate(response)
    verdicts = table.groupby("capacity")["verdict"].first()
    line = (
        f"{kind} {number}: {scene.network.topology} {scene.network.n}, "
        f"s = {1e3 * scene.network.spacing:.0f} mm, B = {scene.buckling_number:.2f}, "
        f"cost {1 + table['cost'].sum() / len(CAPACITIES):.2f} runs; "
    )
    as_it_should = {
        "described": lambda name: verdicts[name] == PHYSICS,
        "chaos": lambda name: CHAOS in verdicts[name],
        "published": lambda name: "filter" in verdicts[name] or "rounding" in verdicts[name],
    }[kind]
    asked = list(CAPACITIES)
    if kind == "described":
        fine, coarse = score(simulate(scene, "fine")), score(response)
        share = 2**ORDER / (2**ORDER - 1)
        error = {name: abs(float(coarse[name] - fine[name])) * share for name in CAPACITIES}
        asked = [name for name in CAPACITIES if error[name] <= TOLERANCE]
        line += ", ".join(f"error of {name} {error[name]:.4f}" for name in CAPACITIES) + "; "
    line += ", ".join(f"{name} is {verdicts[name]}" for name in CAPACITIES)
    count = any if kind == "chaos" else all
    return line, count(map(as_it_should, asked)) if asked else None


def main(kinds: list[str]) -> None:
    with ProcessPoolExecutor(cpu_count()) as pool:
        for kind in kinds or SCENES:
            found = []
            jobs = [pool.submit(partial(certified, kind, number)) for number in SCENES[kind]]
            for job in as_completed(jobs):
                line, good = job.result()
                print(line, flush=True)
                found += [] if good is None else [good]
            print(f"{kind}: {sum(found)} of {len(found)} as they should be", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
