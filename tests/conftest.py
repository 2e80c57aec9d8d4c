"""What tests of several folders share."""

import pytest

from fiberweb.figures import style


@pytest.fixture
def unsaved(monkeypatch):
    """Figures are made and not written, which is most of the work."""
    monkeypatch.setattr(style, "save", lambda figure, path: None)


@pytest.hookimpl(tryfirst=True)  # pytest-xdist reads the groups in the same hook
def pytest_collection_modifyitems(items):
    """For pytest-xdist: tests of a file run in one process, which makes what they share once; so do
    all of the copied tree, which come first because they take longest."""
    for item in items:
        group = "tree" if "tree" in item.fixturenames else item.path.as_posix()
        item.add_marker(pytest.mark.xdist_group(group))
    items.sort(key=lambda item: "tree" not in item.fixturenames)
