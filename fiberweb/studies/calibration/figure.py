"""The calibration: misfit over the grid of unreported parameters, and its best points against
the paper's four numbers."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import LogLocator, StrMethodFormatter

from fiberweb.figures import panels, plots, style
from fiberweb.studies.calibration.grid import GRID, SIZE

K, NU, GAMMA = GRID
SHOWN = 6  # best points in panel b
SYMBOLS = {
    "c_p4": "$c\\,[P_4]$",
    "c_p7": "$c\\,[P_7]$",
    "recall_200ms": "$c$ at 200 ms",
    "recall_400ms": "$c$ at 400 ms",
}
MISFITS = style.SEQUENTIAL.reversed()  # small ones light, so that ink marks show on them
DARK = 0.45  # share of the map above which numbers on it are white
BEST = {"marker": "*", "ms": 6, "color": style.INK, "mew": 0, "ls": ""}
OUTLINE = {"edgecolor": style.INK, "facecolor": "none", "linewidth": 1.4}
THIN = {"linewidth": 1.0}  # in the list
TOLERANCE = {"color": style.FAINT, "alpha": 0.4, "lw": 0}
PAPER = {"color": style.GREY, "lw": 0.8}


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw the calibration, as `fiberweb.figures` says.

    Args:
        given: "calibration" (`tables.table`) and "calibration_check" (`tables.check`); and, to show
            what readouts of the input alone score, "ridge_baselines" (`input_baselines`), whose
            runs have the same input.
    """
    runs = plots.rows_of(given["calibration"], "calibration", setup)
    roles = given["calibration_check"].set_index("role")
    baselines = given.get("ridge_baselines")
    dense = runs[runs["n"] == SIZE]
    figure = style.figure(style.DOUBLE, 116.0)
    top, bottom = figure.subfigures(2, 1, height_ratios=[58, 58])
    style.letter(top, "a", "Misfit of the 8×8 crosshatch to the paper's four numbers")
    style.letter(bottom, "b", "The grid's best points")
    _maps(top, dense, roles)
    _numbers(bottom, runs, dense, roles, baselines)
    return figure


def _maps(part: SubFigure, dense: pd.DataFrame, roles: pd.DataFrame) -> None:
    """Misfit over stiffness and damping of the crossings, one map a damping of fibres."""
    gammas = sorted(dense[GAMMA].unique())
    known = dense["misfit"].dropna()
    low, high = (known.min(), known.max()) if len(known) else (1.0, 10.0)
    norm = LogNorm(low, max(high, 2.0 * low))
    axes = part.subplots(1, len(gammas), sharey=True, squeeze=False)[0]
    ks, nus = (sorted(dense[name].unique()) for name in (K, NU))
    for ax, gamma in zip(axes, gammas, strict=True):
        rows = dense[dense[GAMMA] == gamma]
        grid = rows.pivot(index=NU, columns=K, values="misfit").reindex(index=nus, columns=ks)
        ax.imshow(grid, norm=norm, cmap=MISFITS, origin="lower", aspect="auto")
        _cells(ax, grid.to_numpy(), norm)
        for role in ("default", "best"):
            if role in roles.index and roles.loc[role, GAMMA] == gamma:
                _mark(ax, role, roles.loc[role], ks, nus)
        _unstable(ax, rows, ks, nus)
        ax.set(title=rf"$\gamma$ = {gamma:g} /s", xlabel="Crossing stiffness $k$ (N/m)")
        ax.set_xticks(range(len(ks)), [f"{k:g}" for k in ks])
        ax.set_yticks(range(len(nus)), [f"{nu:g}" for nu in nus])
        ax.tick_params(length=0)
        ax.spines[:].set_visible(False)
    axes[0].set_ylabel(r"Crossing damping $\nu$ (N s/m)")
    bar = part.colorbar(
        ScalarMappable(norm, MISFITS), ax=axes, pad=0.02, aspect=16,
        ticks=LogLocator(subs=(1, 2, 5)), format=StrMethodFormatter("{x:g}"),
    )  # fmt: skip
    bar.minorticks_off()
    bar.set_label("Misfit")
    bar.outline.set_linewidth(0.4)
    handles = {
        "least misfit": Line2D([], [], **BEST),
        "defaults of the compliant setup": Rectangle((0, 0), 1, 1, **OUTLINE),
    }
    unstable = plots.unstable_key((dense["status"] == "unstable").any())
    panels.key_beside_title(part, handles | unstable)


def _cells(ax: Axes, grid: np.ndarray, norm: LogNorm) -> None:
    for (row, column), value in np.ndenumerate(grid):
        if np.isfinite(value):
            colour = "white" if norm(value) > DARK else style.INK
            ax.text(
                column, row, _misfit(value), color=colour, ha="center", va="center", fontsize=6.5
            )


def _misfit(value: float) -> str:
    """Three digits at most, so that maps and list agree."""
    return f"{value:.{max(0, 2 - int(np.log10(max(value, 1.0))))}f}"


def _mark(ax: Axes, role: str, point: pd.Series, ks: list[float], nus: list[float]) -> None:
    """Outline the defaults' cell; put a star into the corner of the best one."""
    if point[K] not in ks or point[NU] not in nus:
        return  # the defaults need not be on the grid
    x, y = ks.index(point[K]), nus.index(point[NU])
    if role == "best":
        ax.plot(x + 0.34, y + 0.3, gid="best", **BEST)
    else:
        box = Rectangle((x - 0.48, y - 0.47), 0.96, 0.94, gid="default", zorder=3, **OUTLINE)
        ax.add_patch(box)


def _unstable(ax: Axes, rows: pd.DataFrame, ks: list[float], nus: list[float]) -> None:
    lost = rows[rows["status"] == "unstable"]
    places = [(ks.index(k), nus.index(nu)) for k, nu in zip(lost[K], lost[NU], strict=True)]
    if places:
        ax.plot(*np.transpose(places), gid="unstable", **style.UNSTABLE)


def _numbers(
    part: SubFigure, runs: pd.DataFrame, dense: pd.DataFrame, roles: pd.DataFrame,
    baselines: pd.DataFrame | None,
) -> None:  # fmt: skip
    """The four numbers of the best points over the paper's, and C_nl and C_m of each size."""
    points = dense.dropna(subset=["misfit"]).sort_values("misfit", kind="stable")
    default = (points[list(GRID)] == roles.loc["default", list(GRID)]).all(axis=1)
    points = pd.concat([points[:SHOWN], points[SHOWN:][default[SHOWN:]]])
    axes = part.subplots(
        1, len(SYMBOLS) + len(plots.TOTALS), sharey=True, width_ratios=[1, 1, 1, 1, 1.3, 1.3]
    )
    for ax, column in zip(axes, SYMBOLS, strict=False):
        value, tolerance = roles.loc[["paper", "tolerance"], column]
        ax.axvspan(value - tolerance, value + tolerance, **TOLERANCE)
        ax.axvline(value, **PAPER)
        ax.plot(points[column], -np.arange(len(points)), "o", color=style.INK, ms=3)
        ax.set_xlabel(SYMBOLS[column])
        ax.margins(0.12, 0.1)
        ax.locator_params(axis="x", nbins=3)
    for ax, name in zip(axes[len(SYMBOLS) :], plots.TOTALS, strict=True):
        _total(ax, name, points, runs, baselines)
    _list(axes[0], points, default)
    for ax in axes:
        ax.grid(axis="y", color=style.FAINT, lw=0.4)
        ax.set_axisbelow(True)
    handles = {
        "defaults": Rectangle((0, 0), 1, 1, **OUTLINE | THIN),
        "paper ± tolerance": (Patch(**TOLERANCE), Line2D([], [], **PAPER)),
    }
    handles |= {
        f"{n}×{n}": Line2D([], [], ls="", **look) for n, look in _looks(runs).items()
    }  # fmt: skip
    handles["± standard error"] = Line2D([], [], marker="_", ms=6, mew=0.7, ls="", color=style.INK)
    if baselines is not None:
        handles[plots.INPUT_ALONE] = Line2D([], [], **plots.BASELINE_LINE)
    panels.key(part, handles, ncols=len(handles), handlelength=1.4)


def _list(ax: Axes, points: pd.DataFrame, default: pd.Series) -> None:
    """Parameters and misfit of each point beside the axes; those of the defaults are outlined, as
    their cell is."""
    labels = [
        f"{row[K]:g}, {row[NU]:g}, {row[GAMMA]:g}   {_misfit(row['misfit'])}"
        for _, row in points.iterrows()
    ]
    ax.set_yticks(-np.arange(len(points)), labels)
    ax.set_title(r"$k$, $\nu$, $\gamma$   misfit", loc="right", x=-0.06, ha="right", fontsize=6.5)
    for label, outlined in zip(ax.get_yticklabels(), default[points.index], strict=True):
        if outlined:
            label.set_bbox({**OUTLINE, **THIN, "pad": 1.5})


def _looks(runs: pd.DataFrame) -> dict[int, dict]:
    """Of each size: upright marks, that do not hide the short bars across them."""
    look = {"marker": "|", "ms": 5, "mew": 1.0}
    return {n: look | {"color": shade} for n, shade in plots.colours(runs["n"]).items()}


def _total(
    ax: Axes, name: str, points: pd.DataFrame, runs: pd.DataFrame, baselines: pd.DataFrame | None
) -> None:
    """A capacity of every size at the points, with standard errors and baselines."""
    places = -np.arange(len(points))
    for n, look in _looks(runs).items():
        same = points[list(GRID)].merge(runs[runs["n"] == n], on=list(GRID), how="left")
        ax.errorbar(same[name], places, xerr=same[f"{name}_se"], ls="", elinewidth=0.7, **look)
    ax.set(xlabel=plots.TOTALS[name], xlim=(0, 1), xticks=[0, 0.5, 1])
    if baselines is not None:
        for value in baselines[name]:
            ax.axvline(value, zorder=0, **plots.BASELINE_LINE)
        for row, (value, label) in enumerate(plots.baseline_labels(baselines, name, 0.1)):
            ax.annotate(  # one above the other, because the column is narrow
                label, (value, 1.0), (0.0, 1.5 + 7.5 * (row % 2)), textcoords="offset points",
                xycoords=("data", "axes fraction"), ha="center", fontsize=6,
            )  # fmt: skip
