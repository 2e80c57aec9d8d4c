"""Fig. 2a and b: capacities over force and spacing and over B, and where C_nl drops."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fiberweb.figures import plots, style
from fiberweb.model.authors import reference_force as authors_reference_force

NOT_RUN = "#ececec"
HALO = [patheffects.withStroke(linewidth=2.2, foreground="white")]
REFERENCE = {"color": style.INK, "lw": 1.0, "ls": (0, (3, 1.5)), "path_effects": HALO}
CRITICAL = {"color": style.INK, "lw": 1.0, "path_effects": HALO}
BEST = {"marker": "o", "mfc": style.INK, "mec": "white", "mew": 0.7, "ms": 3.8, "ls": ""}
ONSET = {"marker": "v", "ms": 4.0, "mew": 0.0, "ls": ""}
CLAIMED = (0.8, 1.5)  # B of the onset, claim R2
BAND = {"color": style.DIVERGING(0.4), "alpha": 0.6, "lw": 0}


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw the ridge, as `fiberweb.figures` says; what was not run stays grey.

    Args:
        given: "ridge" (`fiberweb.scoring.tables.study`), "ridge_onset" (`onset.onsets`) and
            "ridge_baselines" (`input_baselines`). Forces may differ from one spacing to the next.
    """
    ridge = plots.rows_of(given["ridge"], "ridge", setup)
    onset = given["ridge_onset"]
    onset = onset[onset["setup"] == setup]
    baselines = given["ridge_baselines"]
    colour = plots.colours(ridge["spacing_m"])
    size = f"{ridge['n'].iloc[0]}×{ridge['n'].iloc[0]}"
    figure = style.figure(style.DOUBLE, 138.0)
    top, bottom = figure.subfigures(2, 1, height_ratios=[64, 74])
    for ax, letter, name in zip(top.subplots(1, 2), "ab", plots.TOTALS):
        _map(ax, ridge, onset, baselines, name)
        _bar(top, ax, baselines, name)
        title = f"{plots.TOTALS[name]} ({size}, {setup} setup)"
        ax.set_title(style.lettered(letter, title), loc="left")
    *axes, last = bottom.subplots(1, 3, width_ratios=[1, 1, 0.6])
    for ax, letter, name in zip(axes, "cd", plots.TOTALS):
        _over_buckling(ax, ridge, baselines, name, colour)
        title = f"{plots.TOTALS[name]} over {plots.BUCKLING}"
        ax.set_title(style.lettered(letter, title), loc="left")
    _onset(last, onset, colour)
    plots.spacing_bar(bottom, [*axes, last], colour)
    _key(bottom, ridge)
    return figure


def _map(
    ax: Axes, ridge: pd.DataFrame, onset: pd.DataFrame, baselines: pd.DataFrame, name: str
) -> None:
    """One cell a run, the two lines of theory, and the best force of each spacing."""
    cells = ridge.pivot(index="force_N", columns="spacing_m", values=name)
    spacing, force = 1e3 * cells.columns.to_numpy(), cells.index.to_numpy()
    x, y = _edges(spacing), np.exp(_edges(np.log(force)))
    ax.set_facecolor(NOT_RUN)
    ax.pcolormesh(
        x, y, cells, cmap=style.SEQUENTIAL, vmin=0.0, vmax=plots.top(ridge, baselines, name)
    )
    unstable = ridge[ridge["status"] == "unstable"]
    ax.plot(
        1e3 * unstable["spacing_m"], unstable["force_N"], gid="unstable", zorder=5, **style.UNSTABLE
    )
    fine = np.linspace(x[0], x[-1], 200)
    ax.plot(fine, authors_reference_force(1e-3 * fine), **REFERENCE)
    one = (ridge["force_N"] * ridge["spacing_m"] ** 2 / ridge["buckling_number"]).iloc[0]
    ax.plot(fine, one / (1e-3 * fine) ** 2, **CRITICAL)
    ax.plot(1e3 * onset["spacing_m"], onset[f"best_{name}_force_N"], zorder=4, **BEST)
    ax.set(yscale="log", xlim=x[[0, -1]], ylim=y[[0, -1]])
    ax.set(xlabel="Spacing (mm)", ylabel="Force $F_\\mathrm{max}$ (N)")
    plots.logarithmic(ax.yaxis)


def _edges(centres: np.ndarray) -> np.ndarray:
    """Edges of cells around sorted centres, halfway between neighbours, shape (cells + 1,)."""
    gaps = np.diff(centres) if len(centres) > 1 else np.ones(1)
    return np.r_[centres[0] - gaps[0] / 2, centres[:-1] + np.diff(centres) / 2,
                 centres[-1] + gaps[-1] / 2]  # fmt: skip


def _bar(part: SubFigure, ax: Axes, baselines: pd.DataFrame, name: str) -> None:
    """The colour scale, with its ticks on the left and the baselines across it and on the right."""
    bar = part.colorbar(ax.collections[0], ax=ax, pad=0.02, aspect=22)
    bar.ax.yaxis.set_ticks_position("left")
    bar.ax.yaxis.set_label_position("left")
    bar.set_label(plots.TOTALS[name])
    bar.outline.set_linewidth(0.4)
    plots.baselines(bar.ax, baselines, name, zorder=3, color="white", lw=1.0)


def _over_buckling(
    ax: Axes, ridge: pd.DataFrame, baselines: pd.DataFrame, name: str, colour: dict
) -> None:
    """Points over B, joined up to the first buckled run: past it neighbours have little to do with
    each other, and lines would hide the points."""
    ax.axvline(1.0, color=style.INK, lw=1.0, zorder=1)
    plots.lines(ax, ridge, "buckling_number", name, colour, ls="", ms=2.0)
    stable = ridge[ridge["status"] == "ok"].sort_values("buckling_number")
    for spacing, frame in stable.groupby("spacing_m"):
        joined = frame[: (frame["buckling_number"] < 1.0).sum() + 1]
        ax.plot(joined["buckling_number"], joined[name], lw=0.6, color=colour[spacing])
    ax.set(xscale="log", xlabel=f"Buckling number {plots.BUCKLING}")
    plots.scale(ax, ridge, baselines, name)
    plots.logarithmic(ax.xaxis)
    plots.baselines(ax, baselines, name)


def _onset(ax: Axes, onset: pd.DataFrame, colour: dict) -> None:
    """B of the drop of C_nl over spacing; bars end at the two runs that it lies between."""
    ax.axhspan(*CLAIMED, **BAND)
    ax.axhline(1.0, color=style.INK, lw=1.0, zorder=1)
    for row in onset.dropna(subset="onset_B").itertuples():
        bar = [[row.onset_B - row.below_B], [row.above_B - row.onset_B]]
        ax.errorbar(
            1e3 * row.spacing_m, row.onset_B, bar, elinewidth=0.7, color=colour[row.spacing_m],
            gid="onset", **ONSET,
        )  # fmt: skip
    ax.set(yscale="log", xlabel="Spacing (mm)", ylabel=f"Onset {plots.BUCKLING}")
    ax.set_xlim(_edges(1e3 * np.array(list(colour)))[[0, -1]])
    low, high = ax.get_ylim()
    ax.set_ylim(min(low, 0.45), max(high, 2.2))  # room for ticks about 1
    plots.logarithmic(ax.yaxis)
    ax.set_title(style.lettered("e", f"Drop of {plots.TOTALS['c_nl']}"), loc="left")


def _key(part: SubFigure, ridge: pd.DataFrame) -> None:
    handles = {
        "constant deflection (Eq. 3)": Line2D([], [], **REFERENCE),
        f"{plots.BUCKLING} = 1": Line2D([], [], **CRITICAL),
        "best force of a spacing": Line2D([], [], **BEST),
        f"onset that counts as at {plots.BUCKLING} = 1": Patch(**BAND),
    }
    handles |= plots.key(ridge)
    if len(ridge) < ridge["spacing_m"].nunique() * ridge["force_N"].nunique():
        handles["not run"] = Patch(fc=NOT_RUN)
    part.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
