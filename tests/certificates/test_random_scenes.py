"""Certificates of random scenes: nobody converged is accused, and chaos is found.

Takes over an hour; `make test_certificates`.
"""

import numpy as np
import pytest

from fiberweb import Scene, crosshatch, polygon, score, simulate
from fiberweb.validation.certificate import CAPACITIES, CHAOS, TOLERANCE, certificate

SCENES = 200


def random_scene(number, low, high):
    """A described scene with a buckling number between two, by its number."""
    rng = np.random.default_rng(number)
    kind = rng.choice(["crosshatch", "polygon"], p=[0.75, 0.25])
    if kind == "crosshatch":
        network = crosshatch(int(rng.integers(2, 7)), spacing=rng.uniform(0.05, 0.15))
    else:
        network = polygon(int(rng.choice([6, 8])), diameter=rng.uniform(0.3, 0.6))
    wanted = rng.uniform(low, high)
    changes = dict(tension=10.0 ** rng.uniform(-3, -1), seed=int(rng.integers(2**32)))
    at_once = Scene(network, force=1.0, **changes).buckling_number  # which is linear in the force
    return Scene(network, force=wanted / at_once, **changes)


def richardson(scene, response):
    """Error of each capacity at the standard mesh, from one twice as fine at half its step."""
    fine = score(simulate(scene, "fine"))
    coarse = score(response)
    return {name: abs(float(coarse[name] - fine[name])) * 4 / 3 for name in CAPACITIES}


@pytest.mark.parametrize("number", range(SCENES))
def test_who_is_converged_is_not_accused(number):
    scene = random_scene(number, 0.05, 0.9)
    response = simulate(scene)
    error = richardson(scene, response)
    table = certificate(response)
    verdicts = table.groupby("capacity")["verdict"].first()
    print(
        "scene",
        number,
        scene.network.topology,
        scene.network.n,
        f"B={scene.buckling_number:.2f}",
        f"s={scene.network.spacing:.3f}",
        error,
        dict(verdicts),
        f"cost {1 + table['cost'].sum() / 2:.2f}",
        flush=True,
    )
    assert 1 + table["cost"].sum() / 2 < 6
    for name in CAPACITIES:
        assert error[name] > 0.5 * TOLERANCE or verdicts[name] == "physics"


def test_past_buckling_most_are_chaos():
    found = []
    for number in range(30):
        scene = random_scene(1000 + number, 1.75, 3.5)
        table = certificate(simulate(scene))
        found.append(table["verdict"].str.contains(CHAOS).any())
        print(
            "chaos",
            number,
            scene.network.topology,
            scene.network.n,
            f"B={scene.buckling_number:.2f}",
            table.groupby("capacity")["verdict"].first().to_dict(),
            table.loc[table.changed == "start", "change"].tolist(),
            flush=True,
        )
    assert np.mean(found) >= 0.9
