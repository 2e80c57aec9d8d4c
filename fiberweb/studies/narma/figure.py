"""Fig. 6: errors and estimates of the NARMA tasks, on the experiment's twin and on networks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

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
PAPER = {  # Fig. 6: RMSE and interdecile range of the experiment
    2: {"rmse": 0.00096, "interdecile_range": 0.00246},
    5: {"rmse": 0.00924, "interdecile_range": 0.02383},
    10: {"rmse": 0.01573, "interdecile_range": 0.04082},
}
TRIVIAL = {name: plots.BASELINES[name] for name in ("derivatives", "powers", "u")}
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
READOUTS = "Readouts: network, echo-state network (ESN) of as many nodes, input alone"
HALF = {"marker": "^", "ms": 2.8, "mfc": "white", "mec": style.INK, "mew": 0.6, "ls": ""}
GAP = 0.8  # between readouts of the twin's input and of the networks'
ROWS = [42.0, *[27.0] * len(MEASURES), 30.0]  # mm


@dataclass(frozen=True)
class Readout:
    """One violin and its bars: whose readouts, of which case, where, and how they look."""

    case: str
    name: str  # as in the table
    place: float
    label: str
    face: Sequence[float] | str
    edge: Sequence[float] | str
    inner: Sequence[float] | str  # median and deciles, to show on the face


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw Fig. 6, a column for each order, as `fiberweb.figures` says.

    Args:
        given: "narma" (`task.table`) and "narma_errors" (`task.of_runs`), of the same cases.
    """
    table, estimates = plots.rows_of(given["narma"], "NARMA", setup), given["narma_errors"]
    readouts = _readouts(table)
    shown = _example(table, readouts)
    orders = sorted(table["order"].unique())
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
    return figure


def _titles(axes: Sequence[Axes], shown: Readout) -> None:
    """Panel letters, titles and labels of the rows."""
    titles = ["Error", *(title for title, _ in MEASURES.values())]
    labels = ["Error", *(symbol for _, symbol in MEASURES.values()), r"$y,\ \hat{y}$"]
    titles.append(shown.label)
    for ax, letter, title, label in zip(axes, "abcde", titles, labels, strict=True):
        panels.letter(ax, letter, title)
        ax.set_ylabel(f"{label} {UNIT}")


def _readouts(table: pd.DataFrame) -> list[Readout]:
    """Of the twin and of the networks, each: networks by size, echo-state networks as large, and
    what is made of their input alone. Readings of the frame rate but the first are marks."""
    cases = table.drop_duplicates("case")
    cases = cases[cases["verdict"] | (cases["body"] == "network")]
    colour = dict(zip(cases["case"], style.colours(len(cases)), strict=True))
    signals = table[table["readout"] == "echo_state"].groupby("case")["n_signals"].first()
    readouts, at = [], 0.0
    for body in ("twin", "network"):
        looks = []
        of_body = cases[cases["body"] == body].sort_values("n")
        for case, n in zip(of_body["case"], of_body["n"], strict=True):
            label = f"{n}×{n} twin" if body == "twin" else f"{n}×{n}"
            looks.append((case, "network", label, colour[case], colour[case], "white"))
        for case in of_body["case"]:
            label = f"ESN {signals[case]}"
            looks.append((case, "echo_state", label, "white", colour[case], style.INK))
        for case in of_body["case"][:1]:  # the same for all of one input
            looks += [
                (case, name, label, style.FAINT, style.GREY, style.INK)
                for name, label in TRIVIAL.items()
            ]
        readouts += [
            Readout(case, name, at + place, *look)
            for place, (case, name, *look) in enumerate(looks)
        ]
        at += len(looks) + (GAP if looks else 0.0)
    return readouts


def _example(table: pd.DataFrame, readouts: list[Readout]) -> Readout:
    """The first network, stable if there is one: the twin."""
    unstable = set(table.loc[table["status"] == "unstable", "case"])
    networks = [one for one in readouts if one.name == "network"]
    return min(networks, key=lambda one: one.case in unstable)


def _errors(ax: Axes, estimates: xr.Dataset, readouts: list[Readout], order: int) -> None:
    """Violins with the median and the deciles."""
    for one in readouts:
        place, of_case = one.place, _of_case(estimates, one.case, order)
        error = MILLI * (of_case["estimate"].sel(readout=one.name) - of_case["target"]).values
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


def _of_case(estimates: xr.Dataset, case: str, order: int) -> xr.Dataset:
    """Target and estimates of one case, without what others have beyond its test part."""
    of_case = estimates.sel(case=case, order=order, timing=SHOWN)
    return of_case.dropna("time", subset=["target"])


def _categories(ax: Axes, readouts: list[Readout]) -> None:
    """Places of the readouts, without their labels, and a line at 0."""
    ax.axhline(0.0, color=style.FAINT, lw=0.6, zorder=0)
    ax.set_xlim(-0.6, readouts[-1].place + 0.6)
    ax.set_xticks([one.place for one in readouts], [""] * len(readouts))
    ax.tick_params(axis="x", length=0, labelsize=6)
    ax.spines["bottom"].set_visible(False)


def _labels(ax: Axes, readouts: list[Readout]) -> None:
    """Names of the readouts, upright."""
    places, labels = [one.place for one in readouts], [one.label for one in readouts]
    ax.set_xticks(places, labels, rotation=90)


def _bars(ax: Axes, table: pd.DataFrame, readouts: list[Readout], measure: str) -> None:
    """One bar a readout; of the twin the experiment's value; and what the target's mean scores."""
    rows = table.set_index(["case", "readout", "timing"]).sort_index()
    halves = _other_readings(table)
    for one in readouts:
        value = MILLI * rows.loc[(one.case, one.name, SHOWN), measure]
        if np.isnan(value):
            style.mark_unstable(ax, [one.place])
            continue
        ax.bar(one.place, value, 0.62, color=one.face, edgecolor=one.edge, linewidth=0.8)
        ax.plot(one.place, MILLI * rows.loc[(one.case, one.name, "next"), measure], **NEXT)
        for case in halves.get(one.case, []):
            ax.plot(one.place, MILLI * rows.loc[(case, one.name, SHOWN), measure], **HALF)
    published = PAPER[table["order"].iloc[0]]
    for body, cases in table.groupby("body"):
        mine = set(cases["case"])
        places = [one.place for one in readouts if one.case in mine]
        ends = [min(places) - 0.5, max(places) + 0.5]
        if body == "twin" and measure in published:
            ax.plot(ends, [MILLI * published[measure]] * 2, **EXPERIMENT)
        known = cases[
            (cases["timing"] == SHOWN) & cases["rmse"].notna() & (cases["frame_step"] == 1)
        ]
        if measure == "rmse" and len(known):
            spread = known.iloc[0]["rmse"] / known.iloc[0]["nrmse"]
            ax.plot(ends, [MILLI * spread] * 2, **MEAN)
    _categories(ax, readouts)
    ax.locator_params(axis="y", nbins=4)


def _other_readings(table: pd.DataFrame) -> dict[str, list[str]]:
    """Cases of other readings of the frame rate, by that of the first."""
    twin = table[table["body"] == "twin"].drop_duplicates("case")
    first = twin[twin["verdict"]].set_index("run")["case"]
    others = twin[~twin["verdict"]]
    return {case: list(others.loc[others["run"] == run, "case"]) for run, case in first.items()}


def _traces(
    ax: Axes, estimates: xr.Dataset, table: pd.DataFrame, shown: Readout, order: int
) -> None:
    """Target (dashed) and estimate at the beginning of the test part."""
    seen = _of_case(estimates, shown.case, order)
    seen = seen.sel(time=slice(None, float(seen["time"][0]) + TRACE_SECONDS))
    time, estimate = seen["time"].values, MILLI * seen["estimate"].sel(readout=shown.name).values
    ax.plot(time, estimate, **panels.PREDICTION)
    ax.plot(time, MILLI * seen["target"].values, **panels.TARGET)
    if np.isnan(estimate).any():
        style.mark_unstable(ax, [time.mean()])
    else:
        row = table.set_index(["case", "readout", "timing"]).loc[(shown.case, shown.name, SHOWN)]
        ax.set_title(f"NRMSE = {row['nrmse']:.2f}", loc="right")
    ax.margins(x=0.01)
    ax.set_xlabel("Time (s)")


def _handles(table: pd.DataFrame) -> dict[str, Artist]:
    """The key of bars and traces."""
    handles = {
        "estimate of the same sample": Patch(fc=style.FAINT, ec=style.GREY),
        "of the next one": Line2D([], [], **NEXT),
        "twin, fewer frames read": Line2D([], [], **HALF),
        "paper's experiment": Line2D([], [], **EXPERIMENT),
        r"$\sigma_y$, the mean's error": Line2D([], [], **MEAN),
        "target $y$": Line2D([], [], **panels.TARGET),
        r"estimate $\hat{y}$": Line2D([], [], **panels.PREDICTION),
    }
    return handles | plots.unstable_key((table["status"] == "unstable").any())
