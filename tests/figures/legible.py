"""What a figure says and marks, and whether its words can be read."""

import itertools

import pandas as pd
import pytest
from matplotlib.text import Text

from fiberweb.figures import style

BASELINES = pd.DataFrame(
    {
        "readout": ["u", "derivatives", "powers"],
        "c_nl": [0.14, 0.14, 0.41],
        "c_m": [0.09, 0.28, 0.09],
    }
)


def said(figure):
    """Every text that is drawn, one after the other."""
    return " ".join(text.get_text() for text in figure.findobj(Text) if text.get_visible())


def marked(artist, gid="unstable"):
    """What is drawn inside it with this id, the X's of unstable runs unless told otherwise."""
    return artist.findobj(lambda one: one.get_gid() == gid)


def assert_written(path, width=style.DOUBLE):
    """PNG and PDF are there, and as wide as a figure in the paper (mm) at 300 dpi."""
    header = path.with_suffix(".png").read_bytes()[:24]
    assert header[:8] == b"\x89PNG\r\n\x1a\n"
    assert int.from_bytes(header[16:20]) == pytest.approx(width / 25.4 * 300, abs=1)
    assert path.with_suffix(".pdf").read_bytes().startswith(b"%PDF")


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
