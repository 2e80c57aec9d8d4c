"""Whether the words of a figure can be read."""

import itertools

import pytest
from matplotlib.text import Text

from fiberweb.figures import style


def assert_legible(figure):
    """No text is under 6 points, beyond the figure's edge, or over another text."""
    boxes = {}

    def draw(text, renderer, original=Text.draw):
        if text.get_visible() and text.get_text().strip():
            boxes[text] = text.get_window_extent(renderer)
        original(text, renderer)

    with pytest.MonkeyPatch.context() as patch, style.applied():
        patch.setattr(Text, "draw", draw)  # only what is drawn: spare tick labels are not
        figure.canvas.draw()
    assert len(boxes) > 20
    for text, box in boxes.items():
        assert text.get_fontsize() >= 6, text
        assert figure.bbox.x0 <= box.x0 and box.x1 <= figure.bbox.x1, text
        assert figure.bbox.y0 <= box.y0 and box.y1 <= figure.bbox.y1, text
    for (a, box_a), (b, box_b) in itertools.combinations(boxes.items(), 2):
        assert not box_a.padded(-0.5).overlaps(box_b.padded(-0.5)), (a, b)
