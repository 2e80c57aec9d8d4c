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
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fiberweb.figures import panels, plots, style

SHOWN = "same"  # the timing of the authors' script; the other one is a marker beside it
PAPER_N = 6  # of the crosshatch in the experiment
PAPER = {  # Fig. 6: RMSE and interdecile range of the experiment
    2: {"rmse": 0.00096, "interdecile_range": 0.00246},
    5: {"rmse": 0.00924, "interdecile_range": 0.02383},
    10: {"rmse": 0.01573, "interdecile_range": 0.04082},
}
TRIVIAL = {"derivatives": "$u\\,…$\n$u'''$", "powers": "$u\\,…$\n$u^3$", "u": "$u$"}
MEASURES = {  # title and symbol; one row of bars each
    "rmse": ("Root mean square error", "RMSE"),
    "interdecile_range": ("Interdecile range", "$q_{90} - q_{10}$"),
    "bias": ("Bias", "Mean error"),
}
MILLI = 1e3  # y is drawn in thousandths
UNIT = r"($10^{-3}$)"
EXPERIMENT = {"color": style.INK, "lw": 0.8, "ls": "-."}
MEAN = {"color": style.GREY, "lw": 0.8, "ls": ":"}
NEXT = {"marker": "D", "ms": 2.6, "mfc": "white", "mec": style.INK, "mew": 0.6, "ls": ""}
TRACE_SECONDS = 10.0  # of the test part: all of it would be a thicket in a third of the width
READOUTS = "Readouts: networks, echo-state networks (ESN) of as many nodes, input alone"
UPRIGHT = 8  # labels that fit side by side under an axes
ROWS = [42.0, *[27.0] * len(MEASURES), 30.0]  # mm


@dataclass(frozen=True)
class Readout:
    """One violin and its bars: whose readouts, of which run, and how they look."""

    run: str
    name: str  # as in the table
    label: str
    face: Sequence[float] | str
    edge: Sequence[float] | str
    inner: Sequence[float] | str  # median and deciles, to show on the face


def draw(given: dict, setup: str, path: str | Path) -> Figure:
    """Draw Fig. 6, a column for each order, as `fiberweb.figures` says.

    Args:
        given: "narma" (`task.table`) and "narma_errors" (`task.of_runs`), of the same runs.
    """
    table, estimates = plots.rows_of(given["narma"], "NARMA", setup), given["narma_errors"]
    readouts, shown = _readouts(table), _example(table)
    orders = sorted(table["order"].unique())
    with style.applied():
        figure = style.figure(style.DOUBLE, sum(ROWS) + 26.0)
        figure.suptitle(f"NARMA tasks, {setup} setup", x=0.005, ha="left")
        axes = figure.subplots(len(ROWS), len(orders), squeeze=False, height_ratios=ROWS)
        for column, order in zip(axes.T, orders, strict=True):
            of_order = table[table["order"] == order]
            _errors(column[0], estimates, readouts, order)
            for ax, measure in zip(column[1:-1], MEASURES, strict=True):
                _bars(ax, of_order, readouts, measure)
            _labels(column[-2], readouts)
            _traces(column[-1], estimates, of_order, shown, order)
        _titles(axes[:, 0], shown)
        axes[-2, 0].set_xlabel(READOUTS, loc="left")
        figure.align_ylabels(axes[:, 0])
        panels.key(figure, _handles(table), ncols=4)
        style.save(figure, path)
    return figure


def _titles(axes: Sequence[Axes], shown: Readout) -> None:
    """Panel letters, titles and labels of the rows."""
    titles = ["Error", *(title for title, _ in MEASURES.values())]
    labels = ["Error", *(symbol for _, symbol in MEASURES.values()), r"$y,\ \hat{y}$"]
    titles.append(f"{shown.label} network")
    for ax, letter, title, label in zip(axes, "abcde", titles, labels, strict=True):
        panels.letter(ax, letter, title)
        ax.set_ylabel(f"{label} {UNIT}")


def _readouts(table: pd.DataFrame) -> list[Readout]:
    """Networks by size, then echo-state networks as large, then the input alone."""
    runs = table.drop_duplicates("run").sort_values("n")
    colours = style.colours(len(runs))
    signals = table[table["readout"] == "echo_state"].groupby("run")["n_signals"].first()
    readouts = [
        Readout(run.run, "network", f"{run.n}×{run.n}", colour, colour, "white")
        for run, colour in zip(runs.itertuples(), colours, strict=True)
    ]
    readouts += [
        Readout(run, "echo_state", f"ESN\n{signals[run]}", "white", colour, style.INK)
        for run, colour in zip(runs["run"], colours, strict=True)
    ]
    first = runs["run"].iloc[0]  # readouts of the input are the same for every run
    return readouts + [
        Readout(first, name, label, style.FAINT, style.GREY, style.INK)
        for name, label in TRIVIAL.items()
    ]


def _example(table: pd.DataFrame) -> Readout:
    """The network nearest in size to the paper's, stable if there is one."""
    runs = table.drop_duplicates("run").set_index("run")
    badness = {
        run: (row["status"] == "unstable", abs(row["n"] - PAPER_N)) for run, row in runs.iterrows()
    }
    best = min(badness, key=badness.get)
    return next(one for one in _readouts(table) if (one.run, one.name) == (best, "network"))


def _errors(ax: Axes, estimates: xr.Dataset, readouts: list[Readout], order: int) -> None:
    """Violins with the median and the deciles."""
    for place, one in enumerate(readouts):
        at = {"run": one.run, "order": order, "timing": SHOWN}
        estimate = estimates["estimate"].sel(at | {"readout": one.name})
        error = MILLI * (estimate - estimates["target"].sel(at)).values
        if np.isnan(error).any():
            style.mark_unstable(ax, [place])
            continue
        (body,) = ax.violinplot([error], [place], widths=0.85, showextrema=False)["bodies"]
        body.set(facecolor=one.face, edgecolor=one.edge, alpha=1.0, linewidth=0.8)
        low, middle, high = np.quantile(error, (0.1, 0.5, 0.9))
        ax.plot([place, place], [low, high], color=one.inner, lw=1.2, solid_capstyle="butt")
        ax.plot(place, middle, "o", color=one.inner, ms=2.2)
    ax.set_title(f"NARMA-{order}", loc="right")
    _categories(ax, readouts)
    _labels(ax, readouts)


def _categories(ax: Axes, readouts: list[Readout]) -> None:
    """Places of the readouts, without their labels, and a line at 0."""
    ax.axhline(0.0, color=style.FAINT, lw=0.6, zorder=0)
    ax.set_xlim(-0.6, len(readouts) - 0.4)
    ax.set_xticks(range(len(readouts)), [""] * len(readouts))
    ax.tick_params(axis="x", length=0, labelsize=6)
    ax.spines["bottom"].set_visible(False)


def _labels(ax: Axes, readouts: list[Readout]) -> None:
    """Names of the readouts, upright in two lines or, if there are many, turned in one."""
    upright = len(readouts) <= UPRIGHT
    labels = [one.label if upright else one.label.replace("\n", " ") for one in readouts]
    ax.set_xticks(range(len(readouts)), labels, rotation=0 if upright else 90)


def _bars(ax: Axes, table: pd.DataFrame, readouts: list[Readout], measure: str) -> None:
    """One bar a readout; the experiment's value, and what the target's mean would score."""
    rows = table.set_index(["run", "readout", "timing"])
    for place, one in enumerate(readouts):
        value = MILLI * rows.loc[(one.run, one.name, SHOWN), measure]
        if np.isnan(value):
            style.mark_unstable(ax, [place])
            continue
        ax.bar(place, value, 0.62, color=one.face, edgecolor=one.edge, linewidth=0.8)
        ax.plot(place, MILLI * rows.loc[(one.run, one.name, "next"), measure], **NEXT)
    published = PAPER[table["order"].iloc[0]]
    if measure in published:
        ax.axhline(MILLI * published[measure], **EXPERIMENT)
    if measure == "rmse":
        known = table[(table["timing"] == SHOWN) & table["rmse"].notna()].iloc[0]
        ax.axhline(MILLI * known["rmse"] / known["nrmse"], **MEAN)
    _categories(ax, readouts)
    ax.locator_params(axis="y", nbins=4)


def _traces(
    ax: Axes, estimates: xr.Dataset, table: pd.DataFrame, shown: Readout, order: int
) -> None:
    """Target (dashed) and estimate at the beginning of the test part."""
    seen = estimates.sel(run=shown.run, order=order, timing=SHOWN)
    seen = seen.sel(time=slice(None, float(seen["time"][0]) + TRACE_SECONDS))
    time, estimate = seen["time"].values, MILLI * seen["estimate"].sel(readout=shown.name).values
    ax.plot(time, estimate, **panels.PREDICTION)
    ax.plot(time, MILLI * seen["target"].values, **panels.TARGET)
    if np.isnan(estimate).any():
        style.mark_unstable(ax, [time.mean()])
    else:
        row = table.set_index(["run", "readout", "timing"]).loc[(shown.run, shown.name, SHOWN)]
        ax.set_title(f"NRMSE = {row['nrmse']:.2f}", loc="right")
    ax.margins(x=0.01)
    ax.set_xlabel("Time (s)")


def _handles(table: pd.DataFrame) -> dict[str, Artist]:
    """The key of bars and traces."""
    handles = {
        "estimate of the same sample": Patch(fc=style.FAINT, ec=style.GREY),
        "of the next one": Line2D([], [], **NEXT),
        "paper's experiment, another input": Line2D([], [], **EXPERIMENT),
        r"$\sigma_y$, the mean's error": Line2D([], [], **MEAN),
        "target $y$": Line2D([], [], **panels.TARGET),
        r"estimate $\hat{y}$": Line2D([], [], **panels.PREDICTION),
    }
    if (table["status"] == "unstable").any():
        handles["unstable run"] = Line2D([], [], **style.UNSTABLE)
    return handles
