"""What tests of several folders share."""

import pytest

from fiberweb.figures import style


@pytest.fixture
def unsaved(monkeypatch):
    """Figures are made and not written, which is most of the work."""
    monkeypatch.setattr(style, "save", lambda figure, path: None)


def pytest_itemcollected(item):
    """For pytest-xdist: tests of a file run in one process, which makes what they share once; so do
    all of the copied tree."""
    group = "tree" if "tree" in item.fixturenames else item.path.as_posix()
    item.add_marker(pytest.mark.xdist_group(group))


def pytest_collection_modifyitems(items):
    """Those of the copied tree come first, because they take longest."""
    items.sort(key=lambda item: "tree" not in item.fixturenames)
