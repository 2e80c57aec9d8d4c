"""Fig. 2c: capacities over the size of the network, at the best force of each spacing."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from fiberweb.figures import plots, style

RUN = ["force_choice", "spacing_m", "n"]
MARKERS = {  # the shorter step lies upon the longer one
    "last": {"marker": "o", "ms": 4.5, "color": style.INK, "mfc": style.FAINT},
    "first": {"marker": "s", "ms": 2.2, "color": "#2c6e8f"},
}
ASIDE = 0.9  # points from one spacing to the next


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw the size study, as `fiberweb.figures` says.

    C_nl is drawn at the forces chosen for C_nl and C_m at those chosen for C_m: over N, one line a
    spacing, at the longer step where a run was repeated at a shorter one; and over spacing, at both
    steps, for each N that was.

    Args:
        given: "size" (`fiberweb.scoring.tables.study`) and "ridge_baselines" (`input_baselines`).
    """
    size = plots.rows_of(given["size"], "size", setup).sort_values("time_step_s")
    repeated = size[size.duplicated(RUN, keep=False)]
    twice = sorted(repeated["n"].unique())
    over_size = size["n"].nunique() > 1 or not twice
    baselines = given["ridge_baselines"]
    colour = plots.colours(size["spacing_m"])
    letters = iter("abcdefgh")
    figure = style.figure(style.DOUBLE, 76.0 * (over_size + len(twice)))
    parts = iter(figure.subfigures(over_size + len(twice), 1, squeeze=False)[:, 0])
    if over_size:
        part = next(parts)
        rows = size.drop_duplicates(RUN, keep="last")
        axes = part.subplots(1, 2)
        for ax, name in zip(axes, plots.TOTALS, strict=True):
            _over_size(ax, _chosen_for(name, rows), name, colour)
        plots.spacing_bar(part, axes, colour)
        _finish(part, baselines, rows, {}, setup, letters)
    for n in twice:
        part, rows = next(parts), repeated[repeated["n"] == n]
        for ax, name in zip(part.subplots(1, 2), plots.TOTALS, strict=True):
            handles = _over_spacing(ax, _chosen_for(name, rows), name)
        _finish(part, baselines, rows, handles, f"{n}×{n}, {setup}", letters)
    return figure


def _chosen_for(name: str, rows: pd.DataFrame) -> pd.DataFrame:
    """Runs at the force that was chosen for this capacity."""
    return rows[rows["force_choice"].str.endswith(name)]


def _over_size(ax: Axes, rows: pd.DataFrame, name: str, colour: dict) -> None:
    plots.lines(ax, rows, "n", name, colour, ASIDE)
    sizes = sorted(rows["n"].unique())
    ax.set(xticks=sizes, xlim=(sizes[0] - 1.0, sizes[-1] + 1.0))
    ax.set_xlabel("Fibres in each direction, $N$")


def _over_spacing(ax: Axes, rows: pd.DataFrame, name: str) -> dict[str, Line2D]:
    """Both steps over spacing; handles of the legend by label."""
    handles = {}
    for keep, marker in MARKERS.items():
        one = rows.drop_duplicates(RUN, keep=keep).sort_values("spacing_m")
        step = f"{1e6 * one['time_step_s'].median():.3g} µs"
        unstable = one["status"] == "unstable"
        one = one.assign(spacing_mm=1e3 * one["spacing_m"])
        plots.points(ax, one, "spacing_mm", name, ls="", mew=0.8, **marker)
        handles[f"step of {step}"] = Line2D([], [], ls="", mew=0.8, **marker)
        style.mark_unstable(ax, list(one.loc[unstable, "spacing_mm"]))
    ax.set_xlabel("Spacing (mm)")
    return handles


def _finish(
    part: SubFigure, baselines: pd.DataFrame, rows: pd.DataFrame, handles: dict, of: str,
    letters: Iterator[str],
) -> None:  # fmt: skip
    """Scales, baselines, titles and the key of one row of panels."""
    for ax, name in zip(part.axes, plots.TOTALS):
        plots.scale(ax, rows, baselines, name)
        title = f"{plots.TOTALS[name]} at the best force for it ({of} setup)"
        ax.set_title(style.lettered(next(letters), title), loc="left")
        plots.baselines(ax, baselines, name)
    handles = handles | plots.key(rows)
    part.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=5)
