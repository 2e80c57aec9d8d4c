"""What a rule depends on is what its function really imports."""

import subprocess
import sys
from functools import cache
from pathlib import Path

import pytest

from fiberweb import source, studies

CALLED = sorted({
    *(spec.make for name in studies.STUDIES for spec in studies.load(name).TABLES.values()),
    *(spec.draw for name in studies.STUDIES for spec in studies.load(name).FIGURES.values()),
    *studies.claims(),
    source.RUN,
    "fiberweb.scoring.capacity",
    "fiberweb.products",
})  # fmt: skip
LOADED = """
import sys
from importlib import import_module
import_module(sys.argv[1])
print(*(m.__file__ for name, m in sys.modules.items() if name.split(".")[0] == "fiberweb"))
"""


@cache
def loaded(name):
    """Files of the package that importing a module loads."""
    command = [sys.executable, "-c", LOADED, name]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return {Path(file) for file in done.stdout.split()}


def names(*roots):
    return {str(path.relative_to(source.ROOT)) for path in source.files(*roots)}


@pytest.mark.parametrize("called", CALLED)
def test_all_that_is_imported_is_found(called):
    module = called.partition(":")[0]
    # what the packages around it load on the way is no part of what was asked for
    of_module = loaded(module) - loaded(module.rpartition(".")[0])
    assert {file for file in of_module if file.name != "__init__.py"} <= source.files(called)


def test_a_response_depends_on_every_engine_and_on_the_model():
    assert {
        "engines/kirchhoff.py", "engines/cosserat.py", "engines/elastica.py", "model/buckling.py",
        "model/authors.py", "simulation/response.py",
    } <= names(source.RUN)  # fmt: skip
    assert not any(name.startswith(("scoring", "studies", "figures")) for name in names(source.RUN))


def test_a_score_depends_on_no_engine():
    found = names("fiberweb.scoring.capacity")
    assert "scoring/regression.py" in found
    assert not any(name.startswith(("engines", "simulation", "studies")) for name in found)


def test_files_that_a_module_reads_count():
    assert "claims/claims.yaml" in names("fiberweb.claims.judge")


def test_reading_a_table_does_not_depend_on_making_it():
    assert names("fiberweb.tables") == {"tables.py"}
    for name in studies.STUDIES:
        for spec in studies.load(name).FIGURES.values():
            made_by = {file for file in names(spec.draw) if file.startswith("scoring/tables")}
            assert not made_by, spec.draw


def test_an_unknown_module_is_named():
    with pytest.raises(ValueError, match=r"fiberweb\.nothing:call names no module"):
        source.digest("fiberweb.nothing:call")
