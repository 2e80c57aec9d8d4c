"""Capacities over seeds of the input and over the ridge penalty."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from fiberweb.figures import panels, plots, style

TRAINING = {"marker": "o", "mfc": "white", "mew": 0.7, "ms": 3, "lw": 0.8, "ls": (0, (4, 2))}
TEST = {"marker": "o", "ms": 2.4}
MEAN = {"marker": "s", "ms": 3}
CAP = 2.5  # points: wider than the markers, or small bars would not show
LINE = 0.06  # height of a line of text, in capacity


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw C_nl and C_m of each seed, and over the ridge penalty, as `fiberweb.figures` says.

    Args:
        given: "robustness" (`fiberweb.scoring.tables.study`), "robustness_alpha" (`tables.alphas`)
            and "robustness_baselines" (`input_baselines`, of the first seed).
    """
    seeds = plots.rows_of(given["robustness"], "robustness", setup)
    alphas = plots.rows_of(given["robustness_alpha"], "robustness_alpha", setup)
    baselines = given["robustness_baselines"]
    colour = plots.colours(seeds["n"])
    figure = style.figure(style.DOUBLE, 122.0)
    rows = figure.subfigures(2, 1)
    style.letter(rows[0], "a", f"Seeds of the input ({setup} setup)")
    _panels(rows[0], _seeds, seeds, colour, baselines)
    style.letter(rows[1], "b", f"Ridge penalty, first seed ({setup} setup)")
    _panels(rows[1], _alphas, alphas, colour, baselines)
    unstable = any((frame["status"] == "unstable").any() for frame in (seeds, alphas))
    panels.key(figure, _handles(colour, unstable))
    return figure


def _panels(part: SubFigure, panel, rows: pd.DataFrame, colour: dict, baselines) -> None:
    """One axes for C_nl and one for C_m, on the one scale that all four have."""
    for ax, (name, symbol) in zip(part.subplots(1, 2), plots.TOTALS.items(), strict=True):
        panel(ax, rows, name, colour)
        ax.set(ylabel=f"{panels.CAPACITIES[name]} {symbol}", ylim=(0.0, 1.0))
        plots.baselines(ax, baselines, name)


def _seeds(ax: Axes, rows: pd.DataFrame, name: str, colour: dict) -> None:
    """Each seed with its standard error, and beside them their mean and spread."""
    listed = sorted(rows["seed"].unique())
    place = {seed: at for at, seed in enumerate(listed)}
    for n, frame in rows.groupby("n"):
        at = frame["seed"].map(place)
        ax.errorbar(
            at, frame[name], frame[f"{name}_se"], color=colour[n], ls="", elinewidth=0.8,
            capsize=CAP, **TEST,
        )  # fmt: skip
        style.mark_unstable(ax, list(at[frame["status"] == "unstable"]))
    _mean_of_seeds(ax, rows, name, colour, len(listed))
    ax.axvline(len(listed) - 0.5, color=style.FAINT, lw=0.6)
    ax.set_xticks(range(len(listed) + 1), [*map(str, listed), "mean"])
    ax.set(xlabel="Seed", xlim=(-0.5, len(listed) + 2.6))


def _mean_of_seeds(ax: Axes, rows: pd.DataFrame, name: str, colour: dict, place: int) -> None:
    """Mean and spread of every network's seeds, in figures too, one above the other."""
    of_n = rows.groupby("n")
    spread = pd.DataFrame(
        {"mean": of_n[name].mean(), "sd": of_n[name].std(), "se": of_n[f"{name}_se"].mean()}
    )
    below = -np.inf
    for n, one in spread.dropna(subset="mean").sort_values("mean").iterrows():
        ax.errorbar(
            [place], [one["mean"]], [one["sd"]], color=colour[n], elinewidth=1.2,
            capsize=CAP + 0.5, **MEAN,
        )  # fmt: skip
        below = max(one["mean"], below + LINE)
        known = one[["sd", "se"]].dropna()  # a single seed has no spread, a short run no error
        ax.annotate(
            ", ".join(f"{key} {value:.3f}" for key, value in known.items()), (place, below), (7, 0),
            textcoords="offset points", va="center", fontsize=6,
        )  # fmt: skip


def _alphas(ax: Axes, rows: pd.DataFrame, name: str, colour: dict) -> None:
    """Test and training part over the penalty."""
    for n, frame in rows.groupby("n"):
        frame = frame.sort_values("alpha")
        ax.plot(frame["alpha"], frame[f"{name}_train"], color=colour[n], **TRAINING)
        ax.errorbar(
            frame["alpha"], frame[name], frame[f"{name}_se"], color=colour[n], lw=0.9,
            elinewidth=0.7, capsize=CAP, **TEST,
        )  # fmt: skip
        plots.mark_unstable(ax, frame, "alpha")
    ax.set(xscale="log", xlabel=r"Ridge penalty $\alpha$")
    ax.set_xticks(np.sort(rows["alpha"].unique()))
    ax.minorticks_off()


def _handles(colour: dict, unstable: bool) -> dict[str, Line2D]:
    """The key of both rows."""
    handles = {f"{n}×{n}": Line2D([], [], color=colour[n], lw=2.0) for n in colour}
    handles["test ± standard error"] = Line2D([], [], color=style.INK, **TEST)
    handles["mean ± sd of seeds"] = Line2D([], [], color=style.INK, **MEAN)
    handles["training"] = Line2D([], [], color=style.INK, **TRAINING)
    return handles | panels.baseline_and_unstable(unstable)
