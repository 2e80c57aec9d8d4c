"""The score card as a figure. Drawing only: every number comes from the card."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from textwrap import fill

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fiberweb.figures import panels, plots, style

READOUTS = {"body": "body", "u": "$u$", "powers": "powers", "derivatives": "derivatives",
            "delay line": "delay line"}  # fmt: skip
SHORT = ("body", "$u$", "powers", "deriv.", "delays")
COLOURS = dict(zip(READOUTS, [style.INK, *style.colours(4)], strict=True))
MARKS = dict(zip(READOUTS, "osD^v", strict=True))
DEGREES = dict(zip((1, 2, 3), style.SEQUENTIAL([0.1, 0.45, 0.7]), strict=True))
COUNTS = {"n_signals": "signals", "rank": "rank", "effective_rank": "effective rank",
          "kernel_rank": "kernel rank", "generalisation_rank": "generalisation rank"}  # fmt: skip
BOUNDS = {
    "n_signals": {"marker": "_", "ms": 11, "mew": 1.0, "color": style.INK, "ls": "none"},
    "effective_rank": {"marker": "_", "ms": 11, "mew": 1.0, "color": style.GREY, "ls": "none"},
}
ERRORS = ("rmse", "nrmse", "nmse")
DEFINED = (
    "RMSE = root of the mean of (estimate − target)²; NRMSE = RMSE / standard deviation of the "
    "target; NMSE = NRMSE² = mean squared error / variance; all on the test part. Capacity "
    "c = 1 − NMSE, C_nl its mean over Legendre polynomials of the input up to order 10, C_m over "
    "lags up to the horizon. Information processing: c of orthogonal functions of the input's "
    "past, added up where it is above that of inputs shuffled in time; at most the number of "
    "signals. Bars: 95 % of what redrawn blocks of the test part give."
)
WIDTH = 128  # characters of a line at the width of the page


def draw(card: Mapping, path: str | Path) -> Figure:
    """Draw a card, as `fiberweb.scoring.card.Card.as_dict` has it; one that was refused has its
    sentence alone."""
    with style.applied():
        said = [_filled(card["verdict"], WIDTH - 18)] + [
            _filled(note, WIDTH + 10) for note in card["notes"]
        ]
        if card["status"] != "ok":
            figure = style.figure(style.DOUBLE, 30.0)
            figure.text(0.01, 0.9, said[0], va="top")
            style.save(figure, path)
            return figure
        said.append(_filled(_about(card["facts"]), WIDTH + 10))
        defined = fill(DEFINED, WIDTH + 14)
        above, below = _height(said), _height([defined])
        figure = style.figure(style.DOUBLE, above + 104.0 + below)
        head, top, middle, foot = figure.subfigures(
            4, 1, height_ratios=[above, 58.0, 46.0, below]
        )  # fmt: skip
        head.text(0.005, 1.0, said[0], va="top", fontsize=7.5, weight="bold")
        lines = said[0].count("\n") + 1
        head.text(0.005, 1.0 - 4.2 * lines / above, "\n".join(said[1:]), va="top", fontsize=6.5)
        foot.text(0.005, 0.98, defined, va="top", fontsize=6)
        scores = pd.DataFrame(card["scores"]).set_index(["quantity", "readout"])
        scores = scores.astype(float)
        axes = top.subplots(1, 4, width_ratios=[0.8, 1.5, 1.2, 1.0])
        _capacities(axes[0], scores)
        _processing(axes[1], scores)
        _delays(axes[2], pd.DataFrame(card["profile"]), card["facts"])
        _tasks(axes[3], scores, card["facts"])
        handles = {
            READOUTS[name]: Line2D([], [], color=COLOURS[name], marker=MARKS[name], ls="none")
            for name in READOUTS
        }
        handles |= {f"degree {d}": Patch(color=c) for d, c in DEGREES.items()}
        handles |= {COUNTS[name]: Line2D([], [], **look) for name, look in BOUNDS.items()}
        panels.key(top, handles, ncols=len(READOUTS))
        _table(middle.subplots(), scores)
        style.save(figure, path)
    return figure


def _filled(text: str, width: int) -> str:
    """A sentence in lines; the names of files in it may have dollars."""
    return style.verbatim(fill(text, width))


def _about(facts: Mapping) -> str:
    """What was scored, and how."""
    recipe = f"recipe {facts['recipe']}, " if facts["recipe"] else ""
    return (
        f"{facts['run']}: {facts['frames']} frames at {facts['rate_Hz']:.4g} Hz, trained on "
        f"{facts['trained_s']:.3g} s, tested on {facts['tested_s']:.3g} s; {recipe}ridge penalty "
        f"{facts['alpha']}; delay line of {facts['taps']} taps, {facts['taps_s']:.2g} s; "
        f"processing capacity of {facts['functions']} functions, "
        f"{facts['delay_step_s']:.2g} s between delays"
    )


def _height(texts: list[str]) -> float:
    """mm that lines of text take."""
    return 3.0 + 3.3 * sum(text.count("\n") + 1 for text in texts)


def _point(ax: Axes, x: float, row: pd.Series, name: str) -> None:
    ax.plot(x, row["value"], marker=MARKS[name], color=COLOURS[name], ms=3.2, ls="none")
    if row.notna().all():
        ax.vlines(x, row["low"], row["high"], color=COLOURS[name], lw=0.7)


def _beside(number: int) -> float:
    return 0.13 * (number - (len(READOUTS) - 1) / 2)


def _capacities(ax: Axes, scores: pd.DataFrame) -> None:
    for at, quantity in enumerate(plots.TOTALS):
        for number, name in enumerate(READOUTS):
            _point(ax, at + _beside(number), scores.loc[(quantity, name)], name)
    ax.set(xlim=(-0.5, 1.5), ylim=(0.0, 1.0), ylabel="Capacity")
    ax.set_xticks(range(2), plots.TOTALS.values())
    panels.letter(ax, "a", "capacities")


def _processing(ax: Axes, scores: pd.DataFrame) -> None:
    for at, name in enumerate(READOUTS):
        below = 0.0
        for degree, colour in DEGREES.items():
            value = scores.loc[(f"ipc_{degree}", name), "value"]
            ax.bar(at, value, bottom=below, color=colour, width=0.65)
            below += value
        total = scores.loc[("ipc", name)]
        if total.notna().all():
            ax.vlines(at, total["low"], total["high"], color=style.INK, lw=0.8)
    ax.set_xticks(range(len(READOUTS)), SHORT)
    ax.set_ylabel("Processing capacity")
    shown = 1.1 * scores.loc["ipc"].max().max()
    for bound, look in BOUNDS.items():
        levels = [scores.loc[(bound, name), "value"] for name in READOUTS]
        ax.plot(range(len(READOUTS)), levels, **look)
        shown = max([shown, *(1.1 * level for level in levels if level < 2 * shown)])
    ax.set_ylim(0.0, shown)  # a bound far above is in the table alone
    panels.letter(ax, "b", "processing")


def _delays(ax: Axes, profile: pd.DataFrame, facts: Mapping) -> None:
    mine = profile[profile["readout"] == "body"]
    table = mine.pivot_table(index="delay_s", columns="degree", values="capacity", aggfunc="sum")
    table = table.fillna(0.0)
    width = min([0.8 * np.diff(1e3 * table.index).min(initial=np.inf), 150.0 * facts["horizon_s"]])
    below = 0.0
    for degree in table:
        ax.bar(1e3 * table.index, table[degree], width, below, color=DEGREES[degree])
        below = below + table[degree]
    ax.set(xlabel="Longest delay (ms)", ylabel="Capacity of the body")
    ax.locator_params(axis="x", nbins=4)
    panels.letter(ax, "c", "by delay")


def _tasks(ax: Axes, scores: pd.DataFrame, facts: Mapping) -> None:
    quantities = [q for q in scores.index.unique("quantity") if q.endswith("_nmse")]
    for at, quantity in enumerate(quantities):
        for number, name in enumerate(READOUTS):
            _point(ax, at + _beside(number), scores.loc[(quantity, name)], name)
    labels = [q.removeprefix("narma").removesuffix("_nmse") for q in quantities]
    ax.set_xticks(range(len(labels)), labels)
    ax.set(xlabel="NARMA-n", ylabel="NMSE", yscale="log")
    ax.set_xlim(-0.5, max(len(labels), 1) - 0.5)
    if facts["bar"]:
        ax.axhline(facts["bar"], **plots.BASELINE_LINE)
    if quantities:
        plots.logarithmic(ax.yaxis)
    panels.letter(ax, "d", "tasks")


def _table(ax: Axes, scores: pd.DataFrame) -> None:
    """Capacities and counts on the left, errors on the right, a column for each readout."""
    errors = {
        f"{task}_{error}": f"NARMA-{task.removeprefix('narma')} {error.upper()}"
        for task, _, error in (name.rpartition("_") for name in scores.index.unique("quantity"))
        if error in ERRORS
    }
    sides = plots.TOTALS | {"ipc": "processing"} | COUNTS, errors
    lines = 1 + max(map(len, sides))
    for side, quantities in enumerate(filter(None, sides)):
        rows = [["", *SHORT]] + [
            [label, *(_number(scores.loc[(name, readout), "value"]) for readout in READOUTS)]
            for name, label in quantities.items()
        ]
        for line, row in enumerate(rows):
            _line(ax, side, (line + 0.5) / lines, row)
    ax.set_axis_off()


def _line(ax: Axes, side: int, down: float, cells: list[str]) -> None:
    """A line of the table, in its left or right half: a name, then a number for each readout; down:
    share of the height from the top."""
    ends = 0.5 * side + 0.16 + 0.064 * np.arange(len(cells))
    for end, cell in zip(ends, cells, strict=True):
        ax.text(end, 1.0 - down, cell, ha="right", va="center", fontsize=6.5)


def _number(value: float) -> str:
    if pd.isna(value):
        return "–"
    return f"{value:.3g}" if abs(value) >= 0.01 else f"{value:.2g}"
