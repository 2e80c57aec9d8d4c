"""Total information-processing capacity by degree and by delay, over size and over force, and
beside what bounds it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pandas as pd
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from fiberweb.figures import panels, plots, style

CHOICES = {"eq3": "n", "grid": "force_N"}  # what is varied, by where the force comes from
READOUTS = {"u": "$u$", "derivatives": "deriv.", "powers": "powers", "delay line": "delays"}
SPLITS = {"degree": ("Degree", 1.0), "delay_s": ("Longest delay (ms)", 1e3)}
TITLES = ("By degree", "By delay", "Against its bound")
AGAINST = {  # a column of the table to what it is called and how it is drawn
    "n_signals": ("signals (the bound)", {"color": style.INK, "lw": 1.0}),
    "kernel_rank": ("kernel rank", {"color": style.GREY, "marker": "s", "mfc": "white"}),
    "effective_rank": ("effective rank", {"color": style.GREY, "marker": "D", "ls": "--"}),
    "ipc": ("total capacity", {"color": style.SEQUENTIAL(0.45), "marker": "o", "zorder": 4}),
}
LINE = {"lw": 0.8, "ms": 3.0, "mew": 0.7}
HALO = [withStroke(linewidth=2.2, foreground="white")]  # for dark bars
INTERVAL = {"color": style.INK, "lw": 0.9, "zorder": 3, "path_effects": HALO}
BAR = 0.7
ROOM = 1.06  # of the scale above what is tallest


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw the study, as `fiberweb.figures` says.

    Args:
        given: "spectrum" and "spectrum_baselines" (`tables.table` and `tables.baselines`).
    """
    rows = plots.rows_of(given["spectrum"], "spectrum", setup)
    alone = given["spectrum_baselines"].assign(status="ok")
    alone = {name: alone[alone["readout"] == name] for name in READOUTS}
    every = pd.concat([rows, *alone.values()])
    colours = {"degree": plots.colours(every["degree"].dropna()), "delay_s": _delays(every)}
    letters = iter("abcdef")
    figure = style.figure(style.DOUBLE, 112.0)
    axes = figure.subplots(2, 3, width_ratios=[1.25, 1.25, 1.0])
    for line, (choice, varied) in zip(axes, CHOICES.items(), strict=True):
        mine = rows[rows["force_choice"] == choice]
        bodies = dict(list(mine.groupby(varied)))
        shown = bodies | (alone if varied == "n" else {})
        n = mine["n"].iloc[0]
        of = f" ({setup} setup)" if varied == "n" else f", {n}×{n}"
        for ax, by in zip(line, colours, strict=False):
            _stacks(ax, shown, by, colours[by])
            ax.set(ylim=(0.0, ROOM * every[["ipc", "ipc_high"]].max().max()))
        _against(line[2], pd.concat([body.iloc[:1] for body in bodies.values()]))
        for ax, many, title in zip(line, (shown, shown, bodies), TITLES, strict=True):
            _scale(ax, varied, many)
            panels.letter(ax, next(letters), title + (of if ax is not line[2] else ""))
        line[0].set_ylabel("Processing capacity")
        line[2].set_ylabel("Capacity, or count")
    for column, (by, (name, unit)) in zip(axes.T, SPLITS.items(), strict=False):
        fields = {round(unit * value, 1): colour for value, colour in colours[by].items()}
        place = {"location": "bottom", "pad": 0.02, "fraction": 0.03, "aspect": 40}
        plots.colour_bar(figure, list(column), fields, name, **place)
    panels.key(figure, _handles(rows))
    return figure


def _delays(rows: pd.DataFrame) -> dict[float, np.ndarray]:
    """Colours of the delays: of another map than those of the degrees."""
    distinct = sorted(rows["delay_s"].dropna().unique())
    return dict(zip(distinct, cm.lajolla_r(np.linspace(0.2, 0.9, len(distinct))), strict=True))


def _stacks(ax: Axes, bodies: Mapping, by: str, colour: dict) -> None:
    """A bar for each body, split by a column, with the interval of the total."""
    unstable = []
    for at, body in enumerate(bodies.values()):
        one = body.iloc[0]
        if one["status"] != "ok":
            unstable.append(at)
            continue
        below = 0.0
        for value, part in body.groupby(by)["capacity"].sum().items():
            ax.bar(at, part, BAR, below, color=colour[value], lw=0)
            below += part
        ax.vlines(at, one["ipc_low"], one["ipc_high"], **INTERVAL)
    style.mark_unstable(ax, unstable)


def _against(ax: Axes, rows: pd.DataFrame) -> None:
    """The total and what bounds it, on a log scale; one row for each body."""
    for name, (_, look) in AGAINST.items():
        ax.plot(range(len(rows)), rows[name], **LINE | look)
    ax.vlines(range(len(rows)), rows["ipc_low"], rows["ipc_high"], **INTERVAL)
    ax.set(yscale="log", ylim=(0.7, 1.6 * rows["n_signals"].max(skipna=True)))
    plots.logarithmic(ax.yaxis)


def _scale(ax: Axes, varied: str, bodies: Mapping) -> None:
    """Names of the bodies below the axis; where B = 1 lies among forces."""
    first = [body.iloc[0] for body in bodies.values()]
    if varied == "n":
        names = [READOUTS[one["readout"]] if name in READOUTS else str(one["n"])
                 for name, one in zip(bodies, first, strict=True)]  # fmt: skip
        ax.set_xlabel("$N$, or readout of the input" if set(READOUTS) & set(bodies) else "$N$")
    else:
        numbers = [one["buckling_number"] for one in first]
        names = [f"{number:.1f}" if number < 10 else f"{number:.0f}" for number in numbers]
        ax.axvline(sum(np.array(numbers) < 1) - 0.5, color=style.GREY, lw=0.6, ls=":", zorder=0)
        ax.set_xlabel(f"Buckling number {plots.BUCKLING}")
    ax.set_xticks(range(len(names)), names)
    for name, label in zip(bodies, ax.get_xticklabels(), strict=True):
        label.set_rotation(90 if name in READOUTS and name != "u" else 0)
    ax.set_xlim(-0.6, len(names) - 0.4)
    ax.tick_params(axis="x", length=0)


def _handles(rows: pd.DataFrame) -> dict[str, Line2D]:
    handles = {
        label: Line2D([], [], **LINE | look)
        for name, (label, look) in AGAINST.items()
        if rows[name].notna().any()
    }
    handles["95 % interval"] = Line2D([], [], marker="|", ms=7, mew=0.9, ls="", color=style.INK)
    return handles | plots.unstable_key((rows["status"] != "ok").any())
