"""Parts that several figures have in common: colours of networks, panel letters, keys."""

from __future__ import annotations

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import FigureBase
from matplotlib.legend import Legend
from matplotlib.lines import Line2D

from fiberweb.figures import plots, style
from fiberweb.model.network import Network

ROW = 6  # entries of a key that fit side by side
CAPACITIES = {"c_nl": "Nonlinear capacity", "c_m": "Memory capacity"}

DRIVEN = r"$\updownarrow$"  # marker
TARGET = {"color": "black", "lw": 0.7, "ls": "--"}
# light and thick, to show under the dashes of the target
PREDICTION = {"color": style.SEQUENTIAL(0.6), "lw": 1.6}


def letter(ax: Axes, name: str, title: str, pad: float = 3.0) -> None:
    """Panel letter and title above the left end of an axes, `pad` points away."""
    size = style.RC["figure.titlesize"]
    ax.set_title(style.lettered(name, title), loc="left", pad=pad, fontsize=size)


def network(ax: Axes, drawn: Network, colour: str, limits: tuple[float, float]) -> None:
    """The fibres of a network, and an arrow at its driven point; limits of both axes."""
    ax.add_collection(LineCollection(drawn.fibres, colors=colour, linewidths=0.5))
    near, far = drawn.fibres[drawn.driven_fibre]
    driven = near + (far - near) * drawn.driven_distance / np.linalg.norm(far - near)
    ax.plot(*driven, marker=DRIVEN, ms=8, color=style.DRIVE, zorder=3)
    ax.set(aspect="equal", xlim=limits, ylim=limits)
    ax.axis("off")


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
    alone = {plots.INPUT_ALONE: Line2D([], [], **plots.BASELINE_LINE)}
    return alone | plots.unstable_key(unstable)
