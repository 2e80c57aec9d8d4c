"""The run table: how each study's scenes are simulated, and what each run is called.

Studies that ask for the same scene share the run, because its name holds a hash of all that it
depends on.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property

from fiberweb import studies
from fiberweb.config import Config, lab
from fiberweb.errors import Named
from fiberweb.model.authors import SKIPPED_FRAMES
from fiberweb.model.scene import Scene
from fiberweb.scoring.limits import check_frames
from fiberweb.simulation.plan import expected_seconds, request
from fiberweb.studies.base import Point

# What a config may ask for in all: the paper's has 5256 runs, of networks with 19 864 readouts.
MOST_RUNS, MOST_READOUTS = 12_000, 250_000
DIGITS = 12  # of the hash in a name; six were shared by seeds among some ten thousand
# what a scene may have in place of its own without another limit of the step
AT_ANY = {"force": 1.0, "seed": 0, "duration": 1.0, "disturbance": 0.0, "centre_lines": False}


@dataclass(frozen=True)
class Run:
    """One simulation.

    Attributes:
        scene: the physics.
        numerics: keyword arguments of `fiberweb.simulate` beside the scene.
        scoring: keyword arguments of `fiberweb.score` beside the response.
        choice, camera: see `fiberweb.studies.base.Point`.
        study: the first that asks for it, whose keys are to blame for what is refused.
        name: what it is, and a hash of what tells scene and numerics from others.
    """

    scene: Scene
    numerics: dict = field(hash=False)
    scoring: dict = field(hash=False)
    choice: str = ""
    camera: dict | None = field(default=None, hash=False)
    study: str = field(default="", compare=False)

    @cached_property
    def request(self) -> str:
        """All that the response depends on."""
        return self.scene.to_json() + json.dumps(self.numerics, sort_keys=True)

    @cached_property
    def name(self) -> str:
        """For instance crosshatch-n04-s100.0mm-f50.1mN-t10.0mN-3fa9c15d20b7, SI prefixes."""
        network, stroke = self.scene.network, self.scene.stroke
        told_by = json.dumps([self.scene.distinct(), self.numerics], sort_keys=True)
        parts = [
            network.topology,
            f"n{network.n:02d}",
            f"s{1e3 * network.spacing:.1f}mm",
            f"x{1e3 * stroke:.1f}mm" if stroke else f"f{1e3 * self.scene.force:.1f}mN",
            f"t{1e3 * self.scene.tension:.1f}mN",
            "" if self.scene.setup == "described" else self.scene.setup,
            hashlib.sha256(told_by.encode()).hexdigest()[:DIGITS],
        ]
        return "-".join(filter(None, parts))

    @property
    def engine(self) -> str:
        """Which engine runs this."""
        return request(self.scene, **self.numerics).engine

    @property
    def expected_seconds(self) -> float:
        """About how long it takes on a fast core."""
        return expected_seconds(self.scene, **self.numerics)

    def check(self) -> None:
        """Raise ValueError, one sentence, if no engine can run this as asked for."""
        from fiberweb.simulation.plan import plan

        with _named(self.name, self.study):
            plan(self.scene, **self.numerics)

    def check_request(self) -> None:
        """`check` as far as that needs no mesh; and whether the recording can be scored."""
        with _named(self.name, self.study):
            request(self.scene, **self.numerics)
            check_frames(
                self.scene.samples, self.scene.sample_rate, skip=self.scoring.get("skip", 0)
            )

    @property
    def kind(self) -> tuple:
        """What `check` can differ by, beyond `check_request`: the model.

        Finding the limit of a step costs some 20 ms and depends on no force, so it is part of this
        only if the config gives a step of its own. Whether fibres have elements enough for the
        filter, or for the authors' mesh, depends on the network.
        """
        scene = self.scene
        kind = (
            scene.setup, scene.network.topology, scene.ends, scene.layout, scene.filter_order,
            scene.tension,
            math.isinf(scene.crossing_stiffness), scene.loss_factor > 0, scene.stroke is None,
            json.dumps(self.numerics),
        )  # fmt: skip
        if "time_step" in self.numerics and scene.setup != "published":
            return (*kind, replace(scene, **AT_ANY).to_json())
        if scene.layout == "authors" or scene.setup == "published" or scene.filter_order:
            return (*kind, scene.network.n, scene.network.length)
        return kind


@contextmanager
def _named(run: str, study: str = "") -> Iterator[None]:
    """Says in what is refused which run it is, and the study if it is known."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"{' of '.join(filter(None, (run, study)))}: {error}") from None


def check(table: Iterable[Run], checked: set[tuple] | None = None) -> None:
    """Raise ValueError, one sentence, if a run of a table cannot start or not be scored.

    Args:
        table: runs.
        checked: kinds of run that were found to start (`Run.kind`); those of the table are added.
    """
    checked = set() if checked is None else checked
    table = list(table)
    for run in table:
        run.check_request()
    for run in table:
        if run.kind not in checked:
            run.check()
            checked.add(run.kind)


class Asked:
    """How much a config asks for, counted while its runs are listed, so that there is an end to
    it."""

    def __init__(self):
        self._runs, self._networks, self._readouts = 0, set(), 0

    def counted(self, points: Iterable[Point]) -> Iterator[Point]:
        """The points; ValueError, one sentence, where they become too many."""
        for point in points:
            self._runs += 1
            if self._runs > MOST_RUNS:
                raise ValueError(
                    f"the config asks for more than {MOST_RUNS} runs by here: list fewer values, "
                    "or split it"
                )
            if (network := point.scene.network) not in self._networks:
                self._networks.add(network)
                self._readouts += network.readouts
            if self._readouts > MOST_READOUTS:
                raise ValueError(
                    f"n = {network.n}: all networks of the config have more than {MOST_READOUTS} "
                    "readouts by here: take fewer or smaller ones"
                )
            yield point


def runs(
    config: Config, study: str, setup: str, best: Mapping | None = None, asked: Asked | None = None
) -> list[Run]:
    """The runs of a study in one setup, in its order, each once for each choice of the force.

    Args:
        config: the whole config.
        study, setup: names.
        best: as for `fiberweb.config.lab`; only studies that start from it look at it.
        asked: what counts these and others together.

    Raises:
        ValueError: one sentence, of a scene that excludes itself, or of too many.
    """
    if setup not in studies.setups(study):
        return []
    published = setup == "published"
    general = {} if published else _given(config.numerics.model_dump())
    with _named(f"a run of {study} in the setup {setup}"):
        points = studies.load(study).points(getattr(config, study), lab(config, setup, best))
        points = [*(asked or Asked()).counted(points)]
    table = {}
    for point in points:
        scoring = {"alpha": config.scoring.alpha}
        if published and point.scene.network.topology == "polygon":
            scoring["skip"] = SKIPPED_FRAMES
        numerics = general if point.numerics is None else point.numerics
        scoring |= point.scoring
        run = Run(point.scene, numerics, scoring, point.choice, point.camera, study)
        same_scene(table.setdefault((run.name, run.choice), run), run)
    return list(table.values())


def run_table(config: Config) -> dict[str, Run]:
    """Every run that any study of any setup may ask for, by name.

    Raises:
        ValueError: two scenes have one name, or there are too many.
    """
    table: dict[str, Run] = Named("run")
    asked = Asked()
    for study in studies.STUDIES:
        for setup in studies.setups(study):
            for run in runs(config, study, setup, asked=asked):
                same_scene(table.setdefault(run.name, run), run)
    return table


def same_scene(run: Run, other: Run) -> None:
    """Raise ValueError, one sentence, if runs of one name differ: one of them would be lost."""
    if run.request != other.request:
        first, second = (json.loads(each.scene.to_json()) | each.numerics for each in (run, other))
        apart = [key for key in first | second if first.get(key) != second.get(key)]
        values = ", ".join(f"{key} {first.get(key)} and {second.get(key)}" for key in apart)
        raise ValueError(f"{run.name} is the name of two scenes, {values}: change one of them")


def _given(values: dict) -> dict:
    """The values that are set: neither None nor False."""
    return {key: value for key, value in values.items() if value not in (None, False)}
