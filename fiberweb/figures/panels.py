"""Parts that several figures have in common: colours of networks, panel letters, keys."""

from __future__ import annotations

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import FigureBase
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

from fiberweb.figures import plots, style

ROW = 6  # entries of a key that fit side by side
CAPACITIES = {"c_nl": "Nonlinear capacity", "c_m": "Memory capacity"}

TARGET = {"color": "black", "lw": 0.7, "ls": "--"}
# light and thick, to show under the dashes of the target
PREDICTION = {"color": style.SEQUENTIAL(0.6), "lw": 1.6}


def letter(ax: Axes, name: str, title: str, pad: float = 3.0) -> None:
    """Panel letter and title above the left end of an axes, `pad` points away."""
    size = style.RC["figure.titlesize"]
    ax.set_title(rf"$\mathbf{{{name}}}$   {title}", loc="left", pad=pad, fontsize=size)


def key(part: FigureBase, handles: dict[str, Artist], **options) -> Legend:
    """Legend below the axes of a figure, by label, in one row, or in two if it is long."""
    columns = len(handles) if len(handles) <= ROW else -(-len(handles) // 2)
    given = {"loc": "outside lower center", "ncols": columns, "columnspacing": 1.2}
    return part.legend(handles.values(), handles.keys(), **given | options)


def key_beside_title(part: FigureBase, handles: dict[str, Artist]) -> None:
    """Legend on the line of the title, at its right end."""
    legend = key(
        part, handles, loc="upper right", bbox_to_anchor=(0.995, 1.0), ncols=len(handles),
        columnspacing=1.0, handlelength=1.3, handletextpad=0.6,
    )  # fmt: skip
    legend.set_in_layout(False)  # the title reserves the room


def baseline_and_unstable(unstable: bool) -> dict[str, Line2D]:
    """Legend entries of baselines, and of unstable runs if there are any."""
    handles = {plots.INPUT_ALONE: Line2D([], [], **plots.BASELINE_LINE)}
    if unstable:
        handles["unstable run"] = Line2D([], [], **style.UNSTABLE)
    return handles
