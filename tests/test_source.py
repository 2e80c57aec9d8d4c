"""What a rule depends on is what its function really imports."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from fiberweb import source, studies
from fiberweb.studies import accuracy

CALLED = sorted({
    *(spec.make for name in studies.STUDIES for spec in studies.load(name).TABLES.values()),
    *(spec.draw for name in studies.STUDIES for spec in studies.load(name).FIGURES.values()),
    *(spec.make for job in accuracy.JOBS.values() for spec in job.values()),
    *studies.claims(),
    source.RUN,
    "fiberweb.scoring.capacity",
    "fiberweb.products",
})  # fmt: skip
# prints what of the package each module loads beyond what the packages around it load on the way
LOADED = """
import json, sys
from importlib import import_module

def loaded(name):
    for module in [m for m in sys.modules if m.split(".")[0] == "fiberweb"]:
        del sys.modules[module]
    import_module(name)
    return {m.__file__ for n, m in sys.modules.items() if n.split(".")[0] == "fiberweb"}

asked = sys.argv[1:]
print(json.dumps({n: sorted(loaded(n) - loaded(n.rpartition(".")[0])) for n in asked}))
"""


def names(*roots):
    return {str(path.relative_to(source.ROOT)) for path in source.files(*roots)}


def test_all_that_is_imported_is_found():
    modules = sorted({called.partition(":")[0] for called in CALLED})
    command = [sys.executable, "-c", LOADED, *modules]
    done = subprocess.run(
        command, capture_output=True, text=True, check=True, cwd=source.ROOT.parent
    )
    for module, loaded in json.loads(done.stdout).items():
        used = {Path(file) for file in loaded if not file.endswith("__init__.py")}
        assert used <= source.files(module), module


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
