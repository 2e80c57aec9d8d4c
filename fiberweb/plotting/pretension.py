"""Fig. 3: capacities over pretension, at the best force for memory of each spacing.

Drawing only: every number comes from the tables.
"""

from __future__ import annotations

from pathlib import Path

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fiberweb.plotting import style, sweep

PAPERS_LEAST = 0.01  # N


def draw(tables: dict[str, pd.DataFrame], setup: str, path: str | Path) -> Figure:
    """Draw the pretension study of one setup and write it as PNG and PDF.

    Args:
        tables: "pretension" (`tables.study`) and "ridge_floors" (`tables.floors`). An unstable
            run is an X.
        setup: "described" or "published"; rows of the other one are left out.
        path: of the figure; both suffixes are written beside each other.

    Returns:
        The figure.

    Raises:
        ValueError: the table has no run of this setup.
    """
    rows = sweep.rows_of(tables["pretension"], "pretension", setup)
    floors = tables["ridge_floors"]
    colour = sweep.colours(rows["spacing_m"])
    with style.applied():
        figure = style.figure(style.DOUBLE, 66.0)
        axes = figure.subplots(1, 2)
        for ax, letter, name in zip(axes, "ab", sweep.TOTALS):
            sweep.lines(ax, rows, "tension_N", name, colour)
            ax.set_ylim(0.0, sweep.top(rows, floors, name))
            ax.set(xlabel="Pretension $F_t$ (N)", ylabel=sweep.TOTALS[name])
            _tensions(ax, rows["tension_N"])
            sweep.floors(ax, floors, name)
            sweep.typical_error(ax, rows, name)
            title = f"{sweep.TOTALS[name]} over pretension ({setup} setup)"
            ax.set_title(rf"$\mathbf{{{letter}}}$   {title}", loc="left")
        sweep.spacing_bar(figure, axes, colour)
        handles = sweep.key(rows)
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
        style.save(figure, path)
    return figure


def _tensions(ax: Axes, tensions: pd.Series) -> None:
    """A log scale that a tension of zero, which a study may have, does not break."""
    if (tensions > 0).all():
        ax.set_xscale("log")
        sweep.logarithmic(ax.xaxis)
    else:
        ax.set_xscale("symlog", linthresh=PAPERS_LEAST)
