"""Error against cost, what each simplification changes, and where the steps end."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from fiberweb.figures import plots, style

MARKERS = {"kirchhoff": "o", "cosserat": "s", "elastica": "D"}
COLOUR = dict(zip(MARKERS, style.colours(3), strict=True))
ERRORS = {
    "trajectory_error": "Trajectory error (rms)",
    "c_nl_error": r"Error of $C_\mathrm{nl}$",
    "c_m_error": r"Error of $C_\mathrm{m}$",
}
LEAST = 1e-5  # smaller errors are drawn here
SWEPT = {
    "spacing_m": ("Spacing (mm)", 1e3),
    "diameter_m": ("Diameter (mm)", 1e3),
    "tension_N": ("Tension (N)", 1.0),
    "crossing_stiffness": ("Crossing stiffness (N/m)", 1.0),
    "elements_per_section": ("Elements per section", 1.0),
    "force_N": ("Force (N)", 1.0),
}
MIDDLE = {  # of the box: `limits.Point`'s defaults
    "spacing_m": 0.1,
    "diameter_m": 2e-3,
    "tension_N": 0.01,
    "crossing_stiffness": 70.0,
    "crossing_damping": 3.0,
    "elements_per_section": 4,
    "network": "2x2",
}


@style.drawing
def draw_speed_accuracy(given: dict, setup: str) -> Figure:
    """Error against CPU time, one row a network; columns of `accuracy.COLUMNS`.

    The line is the Pareto front; hollow points are shorter steps on the same mesh. Exudyn, of
    other networks and not timed, is left to the table.
    """
    table = given["speed_accuracy"]
    table = table[(table["setup"] == setup) & table["engine"].isin(MARKERS)]
    networks = list(dict.fromkeys(table["network"]))
    figure = style.figure(style.DOUBLE, 8.0 + 55.0 * len(networks))
    axes = figure.subplots(len(networks), 3, squeeze=False, sharex=True)
    for row, (network, letter) in enumerate(zip(networks, "abcdef")):
        rows = table[table["network"] == network]
        for ax, (column, label) in zip(axes[row], ERRORS.items(), strict=True):
            _front(ax, rows["seconds_per_run"], rows[column])
            _points(ax, rows, column)
            ax.set(xscale="log", yscale="log", ylabel=label)
            ax.margins(0.12, 0.15)
        title = f"{network.replace('x', '×')} crosshatch"
        axes[row, 0].set_title(style.lettered(letter, title), loc="left")
    for ax in axes[-1]:
        ax.set_xlabel("CPU time of a 100 s run (s)")
    figure.legend(*_engine_key(axes[0, 0]), loc="outside upper center", ncols=5)
    return figure


def _points(ax: Axes, rows: pd.DataFrame, column: str) -> None:
    """One marker a row, labelled with its elements per section."""
    seen = set()
    for engine, elements, seconds, error in zip(
        rows["engine"], rows["elements_per_section"].astype(str), rows["seconds_per_run"],
        rows[column],
    ):  # fmt: skip
        again = (engine, elements) in seen
        seen.add((engine, elements))
        face = "white" if again else COLOUR[engine]
        ax.plot(
            seconds, max(error, LEAST), MARKERS[engine], color=COLOUR[engine], mfc=face,
            mew=0.8, zorder=3,
        )  # fmt: skip
        if not again:
            text = "10 mm" if elements == "authors" else elements
            ax.annotate(
                text, (seconds, max(error, LEAST)), (4, 3), textcoords="offset points", fontsize=6
            )


def _front(ax: Axes, cost, error) -> None:
    """Staircase of what nothing beats in both."""
    best, xs, ys = np.inf, [], []
    for x, y in sorted(zip(cost, np.maximum(error, LEAST), strict=True)):
        if y < best:
            best = y
            xs.append(x)
            ys.append(y)
    ax.plot(xs, ys, color=style.FAINT, lw=1.5, zorder=1, drawstyle="steps-post")


def _engine_key(ax: Axes):
    names = {"elastica": "PyElastica"}
    handles = [ax.plot([], [], MARKERS[e], color=COLOUR[e])[0] for e in MARKERS]
    handles += ax.plot([], [], "o", color=style.INK, mfc="white", mew=0.8)
    handles += ax.plot([], [], color=style.FAINT, lw=1.5)
    return handles, [*(names.get(e, e) for e in MARKERS), "shorter step", "Pareto front"]


@style.drawing
def draw_model_ladder(given: dict, setup: str) -> Figure:
    """What each rung changes and costs, and growth out of the plane; columns of
    `accuracy.LADDER_COLUMNS` and `limits.PLANE_COLUMNS`."""
    ladder, plane = given["model_ladder"], given["out_of_plane"]
    figure = style.figure(style.DOUBLE, 120.0)
    top, bottom = figure.subfigures(2, 1, height_ratios=[62, 58])
    style.letter(
        top, "a", f"Each change against the rung above it (4×4, 100 mm, {plots.BUCKLING} = 0.8)"
    )
    style.letter(bottom, "b", "Out of the plane: a push that stays, towards the clamped ends")
    _changes(top.subplots(1, 2, sharey=True, width_ratios=[2, 1]), ladder)
    _growth(bottom.subplots(1, 2), plane)
    return figure


def _changes(axes, ladder: pd.DataFrame) -> None:
    changes, cost = axes
    places = -np.arange(len(ladder))
    series = {
        "trajectory_change": ("trajectories (rms)", "o"),
        "c_nl_change": (r"$C_\mathrm{nl}$", "s"),
        "c_m_change": (r"$C_\mathrm{m}$", "D"),
    }
    for colour, (column, (label, marker)) in zip(style.colours(3), series.items(), strict=True):
        known = ladder[column].notna()
        values = ladder.loc[known, column].clip(lower=1e-11)
        changes.plot(values, places[known], marker, color=colour, label=label)
    changes.set(xscale="log", xlabel="Change")
    changes.set_yticks(places, ladder["change"])
    changes.grid(axis="y", color=style.FAINT, lw=0.4)
    changes.axhline(places[-3] - 0.5, color=style.GREY, lw=0.7, ls=(0, (4, 2)))
    changes.annotate(
        "below: not dropped, but what stiff springs cost", (0, places[-3] - 0.5), (3, 2),
        xycoords=("axes fraction", "data"), textcoords="offset points", fontsize=6,
        color=style.GREY,
    )  # fmt: skip
    changes.legend(loc="upper right", bbox_to_anchor=(1.0, 1.02), ncols=3, columnspacing=1.0)
    cost.barh(places, ladder["seconds_per_run"], height=0.55, color=style.GREY)
    for place, seconds in zip(places, ladder["seconds_per_run"], strict=True):
        cost.annotate(
            f"{seconds:,.3g}" if seconds < 100 else f"{seconds:,.0f}", (seconds, place), (2, 0),
            textcoords="offset points", va="center", fontsize=6,
        )  # fmt: skip
    cost.set(xscale="log", xlabel="CPU time of a 100 s run (s)")
    cost.margins(x=0.25)
    cost.grid(axis="y", color=style.FAINT, lw=0.4)
    cost.set_axisbelow(True)


def _growth(axes, plane: pd.DataFrame) -> None:
    numbers = sorted(plane["buckling_number"].unique())
    for colour, number in zip(style.colours(len(numbers)), numbers, strict=True):
        rows = plane[(plane["buckling_number"] == number) & (plane["out_of_plane_m"] > 0)]
        axes[0].plot(rows["time"], 1e3 * rows["out_of_plane_m"], color=colour, label=f"{number:g}")
        axes[1].plot(rows["time"], rows["out_of_plane_m"] / rows["in_plane_m"], color=colour)
    axes[0].set(yscale="log", ylabel="Largest |z| (mm)")
    axes[1].set(yscale="log", ylabel="Largest |z| / largest in-plane")
    axes[0].legend(title=plots.BUCKLING, ncols=2)
    for ax in axes:
        ax.set_xlabel("Time (s)")


@style.drawing
def draw_stability(given: dict, setup: str) -> Figure:
    """Found over predicted limits along each direction of the box, and all of them at once, with
    the drift of energy in words; columns of `limits.COLUMNS` and `limits.DRIFT_COLUMNS`."""
    table, drift = given["stability"], given["energy_drift"]
    figure = style.figure(style.DOUBLE, 130.0)
    axes = figure.subplots(3, 3)
    _agreement(axes[0, 0], table)
    for ax, (column, (label, unit)) in zip(axes.flat[1:], SWEPT.items()):
        _sweep(ax, table, column, label, unit)
    for ax, engine in zip(axes.flat[7:], ("kirchhoff", "cosserat")):
        _ratios(ax, table, engine)
        _drift(ax, drift[drift["engine"] == engine])
    for letter, ax in zip("abcdefghi", axes.flat):
        ax.set_title(style.lettered(letter, ax.get_title(loc="left")), loc="left")
    handles = [
        axes[0, 0].plot([], [], MARKERS[e], color=COLOUR[e], mfc="none", mew=0.8)[0]
        for e in MARKERS
    ]
    handles += axes[0, 0].plot([], [], color=style.INK)
    handles += axes[0, 0].plot([], [], **style.UNSTABLE)
    names = ["kirchhoff", "cosserat", "PyElastica", "predicted", "automatic step unstable"]
    figure.legend(handles, names, loc="outside upper center", ncols=5)
    return figure


def _agreement(ax: Axes, table: pd.DataFrame) -> None:
    ends = np.array([table["predicted_s"].min() / 2, table["predicted_s"].max() * 2]) * 1e6
    ax.plot(ends, ends, color=style.INK, lw=0.7)
    for engine, rows in table.groupby("engine"):
        ax.plot(
            1e6 * rows["predicted_s"], 1e6 * rows["found_s"], MARKERS[engine],
            color=COLOUR[engine], mfc="none", mew=0.8,
        )  # fmt: skip
    ax.set(xscale="log", yscale="log", xlabel="Predicted limit (µs)", ylabel="Found (µs)")
    plots.logarithmic(ax.xaxis)
    plots.logarithmic(ax.yaxis)
    ax.set_title("All points", loc="left")


def _sweep(ax: Axes, table: pd.DataFrame, column: str, label: str, unit: float) -> None:
    """The points that differ from the middle of the box in this column alone, and in what
    follows it: the force of a buckling number."""
    # under the force that is swept; elsewhere under a gentle one, which the prediction is for
    measured = "found_loaded_s" if column == "force_N" else "found_s"
    for engine in ("cosserat", "kirchhoff"):
        rows = table[table["engine"] == engine]
        same = {name: rows[name] == value for name, value in MIDDLE.items() if name != column}
        alike = np.logical_and.reduce(list(same.values())) & np.isfinite(rows[column])
        if column not in ("spacing_m", "diameter_m", "force_N"):
            alike &= rows["force_N"] == rows.loc[alike, "force_N"].mode()[0]
        rows = rows[alike].sort_values([column, "predicted_s"])
        x = rows[column] * unit
        ax.plot(x, 1e6 * rows["predicted_s"], color=COLOUR[engine], lw=0.8)
        ax.plot(x, 1e6 * rows[measured], MARKERS[engine], color=COLOUR[engine], mfc="none", mew=0.8)
        bad = rows["automatic_step_status"] != "ok"
        ax.plot(x[bad], 1e6 * rows.loc[bad, "predicted_s"], **style.UNSTABLE)
    ax.set(yscale="log", xscale="log", xlabel=label, ylabel="Limit (µs)")
    ax.set_ylim(0.5e6 * table[["predicted_s", measured]].min().min(), 2e6 * table["found_s"].max())
    plots.logarithmic(ax.yaxis)
    if column == "tension_N":
        ax.set_xscale("symlog", linthresh=0.1)
        ax.set_xlim(left=-0.02)
    ticks = {"diameter_m": (0.2, 0.5, 1, 2, 4), "elements_per_section": (2, 4, 8, 16)}
    ticks |= {"tension_N": (0, 0.1, 1, 10, 50)}
    if column in ticks:
        ax.set_xticks(ticks[column], [f"{tick:g}" for tick in ticks[column]])
        ax.minorticks_off()
    else:
        plots.logarithmic(ax.xaxis)


def _ratios(ax: Axes, table: pd.DataFrame, engine: str) -> None:
    """Predicted over found, sorted; the band is within 10 % and never above."""
    rows = table[table["engine"] == engine].sort_values("ratio")
    ax.axhspan(0.9, 1.0, color=style.FAINT, alpha=0.4, lw=0)
    ax.plot(
        np.arange(len(rows)), rows["ratio"], MARKERS[engine], color=COLOUR[engine], mfc="none",
        mew=0.8, ms=2.5,
    )  # fmt: skip
    ax.set(xlabel=f"Points, {engine}", ylabel="Predicted / found")
    ax.set_ylim(min(0.85, rows["ratio"].min() - 0.05), 1.05)


def _drift(ax: Axes, drift: pd.DataFrame) -> None:
    for steps, change in zip(drift["steps"], drift["drift"]):
        ax.set_title(f"Drift {change:.0e} in {steps:.0e} steps", loc="left")
