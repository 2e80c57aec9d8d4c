"""Networks of one's own, and their capacities."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fiberweb.figures import panels, plots, style
from fiberweb.model.network import web

ACROSS = 6  # networks side by side


@style.drawing
def draw(given: dict, setup: str, networks: Sequence[Mapping]) -> Figure:
    """Draw each network, and C_nl and C_m of all, as `fiberweb.figures` says.

    Args:
        given: "webs" (`tables.by_name`) and "webs_baselines" (`input_baselines`).
        networks: name, fibres, driven_fibre and driven_distance of each, in the order of the
            figure.
    """
    rows = plots.rows_of(given["webs"], "webs", setup).set_index("name")
    rows = rows.loc[[each["name"] for each in networks]]
    across = min(ACROSS, len(networks))
    down = -(-len(networks) // across)
    figure = style.figure(style.DOUBLE, 38.0 * down + 56.0)
    top, bottom = figure.subfigures(2, 1, height_ratios=[38.0 * down, 56.0])
    style.letter(top, "a", f"Networks ({setup} setup)")
    axes = top.subplots(down, across, squeeze=False).ravel()
    for ax, each in zip(axes, networks, strict=False):
        _schematic(ax, each)
    for ax in axes[len(networks) :]:
        ax.axis("off")
    for ax, name, letter in zip(bottom.subplots(1, 2), plots.TOTALS, "bc", strict=True):
        _capacity(ax, rows, given["webs_baselines"], name)
        panels.letter(ax, letter, panels.CAPACITIES[name])
    panels.key(bottom, plots.key(rows))
    return figure


def _schematic(ax: Axes, each: Mapping) -> None:
    drawn = web(each["fibres"], each["driven_fibre"], each["driven_distance"])
    panels.network(ax, drawn, style.GREY, (0.0, 1.0))
    ax.plot(*drawn.crossings.T, "o", ms=2.0, color=style.INK)
    ends = drawn.fibres.reshape(-1, 2)
    middle, half = 0.5 * (ends.min(axis=0) + ends.max(axis=0)), 0.52 * drawn.length
    ax.set(xlim=middle[0] + np.array([-half, half]), ylim=middle[1] + np.array([-half, half]))
    ax.set_title(style.verbatim(each["name"]))


def _capacity(ax: Axes, rows: pd.DataFrame, baselines: pd.DataFrame, name: str) -> None:
    """A capacity of each network, test part with its standard error."""
    rows = rows.assign(place=np.arange(len(rows)))
    plots.points(ax, rows, "place", name, marker="o", ms=4, ls="", color=style.INK, capsize=2.5)
    plots.mark_unstable(ax, rows, "place")
    ax.set_xticks(rows["place"], [style.verbatim(name) for name in rows.index])
    ax.set_xlim(-0.5, len(rows) - 0.5)
    plots.scale(ax, rows, baselines, name)
    plots.baselines(ax, baselines, name)
