"""What tests of several folders share."""

import pytest

from fiberweb.figures import style


@pytest.fixture
def unsaved(monkeypatch):
    """Figures are made and not written, which is most of the work."""
    monkeypatch.setattr(style, "save", lambda figure, path: None)
