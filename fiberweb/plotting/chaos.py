"""Twin runs about buckling: how they part, and what that does to capacities.

Drawing only: every number comes from the tables.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fiberweb.plotting import style, sweep

SHOWN = 6  # pairs whose separation is drawn
KILO = 1e3  # m to mm


def draw(tables: dict[str, pd.DataFrame], setup: str, path: str | Path) -> Figure:
    """Draw separation over time, and rate, consistency and capacities over B, for one setup.

    Args:
        tables: "chaos_rates" (`chaos.rates`), "chaos_separations" (`chaos.separations`) and
            "chaos_floors" (`tables.floors`).
        setup: "described" or "published".
        path: of the figure; PNG and PDF are written beside each other.

    Returns:
        The figure.

    Raises:
        ValueError: the table of rates has no run of this setup.
    """
    rows = sweep.rows_of(tables["chaos_rates"], "chaos_rates", setup).sort_values("buckling_number")
    apart = tables["chaos_separations"]
    apart = apart[apart["setup"] == setup]
    floors = tables["chaos_floors"]
    with style.applied():
        figure = style.figure(style.DOUBLE, 120.0)
        top, bottom = figure.subfigures(2, 1, height_ratios=[58, 62])
        style.letter(top, "a", "Separation of twin runs, rms over readouts")
        _separations(top.subplots(), apart, _shown(rows["buckling_number"]))
        parts = bottom.subfigures(1, 3, width_ratios=[1, 1, 1.12])
        titles = ("Growth of a small separation", "Twins over the last half", "Capacities")
        panels = (_rate, _consistency, lambda ax, rows: _capacities(ax, rows, floors))
        for part, letter, title, panel in zip(parts, "bcd", titles, panels, strict=True):
            style.letter(part, letter, title)
            ax = part.subplots()
            _over_buckling(ax, rows)
            panel(ax, rows)
            _unstable(ax, rows)
        style.save(figure, path)
    return figure


def _shown(buckling: pd.Series) -> list[float]:
    """Some of the buckling numbers, evenly over the list, the first and the last among them."""
    listed = sorted(buckling.unique())
    picked = np.linspace(0, len(listed) - 1, min(SHOWN, len(listed))).round().astype(int)
    return [listed[at] for at in picked]


def _separations(ax: Axes, apart: pd.DataFrame, shown: list[float]) -> None:
    for number, colour in zip(shown, style.colours(len(shown)), strict=True):
        rows = apart[apart["buckling_number"] == number]
        ax.plot(rows["time_s"], rows["separation_m"], color=colour, lw=0.7, label=f"{number:.3g}")
    ax.set(yscale="log", xlabel="Time (s)", ylabel="Separation (m)")
    ax.margins(x=0.01)
    ax.legend(
        title="Buckling\nnumber B", loc="center left", bbox_to_anchor=(1.0, 0.5), reverse=True
    )


def _over_buckling(ax: Axes, rows: pd.DataFrame) -> None:
    """A log axis of B with its buckling at 1."""
    ax.set(xscale="log", xlabel="Buckling number B")
    ticks = [0.2, 0.5, 1, 2, 5]
    ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.minorticks_off()
    numbers = rows["buckling_number"]
    ax.set_xlim(0.85 * numbers.min(), 1.15 * numbers.max())
    ax.axvline(1.0, color=style.FAINT, lw=0.8, zorder=0)


def _rate(ax: Axes, rows: pd.DataFrame) -> None:
    ax.axhline(0.0, color=style.GREY, lw=0.6, zorder=0)
    ax.errorbar(
        rows["buckling_number"], rows["rate_per_s"], rows["rate_se"], color=style.INK, marker="o",
        ms=3, lw=0.8, elinewidth=0.7, capsize=1.5,
    )  # fmt: skip
    ax.set_ylabel("Rate (1/s)")


def _consistency(ax: Axes, rows: pd.DataFrame) -> None:
    for (name, marker), colour in zip(
        {"consistency": "o", "saturation": "s"}.items(), style.colours(3)[::2], strict=True
    ):
        ax.plot(
            rows["buckling_number"], rows[name], marker=marker, ms=3, lw=0.8, color=colour,
            label=name,
        )  # fmt: skip
    ax.set(ylim=(-0.03, 1.05), ylabel="Consistency, saturation")
    ax.legend(loc="center left")


def _capacities(ax: Axes, rows: pd.DataFrame, floors: pd.DataFrame) -> None:
    """Both totals, each with the best that readouts of the input alone score."""
    for (name, symbol), colour in zip(sweep.TOTALS.items(), style.colours(3)[::2], strict=True):
        ax.errorbar(
            rows["buckling_number"], rows[name], rows[f"{name}_se"], color=colour, marker="o",
            ms=3, lw=0.8, elinewidth=0.7, label=symbol,
        )  # fmt: skip
        floor = sweep.FLOOR_LINE | {"color": colour}
        ax.axhline(floors[name].max(), zorder=0, label=f"{symbol}, input alone", **floor)
    ax.set(ylim=(-0.03, 1.05), ylabel="Capacity")
    legend = ax.legend(loc="upper left", ncols=2, columnspacing=1.0, frameon=True)
    legend.get_frame().set(edgecolor="none", alpha=1.0)  # the line at B = 1 runs behind it


def _unstable(ax: Axes, rows: pd.DataFrame) -> None:
    bad = (rows[["status", "twin_status"]] == "unstable").any(axis=1)
    style.mark_unstable(ax, list(rows.loc[bad, "buckling_number"]))
