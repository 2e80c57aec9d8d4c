"""Capacities over seeds of the input and over the ridge penalty.

Drawing only: every number comes from the tables.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from fiberweb.plotting import style, sweep

TRAINING = {"marker": "o", "mfc": "white", "mew": 0.7, "ms": 3, "lw": 0.8, "ls": (0, (4, 2))}
MARGIN = 0.05  # of capacities about what is drawn


def draw(tables: dict[str, pd.DataFrame], setup: str, path: str | Path) -> Figure:
    """Draw C_nl and C_m of each seed, and over the ridge penalty, for one setup.

    Args:
        tables: "robustness" (`tables.study`), "robustness_alpha" (`robustness.alphas`) and
            "robustness_floors" (`tables.floors`, of the first seed).
        setup: "described" or "published".
        path: of the figure; PNG and PDF are written beside each other.

    Returns:
        The figure.

    Raises:
        ValueError: a table has no run of this setup.
    """
    seeds = sweep.rows_of(tables["robustness"], "robustness", setup)
    alphas = sweep.rows_of(tables["robustness_alpha"], "robustness_alpha", setup)
    sizes = sorted(seeds["n"].unique())
    colour = dict(zip(sizes, style.colours(max(len(sizes), 2)), strict=False))
    with style.applied():
        figure = style.figure(style.DOUBLE, 122.0)
        top, bottom = figure.subfigures(2, 1)
        style.letter(top, "a", "Seeds of the input")
        _panels(top, _seeds, seeds, colour, None)
        _key(top, seeds, colour, {
            "± bootstrap standard error": Line2D([], [], color=style.INK, marker="o", ms=3),
            "mean ± standard deviation of seeds": Line2D([], [], color=style.INK, marker="s", ms=4),
        })  # fmt: skip
        style.letter(bottom, "b", "Ridge penalty")
        _panels(bottom, _alphas, alphas, colour, tables["robustness_floors"])
        _key(bottom, alphas, colour, {
            "test": Line2D([], [], color=style.INK, marker="o", ms=3),
            "training": Line2D([], [], color=style.INK, **TRAINING),
            "readouts made of the input alone": Line2D([], [], **sweep.FLOOR_LINE),
        })  # fmt: skip
        style.save(figure, path)
    return figure


def _panels(part: SubFigure, panel, rows: pd.DataFrame, colour: dict, floors) -> None:
    """One axes for C_nl and one for C_m."""
    for ax, (name, symbol) in zip(part.subplots(1, 2), sweep.TOTALS.items(), strict=True):
        panel(ax, rows, name, colour)
        ax.set_ylabel(symbol)
        if floors is not None:
            ax.set_ylim(0.0, 1.0)
            sweep.floors(ax, floors, name)


def _seeds(ax: Axes, rows: pd.DataFrame, name: str, colour: dict) -> None:
    """Each seed with its standard error, and beside them their mean and spread."""
    listed = sorted(rows["seed"].unique())
    place = {seed: at for at, seed in enumerate(listed)}
    for n, frame in rows.groupby("n"):
        at = frame["seed"].map(place)
        ax.errorbar(
            at, frame[name], frame[f"{name}_se"], color=colour[n], marker="o", ms=3, ls="",
            elinewidth=0.8,
        )  # fmt: skip
        style.mark_unstable(ax, list(at[frame["status"] == "unstable"]))
        mean, spread = frame[name].mean(), frame[name].std()
        ax.plot([-0.5, len(listed) - 0.5], [mean] * 2, color=colour[n], lw=0.6, ls=":", zorder=0)
        ax.errorbar(
            [len(listed)], [mean], [spread], color=colour[n], marker="s", ms=4, elinewidth=1.2,
            capsize=2,
        )  # fmt: skip
        ax.annotate(
            f"sd {spread:.3f}\nse {frame[f'{name}_se'].mean():.3f}", (len(listed), mean), (8, 0),
            textcoords="offset points", va="center", fontsize=6, color=colour[n],
        )  # fmt: skip
    ax.axvline(len(listed) - 0.5, color=style.FAINT, lw=0.6)
    ax.set_xticks(range(len(listed) + 1), [*map(str, listed), "mean"])
    ax.set(xlabel="Seed", xlim=(-0.5, len(listed) + 0.9))
    known = pd.concat([rows[name] - rows[f"{name}_se"], rows[name] + rows[f"{name}_se"]]).dropna()
    if len(known):
        ax.set_ylim(max(0.0, known.min() - MARGIN), min(1.0, known.max() + MARGIN))


def _alphas(ax: Axes, rows: pd.DataFrame, name: str, colour: dict) -> None:
    """Test and training part over the penalty."""
    for n, frame in rows.groupby("n"):
        frame = frame.sort_values("alpha")
        ax.plot(frame["alpha"], frame[f"{name}_train"], color=colour[n], **TRAINING)
        ax.errorbar(
            frame["alpha"], frame[name], frame[f"{name}_se"], color=colour[n], marker="o", ms=3,
            lw=0.9, elinewidth=0.7,
        )  # fmt: skip
        style.mark_unstable(ax, list(frame.loc[frame["status"] == "unstable", "alpha"]))
    ax.set(xscale="log", xlabel=r"Ridge penalty $\alpha$")
    ax.set_xticks(np.sort(rows["alpha"].unique()))
    ax.minorticks_off()


def _key(part: SubFigure, rows: pd.DataFrame, colour: dict, marks: dict) -> None:
    handles = {f"{n}×{n}": Line2D([], [], color=colour[n], lw=2.0) for n in colour} | marks
    if (rows["status"] == "unstable").any():
        handles["unstable run"] = Line2D([], [], **style.UNSTABLE)
    part.legend(
        handles.values(), handles.keys(), ncols=len(handles), loc="outside lower center",
        columnspacing=1.2,
    )  # fmt: skip
