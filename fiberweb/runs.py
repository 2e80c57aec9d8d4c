"""The run table: which scenes each study simulates, how, and what each run is called.

A study is a section of the config and a function here that yields its scenes. Studies that ask
for the same scene share the run, because its name holds a hash of all that it depends on.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from fiberweb.config import AUTHORS_SKIP, Config
from fiberweb.network import Network, crosshatch, polygon
from fiberweb.scene import Scene

SETUPS = ("described", "published")
EXAMPLE = 8  # N of the crosshatch whose computations Fig. 1d shows


@dataclass(frozen=True)
class Run:
    """One simulation.

    Attributes:
        scene: the physics.
        numerics: keyword arguments of `fiberweb.simulate` beside the scene.
        scoring: keyword arguments of `fiberweb.score` beside the response.
        name: what it is, and a hash of scene and numerics.
    """

    scene: Scene
    numerics: dict = field(hash=False)
    scoring: dict = field(hash=False)

    @property
    def name(self) -> str:
        """For instance crosshatch-n04-s100.0mm-f50.1mN-t10.0mN-3fa9c1, SI prefixes as marked."""
        network = self.scene.network
        request = self.scene.to_json() + json.dumps(self.numerics, sort_keys=True)
        parts = [
            network.topology,
            f"n{network.n:02d}",
            f"s{1e3 * network.spacing:.1f}mm",
            f"f{1e3 * self.scene.force:.1f}mN",
            f"t{1e3 * self.scene.tension:.1f}mN",
            "published" if self.scene.setup == "published" else "",
            hashlib.sha256(request.encode()).hexdigest()[:6],
        ]
        return "-".join(filter(None, parts))

    def check(self) -> None:
        """Raise ValueError, one sentence, if no engine can run this as asked for."""
        from fiberweb.engines.choose import resolve

        try:
            resolve(self.scene, **self.numerics)
        except ValueError as error:
            raise ValueError(f"{self.name}: {error}") from None


def topology(config: Config, setup: str) -> Iterator[Scene]:
    """Crosshatches and polygons of one outer length and rising N (Fig. 1)."""
    section = config.topology
    for n in section.crosshatch:
        yield scene(config, setup, crosshatch(n, length=section.length))
    for n in section.polygon:
        diagonals = getattr(section.diagonals, setup)
        yield scene(config, setup, polygon(n, section.length, diagonals))


STUDIES: dict[str, Callable[[Config, str], Iterator[Scene]]] = {"topology": topology}


def scene(config: Config, setup: str, network: Network, **changes) -> Scene:
    """A network with the config's physics in one setup; changes win over the config."""
    overrides = getattr(config.setups, setup).model_dump()
    return Scene(network, setup, **config.scene.model_dump() | overrides | changes)


def runs(config: Config, study: str, setup: str) -> list[Run]:
    """The runs of a study in one setup, each once, in the order of the study."""
    numerics = _given(config.numerics.model_dump()) if setup == "described" else {}
    found = {}
    for each in STUDIES[study](config, setup):
        scoring = {"alpha": config.scoring.alpha}
        if setup == "published" and each.network.topology == "polygon":
            scoring["skip"] = AUTHORS_SKIP
        run = Run(each, numerics, scoring)
        found.setdefault(run.name, run)
    return list(found.values())


def run_table(config: Config) -> dict[str, Run]:
    """Every run of every study and setup by name."""
    return {
        run.name: run for study in STUDIES for setup in SETUPS for run in runs(config, study, setup)
    }


def example(found: list[Run]) -> Run:
    """The run whose computations Fig. 1d shows: the 8x8 crosshatch, or the nearest to it."""
    crosshatches = [run for run in found if run.scene.network.topology == "crosshatch"]
    return min(crosshatches or found, key=lambda run: abs(run.scene.network.n - EXAMPLE))


def _given(values: dict) -> dict:
    """The values that are set: neither None nor False."""
    return {key: value for key, value in values.items() if value not in (None, False)}
