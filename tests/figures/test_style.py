"""Files of a figure are named after its path; colours can be told apart."""

import numpy as np

from fiberweb.figures import style


def test_a_dot_in_the_name_is_not_a_suffix(tmp_path):
    png, pdf = style.save(style.figure(style.SINGLE, 20), tmp_path / "new" / "s100.0mm")
    assert (png.name, pdf.name) == ("s100.0mm.png", "s100.0mm.pdf")
    assert png.exists() and pdf.exists()


def test_colours_are_distinct_and_dark_enough_to_show():
    colours = style.colours(6)
    assert len(np.unique(colours, axis=0)) == 6
    assert style.colours(1).shape == (1, 4)
    luminance = colours[:, :3] @ [0.2126, 0.7152, 0.0722]
    assert luminance.max() < 0.8
