"""What the workflow reads and writes between its rules, by suffix, and what it calls by name."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from pathlib import Path


def function(name: str) -> Callable:
    """The function of "module:function"."""
    module, _, leaf = name.partition(":")
    return getattr(import_module(module), leaf)


def read(path: str | Path):
    """A table (.csv) as DataFrame, a dataset (.nc) as Dataset."""
    return _format(path)[0](path)


def write(product, path: str | Path) -> None:
    """Write what `read` reads."""
    _format(path)[1](product, path)


def _format(path: str | Path) -> tuple[Callable, Callable]:
    # imported when needed: most jobs need one of the two, and each takes a third of a second
    if Path(path).suffix == ".nc":
        from fiberweb.simulation import dataset

        return dataset.load, dataset.save
    from fiberweb import tables

    return tables.read, tables.write
