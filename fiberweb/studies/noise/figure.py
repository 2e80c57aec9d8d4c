"""Capacities against readout noise."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fiberweb.figures import panels, plots, style

MICRO = 1e6  # m to um
# m; orders of magnitude by our own estimate, without a source, to place the scale
INSTRUMENTS = {1e-8: "laser vibrometer", 1e-5: "camera"}
AMPLITUDES = {"fc": style.FAINT, "ec": style.FAINT, "lw": 0.8}
BARS = {"elinewidth": 0.8, "capsize": 2.5}  # wider than the markers, or small bars would not show


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw C_nl and C_m over the noise of the readouts, as `fiberweb.figures` says.

    Args:
        given: "noise" (`tables.table`) and "noise_baselines" (`input_baselines`).
    """
    rows = plots.rows_of(given["noise"], "noise", setup)
    colour = plots.colours(rows["n"])
    figure = style.figure(style.DOUBLE, 70.0)
    axes = figure.subplots(1, 2)
    for ax, (name, symbol), letter in zip(axes, plots.TOTALS.items(), "ab", strict=True):
        for n in colour:
            _network(ax, rows[rows["n"] == n], name, colour[n])
        _scale(ax, rows)
        title = f"{panels.CAPACITIES[name]} ({setup} setup)"
        panels.letter(ax, letter, title, pad=20)  # above the instruments
        ax.set(ylabel=symbol, ylim=(0.0, 1.0))
        plots.baselines(ax, given["noise_baselines"], name)
    panels.key(figure, _handles(rows, colour))
    return figure


def _network(ax: Axes, rows: pd.DataFrame, name: str, colour) -> None:
    """Means over draws with standard errors, the noise-free value at the left edge."""
    if (rows["status"] == "unstable").all():
        style.mark_unstable(ax, [_place_of_none(rows)])
        return
    free, noisy = (rows[chosen] for chosen in (rows["noise_m"] == 0, rows["noise_m"] > 0))
    by_level = noisy.groupby("noise_m")
    ax.errorbar(
        MICRO * by_level[name].mean().index, by_level[name].mean(), _error(by_level, name),
        color=colour, marker="o", ms=2.6, lw=0.9, **BARS,
    )  # fmt: skip
    ax.errorbar(
        [_place_of_none(rows)] * len(free), free[name], free[f"{name}_se"], color=colour,
        marker="D", ms=3.0, ls="", **BARS,
    )  # fmt: skip


def _error(by_level, name: str) -> pd.Series:
    """What the finite test part and the draw of the noise leave open, in quadrature; a single
    draw has the first alone."""
    return np.hypot(by_level[f"{name}_se"].mean(), by_level[name].std().fillna(0.0))


def _place_of_none(rows: pd.DataFrame) -> float:
    """Where noise-free runs stand on a log axis: a decade below the least noise (um)."""
    return MICRO * rows.loc[rows["noise_m"] > 0, "noise_m"].min() / 10


def _scale(ax: Axes, rows: pd.DataFrame) -> None:
    """A log axis in um whose leftmost tick is no noise, how far median readouts move, and what
    some instruments reach."""
    least = _place_of_none(rows)
    levels = sorted(MICRO * rows.loc[rows["noise_m"] > 0, "noise_m"].unique())
    ax.set(xscale="log", xlabel="Standard deviation of the readout noise (µm)")
    ax.set_xticks([least, *levels], ["none", *(f"{level:g}" for level in levels)])
    ax.minorticks_off()
    ax.set_xlim(least / 2, 2 * levels[-1])
    amplitude = MICRO * rows["amplitude_m"].dropna()
    if len(amplitude):
        ax.axvspan(amplitude.min(), amplitude.max(), zorder=0, **AMPLITUDES)
    for noise, instrument in INSTRUMENTS.items():
        if levels[0] <= 1.001 * MICRO * noise and MICRO * noise <= 1.001 * levels[-1]:
            ax.annotate(
                f"{instrument}\n▾", (MICRO * noise, 1.0), (0, -1),
                xycoords=ax.get_xaxis_transform(), textcoords="offset points", fontsize=6,
                ha="center", va="bottom", linespacing=0.9,
            )  # fmt: skip


def _handles(rows: pd.DataFrame, colour: dict) -> dict:
    handles = {f"{n}×{n}": Line2D([], [], color=colour[n], marker="o", ms=3) for n in colour}
    handles["no noise"] = Line2D([], [], color=style.INK, marker="D", ms=3.0, ls="")
    bar = Line2D([], [], marker="|", ms=7, mew=0.8, ls="", color=style.INK)
    handles["± standard error"] = bar
    handles["sd of the median readout"] = Patch(**AMPLITUDES)
    return handles | panels.baseline_and_unstable((rows["status"] == "unstable").any())
