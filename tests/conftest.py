"""What tests of several folders share."""

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
    """Of two processes, one runs all tests of a file, and one all of the workflow, so that what
    they share is made once. pytest-xdist 3.8 has groups for it, which pytest 9.2 does not heed."""
    from xdist.scheduler import LoadScopeScheduling

    class Together(LoadScopeScheduling):
        def _split_scope(self, nodeid):
            return WORKFLOW if nodeid.startswith(WORKFLOW) else nodeid.split("::")[0]

    return Together(config, log)
