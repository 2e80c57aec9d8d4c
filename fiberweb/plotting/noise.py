"""Capacities against readout noise.

Drawing only: every number comes from the tables.
"""

from __future__ import annotations

from pathlib import Path

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fiberweb.plotting import style, sweep

MICRO = 1e6  # m to um
# orders of magnitude, to place the scale
INSTRUMENTS = {1e-8: "laser vibrometer", 1e-5: "camera"}


def draw(tables: dict[str, pd.DataFrame], setup: str, path: str | Path) -> Figure:
    """Draw C_nl and C_m over the noise of the readouts, for one setup.

    Args:
        tables: "noise" (`fiberweb.noise.table`) and "noise_floors" (`tables.floors`).
        setup: "described" or "published".
        path: of the figure; PNG and PDF are written beside each other.

    Returns:
        The figure.

    Raises:
        ValueError: the table has no run of this setup.
    """
    rows = sweep.rows_of(tables["noise"], "noise", setup)
    sizes = sorted(rows["n"].unique())
    colour = dict(zip(sizes, style.colours(max(len(sizes), 2)), strict=False))
    with style.applied():
        figure = style.figure(style.DOUBLE, 66.0)
        axes = figure.subplots(1, 2)
        for ax, (name, symbol), letter in zip(axes, sweep.TOTALS.items(), "ab", strict=True):
            for n in sizes:
                _network(ax, rows[rows["n"] == n], name, colour[n])
            _scale(ax, rows)
            ax.set(ylabel=symbol, ylim=(0.0, 1.0))
            ax.set_title(rf"$\mathbf{{{letter}}}$", loc="left", fontsize=8, pad=12)
            sweep.floors(ax, tables["noise_floors"], name)
        figure.legend(**_key(rows, colour), loc="outside lower center", columnspacing=1.2)
        style.save(figure, path)
    return figure


def _network(ax: Axes, rows: pd.DataFrame, name: str, colour) -> None:
    """Mean over draws with least and largest, the noise-free value at the left edge, and the
    median readout's amplitude as a tick at the foot."""
    if (rows["status"] == "unstable").all():
        style.mark_unstable(ax, [_place_of_none(rows)])
        return
    noisy = rows[rows["noise_m"] > 0].groupby("noise_m")[name].agg(["mean", "min", "max"])
    spread = [noisy["mean"] - noisy["min"], noisy["max"] - noisy["mean"]]
    ax.errorbar(
        MICRO * noisy.index, noisy["mean"], spread, color=colour, marker="o", ms=3, lw=0.9,
        elinewidth=0.7, capsize=1.5,
    )  # fmt: skip
    free = rows.loc[rows["noise_m"] == 0, name]
    ax.plot([_place_of_none(rows)] * len(free), free, "D", color=colour, ms=3.5)
    ax.axvline(MICRO * rows["amplitude_m"].iloc[0], color=colour, lw=0.8, ls=":", zorder=0)


def _place_of_none(rows: pd.DataFrame) -> float:
    """Where noise-free runs stand on a log axis: a decade below the least noise (um)."""
    return MICRO * rows.loc[rows["noise_m"] > 0, "noise_m"].min() / 10


def _scale(ax: Axes, rows: pd.DataFrame) -> None:
    """A log axis in um whose leftmost tick is no noise, and what some instruments reach."""
    least = _place_of_none(rows)
    levels = sorted(MICRO * rows.loc[rows["noise_m"] > 0, "noise_m"].unique())
    ax.set(xscale="log", xlabel="Standard deviation of the readout noise (µm)")
    ax.set_xticks([least, *levels], ["none", *(f"{level:g}" for level in levels)])
    ax.minorticks_off()
    ax.set_xlim(least / 2, 2 * levels[-1])
    for noise, instrument in INSTRUMENTS.items():
        if levels[0] <= 1.001 * MICRO * noise and MICRO * noise <= 1.001 * levels[-1]:
            ax.annotate(
                f"{instrument}\n▾", (MICRO * noise, 1.0), (0, -1),
                xycoords=ax.get_xaxis_transform(), textcoords="offset points", fontsize=6,
                color=style.GREY, ha="center", va="bottom", linespacing=0.9,
            )  # fmt: skip


def _key(rows: pd.DataFrame, colour: dict) -> dict:
    handles = {f"{n}×{n}": Line2D([], [], color=colour[n], marker="o", ms=3) for n in colour}
    handles |= {
        "no noise": Line2D([], [], color=style.INK, marker="D", ms=3.5, ls=""),
        "median readout's standard deviation": Line2D([], [], color=style.INK, lw=0.8, ls=":"),
    }
    handles["readouts made of the input alone"] = Line2D([], [], **sweep.FLOOR_LINE)
    if (rows["status"] == "unstable").any():
        handles["unstable run"] = Line2D([], [], **style.UNSTABLE)
    return {"handles": handles.values(), "labels": handles.keys(), "ncols": len(handles)}
