"""Fig. 6: errors and estimates of the NARMA tasks, here on simulated networks.

Drawing only: every number comes from the table and the estimates.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fiberweb.plotting import style

SHOWN = "same"  # the timing of the authors' script; the other one is a marker beside it
PAPER_N = 6  # of the crosshatch in the experiment
PAPER = {  # Fig. 6: RMSE and interdecile range of the experiment
    2: {"rmse": 0.00096, "interdecile_range": 0.00246},
    5: {"rmse": 0.00924, "interdecile_range": 0.02383},
    10: {"rmse": 0.01573, "interdecile_range": 0.04082},
}
TRIVIAL = {"derivatives": "$u\\,…\\,u'''$", "powers": "$u\\,…\\,u^3$", "u": "$u$"}
MILLI = 1e3  # y is drawn in thousandths
EXPERIMENT = {"color": style.INK, "lw": 0.8, "ls": (0, (4, 2))}
MEAN = {"color": style.GREY, "lw": 0.8, "ls": ":"}
NEXT = {"marker": "D", "ms": 2.6, "mfc": "white", "mec": style.INK, "mew": 0.6, "ls": ""}
BAR = 4.5  # height that a bar gets, mm


@dataclass(frozen=True)
class Readout:
    """One line of the bars: whose readouts, of which run, and how they look."""

    run: str
    name: str  # as in the table
    label: str
    face: Sequence[float] | str
    edge: Sequence[float] | str


def draw(table: pd.DataFrame, found: xr.Dataset, setup: str, path: str | Path) -> Figure:
    """Draw the figure for one setup and write it as PNG and PDF.

    Args:
        table: from `narma.table`; rows of other setups are left out. A run whose status is
            "unstable" is drawn as an X.
        found: from `narma.of_runs`, of the same runs.
        setup: "described" or "published".
        path: of the figure; both suffixes are written beside each other.

    Returns:
        The figure.

    Raises:
        ValueError: the table has no run of this setup.
    """
    table = table[table["setup"] == setup]
    if table.empty:
        raise ValueError(f"the NARMA table has no run of the {setup} setup to draw")
    readouts = _readouts(table)
    orders = sorted(table["order"].unique())
    bars = 20.0 + BAR * len(readouts)
    with style.applied():
        figure = style.figure(style.DOUBLE, 68.0 + bars)
        top, bottom = figure.subfigures(2, 1, height_ratios=[68.0, bars])
        left, right = top.subfigures(1, 2, width_ratios=[1.0, 1.15])
        style.letter(left, "a", "Error $\\hat{y} - y$, its median and deciles")
        reservoirs = [one for one in readouts if one.name in ("network", "echo_state")]
        for ax, order in zip(_row(left, len(orders)), orders, strict=True):
            _errors(ax, found, reservoirs, order)
        _errors_key(left, reservoirs)
        shown = _example(table)
        style.letter(right, "b", f"{shown.label} crosshatch (black dashes: target)")
        _traces(right, found, table, shown, orders)
        style.letter(bottom, "c", f"Root mean square error and interdecile range ({setup} setup)")
        axes = _row(bottom, 2 * len(orders), sharey=True)
        for column, axes_of_it in zip(
            ("rmse", "interdecile_range"), (axes[: len(orders)], axes[len(orders) :]), strict=True
        ):
            for ax, order in zip(axes_of_it, orders, strict=True):
                _bars(ax, table[table["order"] == order], readouts, column, order)
        _bars_key(bottom, table)
        style.save(figure, path)
    return figure


def _row(part: SubFigure, count: int, **options) -> np.ndarray:
    return part.subplots(1, count, squeeze=False, **options)[0]


def _readouts(table: pd.DataFrame) -> list[Readout]:
    """Networks by size, then echo-state networks as large, then the input alone."""
    runs = table.drop_duplicates("run").sort_values("n")
    colours = style.colours(len(runs))
    signals = table[table["readout"] == "echo_state"].groupby("run")["n_signals"].first()
    made = [
        Readout(run.run, "network", f"{run.n}×{run.n}", colour, colour)
        for run, colour in zip(runs.itertuples(), colours, strict=True)
    ]
    made += [
        Readout(run, "echo_state", f"echo state, {signals[run]} nodes", "white", colour)
        for run, colour in zip(runs["run"], colours, strict=True)
    ]
    first = runs["run"].iloc[0]  # readouts of the input are the same for every run
    return made + [
        Readout(first, name, label, style.FAINT, style.FAINT) for name, label in TRIVIAL.items()
    ]


def _example(table: pd.DataFrame) -> Readout:
    """The network nearest in size to the paper's, stable if there is one."""
    runs = table.drop_duplicates("run").set_index("run")
    badness = {
        run: (row["status"] == "unstable", abs(row["n"] - PAPER_N)) for run, row in runs.iterrows()
    }
    best = min(badness, key=badness.get)
    return next(one for one in _readouts(table) if (one.run, one.name) == (best, "network"))


def _errors(ax: Axes, found: xr.Dataset, readouts: list[Readout], order: int) -> None:
    """Violins with the median and the deciles, and the width between the experiment's deciles."""
    for place, one in enumerate(readouts):
        at = {"run": one.run, "order": order, "timing": SHOWN}
        estimate = found["estimate"].sel(at | {"readout": one.name})
        error = MILLI * (estimate - found["target"].sel(at)).values
        if np.isnan(error).any():
            style.mark_unstable(ax, [place])
            continue
        (body,) = ax.violinplot([error], [place], widths=0.85, showextrema=False)["bodies"]
        body.set(facecolor=one.face, edgecolor=one.edge, alpha=1.0, linewidth=0.8)
        low, middle, high = np.quantile(error, (0.1, 0.5, 0.9))
        # on a dark violin a dark bar would not show, on a white one a white bar would not
        contrast = style.INK if one.name == "echo_state" else "white"
        ax.plot([place, place], [low, high], color=contrast, lw=1.2, solid_capstyle="butt")
        ax.plot(place, middle, "o", color=contrast, ms=2.2)
    half = MILLI * PAPER[order]["interdecile_range"] / 2.0
    place = len(readouts)
    ax.errorbar(place, 0.0, yerr=half, color=style.INK, elinewidth=0.8, capsize=2.0, marker="")
    ax.axhline(0.0, color=style.FAINT, lw=0.6, zorder=0)
    ax.set_title(f"NARMA-{order}")
    ax.set_xticks([])
    ax.spines["bottom"].set_visible(False)
    ax.set_ylabel(r"Error ($10^{-3}$)" if ax.get_subplotspec().is_first_col() else "")


def _errors_key(part: SubFigure, readouts: list[Readout]) -> None:
    handles = {
        one.label: Patch(fc=one.face, ec=one.edge) for one in readouts if one.name == "network"
    }
    handles["echo state, equal size"] = Patch(fc="white", ec=style.GREY, lw=0.8)
    handles["paper, experiment"] = Line2D([], [], color=style.INK, marker="|", ms=4, lw=0.8)
    part.legend(
        handles.values(), handles.keys(), loc="outside lower center", ncols=len(handles),
        columnspacing=0.9, handlelength=1.2,
    )  # fmt: skip


def _traces(
    part: SubFigure, found: xr.Dataset, table: pd.DataFrame, shown: Readout, orders: list[int]
) -> None:
    """Target (dashed) and estimate over the test part."""
    axes = part.subplots(len(orders), 1, sharex=True, squeeze=False)[:, 0]
    time = found["time"].values
    mine = table[(table["run"] == shown.run) & (table["readout"] == shown.name)]
    nrmse = mine[mine["timing"] == SHOWN].set_index("order")["nrmse"]
    for ax, order in zip(axes, orders, strict=True):
        at = {"run": shown.run, "order": order, "timing": SHOWN}
        estimate = MILLI * found["estimate"].sel(at | {"readout": shown.name}).values
        ax.plot(time, estimate, color=shown.edge)
        ax.plot(time, MILLI * found["target"].sel(at).values, "--", color="black", lw=0.7)
        title = f"NARMA-{order}"
        if np.isnan(estimate).any():
            style.mark_unstable(ax, [time.mean()])
        else:
            title += rf"   RMSE / $\sigma_y$ = {nrmse[order]:.2f}"
        ax.set_title(title)
        ax.margins(x=0.01)
    axes[len(axes) // 2].set_ylabel(r"$y,\ \hat{y}$ ($10^{-3}$)")
    axes[-1].set_xlabel("Time (s)")


def _bars(ax: Axes, table: pd.DataFrame, readouts: list[Readout], column: str, order: int) -> None:
    """One bar a readout; the experiment's value, and what the target's mean would score."""
    rows = table.set_index(["run", "readout", "timing"])
    places = -np.arange(len(readouts))
    for place, one in zip(places, readouts, strict=True):
        value = MILLI * rows.loc[(one.run, one.name, SHOWN), column]
        if np.isnan(value):
            ax.plot(
                0.04, place, transform=ax.get_yaxis_transform(), gid="unstable", **style.UNSTABLE
            )
            continue
        ax.barh(place, value, 0.62, color=one.face, edgecolor=one.edge, linewidth=0.8)
        ax.plot(MILLI * rows.loc[(one.run, one.name, "next"), column], place, **NEXT)
    ax.axvline(MILLI * PAPER[order][column], **EXPERIMENT)
    if column == "rmse":
        known = table[(table["timing"] == SHOWN) & table["rmse"].notna()].iloc[0]
        ax.axvline(MILLI * known["rmse"] / known["nrmse"], **MEAN)
    ax.set_yticks(places, [one.label for one in readouts])
    ax.tick_params(axis="y", length=0)
    ax.margins(x=0.08)
    ax.set_xlim(0.0, ax.get_xlim()[1])
    ax.locator_params(axis="x", nbins=4)
    ax.set_title(f"NARMA-{order}")
    ax.set_xlabel(r"RMSE ($10^{-3}$)" if column == "rmse" else r"$q_{90} - q_{10}$ ($10^{-3}$)")


def _bars_key(part: SubFigure, table: pd.DataFrame) -> None:
    handles = {
        "estimate of $y$ at the same sample": Patch(fc=style.GREY, ec=style.GREY),
        "at the next one": Line2D([], [], **NEXT),
        "paper, experiment": Line2D([], [], **EXPERIMENT),
        r"$\sigma_y$: the mean alone": Line2D([], [], **MEAN),
    }
    if (table["status"] == "unstable").any():
        handles["unstable run"] = Line2D([], [], **style.UNSTABLE)
    part.legend(
        handles.values(), handles.keys(), ncols=len(handles), loc="outside lower center",
        columnspacing=1.4,
    )  # fmt: skip
