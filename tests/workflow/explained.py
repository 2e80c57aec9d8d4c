"""What files hold, against what docs/data-dictionary.md says of them."""

import json
import re
from fnmatch import fnmatch

import pandas as pd
import xarray as xr

from fiberweb.scoring.tables import VERDICTS
from fiberweb.simulation.conventions import OF_FILES
from fiberweb.tools.dictionary import dictionary
from fiberweb.written import BESIDE

OPTIONAL = set(VERDICTS.values())  # columns that come with certificates


def compared(results):
    """The kinds of files that lie in a folder of results; each must hold what is said of it."""
    said = {file: made for made in dictionary() for file in made.files}
    found = set()
    for path in sorted(results.rglob("*.*")):
        name = path.relative_to(results).as_posix()
        if path.suffix not in (".csv", ".nc", ".json"):
            continue
        if name.endswith(BESIDE):
            assert path.with_name(path.name.removesuffix(BESIDE)).exists()
            name = f"tables/any/any{BESIDE}"
        (kind,) = [kind for kind in said if _is(name, kind)]
        found.add(kind)
        {".csv": _table, ".nc": _variables, ".json": _named}[path.suffix](path, said[kind])
    return found


def _is(name, kind):
    pattern = re.sub("<[a-z]+>", "*", kind)
    return fnmatch(name, pattern) and name.count("/") == kind.count("/")


def _table(path, made):
    columns = set(pd.read_csv(path, nrows=1).columns)
    meant = {name for name in made.meanings if not name.startswith("quantity = ")}
    assert columns <= meant and meant - columns <= OPTIONAL, path


def _variables(path, made):
    with xr.open_dataset(path) as data:
        assert set(data.variables) <= set(made.meanings), path
        assert set(data.attrs) - {*OF_FILES, "title"} <= set(made.attributes), path
        for name, variable in data.variables.items():
            assert variable.attrs["long_name"], (path, name)
            if variable.dtype.kind in "iuf":
                unit = made.meanings[name][1] if isinstance(made.meanings[name], tuple) else "1"
                assert variable.attrs["units"] in unit.split(" or "), (path, name)


def _named(path, made):
    """Every name in a file has a meaning, or is below one that has, and of whose parts none does:
    of a run, of a package."""
    content = json.loads(path.read_text(encoding="utf-8"))
    parents = [said for said in made.meanings if not _below(said, made.meanings)]
    for name in _names(content):
        meant = name in made.meanings or any(_below(parent, [name]) for parent in parents)
        assert meant, (path, name)


def _below(parent, names):
    return any(name.startswith((f"{parent}.", f"{parent}[")) for name in names)


def _names(content, at=""):
    if isinstance(content, dict):
        for name, value in content.items():
            yield from _names(value, f"{at}.{name}" if at else name)
    elif isinstance(content, list):
        for value in content:
            yield from _names(value, f"{at}[]")
    else:
        yield at
