"""Total information-processing capacity by degree and by delay, over size and over force.

Drawing only: every number comes from the tables.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fiberweb.figures import panels, plots, style

CHOICES = {"eq3": "n", "grid": "force_N"}  # what is varied, by where the force comes from
READOUTS = {"u": "$u$", "derivatives": "$u…u'''$", "powers": "$u…u^3$", "delay line": "delay\nline"}
BOUNDS = {
    "effective_rank": ("effective rank", {"marker": "_", "ms": 11, "mew": 1.4}),
    "kernel_rank": ("kernel rank", {"marker": "D", "ms": 3.0, "mew": 0.7, "mfc": "white"}),
}
BOUND = {"color": style.INK, "ls": "none", "zorder": 4}
BAR = 0.68
ROOM = 1.08  # of the scale above what is tallest


def draw(given: dict, setup: str, path: str | Path) -> Figure:
    """Draw the study, as `fiberweb.figures` says.

    Args:
        given: "spectrum" and "spectrum_baselines" (`tables.table` and `tables.baselines`).
    """
    rows = plots.rows_of(given["spectrum"], "spectrum", setup)
    baselines = given["spectrum_baselines"].assign(status="ok")
    colours = {
        "degree": plots.colours(rows["degree"].dropna()),
        "delay_s": _delays(rows["delay_s"].dropna()),
    }
    top = _top(rows, baselines)
    with style.applied():
        figure = style.figure(style.DOUBLE, 116.0)
        axes = figure.subplots(2, 2, width_ratios=[1, 1])
        for row, (choice, varied) in zip(axes, CHOICES.items(), strict=True):
            mine = rows[rows["force_choice"] == choice]
            bodies = dict(list(mine.groupby(varied)))
            labels = [_label(varied, body) for body in bodies.values()]
            if varied == "n":
                bodies |= {name: baselines[baselines["readout"] == name] for name in READOUTS}
                labels += [*READOUTS.values()]
            for ax, by in zip(row, colours, strict=True):
                _stacks(ax, bodies, by, colours[by])
                ax.set_xticks(range(len(bodies)), labels)
                ax.set(xlim=(-0.6, len(bodies) - 0.4), ylim=(0.0, top))
                ax.tick_params(axis="x", length=0)
            row[0].set_ylabel("Processing capacity")
        _words(axes, rows, setup)
        for column, (by, unit) in zip(axes.T, (("degree", 1.0), ("delay_s", 1e3)), strict=True):
            shown = {round(unit * value, 1): colour for value, colour in colours[by].items()}
            name = "Degree" if by == "degree" else "Longest delay (ms)"
            plots.colour_bar(figure, list(column), shown, name, pad=0.01, fraction=0.03, aspect=40)
        panels.key(figure, _handles(rows))
        style.save(figure, path)
    return figure


def _delays(values: pd.Series) -> dict[float, np.ndarray]:
    """Colours of the delays: of another map than those of the degrees."""
    distinct = sorted(set(values))
    return dict(zip(distinct, cm.oslo(np.linspace(0.2, 0.85, len(distinct))), strict=True))


def _top(rows: pd.DataFrame, baselines: pd.DataFrame) -> float:
    """End of the scale, above every bar and every mark of `BOUNDS`."""
    tallest = [each[name].max() for each in (rows, baselines) for name in ("ipc", "ipc_high")]
    return ROOM * np.nanmax([1.0, *tallest, *(rows[name].max() for name in BOUNDS)])


def _stacks(ax: Axes, bodies: Mapping, by: str, colour: dict) -> None:
    """A bar for each body, split by a column, with the interval of the total and its bounds."""
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
        ax.vlines(at, one["ipc_low"], one["ipc_high"], color=style.INK, lw=0.9, zorder=3)
        for name, (_, look) in BOUNDS.items():
            ax.plot(at, one[name], **BOUND | look)
    style.mark_unstable(ax, unstable)


def _label(varied: str, body: pd.DataFrame) -> str:
    one = body.iloc[0]
    if varied == "n":
        signals = "" if pd.isna(one["n_signals"]) else f"\n{one['n_signals']:.0f}"
        return f"{one['n']}×{one['n']}{signals}"
    return f"{one['buckling_number']:.2g}"


def _words(axes: np.ndarray, rows: pd.DataFrame, setup: str) -> None:
    """Titles and labels of x."""
    forced = rows[rows["force_choice"] == "grid"].iloc[0]
    body = f"{forced['n']}×{forced['n']}"
    of = {"degree": f"by degree ({setup} setup)", "delay": f"by delay ({setup} setup)"}
    letters = iter("abcd")
    for row, what in zip(axes, ("Size", f"Force, {body}"), strict=True):
        for ax, split in zip(row, of.values(), strict=True):
            panels.letter(ax, next(letters), f"{what}, {split}")
    for ax in axes[0]:
        ax.set_xlabel("Crosshatch and its number of signals; readouts of the input alone")
    for ax in axes[1]:
        ax.set_xlabel(f"Buckling number {plots.BUCKLING} of the force")


def _handles(rows: pd.DataFrame) -> dict[str, Line2D]:
    bar = Line2D([], [], marker="|", ms=7, mew=0.9, ls="", color=style.INK)
    handles = {"95 % interval of the total": bar}
    handles |= {
        label: Line2D([], [], **BOUND | look)
        for name, (label, look) in BOUNDS.items()
        if rows[name].notna().any()
    }
    if (rows["status"] != "ok").any():
        handles["unstable run"] = Line2D([], [], **style.UNSTABLE)
    return handles
