"""What tests of several folders share."""

import os
from collections import Counter

# tests run side by side, and more threads than cores wait for one another
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import pytest

from fiberweb.figures import style

LONGEST = "tests/workflow/test_workflow.py", "tests/engines/", "tests/workflow/"


@pytest.fixture
def unsaved(monkeypatch):
    """Figures are made and not written, which is most of the work."""
    monkeypatch.setattr(style, "save", lambda figure, path: None)


def pytest_collection_modifyitems(items):
    """What takes longest comes first, file by file, so that processes end together; and beside the
    smoke run come engines, which need nothing of it."""
    slow = Counter(item.path for item in items if item.get_closest_marker("slow"))

    def rank(item):
        group = (i for i, start in enumerate(LONGEST) if item.nodeid.startswith(start))
        return next(group, len(LONGEST)), -slow[item.path]

    items.sort(key=rank)
