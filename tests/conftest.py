"""What tests of several folders share."""

import os
from functools import cache
from pathlib import Path

# tests run side by side, and more threads than cores wait for one another
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest

from fiberweb.figures import style

WORKFLOW = "tests/workflow/"


@pytest.fixture
def unsaved(monkeypatch):
    """Figures are made and not written, which is most of the work."""
    monkeypatch.setattr(style, "save", lambda figure, path: None)


def pytest_collection_modifyitems(items):
    """The workflow's tests come first, because they take longest."""
    items.sort(key=lambda item: not item.nodeid.startswith(WORKFLOW))


def pytest_xdist_make_scheduler(config, log):
    """Of two processes, one runs all tests of a file, and one all that look at the smoke run, so
    that what they share is made once. pytest-xdist 3.8 has groups for it, which pytest 9.2 does not
    heed."""
    from xdist.scheduler import LoadScopeScheduling

    @cache
    def text(file):
        return Path(config.rootpath, file).read_text()

    class Together(LoadScopeScheduling):
        def _split_scope(self, nodeid):
            file = nodeid.split("::")[0]
            return "smoke run" if "smoked" in text(file) else file

    return Together(config, log)
