"""The studies, one folder each; `fiberweb.studies.base` says what is in it."""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

STUDIES = (
    "topology",
    "ridge",
    "size",
    "pretension",
    "features",
    "memory_origin",
    "calibration",
    "noise",
    "chaos",
    "robustness",
    "narma",
    "buckling",
    "accuracy",
)


def load(name: str) -> ModuleType:
    """The module of a study."""
    return import_module(f"fiberweb.studies.{name}")


def setups(name: str) -> tuple[str, ...]:
    """The setups that a study runs in."""
    return getattr(load(name), "SETUPS", ("described", "published"))


def claims() -> list[str]:
    """Names of the modules with rules of claims."""
    judged = [name for name in STUDIES if hasattr(load(name), "JUDGED_BY")]
    return [f"fiberweb.studies.{name}.claims" for name in judged]
