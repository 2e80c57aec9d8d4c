"""The run table: how each study's scenes are simulated, and what each run is called.

Studies that ask for the same scene share the run, because its name holds a hash of all that it
depends on.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from fiberweb import studies
from fiberweb.config import Config, lab
from fiberweb.model.authors import SKIPPED_FRAMES
from fiberweb.model.scene import Scene

# what a scene may have in place of its own without another limit of the step
AT_ANY = {"force": 1.0, "seed": 0, "duration": 1.0, "disturbance": 0.0, "centre_lines": False}


@dataclass(frozen=True)
class Run:
    """One simulation.

    Attributes:
        scene: the physics.
        numerics: keyword arguments of `fiberweb.simulate` beside the scene.
        scoring: keyword arguments of `fiberweb.score` beside the response.
        choice: where the study took the force from; see `fiberweb.studies.base.Point`.
        name: what it is, and a hash of scene and numerics.
    """

    scene: Scene
    numerics: dict = field(hash=False)
    scoring: dict = field(hash=False)
    choice: str = ""

    @cached_property
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
            "" if self.scene.setup == "described" else self.scene.setup,
            hashlib.sha256(request.encode()).hexdigest()[:6],
        ]
        return "-".join(filter(None, parts))

    def check(self) -> None:
        """Raise ValueError, one sentence, if no engine can run this as asked for."""
        from fiberweb.simulation.plan import plan

        try:
            plan(self.scene, **self.numerics)
        except ValueError as error:
            raise ValueError(f"{self.name}: {error}") from None


def check(table: Iterable[Run]) -> None:
    """`Run.check` for runs of a table, where it can differ from one to the next.

    Finding the limit of a step costs some 20 ms and depends on no force, so it is done for every
    network if the config gives a step of its own, and for one run of each kind of model otherwise.
    """
    kinds = {}
    for run in table:
        scene = run.scene
        model = (scene.setup, scene.network.topology, scene.ends, scene.filter_order, scene.tension)
        kind = (*model, math.isinf(scene.crossing_stiffness), json.dumps(run.numerics))
        if "time_step" in run.numerics and scene.setup != "published":
            kind = (*kind, replace(scene, **AT_ANY).to_json())
        kinds.setdefault(kind, run)
    for run in kinds.values():
        run.check()


def runs(config: Config, study: str, setup: str, best: Mapping | None = None) -> list[Run]:
    """The runs of a study in one setup, in its order, each once for each choice of the force.

    Args:
        config: the whole config.
        study, setup: names.
        best: as for `fiberweb.config.lab`; only studies that start from it look at it.
    """
    if setup not in studies.setups(study):
        return []
    published = setup == "published"
    general = {} if published else _given(config.numerics.model_dump())
    table = {}
    for point in studies.load(study).points(getattr(config, study), lab(config, setup, best)):
        scoring = {"alpha": config.scoring.alpha}
        if published and point.scene.network.topology == "polygon":
            scoring["skip"] = SKIPPED_FRAMES
        numerics = general if point.numerics is None else point.numerics
        run = Run(point.scene, numerics, scoring, point.choice)
        table.setdefault((run.name, run.choice), run)
    return list(table.values())


def run_table(config: Config) -> dict[str, Run]:
    """Every run that any study of any setup may ask for, by name."""
    return {
        run.name: run
        for study in studies.STUDIES
        for setup in studies.setups(study)
        for run in runs(config, study, setup)
    }


def _given(values: dict) -> dict:
    """The values that are set: neither None nor False."""
    return {key: value for key, value in values.items() if value not in (None, False)}
