"""What a study is made of: points, which become runs; tables; and figures.

A study is a folder here, listed in `fiberweb.studies`. Its `__init__` has

- `SECTION`, its section of the config;
- `points(section, lab)`, which yields its runs;
- `TABLES`, by file name, and `FIGURES`, by name, of what is made of them;
- if it needs them: `SETUPS` that it runs in, where not all; `AFTER_RIDGE = True` if it starts from
  the best forces of the ridge; `check(section, lab)`, which raises ValueError, one sentence; and
  `JUDGED_BY`, the files that the rules in its `claims.py` read.

Beside it stand `figure.py` and `caption.rst`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache

from fiberweb.model.authors import OVERSHOOT
from fiberweb.model.buckling import critical_force
from fiberweb.model.network import Network
from fiberweb.model.network import crosshatch as _crosshatch
from fiberweb.model.network import polygon as _polygon
from fiberweb.model.scene import Scene
from fiberweb.scoring.limits import HORIZON as HORIZON
from fiberweb.sections import ExperimentSection
from fiberweb.simulation.plan import ACCURACIES

CHOICES = ("best_c_nl", "best_c_m")

crosshatch, polygon = cache(_crosshatch), cache(_polygon)  # studies ask for the same ones


@dataclass(frozen=True)
class Point:
    """One run of a study.

    Attributes:
        scene: the physics.
        choice: where its force comes from: "eq3", "grid", "best_c_nl", "best_c_m",
            "authors_c_nl", "authors_c_m", "authors", "buckling" or "mesh"; of the experiment
            "angle" or, in its panel of parameters, "same" or "parameter=value"; of the study
            `webs`, the name of the network.
        numerics: keyword arguments of `fiberweb.simulate` instead of the config's; None for those.
        scoring: keyword arguments of `fiberweb.score` over the config's.
        camera: keyword arguments of `fiberweb.scoring.camera.films`; None if nothing films it.
    """

    scene: Scene
    choice: str
    numerics: dict | None = field(default=None, hash=False)
    scoring: dict = field(default_factory=dict, hash=False)
    camera: dict | None = field(default=None, hash=False)


@dataclass(frozen=True)
class ForceMap:
    """What studies beyond it need of the map over force and spacing (Fig. 2a).

    Attributes:
        n: size of its crosshatch.
        spacings: m.
        best: (choice, spacing in m) to forces in N: the best unbuckled one for C_nl
            ("best_c_nl") or for C_m ("best_c_m"); all that it could be while that is unknown.
    """

    n: int
    spacings: tuple[float, ...]
    best: Mapping[tuple[str, float], Sequence[float]] = field(hash=False)


@dataclass(frozen=True)
class Lab:
    """What every study is given beside its own section.

    Attributes:
        setup: one of `fiberweb.model.scene.SETUPS`.
        defaults: fields of a scene in this setup, as in the config.
        map: see `ForceMap`.
        thinned: whether the published setup runs only what two cores can afford.
        experiment: the config's section of that name.
    """

    setup: str
    defaults: Mapping[str, object] = field(hash=False)
    map: ForceMap
    thinned: bool
    experiment: ExperimentSection = field(hash=False)

    def scene(self, network: Network, **changes) -> Scene:
        """A network with the config's physics; changes win over the config."""
        return Scene(network, self.setup, **{**self.defaults, **changes})

    def twin(self, n: int, angle: float, choice: str = "angle", **changes) -> Point:
        """The experiment on a crosshatch of n at a motor angle (degrees), filmed and scored.

        There is one scene; what the setups differ in is the scoring, the authors' (`published`) or
        a clean one. Changes win over the keys of the config's section `experiment`.
        """
        given = self.experiment.model_copy(update=changes)
        same = (
            "duration", "sample_rate", "drive_rate", "lever", "tension", "diameter",
            "youngs_modulus", "density", "loss_factor", "bond_stiffness", "damping",
            "end_stiffness",
        )  # fmt: skip
        scene = Scene(
            crosshatch(n, length=given.length),
            stroke=given.direction * given.lever * math.sin(math.radians(angle)),
            lowest_knot=0, ends="sprung", seed=self.defaults["seed"],
            **{name: getattr(given, name) for name in same},
        )  # fmt: skip
        scoring = {"scoring": "clean"}
        if self.setup == "published":
            scoring = {"scoring": "published", "shuffle": True, "overshoot": OVERSHOOT}
        camera = {
            "pixels_per_mm": given.pixels_per_mm, "noise": given.marker_noise,
            "seed": given.camera_seed, "frame_step": given.frame_step,
        }  # fmt: skip
        scoring |= {"alpha": given.alpha, "skip": given.skip}
        accuracy = _accuracy(scene.network.spacing, given.element)
        return Point(scene, choice, {"accuracy": accuracy}, scoring, camera)

    def critical_force(self, spacing: float) -> float:
        """F_max (N) at which B = 1; spacing in m."""
        return critical_force(spacing, self.defaults["diameter"], self.defaults["youngs_modulus"])

    def check_duration(self, name: str, duration: float, least: float = 0.0, why: str = ""):
        """Raise ValueError if a recording (s) is too short to be scored with `least` s dropped."""
        least += 2 * HORIZON
        if duration < least:
            raise ValueError(
                f"{name} = {duration:g} s is too short for the recall horizon of {HORIZON:g} s: "
                f"record at least {least:g} s, twice the horizon{why}"
            )


def _accuracy(spacing: float, element: float) -> str:
    """The coarsest accuracy without an element longer than this (m)."""
    for name, elements in ACCURACIES.items():
        if spacing <= element * elements * (1 + 1e-9):
            return name
    raise ValueError(
        f"element = {element:g} m is shorter than those of accuracy {name!r}, "
        f"{spacing / elements:.2g} m at a spacing of {spacing:.2g} m; give a longer one"
    )


def every(runs: Sequence, section) -> Sequence:
    """All runs of a study."""
    return runs


def first(runs: Sequence, section) -> Sequence:
    """The first run of a study."""
    return runs[:1]


def scoring_of(_, runs: Sequence) -> dict:
    """Options: how the runs are scored, which is the same for all."""
    return dict(runs[0].scoring)


@dataclass(frozen=True)
class Table:
    """A table (CSV) or dataset (NetCDF) that a study makes in each of its setups.

    Attributes:
        make: "module:function". Called with the tables, then by keyword with those of
            ``capacity_paths``, ``certificate_paths``, ``response_paths`` (lists, or
            ``response_path`` if `single`) and ``choices`` (see `Point`) that are asked for, and
            with the options.
        capacities, responses: which of the study's runs it is given: a function of the list of
            them and of the section, or None.
        certificates: whether it is given their certificates too, if the config asks for them.
        single: whether it is given one response and not a list.
        choices: whether it is given the choice of each run.
        tables: names of files of the same setup.
        options: function of the section and of the runs it is given.
    """

    make: str
    capacities: Callable | None = None
    responses: Callable | None = None
    certificates: bool = False
    single: bool = False
    choices: bool = False
    tables: tuple[str, ...] = ()
    options: Callable[[object, Sequence], dict] = lambda section, runs: {}

    def runs(self, runs: Sequence, section) -> Sequence:
        """Those of the study's runs that the table is made of."""
        chosen = self.capacities or self.responses
        return chosen(runs, section) if chosen else []


def one_row_per_run(certificates: bool = False) -> Table:
    """The table that most studies have."""
    make = "fiberweb.scoring.tables:study"
    return Table(make, capacities=every, certificates=certificates, choices=True)


def input_baselines(of: Callable = first) -> Table:
    """What readouts made of the input alone would score on the input of a study's runs."""
    make = "fiberweb.scoring.tables:input_baselines"
    return Table(make, responses=of, single=True, options=scoring_of)


@dataclass(frozen=True)
class Figure:
    """A figure that a study makes in each of its setups.

    Attributes:
        draw: "module:function", called with what it is given (by file name without suffix),
            the setup, the path, and the options by keyword.
        given: names of files that tables of this or another study, or rules of their own, make.
        responses: whether it is given the study's responses too, as "responses".
        caption: file beside the study's `__init__`.
        category: of the report.
        options: function of the section.
    """

    draw: str
    given: tuple[str, ...] = ()
    responses: bool = False
    caption: str = "caption.rst"
    category: str = "Figures"
    options: Callable[[object], dict] = lambda section: {}
