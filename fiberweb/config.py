"""The config: every key with its unit, range and place in the paper, as pydantic models.

    config = load("config/config.yaml", {"scene": {"duration": 20.0}})

Defaults are the paper's. What is generated from the models is in `fiberweb.tools.schema`.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from tempfile import TemporaryFile
from typing import Self

from pydantic import ValidationError, model_validator

from fiberweb.errors import sentence
from fiberweb.sections import (
    AccuracySection,
    NumericsSection,
    SceneSection,
    ScoringSection,
    Section,
    SetupsSection,
    key,
)
from fiberweb.studies.sections import (
    BucklingSection,
    CalibrationSection,
    ChaosSection,
    FeaturesSection,
    MemoryOriginSection,
    NarmaSection,
    NoiseSection,
    PretensionSection,
    RidgeSection,
    RobustnessSection,
    SizeSection,
    TopologySection,
)

HORIZON = 1.0  # longest recall lag (s)
AUTHORS_SKIP = 300  # first frames that the authors drop from polygons


class Config(Section):
    """The whole config."""

    results: str = key("results", "folder that everything is written to", min_length=1)
    published_tables: str | None = key(
        None, "folder of the authors' own tables; without it the G claims are not computed"
    )
    scene: SceneSection = SceneSection()
    setups: SetupsSection = SetupsSection()
    numerics: NumericsSection = NumericsSection()
    scoring: ScoringSection = ScoringSection()
    topology: TopologySection = TopologySection()
    ridge: RidgeSection = RidgeSection()
    size: SizeSection = SizeSection()
    pretension: PretensionSection = PretensionSection()
    features: FeaturesSection = FeaturesSection()
    memory_origin: MemoryOriginSection = MemoryOriginSection()
    calibration: CalibrationSection = CalibrationSection()
    noise: NoiseSection = NoiseSection()
    chaos: ChaosSection = ChaosSection()
    robustness: RobustnessSection = RobustnessSection()
    narma: NarmaSection = NarmaSection()
    buckling: BucklingSection = BucklingSection()
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
        if self.size.published_duration < 2 * HORIZON:
            raise ValueError(
                f"size.published_duration = {self.size.published_duration:g} s is too short for "
                f"the recall horizon of {HORIZON:g} s: record at least {2 * HORIZON:g} s"
            )
        return self

    @model_validator(mode="after")
    def _follows_the_ridge(self) -> Self:
        spacings = self.ridge.spacing
        for name in ("published_c_nl_force", "published_c_m_force"):
            forces = getattr(self.size, name)
            if len(forces) != len(spacings):
                raise ValueError(
                    f"size.{name} lists {len(forces)} forces, but ridge.spacing {len(spacings)} "
                    "spacings: list one force for each"
                )
        for spacing in self.pretension.spacing:
            if spacing not in spacings:
                raise ValueError(
                    f"pretension.spacing holds {spacing:g} m, but ridge.spacing does not: the "
                    "forces of this study come from the ridge, so use spacings of both"
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
    for name, value in above.items():
        both = isinstance(value, Mapping) and isinstance(merged.get(name), Mapping)
        merged[name] = _overlay(merged[name], value) if both else value
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
    for name in path:
        field = section.model_fields[name]
        section = field.annotation
    is_section = isinstance(section, type) and issubclass(section, Section)
    return (section, None) if is_section else (None, field)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
