"""The config: every key with its unit, range and place in the paper, as pydantic models.

    config = load("config/config.yaml", {"scene": {"duration": 20.0}})

Defaults are the paper's. What is generated from the models is in `fiberweb.schema`.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryFile
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

from fiberweb.errors import sentence
from fiberweb.scene import SETUPS, NotNegative, Positive, PositiveOrPinned, Scene

HORIZON = 1.0  # longest recall lag (s)
AUTHORS_SKIP = 300  # first frames that the authors drop from polygons

NETWORK = "Fiber network setup"
CAPACITY = "Quantifying physical reservoir capacity"
SIMULATION = "Simulation experiments"
TOPOLOGY = "Fiber network topology"


def _key(default, text: str, unit: str = "", paper: str = "", **constraints):
    """A field: what it means, its unit, and the section of the paper that states it."""
    extra = {"unit": unit, "paper": paper}
    return Field(default, description=text, json_schema_extra=extra, **constraints)


def _scene_key(name: str, *labels: str):
    """A field that overrides the scene's own default."""
    return _key(Scene.__dataclass_fields__[name].default, *labels)


class Section(BaseModel):
    """Keys that belong together; unknown ones are refused."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)


class SceneSection(Section):
    """Physics and recording of every run, in both setups."""

    tension: NotNegative = _scene_key(
        "tension", "constant pull along each fibre at its far end, F_t", "N", SIMULATION
    )
    duration: Positive = _scene_key("duration", "length of the recording", "s", SIMULATION)
    seed: Annotated[int, Field(ge=0)] = _scene_key("seed", "seed of the input", "", SIMULATION)
    sample_rate: Positive = _scene_key("sample_rate", "rate of the recording", "Hz", SIMULATION)
    drive_rate: Positive = _scene_key(
        "drive_rate", "random knots of the input per second", "Hz", SIMULATION
    )
    diameter: Positive = _scene_key("diameter", "diameter of the fibres", "m", SIMULATION)
    youngs_modulus: Positive = _scene_key(
        "youngs_modulus", "Young's modulus E; the shear modulus is E/3", "Pa", SIMULATION
    )
    density: Positive = _scene_key("density", "density of the fibres", "kg/m^3", SIMULATION)
    tension_ramp: NotNegative = _scene_key(
        "tension_ramp", "time over which the tension grows from zero", "s", ""
    )


class SetupSection(Section):
    """What the paper's text leaves open; null takes the setup's own value."""

    crossing_stiffness: PositiveOrPinned | None = _key(
        None, "spring between fibres at a crossing; .inf joins them in one point", "N/m", SIMULATION
    )
    crossing_damping: NotNegative | None = _key(
        None, "damper beside that spring", "N s/m", SIMULATION
    )
    damping: NotNegative | None = _key(None, "rate at which velocity decays", "1/s", "")
    filter_order: Annotated[int, Field(ge=0, le=6)] | None = _key(
        None, "order of the Laplace filter on velocities at every step, 0 for none"
    )
    ends: Literal["clamped", "sliding", "pinned"] | None = _key(
        None,
        "clamped near end and free far end; pinned near end and far end that slides along the "
        "fibre; or pinned near end and free far end",
        "",
        NETWORK,
    )


class SetupsSection(Section):
    """The two setups: the paper's text, and the authors' code."""

    described: SetupSection = SetupSection(**SETUPS["described", "crosshatch"])
    published: SetupSection = SetupSection()


class NumericsSection(Section):
    """How runs of the described setup are integrated; the published setup fixes its own."""

    accuracy: Literal["draft", "standard", "fine", "reference"] | None = _key(
        "standard", "chooses engine, mesh and step; null to choose them by the next keys"
    )
    engine: Literal["kirchhoff", "cosserat", "elastica"] | None = _key(
        None, "kirchhoff: no shear; cosserat: planar PyElastica; elastica: PyElastica itself"
    )
    elements_per_section: Annotated[int, Field(ge=1)] | None = _key(
        None, "elements between two crossings"
    )
    time_step: Positive | None = _key(
        None, "at most the stability limit; null takes 0.9 of it", "s"
    )
    force_time_step: bool = _key(False, "accept a time step above the limit, to see it fail")

    @model_validator(mode="after")
    def _one_or_the_other(self) -> Self:
        chosen = [name for name in type(self).model_fields if name != "accuracy"]
        chosen = [name for name in chosen if getattr(self, name) not in (None, False)]
        if self.accuracy is not None and chosen:
            raise ValueError(
                f"numerics.accuracy = {self.accuracy!r} chooses numerics.{chosen[0]} as well: "
                f"set accuracy to null to keep {chosen[0]} = {getattr(self, chosen[0])!r}"
            )
        return self


class ScoringSection(Section):
    """How capacities are computed."""

    alpha: Positive = _key(0.01, "ridge penalty", "", SIMULATION)


class DiagonalsSection(Section):
    """Which diagonals of a polygon are fibres, in each setup."""

    described: Literal["all", "skip-one"] = _key("all", "as the text says", "", NETWORK)
    published: Literal["all", "skip-one"] = _key(
        "skip-one", "as the authors' code does: diameters, and vertices two apart"
    )


class TopologySection(Section):
    """The topology study, Fig. 1."""

    length: Positive = _key(
        0.5,
        "fibre length of a crosshatch, diameter of a polygon's circumscribed circle",
        "m",
        TOPOLOGY,
    )
    crosshatch: list[Annotated[int, Field(ge=2)]] = _key(
        [2, 4, 6, 8, 10, 12], "numbers of fibres in each direction, N", "", TOPOLOGY
    )
    polygon: list[Annotated[int, Field(ge=6, multiple_of=2)]] = _key(
        [6, 8, 10, 12], "numbers of vertices, N", "", TOPOLOGY
    )
    diagonals: DiagonalsSection = DiagonalsSection()

    @model_validator(mode="after")
    def _not_empty(self) -> Self:
        if not (self.crosshatch or self.polygon):
            raise ValueError(
                "topology.crosshatch = [] and topology.polygon = []: list at least one network"
            )
        return self


class StabilitySection(Section):
    """The box in which predicted limits of the step are held against found ones; from the middle,
    one key at a time."""

    spacing: list[Positive] = _key([0.005, 0.01, 0.02, 0.05, 0.2, 0.5], "spacings", "m")
    diameter: list[Positive] = _key([0.0002, 0.0005, 0.001, 0.004], "diameters", "m")
    tension: list[NotNegative] = _key([0.0, 0.1, 1.0, 5.0, 50.0], "tensions", "N")
    stiffness: list[Positive] = _key(
        [1.0, 10.0, 1e3, 1e4, 1e5, 1e6], "springs of the crossings", "N/m"
    )
    buckling: list[Positive] = _key([0.001, 2.0, 10.0, 100.0], "buckling numbers of the force")
    elements: list[Annotated[int, Field(ge=1)]] = _key([2, 3, 6, 8, 16], "elements per section")


class AccuracySection(Section):
    """What accuracy costs; the target `accuracy`, which no figure of the paper needs."""

    networks: list[Annotated[int, Field(ge=2)]] = _key([4, 8], "crosshatches, N; 4 is the ladder's")
    length: Positive = _key(0.5, "fibre length", "m")
    buckling: Positive = _key(0.8, "buckling number of the force")
    seconds: Positive = _key(1.0, "length of the runs whose trajectories are compared", "s")
    duration: Positive = _key(50.0, "length of the runs that are scored", "s")
    window: Annotated[int, Field(ge=10)] = _key(2000, "steps in which PyElastica is timed")
    plane: list[Positive] = _key(
        [0.3, 0.5, 0.8, 1.5], "buckling numbers of the runs that may leave the plane"
    )
    plane_seconds: Positive = _key(0.3, "length of these runs", "s")
    steps: Annotated[int, Field(ge=100)] = _key(4000, "steps of a run that looks for a limit")
    drift_steps: Annotated[int, Field(ge=1_000_000)] = _key(
        10_000_000, "steps of the undamped runs that have to keep their energy"
    )
    stability: StabilitySection = StabilitySection()


class Config(Section):
    """The whole config."""

    results: str = _key("results", "folder that everything is written to", min_length=1)
    published_tables: str | None = _key(
        None, "folder of the authors' own tables; without it the G claims are not computed"
    )
    scene: SceneSection = SceneSection()
    setups: SetupsSection = SetupsSection()
    numerics: NumericsSection = NumericsSection()
    scoring: ScoringSection = ScoringSection()
    topology: TopologySection = TopologySection()
    accuracy: AccuracySection = AccuracySection()

    @model_validator(mode="after")
    def _long_enough_to_score(self) -> Self:
        least, why = 2 * HORIZON, "twice the horizon"
        if self.topology.polygon:
            least += AUTHORS_SKIP / self.scene.sample_rate
            why += f" and the {AUTHORS_SKIP} frames that published polygons drop"
        if self.scene.duration < least:
            raise ValueError(
                f"scene.duration = {self.scene.duration:g} s is too short for the recall horizon "
                f"of {HORIZON:g} s: record at least {least:g} s, {why}"
            )
        return self


def load(*layers: Mapping | str | Path) -> Config:
    """The config made of mappings or YAML files, each laid over the ones before it.

    Raises:
        ValueError: one sentence with the key, its value and what would be right.
    """
    values: dict = {}
    for layer in layers:
        values = _overlay(values, layer if isinstance(layer, Mapping) else _read(layer))
    try:
        return Config.model_validate(values)
    except ValidationError as error:
        raise ValueError(_explain(error)) from None


def check_folders(config: Config) -> None:
    """Raise ValueError if results cannot be written or the authors' tables are not there."""
    folder = Path(config.results)
    try:
        there = next(path for path in (folder, *folder.parents) if path.exists())
        with TemporaryFile(dir=there):
            pass
    except OSError as error:
        raise ValueError(
            f"results = {config.results!r} cannot be written ({error.strerror}): name a folder "
            "that can"
        ) from None
    tables = config.published_tables
    if tables is not None and not any(Path(tables).glob("*.csv")):
        raise ValueError(
            f"published_tables = {tables!r} holds no CSV file: name the folder of the authors' "
            "tables, or leave the key out"
        )


def _read(path: str | Path) -> Mapping:
    import yaml

    values = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    if values is None:
        return {}
    if not isinstance(values, Mapping):
        raise ValueError(f"{path} holds {values!r}: a config is a group of keys")
    return values


def _overlay(below: Mapping, above: Mapping) -> dict:
    merged = dict(below)
    for key, value in above.items():
        both = isinstance(value, Mapping) and isinstance(merged.get(key), Mapping)
        merged[key] = _overlay(merged[key], value) if both else value
    return merged


def _explain(error: ValidationError) -> str:
    """The first problem as one sentence, with the meaning and unit of the key."""
    problem = error.errors()[0]
    if problem["type"] == "value_error":
        return str(problem["ctx"]["error"])
    path = [part for part in problem["loc"] if isinstance(part, str)]
    if problem["type"] == "extra_forbidden":
        return sentence(error, known=_look_up(path[:-1])[0].model_fields)
    section, field = _look_up(path)
    if section is not None:
        keys = ", ".join(section.model_fields)
        return f"{'.'.join(path)} = {problem['input']!r}: this is a group of keys ({keys})"
    text = sentence(error)
    if problem["type"] != "literal_error":  # its message says all
        about = [field.description, field.json_schema_extra["unit"]]
        text += f" ({'; '.join(filter(None, about))})"
    if isinstance(problem["input"], str) and _is_number(problem["input"]):
        text += "; write numbers without quotes, and exponents as in 1.0e+8"
    return text


def _look_up(path: list[str]):
    """(Section, None) or (None, field) that a path of keys leads to."""
    section, field = Config, None
    for key in path:
        field = section.model_fields[key]
        section = field.annotation
    is_section = isinstance(section, type) and issubclass(section, Section)
    return (section, None) if is_section else (None, field)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
