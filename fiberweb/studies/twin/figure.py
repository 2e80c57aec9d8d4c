"""Fig. 5: capacities of the experiment's twin over the motor angle, by target and by group."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fiberweb.figures import panels, plots, style
from fiberweb.scoring.groups import ALL, REDUCED

GROUPS = {
    ALL: "all\nmarkers", "lateral_midpoints": "lateral\nmidpoints",
    "near_springs": "near\nsprings", "near_actuation": "near\nactuation",
    "derivatives": "$u\\,…$\n$u'''$", "powers": "$u\\,…$\n$u^3$", "u": "\n$u$",
}  # fmt: skip
SCORINGS = {"described": "clean scoring", "published": "the authors' scoring"}
OTHER = {"ls": ":", "mfc": "white", "mew": 0.7}  # readings of the frame rate but the first
BAR = 0.38  # width, where groups lie 1 apart
PAPER_RECALL = (0.5, 0.8)  # s, and what c of the 6x6 exceeds there at large angles, by the paper
RECALL_MARK = {"marker": r"$\uparrow$", "color": style.INK, "ms": 7, "mew": 0.3, "ls": ""}
INPUT_LINE = {"u": (0, (4, 2)), "powers": (0, (1, 1.5))}


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw Fig. 5, as `fiberweb.figures` says.

    Args:
        given: "twin" (`tables.by_readouts`) and "twin_curves" (`tables.curves`).
    """
    rows, curves = (plots.rows_of(given[name], name, setup) for name in ("twin", "twin_curves"))
    figure = style.figure(style.DOUBLE, 172.0)
    top, middle, bottom = figure.subfigures(3, 1, height_ratios=[54, 60, 58])
    _over_angle(top, rows, SCORINGS[setup])
    _by_target(middle, curves)
    _by_group(bottom, rows)
    return figure


def _over_angle(part: SubFigure, rows: pd.DataFrame, scoring: str) -> None:
    """C_nl and C_m of all markers over the angle, a line for each size and reading."""
    colour = plots.colours(rows["n"])
    alone = rows[rows["readouts"].isin(list(plots.BASELINES)) & rows["verdict"]]
    baselines = alone.groupby("readouts")[["c_nl", "c_m"]].mean().reset_index(names="readout")
    markers = rows[rows["readouts"] == ALL]
    for ax, letter, name in zip(part.subplots(1, 2), "ab", plots.TOTALS):
        for (n, first, _), frame in markers.groupby(["n", "verdict", "frame_step"]):
            frame = frame.sort_values("angle_deg")
            look = {"color": colour[n], "marker": "o", "ms": 3.0, "lw": 0.9}
            look |= {} if first else OTHER
            plots.points(ax, frame[frame["status"] == "ok"], "angle_deg", name, **look)
        lost = markers[(markers["status"] == "unstable") & markers["verdict"]]
        style.mark_unstable(ax, list(lost["angle_deg"]))
        plots.scale(ax, markers, baselines, name)
        ax.set(xlabel="Motor angle (degrees)", xticks=sorted(markers["angle_deg"].unique()))
        ax.margins(x=0.06)
        plots.baselines(ax, baselines, name)
        panels.letter(ax, letter, f"{panels.CAPACITIES[name]} of the twin, {scoring}")
    panels.key(part, _handles(markers, colour))


def _handles(markers: pd.DataFrame, colour: dict) -> dict[str, Artist]:
    """What the lines of the upper panels mean."""
    handles = {
        f"{n}×{n}": Line2D([], [], color=shade, marker="o", ms=3.0) for n, shade in colour.items()
    }
    for step in sorted(markers.loc[~markers["verdict"], "frame_step"].unique()):
        look = {"color": style.INK, "marker": "o", "ms": 3.0} | OTHER
        handles[f"one frame in {step}, taken for consecutive"] = Line2D([], [], **look)
    return handles | plots.key(markers)


def _by_target(part: SubFigure, curves: pd.DataFrame) -> None:
    """c over Legendre order and over lag, one line an angle, one axes a size."""
    sizes, colour = sorted(curves["n"].unique()), plots.colours(curves["angle_deg"])
    axes = part.subplots(1, 2 * len(sizes), sharey=True)
    for target, letter, title, of_target in zip(
        ("order", "lag"), "cd", ("Legendre polynomials", "Recall"),
        np.split(axes, 2), strict=True,
    ):  # fmt: skip
        panels.letter(of_target[0], letter, title)
        for ax, n in zip(of_target, sizes, strict=True):
            shown = curves[(curves["target"] == target) & (curves["n"] == n)]
            _curves(ax, shown, colour, marker="o" if target == "order" else "")
            ax.text(0.97, 0.97, f"{n}×{n}", transform=ax.transAxes, ha="right", va="top")
            ax.set(xlabel="Order" if target == "order" else "Lag (s)", ylim=(-0.12, 1.03))
        if target == "lag":
            of_target[-1].plot(*PAPER_RECALL, **RECALL_MARK)
        else:
            for ax in of_target:
                ax.set_xticks([1, 4, 7, 10])
    axes[0].set_ylabel("$c$")
    panels.key(
        part,
        {
            "$u$ alone": Line2D([], [], **_look("u")),
            "$u\\,…\\,u^3$ alone": Line2D([], [], **_look("powers")),
            "the paper's 6×6 at large angles: $c$ above": Line2D([], [], **RECALL_MARK),
        },
    )
    plots.colour_bar(
        part, axes, colour, "Motor angle (degrees)", pad=0.01, fraction=0.02, aspect=22
    )


def _curves(ax: Axes, shown: pd.DataFrame, colour: dict, marker: str) -> None:
    """Lines of one size and kind of target; the input's own, at the largest angle, behind them."""
    for angle, frame in shown[shown["readouts"] == ALL].groupby("angle_deg"):
        frame = frame.sort_values("at")
        ax.plot(frame["at"], frame["c"], color=colour[angle], marker=marker, ms=2.2, lw=0.9)
    widest = shown[shown["angle_deg"] == shown["angle_deg"].max()]
    for name in INPUT_LINE:
        frame = widest[widest["readouts"] == name].sort_values("at")
        ax.plot(frame["at"], frame["c"], **_look(name), zorder=1)
    ax.axhline(0.0, color=style.FAINT, lw=0.6, zorder=0)


def _look(name: str) -> dict:
    return plots.BASELINE_LINE | {"ls": INPUT_LINE[name], "lw": 0.9}


def _by_group(part: SubFigure, rows: pd.DataFrame) -> None:
    """What groups of markers keep at the largest angle, beside the input alone."""
    rows = rows[rows["verdict"] & (rows["angle_deg"] == rows["angle_deg"].max())]
    colour = plots.colours(rows["n"])
    shift = BAR * (np.arange(len(colour)) - (len(colour) - 1) / 2)
    for ax, letter, name in zip(part.subplots(1, 2), "ef", plots.TOTALS):
        for (n, shade), aside in zip(colour.items(), shift, strict=True):
            _bars(ax, rows[rows["n"] == n].set_index("readouts"), name, shade, aside)
        _shares(ax, rows, name)
        ax.set_xticks(range(len(GROUPS)), GROUPS.values())
        ax.tick_params(axis="x", length=0, labelsize=6)
        ax.set_ylabel(plots.TOTALS[name])
        angle = f"{rows['angle_deg'].iloc[0]:g} degrees"
        panels.letter(ax, letter, f"{panels.CAPACITIES[name]} at {angle}", pad=12.0)
    handles = {f"{n}×{n}": Patch(facecolor=shade) for n, shade in colour.items()}
    handles["of the input alone"] = Patch(facecolor=style.FAINT, edgecolor=style.GREY)
    panels.key(part, handles)


def _bars(ax: Axes, scored: pd.DataFrame, name: str, shade: Sequence[float], aside: float) -> None:
    """Bars of one size."""
    if scored.loc[ALL, "status"] == "unstable":
        style.mark_unstable(ax, [place + aside for place in range(len(GROUPS))])
        return
    for place, group in enumerate(GROUPS):
        c, error = scored.loc[group, [name, f"{name}_se"]].astype(float)
        alone = {"color": style.FAINT, "edgecolor": style.GREY}
        look = alone if group in plots.BASELINES else {"color": shade}
        ax.bar(
            place + aside, c, BAR, linewidth=0.5, yerr=error,
            error_kw={"elinewidth": 0.7, "ecolor": style.INK}, **look,
        )  # fmt: skip


def _shares(ax: Axes, rows: pd.DataFrame, name: str) -> None:
    """What each group keeps of all markers, of one size after the other, above its bars."""
    c = rows.pivot(index="n", columns="readouts", values=name)
    kept = c.div(c[ALL], axis=0)
    texts = {ALL: "kept (%):"} | {
        group: ", ".join(f"{100 * share:.0f}" for share in kept[group]) for group in REDUCED
    }
    for group, text in texts.items():
        ax.annotate(
            text, ([*GROUPS].index(group), 1.0), xycoords=("data", "axes fraction"), ha="center",
            va="bottom", fontsize=6,
        )  # fmt: skip
