"""Fig. 3: capacities over pretension, at the best force for memory of each spacing."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fiberweb.figures import plots, style

PAPERS_LEAST = 0.01  # N
ASIDE = 1.2  # points from one spacing to the next


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw the pretension study, as `fiberweb.figures` says.

    Args:
        given: "pretension" (`fiberweb.scoring.tables.study`) and "ridge_baselines"
            (`input_baselines`).
    """
    rows = plots.rows_of(given["pretension"], "pretension", setup)
    baselines = given["ridge_baselines"]
    colour = plots.colours(rows["spacing_m"])
    figure = style.figure(style.DOUBLE, 76.0)
    axes = figure.subplots(1, 2)
    for ax, letter, name in zip(axes, "ab", plots.TOTALS):
        _tensions(ax, sorted(rows["tension_N"].unique()))
        plots.lines(ax, rows, "tension_N", name, colour, ASIDE)
        plots.scale(ax, rows, baselines, name)
        plots.baselines(ax, baselines, name)
        title = f"{plots.TOTALS[name]} over pretension ({setup} setup)"
        ax.set_title(style.lettered(letter, title), loc="left")
    plots.spacing_bar(figure, axes, colour)
    handles = plots.key(rows)
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=4)
    return figure


def _tensions(ax: Axes, tensions: list[float]) -> None:
    """Ticks at the tensions, on a log scale that a tension of zero, which a study may have, does
    not break."""
    if tensions[0] > 0:
        ax.set(xscale="log", xlim=(tensions[0] / 1.5, tensions[-1] * 1.5))
    else:
        ax.set_xscale("symlog", linthresh=PAPERS_LEAST)
        ax.set_xlim(-0.5 * PAPERS_LEAST, 1.5 * max(tensions[-1], PAPERS_LEAST))
    ax.set_xticks(tensions, [f"{tension:g}" for tension in tensions])
    ax.minorticks_off()
    ax.set_xlabel("Pretension $F_\\mathrm{t}$ (N)")
