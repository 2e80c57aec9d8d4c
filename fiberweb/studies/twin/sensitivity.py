"""Which observations of the experiment hold, over what the paper does not report of it."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from fiberweb.figures import panels, plots, style
from fiberweb.scoring.groups import ALL

PARAMETERS = {  # label with unit, and what a value is multiplied by
    "none": ("as\nstated", 1.0),
    "tension": ("pretension\n(N)", 1.0),
    "lever": ("lever\n(mm)", 1e3),
    "direction": ("pull to\nsprings", 1.0),
    "damping": ("damping\n(1/s)", 1.0),
    "loss_factor": ("loss\nfactor", 1.0),
    "bond_stiffness": ("bonds\n(N m)", 1.0),
    "youngs_modulus": ("$E$\n(GPa)", 1e-9),
    "marker_noise": ("noise\n(pixels)", 1.0),
}
C_NL, C_M = plots.TOTALS["c_nl"], plots.TOTALS["c_m"]
OBSERVED = {  # by observation and part
    ("E1", "rises with the angle"): f"{C_NL} rises with the angle",
    ("E1", "alike for both"): f"{C_NL} alike for both",
    ("E2", "4x4 rises modestly"): f"4×4: {C_M} rises modestly",
    ("E2", "6x6 begins near zero"): f"6×6: {C_M} near zero at first",
    ("E2", "6x6 rises sharply"): f"6×6: {C_M} rises sharply",
    ("E2", "6x6 ends above 4x4"): f"6×6: {C_M} ends above 4×4",
    ("E3", "6x6 recalls 0.5 s"): "6×6: $c$ > 0.8 for 0.5 s ago",
    ("E4", "strong groups keep"): "strong groups keep",
    ("E4", "near actuation is weaker"): "near actuation weaker",
    ("E4", "memory is kept better"): "memory kept better",
    ("E5", "more memory than simulated"): "more memory than simulated",
}
VERDICTS = {
    "holds": {"marker": "o", "color": style.INK, "ms": 5, "ls": ""},
    "differs": {"marker": "o", "mfc": "white", "mec": style.GREY, "mew": 0.7, "ms": 5, "ls": ""},
    "not computed": {"marker": "_", "color": style.GREY, "ms": 4, "mew": 0.6, "ls": ""},
}
ASIDE = 0.12  # of columns that lie 1 apart, by which sizes are parted
GAP = 0.6  # between parameters
NAMES = 23.0  # points above panel a for the names of the parameters


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw the panel, as `fiberweb.figures` says.

    Args:
        given: "twin_sensitivity" (`tables.sensitivity`) and "twin_observations"
            (`observations.table`).
    """
    rows, verdicts = (
        plots.rows_of(given[name], name, setup)
        for name in ("twin_sensitivity", "twin_observations")
    )
    places = _places(rows)
    figure = style.figure(style.DOUBLE, 158.0)
    axes = figure.subplots(3, 1, sharex=True, height_ratios=[40, 40, 58])
    for ax, letter, name, pad in zip(axes, "ab", plots.TOTALS, (NAMES, 3.0), strict=False):
        _totals(ax, rows, places, name)
        title = f"{panels.CAPACITIES[name]} of the twin, one parameter changed at a time"
        panels.letter(ax, letter, title, pad)
    _verdicts(axes[2], verdicts, places)
    panels.letter(axes[2], "c", f"The paper's observations ({setup} setup)")
    _labels(axes[0], axes[2], places)
    panels.key(figure, _handles(rows))
    return figure


def _places(rows: pd.DataFrame) -> dict[tuple[str, str], float]:
    """Column of each parameter and value, by the value as text."""
    places, at = {}, 0.0
    for parameter in PARAMETERS:
        values = sorted(rows.loc[rows["parameter"] == parameter, "value"].unique())
        for value in values:
            places[parameter, _key(value)] = at
            at += 1.0
        at += GAP if values else 0.0
    return places


def _key(value: float) -> str:
    """A value as text; NaN, of nothing changed, too."""
    return f"{value:g}"


def _totals(ax: Axes, rows: pd.DataFrame, places: dict, name: str) -> None:
    """A capacity of all markers in every column, and what the input alone scores."""
    colour, fill = plots.colours(rows["n"]), _fills(rows)
    markers = rows[rows["readouts"] == ALL]
    for (n, angle), frame in markers.groupby(["n", "angle_deg"]):
        aside = ASIDE * (list(colour).index(n) - (len(colour) - 1) / 2) * 2
        at = [places[p, _key(v)] for p, v in zip(frame["parameter"], frame["value"])]
        frame = frame.assign(at=np.add(at, aside))
        stable = frame[frame["status"] == "ok"]
        look = {"mfc": colour[n] if fill[angle] else "white", "mew": 0.8}
        plots.points(ax, stable, "at", name, color=colour[n], marker="o", ms=3.4, ls="", **look)
        plots.mark_unstable(ax, frame, "at")
    alone = rows[rows["readouts"].isin(["u", "powers"]) & (rows["parameter"] == "none")]
    baselines = alone.groupby("readouts")[["c_nl", "c_m"]].mean().reset_index(names="readout")
    highest = plots.top(markers, baselines, name) + 0.03  # a mark at the end is whole
    ax.set(ylim=(0.0, highest), ylabel=plots.TOTALS[name])
    plots.baselines(ax, baselines, name)


def _fills(rows: pd.DataFrame) -> dict[float, bool]:
    """Which angles have filled marks: the largest."""
    angles = sorted(rows["angle_deg"].unique())
    return {angle: angle == angles[-1] for angle in angles}


def _verdicts(ax: Axes, verdicts: pd.DataFrame, places: dict) -> None:
    """A mark for each part of an observation and column; of what is unknown as a whole, for all."""
    lines = list(OBSERVED)
    for one in verdicts.fillna({"part": ""}).itertuples():
        at = places[one.parameter, _key(one.value)]
        for line, (observation, part) in enumerate(lines):
            if observation == one.observation and one.part in ("", part):
                ax.plot(at, line, **VERDICTS[one.verdict])
    labels = []
    for number, ((observation, _), text) in enumerate(OBSERVED.items()):
        first = number == 0 or lines[number - 1][0] != observation
        labels.append(f"{text}   $\\mathbf{{{observation}}}$" if first else f"{text}        ")
        if first and number:
            ax.axhline(number - 0.5, color=style.FAINT, lw=0.5)
    ax.set_yticks(range(len(lines)), labels)
    ax.set(ylim=(len(lines) - 0.5, -0.5))
    ax.tick_params(length=0)
    ax.spines[:].set_visible(False)


def _labels(top: Axes, bottom: Axes, places: dict) -> None:
    """Values below the columns, parameters above them."""
    texts = []
    for parameter, value in places:
        factor = PARAMETERS[parameter][1]
        texts.append("–" if parameter in ("none", "direction") else f"{float(value) * factor:g}")
    bottom.set_xticks(list(places.values()), texts)
    for parameter, (label, _) in PARAMETERS.items():
        at = [place for (name, _), place in places.items() if name == parameter]
        if at:
            top.annotate(
                label, (np.mean(at), 1.0), (0, 2), xycoords=("data", "axes fraction"),
                textcoords="offset points", ha="center", va="bottom", fontsize=6,
            )  # fmt: skip
    for ax in (top, bottom):
        ax.set_xlim(-0.7, max(places.values()) + 0.7)


def _handles(rows: pd.DataFrame) -> dict[str, Line2D]:
    """What the marks mean."""
    colour, fill = plots.colours(rows["n"]), _fills(rows)
    handles = {}
    for n, shade in colour.items():
        for angle, filled in fill.items():
            handles[f"{n}×{n}, {angle:g}°"] = Line2D(
                [], [], marker="o", ms=3.4, color=shade, mfc=shade if filled else "white", ls=""
            )
    handles |= plots.key(rows)
    return handles | {name: Line2D([], [], **VERDICTS[name]) for name in VERDICTS}
