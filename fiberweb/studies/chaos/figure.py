"""Perturbed pairs around buckling: how they part, and what that does to capacities."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fiberweb.figures import panels, plots, style
from fiberweb.studies.chaos.round_off import ROUND_OFF

SHOWN = 6  # pairs whose separation is drawn
CONSISTENCY = {"marker": "o", "ms": 3, "lw": 0.8, "color": style.colours(2)[0]}
SATURATION = {"marker": "s", "ms": 3, "lw": 0.8, "color": style.colours(2)[1]}
BUCKLING = {"color": style.FAINT, "lw": 0.8}
# caps wider than the markers, or small bars would not show
POINTS = {"color": style.INK, "marker": "o", "ms": 2.4, "lw": 0.8, "elinewidth": 0.7, "capsize": 2}


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw separation over time, and rate, consistency and capacities over B, as
    `fiberweb.figures` says.

    Args:
        given: "chaos_rates" (`tables.rates`), "chaos_separations" (`tables.separations`) and
            "chaos_baselines" (`input_baselines`).
    """
    rows = plots.rows_of(given["chaos_rates"], "chaos_rates", setup).sort_values("buckling_number")
    apart = given["chaos_separations"]
    apart = apart[apart["setup"] == setup]
    bad = (rows[["status", "twin_status"]] == "unstable").any(axis=1)
    figure = style.figure(style.DOUBLE, 122.0)
    top, bottom = figure.subfigures(2, 1, height_ratios=[56, 66])
    style.letter(top, "a", f"Separation of perturbed pairs, rms over readouts ({setup} setup)")
    _separations(top.subplots(), apart, rows)
    axes = bottom.subplots(1, 4)
    titles = ("Growth rate", "Pairs, last half", *panels.CAPACITIES.values())
    for ax, letter, title in zip(axes, "bcde", titles, strict=True):
        panels.letter(ax, letter, title)
        _over_buckling(ax, rows)
    axes[0].axhline(0.0, color=style.GREY, lw=0.6, zorder=0)
    _points(axes[0], rows, "rate_per_s", "rate_se")
    axes[0].set_ylabel("Rate (1/s)")
    axes[1].plot(rows["buckling_number"], rows["consistency"], **CONSISTENCY)
    axes[1].plot(rows["buckling_number"], rows["saturation"], **SATURATION)
    axes[1].set(ylim=(-0.03, 1.03), ylabel="Consistency, saturation")
    for ax, (name, symbol) in zip(axes[2:], plots.TOTALS.items(), strict=True):
        _points(ax, rows, name, f"{name}_se")
        ax.set(ylim=(-0.03, 1.03), ylabel=symbol)
        plots.baselines(ax, given["chaos_baselines"], name)
    for ax in axes:
        style.mark_unstable(ax, list(rows.loc[bad, "buckling_number"]))
    panels.key(bottom, _handles(bad.any()), ncols=2, columnspacing=3.0)
    return figure


def _shown(buckling: pd.Series) -> list[float]:
    """Some of the buckling numbers, evenly over the list, the first and the last among them."""
    listed = sorted(buckling.unique())
    picked = np.linspace(0, len(listed) - 1, min(SHOWN, len(listed))).round().astype(int)
    return [listed[at] for at in picked]


def _separations(ax: Axes, apart: pd.DataFrame, rows: pd.DataFrame) -> None:
    """Separation of some pairs over time, and where it is but round-off."""
    for number, colour in plots.colours(_shown(rows["buckling_number"])).items():
        pair = apart[apart["buckling_number"] == number]
        ax.plot(pair["time_s"], pair["separation_m"], color=colour, lw=0.7, label=f"{number:.3g}")
    ax.set(yscale="log", xlabel="Time (s)", ylabel="Separation (m)")
    ax.margins(x=0.01)
    _round_off(ax, ROUND_OFF * (rows["spacing_m"] * (rows["n"] + 1)).max())
    legend = ax.legend(
        title=f"Buckling\nnumber {plots.BUCKLING}", loc="upper left", bbox_to_anchor=(1.0, 1.0)
    )
    legend.set(alignment="left")


def _round_off(ax: Axes, level: float) -> None:
    """A band from the foot of the axes up to a level (m), with its name beside it."""
    foot = min(ax.get_ylim()[0], level / 100)  # room for the name, wherever the curves end
    ax.axhspan(foot, level, color=style.FAINT, alpha=0.45, lw=0, zorder=0)
    ax.annotate(
        "round-off:\nequal runs", (1.01, level), va="top", xycoords=("axes fraction", "data")
    )
    ax.set_ylim(foot, max(ax.get_ylim()[1], 1e8 * level))


def _over_buckling(ax: Axes, rows: pd.DataFrame) -> None:
    """A log axis of B with its buckling at 1."""
    ax.set(xscale="log", xlabel=f"Buckling number {plots.BUCKLING}")
    ticks = [0.2, 0.5, 1, 2, 5]
    ax.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    ax.minorticks_off()
    numbers = rows["buckling_number"]
    ax.set_xlim(0.85 * numbers.min(), 1.15 * numbers.max())
    ax.axvline(1.0, zorder=0, **BUCKLING)


def _points(ax: Axes, rows: pd.DataFrame, name: str, error: str) -> None:
    ax.errorbar(rows["buckling_number"], rows[name], rows[error], **POINTS)


def _handles(unstable: bool) -> dict[str, Line2D]:
    """The key of the panels over B."""
    handles = {
        "consistency: correlation of a pair": Line2D([], [], **CONSISTENCY),
        "saturation: separation / that of unrelated motions": Line2D([], [], **SATURATION),
        f"buckling at {plots.BUCKLING} = 1": Line2D([], [], **BUCKLING),
    }
    return handles | panels.baseline_and_unstable(unstable)
