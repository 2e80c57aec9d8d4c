"""Fig. 1: capacities of crosshatch and polygonal networks, and example computations."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from fiberweb.figures import panels, plots, style
from fiberweb.model.network import Network, crosshatch, polygon
from fiberweb.model.scene import Scene

if TYPE_CHECKING:
    import xarray as xr

DRAWN = {"crosshatch": (2, 4, 8), "polygon": (6, 8, 12)}  # schematics, where they were run
TITLES = {"crosshatch": "Crosshatch networks", "polygon": "Polygonal networks"}
TRACE_SECONDS = 5.0  # of the test part: some 25 knots of the input, still resolved in a third
CAPACITY_AXIS = (-0.03, 1.03)  # c < 0 counts as 0 in the totals and falls below this axis
TRAINING = {"color": style.GREY, "marker": "o", "mfc": "white", "mew": 0.7, "ms": 3, "ls": ""}
# what a certificate found a capacity to follow, at the foot of its axes
FOLLOWS = {"filter": "f", "rounding": "r", "mesh": "m", "step": "t", "shear": "s", "chaos": "c"}
# caps wider than the markers, or small bars would not show
TEST = {"marker": "o", "ms": 2.6, "elinewidth": 0.7, "capsize": 2.5, "capthick": 0.7}


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw Fig. 1, as `fiberweb.figures` says.

    Args:
        given: "topology" (`fiberweb.scoring.tables.study`), "topology_curves" (`curves`),
            "topology_baselines" (`input_baselines`) and "topology_traces"
            (`traces.example_traces`), which leaves panel d out if it has nothing or nothing but
            NaN.
    """
    table, curves = (
        plots.rows_of(given[name], name, setup) for name in ("topology", "topology_curves")
    )
    baselines, traces = given["topology_baselines"], given["topology_traces"]
    if not traces.data_vars or not _known(traces).any():
        traces = None  # an unstable run has no prediction to show
    present = [name for name in TITLES if (table["topology"] == name).any()]
    heights = [30.0] + [46.0] * len(present) + ([54.0] if traces is not None else [])
    figure = style.figure(style.DOUBLE, sum(heights))
    rows = list(np.atleast_1d(figure.subfigures(len(heights), 1, height_ratios=heights)))
    letters = iter("abcd")
    colour = plots.colours(table["n"])
    style.letter(rows[0], next(letters), f"Networks ({setup} setup)")
    _networks(rows[0], table, setup)
    for row, topology in zip(rows[1:], present, strict=False):
        style.letter(row, next(letters), f"{TITLES[topology]} ({setup} setup)")
        runs, points = (frame[frame["topology"] == topology] for frame in (table, curves))
        _capacities(row, runs, points, baselines, colour)
    panels.key_beside_title(rows[1], _marks(table))
    if followed := _followed_marks(table):
        panels.key_beside_title(rows[0], followed)
    if traces is not None:
        title = f"Example computations{_network_name(traces)} ({setup} setup)"
        style.letter(rows[-1], next(letters), title)
        _traces(rows[-1], traces)
    return figure


def _networks(part: SubFigure, table: pd.DataFrame, setup: str) -> None:
    """Schematics of a few networks side by side, each to its own scale."""
    drawn = []
    for topology, preferred in DRAWN.items():
        ran = sorted(table.loc[table["topology"] == topology, "n"].unique())
        drawn += [(topology, n) for n in ([n for n in preferred if n in ran] or ran[:3])]
    axes = part.subplots(1, len(drawn) + 1, width_ratios=[1] * len(drawn) + [1.5])
    for index, (ax, (topology, n)) in enumerate(zip(axes, drawn, strict=False)):
        network = _network(topology, int(n), setup)
        _schematic(ax, network, readouts=index == 0)
        ax.set_title(_label(topology, n))
    handles = [
        Line2D([], [], color=style.DRIVE, marker=panels.DRIVEN, ls="", ms=6),
        Line2D([], [], color=style.INK, marker="o", ls="", ms=2.4),
        Line2D([], [], color=style.INK, marker="o", mfc="white", mew=0.6, ls="", ms=2.6),
    ]
    axes[-1].axis("off")
    labels = ["driven point", "readout: crossing", "readout: midpoint"]
    axes[-1].legend(handles, labels, loc="center left")


def _network(topology: str, n: int, setup: str) -> Network:
    if topology == "crosshatch":
        return crosshatch(n, length=1.0)
    return polygon(n, diameter=1.0, diagonals="skip-one" if setup == "published" else "all")


def _schematic(ax: Axes, network: Network, readouts: bool) -> None:
    if readouts:
        middle = np.concatenate(
            [_midpoints(network, fibre) for fibre in range(len(network.fibres))]
        )
        ax.plot(*middle.T, "o", ms=2.6, mfc="white", mec=style.INK, mew=0.6, zorder=4)
        ax.plot(*network.crossings.T, "o", ms=2.4, color=style.INK, zorder=4)
    centre = 0.5 if network.topology == "crosshatch" else 0.0
    panels.network(ax, network, style.GREY, (centre - 0.52, centre + 0.52))


def _midpoints(network: Network, fibre: int) -> np.ndarray:
    """Midpoints of a fibre's sections, shape (sections, 2)."""
    ends = network.sections(fibre)
    near, far = network.fibres[fibre]
    share = 0.5 * (ends[1:] + ends[:-1]) / ends[-1]
    return near + share[:, None] * (far - near)


def _capacities(
    part: SubFigure, runs: pd.DataFrame, points: pd.DataFrame, baselines: pd.DataFrame, colour: dict
) -> None:
    """c over order and over lag for each N, then the totals over N."""
    by_order, by_lag, nonlinear, memory = part.subplots(1, 4, width_ratios=[1.15, 1.15, 1, 1])
    sizes = sorted(runs["n"].unique())
    unstable = set(runs.loc[runs["status"] == "unstable", "n"])
    for n in sizes:
        if n in unstable:
            continue
        curve = points[points["n"] == n]
        for ax, target, marker in ((by_order, "order", "o"), (by_lag, "lag", "")):
            at = curve[curve["target"] == target].sort_values("at")
            ax.plot(at["at"], at["c"], color=colour[n], marker=marker, ms=2.4)
    by_order.set(xlabel="Legendre order", ylabel="Capacity $c$", xticks=range(2, 11, 2))
    by_lag.set(xlabel="Recall lag (s)", xlim=(0, points["at"][points["target"] == "lag"].max()))
    by_lag.tick_params(labelleft=False)
    shades = {n: colour[n] for n in sizes}
    plots.colour_bar(part, [by_order, by_lag], shades, "$N$", pad=0.01, fraction=0.04, aspect=14)
    for ax, (name, symbol) in zip((nonlinear, memory), plots.TOTALS.items(), strict=True):
        _total(ax, runs, name, colour)
        ax.set(xlabel="$N$", ylabel=symbol, xticks=sizes)
    for ax in (by_order, by_lag, nonlinear, memory):
        ax.set_ylim(*CAPACITY_AXIS)
    for ax, name in zip((nonlinear, memory), plots.TOTALS, strict=True):
        plots.baselines(ax, baselines, name)


def _marks(table: pd.DataFrame) -> dict[str, Line2D]:
    """Legend entries of the totals."""
    handles = {
        "test ± standard error": Line2D([], [], color=style.INK, marker="o", ms=3, lw=0),
        "training": Line2D([], [], **TRAINING),
    }
    return handles | panels.baseline_and_unstable((table["status"] == "unstable").any())


def _followed_marks(table: pd.DataFrame) -> dict[str, Line2D]:
    """Legend entries of what certificates found, if there are any."""
    found = "".join(_followed(row, name) for row in table.itertuples() for name in plots.TOTALS)
    look = {"color": style.INK, "ms": 4, "mew": 0.2, "ls": ""}
    return {
        f"follows {cause}": Line2D([], [], marker=rf"$\mathrm{{{mark}}}$", **look)
        for cause, mark in FOLLOWS.items()
        if mark in found
    }


def _total(ax: Axes, runs: pd.DataFrame, name: str, colour: dict) -> None:
    """C_nl or C_m over N: test with its standard error, training as open markers."""
    runs = runs.sort_values("n")
    stable = runs[runs["status"] != "unstable"]
    ax.plot(stable["n"], stable[name], color=style.FAINT, lw=0.8, zorder=1)
    ax.plot(stable["n"], stable[f"{name}_train"], **TRAINING)
    for run in stable.itertuples():
        ax.errorbar(
            run.n, getattr(run, name), yerr=getattr(run, f"{name}_se"), color=colour[run.n],
            ecolor=style.INK, zorder=3, **TEST,
        )  # fmt: skip
        foot = run.n, 0.01
        ax.text(*foot, _followed(run, name), transform=ax.get_xaxis_transform(), ha="center")
    plots.mark_unstable(ax, runs, "n")
    ax.margins(x=0.08)


def _followed(run, name: str) -> str:
    """Marks of what a capacity follows that is no physics; none where there is no certificate."""
    verdict = getattr(run, f"{name}_verdict", "")
    return "".join(mark for cause, mark in FOLLOWS.items() if cause in str(verdict))


def _traces(part: SubFigure, traces: xr.Dataset) -> None:
    """Target (dashed) and prediction over a few seconds of the test part, one axes a trace."""
    known = _known(traces)
    time = traces["time"].values
    start = time[known][0]
    shown = known & (time < start + TRACE_SECONDS)
    columns = -(-traces.sizes["trace"] // 2)
    axes = part.subplots(2, columns, sharex=True, sharey=True, squeeze=False)
    for ax in axes[:, 0]:
        ax.set_ylabel(r"$z,\ \hat{z}$")
    for ax, name in zip(axes.T.ravel(), traces["trace"].values, strict=False):
        one = traces.sel(trace=name)
        legendre = str(name).startswith("P")
        ax.plot(time[shown], one["prediction"].values[shown], **panels.PREDICTION)
        ax.plot(time[shown], one["target"].values[shown], **panels.TARGET)
        title = f"$P_{{{name[1:]}}}(u(t))$" if legendre else f"$u(t - {name.split()[0]}$ ms$)$"
        ax.set_title(f"{title}   $c$ = {float(one['c']):.3f}")
        ax.set(ylim=(-1.15, 1.15), xlim=(start, start + TRACE_SECONDS))
    for ax in axes[-1]:
        ax.set_xlabel("Time (s)")
    lines = {"target $z$": panels.TARGET, "prediction $\\hat{z}$": panels.PREDICTION}
    handles = {label: Line2D([], [], **line) for label, line in lines.items()}
    panels.key_beside_title(part, handles)


def _known(traces: xr.Dataset) -> np.ndarray:
    """Instants at which every target and prediction exists, shape (time,)."""
    both = np.isfinite(traces["target"].values) & np.isfinite(traces["prediction"].values)
    return both.all(axis=list(traces["target"].dims).index("trace"))


def _network_name(traces: xr.Dataset) -> str:
    if "scene" not in traces.attrs:
        return ""
    network = Scene.from_json(traces.attrs["scene"]).network
    return f", {_label(network.topology, network.n)} {network.topology}"


def _label(topology: str, n: int) -> str:
    return f"{n}×{n}" if topology == "crosshatch" else f"$N$ = {n}"
