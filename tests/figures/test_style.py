"""Files of a figure are named after its path; colours can be told apart."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

from fiberweb.figures import style

ROOT = Path(__file__).parents[2]


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


HOSTILE = """
text.usetex: True
font.size: 30
lines.linewidth: 9
axes.grid: True
axes.prop_cycle: cycler('color', ['lime'])
path.simplify: False
savefig.bbox: tight
savefig.transparent: True
pdf.compression: 0
"""
DRAW = """
import sys
import matplotlib
from fiberweb.figures import style
before = dict(matplotlib.rcParams)
with style.applied():
    figure = style.figure(60.0, 40.0)
    axes = figure.subplots()
    axes.plot([1, 2], label="$x$")
    axes.legend()
    style.save(figure, sys.argv[1])
assert dict(matplotlib.rcParams) == before
"""


def test_a_matplotlibrc_changes_no_figure_and_is_left_as_it_was(tmp_path):
    (tmp_path / "matplotlibrc").write_text(HOSTILE)
    drawn = {}
    for name, folder in {"plain": "", "hostile": str(tmp_path / "matplotlibrc")}.items():
        environment = os.environ | {"PYTHONPATH": str(ROOT), "MATPLOTLIBRC": folder}
        subprocess.run(
            [sys.executable, "-c", DRAW, tmp_path / name], env=environment, check=True, cwd=tmp_path
        )
        drawn[name] = [(tmp_path / f"{name}.{end}").read_bytes() for end in ("png", "pdf")]
    assert drawn["plain"] == drawn["hostile"]
