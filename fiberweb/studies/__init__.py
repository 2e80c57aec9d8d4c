"""The studies, one folder each; `fiberweb.studies.base` says what is in it."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from types import ModuleType

from fiberweb.model.scene import SETUPS

STUDIES = (
    "topology",
    "ridge",
    "size",
    "pretension",
    "features",
    "spectrum",
    "capacity_origin",
    "memory_origin",
    "calibration",
    "noise",
    "chaos",
    "robustness",
    "twin",
    "narma",
    "webs",
    "buckling",
    "accuracy",
)


def load(name: str) -> ModuleType:
    """The module of a study.

    Raises:
        ValueError: it has no folder.
    """
    module = f"fiberweb.studies.{name}"
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            raise
        raise ValueError(
            f"STUDIES in fiberweb/studies/__init__.py lists {name!r}, but there is no folder "
            f"fiberweb/studies/{name}"
        ) from None


def setups(name: str) -> tuple[str, ...]:
    """The setups that a study runs in."""
    return getattr(load(name), "SETUPS", tuple(SETUPS))


def waits(name: str, setup: str) -> bool:
    """Whether the runs of a study start from the best forces of the ridge."""
    return setup != "published" and getattr(load(name), "AFTER_RIDGE", False)


def judged_by(setup: str) -> list[str]:
    """The tables that the rules of the claims read, of the studies that a setup runs."""
    taking_part = [load(name) for name in STUDIES if setup in setups(name)]
    return [file for study in taking_part for file in getattr(study, "JUDGED_BY", ())]


def makers(kind: str) -> dict[str, str]:
    """Which study makes each of the "TABLES" or "FIGURES".

    Raises:
        ValueError: two studies make files of one name.
    """
    by_name: dict[str, str] = {}
    for study in STUDIES:
        for name in getattr(load(study), kind):
            if name in by_name:
                raise ValueError(f"{name} is made by two studies, {by_name[name]} and {study}")
            by_name[name] = study
    return by_name


def claims() -> list[str]:
    """Names of the modules with rules of claims."""
    judged = [name for name in STUDIES if hasattr(load(name), "JUDGED_BY")]
    return [f"fiberweb.studies.{name}.claims" for name in judged]


def caption(figure: str, setup: str) -> str:
    """What the report says beneath a figure, by its name."""
    study = load(makers("FIGURES")[figure])
    text = Path(study.__file__).with_name(study.FIGURES[figure].caption).read_text("utf-8")
    return text.replace("{{ setup }}", setup)
