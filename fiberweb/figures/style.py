"""How every figure looks: a journal column, colour-blind-safe maps, the same bytes every time.

Figures are `matplotlib.figure.Figure` objects made without pyplot: they need no display, write
through the Agg backend, and nothing outside `applied` changes matplotlib's global state, nor does
the user's matplotlibrc change a figure.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from pathlib import Path

import matplotlib as mpl
import numpy as np
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure, FigureBase

# DejaVu carries an old creation date; fontTools warns of it in every job that writes a PDF.
logging.getLogger("fontTools.ttLib.tables._h_e_a_d").setLevel(logging.ERROR)

SINGLE, DOUBLE = 88.0, 180.0  # column widths, mm
MM = 1 / 25.4  # inch
RESOLUTION = 300  # dpi

INK, GREY, FAINT = "#1a1a1a", "#6e6e6e", "#bdbdbd"
DRIVE = "#c8442c"  # the driven point, and nothing else
SEQUENTIAL = cm.batlow  # magnitudes
DIVERGING = cm.vik  # signed differences
UNSTABLE = {"marker": "X", "color": "#b2182b", "markersize": 5.5, "mew": 0.3, "linestyle": "none"}

RC = {
    "font.family": "DejaVu Sans",
    "font.size": 7,
    "axes.titlesize": 7,
    "axes.labelsize": 7,
    "xtick.labelsize": 6.5,
    "ytick.labelsize": 6.5,
    "legend.fontsize": 6.5,
    "figure.titlesize": 8,
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.edgecolor": INK,
    "axes.labelcolor": INK,
    "axes.labelpad": 2.0,
    "axes.titlepad": 3.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.major.size": 2.5,
    "ytick.major.size": 2.5,
    "xtick.color": INK,
    "ytick.color": INK,
    "text.color": INK,
    "lines.linewidth": 1.0,
    "lines.markersize": 3.5,
    "legend.frameon": False,
    "legend.handlelength": 1.6,
    "legend.borderaxespad": 0.2,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "pdf.fonttype": 42,  # text stays text in the PDF
}


@contextmanager
def applied() -> Iterator[None]:
    """Context in which a figure is made and saved: matplotlib's own defaults and this style on
    top, whatever a matplotlibrc says."""
    with mpl.rc_context():
        mpl.rcdefaults()
        mpl.rcParams.update(RC)
        yield


def drawing(draw: Callable[..., Figure]) -> Callable[..., Figure]:
    """Makes a function that draws what it is given of a setup into one that is called with a path
    as well: it runs in `applied`, and the figure that it returns is written, see `save`."""

    @wraps(draw)
    def drawn(given: dict, setup: str, path: str | Path, **options) -> Figure:
        with applied():
            figure = draw(given, setup, **options)
            save(figure, path)
        return figure

    return drawn


def figure(width: float, height: float) -> Figure:
    """An empty figure with constrained layout; width and height in mm."""
    empty = Figure(figsize=(width * MM, height * MM), layout="constrained")
    FigureCanvasAgg(empty)
    empty.get_layout_engine().set(w_pad=2 * MM, h_pad=1 * MM, wspace=0.03, hspace=0.03)
    return empty


def colours(count: int) -> np.ndarray:
    """Distinct colours in the order of a magnitude, dark to light, shape (count, 4).

    The map ends at its orange: the salmon and pink after it do not show on white as thin lines.
    """
    return SEQUENTIAL(np.linspace(0.0, 0.72, count) if count > 1 else np.zeros(1))


def lettered(name: str, title: str) -> str:
    """A title with its panel letter before it."""
    return rf"$\mathbf{{{name}}}$   {title}"


def verbatim(text: str) -> str:
    """Text of a user's as it stands: matplotlib takes what is between two dollars for a formula."""
    return text.replace("$", r"\$")


def letter(part: FigureBase, name: str, title: str) -> None:
    """Panel letter and title at the upper left of a figure or subfigure."""
    part.suptitle(lettered(name, title), x=0.005, ha="left", fontsize=RC["figure.titlesize"])


def mark_unstable(ax: Axes, places: Sequence[float]) -> None:
    """An X just above the axis at each x where a run was unstable and has no value."""
    if len(places):
        ax.plot(
            places, [0.04] * len(places), transform=ax.get_xaxis_transform(), zorder=5,
            gid="unstable", **UNSTABLE,
        )  # fmt: skip


def save(drawn: Figure, path: str | Path) -> tuple[Path, Path]:
    """Write the figure as PNG (300 dpi) and as PDF, with the same bytes for the same figure.

    Args:
        drawn: from `figure`.
        path: with or without .png or .pdf; folders are made.

    Returns:
        Paths of the PNG and of the PDF.
    """
    path = Path(path)
    stem = path.stem if path.suffix in (".png", ".pdf") else path.name  # "s100.0mm" has a dot
    path.parent.mkdir(parents=True, exist_ok=True)
    png, pdf = path.with_name(f"{stem}.png"), path.with_name(f"{stem}.pdf")
    drawn.savefig(png, dpi=RESOLUTION)
    drawn.set_layout_engine("none")  # to look for what was found takes as long as to draw
    drawn.savefig(pdf, metadata={"CreationDate": None})
    return png, pdf
