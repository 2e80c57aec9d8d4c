"""The config: every key with its unit, range and place in the paper, as pydantic models.

    config = load("config/config.yaml", {"scene": {"duration": 20.0}})

Defaults are the paper's. What is generated from the models is in `fiberweb.tools.schema`.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import replace
from itertools import product
from pathlib import Path
from tempfile import TemporaryFile
from typing import Annotated, Self, get_args, get_origin

from pydantic import BeforeValidator, ValidationError, create_model, model_validator

from fiberweb import studies
from fiberweb.errors import brief, location, on_one_line, sentence
from fiberweb.folders import folder, missing_disk
from fiberweb.layers import is_number, overlay, read
from fiberweb.model.scene import Scene
from fiberweb.recorded import RecordingSection
from fiberweb.sections import (
    ExperimentSection,
    NumericsSection,
    SceneSection,
    ScoringSection,
    Section,
    SetupSection,
    SetupsSection,
    is_section,
    key,
)
from fiberweb.studies.base import CHOICES, ForceMap, Lab

ROOM = 65536  # bytes without which a disk is full: the notes and logs of a call
Folder = Annotated[str, BeforeValidator(lambda value, info: folder(value, info.field_name))]


class General(Section):
    """What is not of one study alone."""

    results: Folder = key("results", "folder that everything is written to", min_length=1)
    published_tables: Folder | None = key(
        None, "folder of the authors' own tables; without it the G claims are not computed"
    )
    published_all: bool = key(
        False, "every run of the authors in the published setup, not only what two cores afford"
    )
    certify: bool = key(
        False,
        "run each network of Fig. 1 again with step, mesh, engine, start and the authors' numerics "
        "changed one at a time, to mark what is not physics; takes up to six times as long",
    )
    scene: SceneSection = SceneSection()
    setups: SetupsSection = SetupsSection()
    numerics: NumericsSection = NumericsSection()
    scoring: ScoringSection = ScoringSection()
    experiment: ExperimentSection = ExperimentSection()
    recordings: list[RecordingSection] = key(
        [], "files or folders of recordings: the target recordings"
    )

    @model_validator(mode="after")
    def _studies_agree(self) -> Self:
        here = lab(self, "described")
        for name in studies.STUDIES:
            if check := getattr(studies.load(name), "check", None):
                check(getattr(self, name), here)
        here.check_duration("scene.duration", self.scene.duration)
        return self


for _name in ("ridge", "buckling", "accuracy"):  # the workflow has rules of their own for these
    if _name not in studies.STUDIES:
        raise ValueError(
            f"STUDIES in fiberweb/studies/__init__.py lacks {_name!r}, which the workflow needs"
        )
_SECTIONS = {name: studies.load(name).SECTION for name in studies.STUDIES}
Config = create_model(
    "Config",
    __base__=General,
    __doc__="The whole config: what is general, and a section of each study.",
    **{name: (section, section()) for name, section in _SECTIONS.items()},
)


def lab(config: Config, setup: str, best: Mapping | None = None) -> Lab:
    """What a study is given beside its own section.

    Args:
        config: the whole config.
        setup: one of `fiberweb.model.scene.SETUPS`.
        best: (choice, spacing in m) to force (N), as the ridge's table of best forces holds them;
            None while it is not made.
    """
    overrides = getattr(config.setups, setup).model_dump()
    defaults = config.scene.model_dump() | overrides
    ridge = config.ridge
    no_map = ForceMap(ridge.n, tuple(ridge.spacing), {})
    empty = Lab(setup, defaults, no_map, True, config.experiment)
    forces = {}
    for choice, spacing in product(CHOICES, ridge.spacing):
        if best is None:
            critical = empty.critical_force(spacing)
            forces[choice, spacing] = [force for force in ridge.force if force < critical]
            continue
        for (chosen, at), force in best.items():
            if chosen == choice and math.isclose(at, spacing, rel_tol=1e-9):
                # the config's own number: a table keeps ten digits, the name of a run all
                forces[choice, spacing] = [min(ridge.force, key=lambda f, to=force: abs(f - to))]
    force_map = ForceMap(ridge.n, tuple(ridge.spacing), forces)
    return replace(empty, map=force_map, thinned=not config.published_all)


def load(*layers: Mapping | str | Path) -> Config:
    """The config made of mappings or YAML files, each laid over the ones before it.

    Raises:
        ValueError: one sentence with the key, its value and what would be right.
    """
    values: dict = {}
    for layer in layers:
        values = overlay(values, layer if isinstance(layer, Mapping) else read(layer))
    try:
        return Config.model_validate(values)
    except ValidationError as error:
        raise ValueError(on_one_line(_explain(error))) from None


def check_folders(config: Config) -> None:
    """Raise ValueError if results cannot be written or the authors' tables are not there."""
    results = Path(config.results)
    above = (results, *results.parents)
    if link := next((path for path in above if path.is_symlink() and not path.exists()), None):
        raise ValueError(
            f"results = {config.results!r} cannot be written (the link {link} leads nowhere): name "
            "a folder that can, or make what it leads to"
        )
    try:
        there = next(path for path in above if path.exists())
        if disk := missing_disk(results):
            raise ValueError(
                f"results = {config.results!r} is on a disk that is not mounted: mount {disk}, or "
                "name a folder elsewhere"
            )
        with TemporaryFile(dir=there) as file:
            file.write(bytes(ROOM))
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


def _explain(error: ValidationError) -> str:
    """The first problem as one sentence, with the meaning and unit of the key."""
    problem = error.errors()[0]
    if problem["type"] == "value_error":
        return str(problem["ctx"]["error"])
    if problem["type"] == "invalid_key":  # YAML reads on, off, yes and no as truth values
        within = "".join(f"{part}." for part in problem["loc"][:-1])
        return f"unknown key {within}{brief(problem['input'])}: a key is a word, so quote it"
    path = [part for part in location(problem) if isinstance(part, str)]
    if problem["type"] == "missing":
        name = sentence(error).partition(" = ")[0]
        return f"{name} has to be given: {_look_up(path)[1].description}"
    if problem["type"] == "extra_forbidden":
        unknown = sentence(error, known=_look_up(path[:-1])[0].model_fields)
        return unknown + _spelling(path) + _elsewhere(path)
    section, field = _look_up(path)
    if section is not None:
        keys = ", ".join(section.model_fields)
        name, first = ".".join(path), next(iter(section.model_fields))
        if _listed(path):
            return (
                f"{name} = {brief(problem['input'])}: give a list of groups of keys, each of {keys}"
            )
        return (
            f"{name} = {brief(problem['input'])}: this is a group of keys ({keys}), given as "
            f"{_nested([*path, first])}"
        )
    text = sentence(error)
    if problem["type"] != "literal_error":  # its message says all
        about = [field.description, field.json_schema_extra["unit"]]
        text += f" ({'; '.join(filter(None, about))})"
    if isinstance(problem["input"], str) and is_number(problem["input"]):
        text += "; write numbers without quotes, and exponents as in 1.0e+8"
    return text


def _look_up(path: list[str]):
    """(Section, None) or (None, field) that a path of keys leads to."""
    section, field = Config, None
    for name in path:
        field = section.model_fields[name]
        section = field.annotation
        if get_origin(section) is list and is_section(get_args(section)[0]):
            section = get_args(section)[0]
    return (section, None) if is_section(section) else (None, field)


def _listed(path: list[str]) -> bool:
    """Whether a path of keys leads into a list of groups of keys."""
    section = Config
    for name in path:
        section = section.model_fields[name].annotation
        if get_origin(section) is list:
            return True
    return False


def _spelling(path: list[str]) -> str:
    """What to say of an unknown key that joins names of several, or a name and a value."""
    *above, last = path
    if ":" in last and above:
        return f"; put a blank after the colon, {last.replace(':', ': ', 1)}"
    names = [name for name in re.split(r"[.:]", last) if name]
    return f"; a key in a group is given as {_nested([*above, *names])}" if names[1:] else ""


def _elsewhere(path: list[str]) -> str:
    """What to say of an unknown key of the scene or a setup that is a field of every `Scene`."""
    group, name = path[0], path[-1]
    if group not in ("scene", "setups") or name not in Scene.__dataclass_fields__:
        return ""
    if name in SceneSection.model_fields:
        return f"; it is given as {_nested(['scene', name])}"
    if name in SetupSection.model_fields:
        return f"; it is given as {_nested(['setups', 'described', name])}"
    return f"; studies see to it, and the library takes it, Scene({name}=...)"


def _nested(path: list[str]) -> str:
    """How a key of a group is written, in a file and on the command line."""
    value = "..."
    for name in reversed(path[1:]):
        value = f"{{{name}: {value}}}"
    return f"{path[0]}: {value} in a file and --config '{path[0]}={value}' on the command line"
