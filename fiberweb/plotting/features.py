"""Fig. 4: what groups of readouts score, and how few signals keep the capacity.

Drawing only: every number comes from the tables.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from fiberweb import groups
from fiberweb.network import Network, crosshatch
from fiberweb.plotting import style, sweep

TOTALS = {"c_nl": r"$C_\mathrm{nl}$", "c_m": r"$C_\mathrm{m}$"}
NAMES = {
    "all": "all outputs",
    "crossing_x": "crossings\nx",
    "crossing_y": "crossings\ny",
    "horizontal_midpoint_x": "horizontal\nmidpoints x",
    "horizontal_midpoint_y": "horizontal\nmidpoints y",
    "vertical_midpoint_x": "vertical\nmidpoints x",
    "vertical_midpoint_y": "vertical\nmidpoints y",
    "lateral_midpoints": "lateral\nmidpoints",
    "near_springs": "near\nsprings",
    "near_actuation": "near\nactuation",
}
# letter in panel c, and where it stands beside its point, in points
SHORT = {
    "lateral_midpoints": ("L", (-7, -3)),
    "near_springs": ("S", (3, -7)),
    "near_actuation": ("A", (-2, -10)),
}
# strokes along the displacements that are used
STROKES = {(True, True): "+", (True, False): "_", (False, True): "|"}
KIND_COLOUR = dict(zip(groups.KINDS, style.colours(3)))
FORCES = cm.oslo  # batlow's colours stand for kinds of readouts here
BAR = 0.26  # width, where groups lie 1 apart
HELD = {"color": style.GREY, "marker": "s", "ms": 2.4, "mew": 0, "ls": ""}
PULLED = {"color": style.GREY, "marker": ">", "ms": 3, "mew": 0, "ls": ""}
SHUFFLED = {"color": style.INK, "marker": "D", "mfc": "white", "mew": 0.6, "ms": 2.4, "ls": ""}
RANK_LINE = {"color": style.INK, "lw": 0.8, "ls": (0, (1, 1.5))}


def draw(tables: dict[str, pd.DataFrame], setup: str, path: str | Path) -> Figure:
    """Draw Fig. 4 for one setup and write it as PNG and PDF.

    Args:
        tables: "features" and "features_greedy" from `fiberweb.features`, of which rows of other
            setups are left out, and "features_floors" from `fiberweb.tables.floors`. An unstable
            run is drawn as an X.
        setup: "described" or "published".
        path: of the figure; both suffixes are written beside each other.

    Raises:
        ValueError: the table has no run of this setup.
    """
    table, greedy = (
        frame[frame["setup"] == setup]
        for frame in (tables["features"], tables["features_greedy"])
    )  # fmt: skip
    if table.empty:
        raise ValueError(f"the features table has no run of the {setup} setup to draw")
    network = crosshatch(int(table["n"].iloc[0]), length=1.0)
    with style.applied():
        figure = style.figure(style.DOUBLE, 205.0)
        top, middle, bottom = figure.subfigures(3, 1, height_ratios=[46, 103, 56])
        size = f"{network.n}×{network.n}"
        style.letter(top, "a", f"Groups of readouts, {size} crosshatch ({setup} setup)")
        _schematics(top, network)
        style.letter(middle, "b", "Scores")
        _scores(middle, table, tables["features_floors"])
        force = f"{greedy['force_N'].iloc[0]:g} N"
        title = f"Fewest signals at {force}, chosen one by one on the training part"
        style.letter(bottom, "c", f"{title} (L, S, A: the last three groups)")
        _selection(bottom, network, table, greedy)
        style.save(figure, path)
    return figure


def _schematics(part: SubFigure, network: Network) -> None:
    axes = part.subplots(1, 5, width_ratios=[1, 1, 1, 1, 0.75])
    _marked(axes[0], network, groups.ALL)
    axes[0].set_title("kinds of readouts")
    for ax, group in zip(axes[1:], groups.REDUCED):
        count = _marked(ax, network, group)
        ax.set_title(f"{NAMES[group].replace(chr(10), ' ')} ({count} signals)")
    handles = {
        kind.replace("_", " "): Line2D([], [], color=KIND_COLOUR[kind], marker="o", ms=3, ls="")
        for kind in groups.KINDS
    }
    handles |= {
        label: Line2D([], [], color=style.INK, marker=STROKES[used], ms=4, mew=1.0, ls="")
        for label, used in (
            ("x and y used", (True, True)), ("x used", (True, False)), ("y used", (False, True)),
        )
    }  # fmt: skip
    handles["driven point"] = Line2D([], [], color=style.DRIVE, marker=r"$\updownarrow$", ls="")
    handles["held end"], handles["pulled end"] = Line2D([], [], **HELD), Line2D([], [], **PULLED)
    axes[4].axis("off")
    axes[4].legend(handles.values(), handles.keys(), loc="center left", labelspacing=0.4)


def _marked(ax: Axes, network: Network, group: str) -> int:
    """The network with a group's readouts marked; returns how many signals they are."""
    points = groups.readouts(network)
    used = groups.mask(group, network, points)
    _network(ax, network)
    _strokes(ax, points, used.reshape(2, -1))
    return int(used.sum())


def _network(ax: Axes, network: Network) -> None:
    ax.add_collection(LineCollection(network.fibres, colors=style.FAINT, linewidths=0.5))
    near, far = network.fibres[network.driven_fibre]
    driven = near + (far - near) * network.driven_distance / network.length
    ax.plot(*driven, marker=r"$\updownarrow$", ms=8, color=style.DRIVE, zorder=3)
    held, pulled = network.fibres[:, 0], network.fibres[:, 1]
    ax.plot(*held.T, **HELD)
    ax.plot(*pulled[: network.n].T, **PULLED)
    ax.plot(*pulled[network.n :].T, **PULLED | {"marker": "^"})
    limits = (-0.03, 1.03)
    ax.set(aspect="equal", xlim=limits, ylim=limits)
    ax.axis("off")


def _strokes(ax: Axes, points: pd.DataFrame, used: np.ndarray) -> None:
    """A stroke along each displacement in use, used (2, m)."""
    for kind, colour in KIND_COLOUR.items():
        for (x, y), marker in STROKES.items():
            some = points[(points["kind"] == kind) & (used[0] == x) & (used[1] == y)]
            ax.plot(some["x"], some["y"], marker, color=colour, ms=4, mew=1.0, zorder=4)


def _scores(part: SubFigure, table: pd.DataFrame, floors: pd.DataFrame) -> None:
    """C_nl, C_m and effective rank of each group at each force."""
    names = [name for name in NAMES if (table["group"] == name).any()]
    forces = sorted(table["force_N"].unique())
    colour = dict(zip(forces, FORCES(np.linspace(0.25, 0.8, len(forces)))))
    shift = dict(zip(forces, BAR * (np.arange(len(forces)) - (len(forces) - 1) / 2)))
    axes = part.subplots(3, 1, sharex=True, height_ratios=[1.1, 1.1, 0.8])
    for ax, (column, symbol) in zip(axes, TOTALS.items()):
        for force in forces:
            _bars(ax, table[table["force_N"] == force], names, column, colour[force], shift[force])
        for value in floors[column]:
            ax.axhline(value, zorder=3, **sweep.FLOOR_LINE)
        _shares(ax, table[table["verdict"]], names, column)
        ax.set(ylabel=symbol, ylim=(0, None))
    ranks, counts = axes[2], table.drop_duplicates("group").set_index("group")["n_signals"]
    for force in forces:
        rank = _one(table[table["force_N"] == force], names)["effective_rank"]
        ranks.plot(np.arange(len(names)) + shift[force], rank, "o", color=colour[force])
    ranks.plot(counts[names].to_numpy(), "_", color=style.INK, ms=20, mew=0.8)
    ranks.annotate(
        "number of signals", (0, counts[names[0]]), (11, 0), textcoords="offset points",
        va="center", fontsize=6,
    )  # fmt: skip
    ranks.set(ylabel="Effective rank", yscale="log", ylim=(1, 2.5 * counts.max()))
    ranks.set_yticks([1, 10, 100], ["1", "10", "100"])
    ranks.set_xticks(range(len(names)), [f"{NAMES[name]}\n{counts[name]}" for name in names])
    ranks.tick_params(axis="x", length=0)
    ranks.set_xlim(-0.5, len(names) - 0.5)
    _key(part, table, colour)


def _bars(ax: Axes, rows: pd.DataFrame, names: list[str], column: str, colour, shift) -> None:
    """One force: chronological split as bars with standard errors; shuffled, where it counts."""
    at = np.arange(len(names)) + shift
    scored = _one(rows, names)
    if (scored["status"] == "unstable").any():
        style.mark_unstable(ax, list(at))
        return
    ax.bar(
        at, scored[column], BAR, yerr=scored[f"{column}_se"], color=colour,
        error_kw={"elinewidth": 0.6, "ecolor": style.INK}, linewidth=0,
    )  # fmt: skip
    if column == "c_nl":
        ax.plot(at, _one(rows, names, "shuffled")[column], zorder=4, **SHUFFLED)


def _one(rows: pd.DataFrame, names: list[str], split: str = "chronological") -> pd.DataFrame:
    """Rows of one force and split, by group."""
    return rows[rows["split"] == split].set_index("group").loc[names]


def _shares(ax: Axes, verdict: pd.DataFrame, names: list[str], column: str) -> None:
    """What each group keeps of all outputs at the verdict force, above its bars."""
    if verdict.empty or (verdict["status"] == "unstable").any():
        return
    kept = _one(verdict, names)[column]
    texts = [f"{kept[name] / kept['all']:.0%}".replace("%", " %") for name in names]
    texts[names.index("all")] = f"kept at {verdict['force_N'].iloc[0]:g} N:"
    for place, text in enumerate(texts):
        ax.annotate(
            text, (place, 1.0), xycoords=("data", "axes fraction"), ha="center", va="bottom",
            fontsize=6.5,
        )  # fmt: skip


def _key(part: SubFigure, table: pd.DataFrame, colour: dict) -> None:
    """What the marks mean, on the title's line."""
    handles = {}
    for force, rows in table.groupby("force_N"):
        verdict = ", verdicts" if rows["verdict"].any() else ""
        label = f"{force:g} N (B = {rows['buckling_number'].iloc[0]:.2f}{verdict})"
        handles[label] = Line2D([], [], color=colour[force], lw=4)
    handles["shuffled split"] = Line2D([], [], **SHUFFLED)
    handles["input alone"] = Line2D([], [], **sweep.FLOOR_LINE)
    if (table["status"] == "unstable").any():
        handles["unstable run"] = Line2D([], [], **style.UNSTABLE)
    legend = part.legend(
        handles.values(), handles.keys(), ncols=len(handles), loc="upper right",
        bbox_to_anchor=(0.995, 1.0), columnspacing=1.0, handlelength=1.2, handletextpad=0.5,
    )  # fmt: skip
    legend.set_in_layout(False)  # it shares the line of the title, which reserves the room


def _selection(
    part: SubFigure, network: Network, table: pd.DataFrame, greedy: pd.DataFrame
) -> None:
    """Share of a capacity over the number of signals, and where the fewest lie."""
    axes = part.subplots(1, 4, width_ratios=[1.35, 1.35, 1, 1])
    scored = _one(table[table["verdict"]], [*groups.REDUCED, "all"])
    for curve, place, (target, symbol) in zip(axes[:2], axes[2:], TOTALS.items()):
        chosen = greedy[greedy["target"] == target]
        _network(place, network)
        place.set_title(f"the fewest for {symbol}")
        if (chosen["status"] == "unstable").any():
            style.mark_unstable(curve, [1.0])
        else:
            _curve(curve, chosen, scored, target)
            _fewest(place, network, chosen)
        curve.set(xscale="log", xlabel="Number of signals", ylabel=f"{symbol} / that of all")
        curve.set_xticks([1, 10, 100], ["1", "10", "100"])


def _curve(ax: Axes, chosen: pd.DataFrame, scored: pd.DataFrame, target: str) -> None:
    """Share kept on the test part, groups of the paper for comparison, and effective rank."""
    share, needed = chosen["share"].iloc[0], int(chosen["needed"].iloc[0])
    ax.axhline(share, color=style.GREY, lw=0.7)
    rank = scored.loc["all", "effective_rank"]
    ax.axvline(rank, **RANK_LINE)
    ax.plot(chosen["n_chosen"], chosen["kept"], color=style.INK)
    kept = chosen.set_index("n_chosen").loc[needed, "kept"]
    ax.plot(needed, kept, "o", color=style.INK, ms=4, zorder=4)
    ax.text(
        0.97, 0.6, f"{needed} signals\nkeep {share:.0%}".replace("%", " %"),
        transform=ax.transAxes, ha="right", va="top",
    )  # fmt: skip
    for group, (letter, beside) in SHORT.items():
        row = scored.loc[group]
        place = row["n_signals"], row[target] / scored.loc["all", target]
        ax.plot(*place, "s", color=style.GREY, ms=2.5)
        label = ax.annotate(letter, place, beside, textcoords="offset points", fontsize=6)
        label.set_bbox({"facecolor": "white", "edgecolor": "none", "pad": 0.2})
    ax.text(rank * 1.15, 0.03, f"effective\nrank {rank:.1f}", fontsize=6)
    ax.set_ylim(0, None)


def _fewest(ax: Axes, network: Network, chosen: pd.DataFrame) -> None:
    """The signals that keep the share."""
    chosen = chosen[chosen["n_chosen"] <= chosen["needed"]]
    points = groups.readouts(network)
    keys = ["kind", "fibre", "section"]
    used = [
        pd.MultiIndex.from_frame(points[keys]).isin(
            pd.MultiIndex.from_frame(chosen.loc[chosen["axis"] == axis, keys])
        )
        for axis in "xy"
    ]
    _strokes(ax, points, np.array(used))
