"""What files hold, against what docs/data-dictionary.md says of them."""

import json
import re
from fnmatch import fnmatch

import pandas as pd
import xarray as xr

from fiberweb.scoring.tables import VERDICTS
from fiberweb.simulation.conventions import OF_FILES
from fiberweb.tools.dictionary import dictionary

# of the calls, and of what tables rest on: docs/provenance.md
ABOUT_CALLS = re.compile(r"^(provenance|progress)\.json$|-metadata\.json$")
OPTIONAL = set(VERDICTS.values())  # columns that come with certificates


def compared(results):
    """The kinds of files that lie in a folder of results; each must hold what is said of it."""
    said = {file: made for made in dictionary() for file in made.files}
    found = set()
    for path in sorted(results.rglob("*.*")):
        name = path.relative_to(results).as_posix()
        if path.suffix not in (".csv", ".nc", ".json") or ABOUT_CALLS.search(name):
            continue
        (kind,) = [kind for kind in said if _is(name, kind)]
        found.add(kind)
        {".csv": _table, ".nc": _variables, ".json": _card}[path.suffix](path, said[kind])
    return found


def _is(name, kind):
    pattern = kind.replace("<run>", "*").replace("<name>", "*").replace("<setup>", "*")
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


def _card(path, made):
    card = json.loads(path.read_text(encoding="utf-8"))
    names = {*card, *(f"facts.{name}" for name in card["facts"])}
    names |= {f"profile[].{name}" for row in card["profile"] for name in row}
    assert names <= set(made.meanings), path
