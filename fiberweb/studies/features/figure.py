"""Fig. 4: what groups of readouts score, and how few signals keep the capacity."""

from __future__ import annotations

import numpy as np
import pandas as pd
from cmcrameri import cm
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fiberweb.figures import panels, plots, style
from fiberweb.model.network import Network, crosshatch
from fiberweb.scoring import groups

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
MARKED = {"lateral_midpoints": "s", "near_springs": "^", "near_actuation": "D"}  # in e
# strokes along the displacements that are used
STROKES = {(True, True): "+", (True, False): "_", (False, True): "|"}
STROKE = {"ms": 5.2, "mew": 1.3}
KIND_COLOUR = dict(zip(groups.KINDS, style.colours(3)))
FORCES = cm.oslo  # batlow's colours stand for kinds of readouts here
BAR = 0.26  # width, where groups lie 1 apart
EDGE = {"edgecolor": style.INK, "linewidth": 0.4}  # the palest bars would hardly show without
UNDER = -1  # bars and their errors lie under the baselines, which they would hide
TITLE = 12.0  # points from an axes to its title, with a line of shares between
HELD = {"color": style.GREY, "marker": "s", "ms": 2.4, "mew": 0, "ls": ""}
PULLED = {"color": style.GREY, "marker": ">", "ms": 3, "mew": 0, "ls": ""}
SHUFFLED = {"color": style.INK, "marker": "D", "mfc": "white", "mew": 0.6, "ms": 2.4, "ls": ""}
GROUP = {"color": style.GREY, "mfc": "white", "mew": 0.8, "ms": 3.4, "ls": ""}
RANK_LINE = {"color": style.INK, "lw": 0.8, "ls": (0, (1, 1.5))}


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw Fig. 4, as `fiberweb.figures` says.

    Args:
        given: "features" (`tables.group_table`), "features_greedy" (`tables.greedy_table`) and
            "features_baselines" (`input_baselines`).
    """
    table, greedy = (
        plots.rows_of(given[name], name, setup) for name in ("features", "features_greedy")
    )
    network = crosshatch(int(table["n"].iloc[0]), length=1.0)
    figure = style.figure(style.DOUBLE, 218.0)
    top, middle, bottom = figure.subfigures(3, 1, height_ratios=[45, 117, 56])
    size = f"{network.n}×{network.n}"
    style.letter(top, "a", f"Groups of readouts, {size} crosshatch ({setup} setup)")
    _schematics(top, network)
    _scores(middle, table, given["features_baselines"])
    curves, places = bottom.subfigures(1, 2, width_ratios=[1.3, 1])
    force = f"{greedy['force_N'].iloc[0]:g} N"
    style.letter(curves, "e", f"Signals at {force}, chosen one by one on the training part")
    style.letter(places, "f", "Where the fewest that suffice lie")
    _curves(curves, table, greedy)
    _places(places, network, greedy)
    return figure


def _schematics(part: SubFigure, network: Network) -> None:
    axes = part.subplots(1, 5, width_ratios=[1, 1, 1, 1, 0.7])
    _marked(axes[0], network, groups.ALL)
    axes[0].set_title("Kinds of readouts")
    for ax, group in zip(axes[1:], groups.REDUCED):
        count = _marked(ax, network, group)
        ax.set_title(f"{_name(group).capitalize()} ({count})")
    handles = {
        kind.replace("_", " "): Line2D([], [], color=KIND_COLOUR[kind], marker="o", ms=3, ls="")
        for kind in groups.KINDS
    }
    handles |= {
        label: Line2D([], [], color=style.INK, marker=STROKES[used], ls="", **STROKE)
        for label, used in (
            ("x and y used", (True, True)), ("x used", (True, False)), ("y used", (False, True)),
        )
    }  # fmt: skip
    handles["driven point"] = Line2D([], [], color=style.DRIVE, marker=panels.DRIVEN, ls="")
    handles["held end"], handles["pulled end"] = Line2D([], [], **HELD), Line2D([], [], **PULLED)
    axes[4].axis("off")
    axes[4].legend(handles.values(), handles.keys(), loc="center left", labelspacing=0.4)


def _name(group: str) -> str:
    return NAMES[group].replace("\n", " ")


def _marked(ax: Axes, network: Network, group: str) -> int:
    """The network with a group's readouts marked; returns how many signals they are."""
    points = groups.readouts(network)
    used = groups.mask(group, network, points)
    _network(ax, network)
    _strokes(ax, points, used.reshape(2, -1))
    return int(used.sum())


def _network(ax: Axes, network: Network) -> None:
    panels.network(ax, network, style.FAINT, (-0.03, 1.03))
    held, pulled = network.fibres[:, 0], network.fibres[:, 1]
    ax.plot(*held.T, **HELD)
    ax.plot(*pulled[: network.n].T, **PULLED)
    ax.plot(*pulled[network.n :].T, **PULLED | {"marker": "^"})


def _strokes(ax: Axes, points: pd.DataFrame, used: np.ndarray) -> None:
    """A stroke along each displacement in use, used (2, m)."""
    for kind, colour in KIND_COLOUR.items():
        for (x, y), marker in STROKES.items():
            some = points[(points["kind"] == kind) & (used[0] == x) & (used[1] == y)]
            ax.plot(some["x"], some["y"], marker, color=colour, zorder=4, **STROKE)


def _scores(part: SubFigure, table: pd.DataFrame, baselines: pd.DataFrame) -> None:
    """C_nl, C_m and effective rank of each group at each force."""
    names = [name for name in NAMES if (table["group"] == name).any()]
    forces = sorted(table["force_N"].unique())
    colour = dict(zip(forces, FORCES(np.linspace(0.25, 0.8, len(forces)))))
    shift = dict(zip(forces, BAR * (np.arange(len(forces)) - (len(forces) - 1) / 2)))
    axes = part.subplots(3, 1, sharex=True, height_ratios=[1.1, 1.1, 0.8])
    for ax, letter, (column, symbol) in zip(axes, "bc", plots.TOTALS.items()):
        for force in forces:
            _bars(ax, table[table["force_N"] == force], names, column, colour[force], shift[force])
        _shares(ax, table[table["verdict"]], names, column)
        panels.letter(ax, letter, f"{panels.CAPACITIES[column]} of each group", TITLE)
        ax.set(ylabel=symbol, ylim=(0.0, plots.top(table, baselines, column)))
        plots.baselines(ax, baselines, column)
    ranks, counts = axes[2], table.drop_duplicates("group").set_index("group")["n_signals"]
    for force in forces:
        rank = _one(table[table["force_N"] == force], names)["effective_rank"]
        at = np.arange(len(names)) + shift[force]
        ranks.plot(at, rank, "o", color=colour[force], mec=style.INK, mew=0.4)
    ranks.plot(counts[names].to_numpy(), "_", color=style.INK, ms=20, mew=0.8)
    ranks.annotate(
        "number of signals", (0, counts[names[0]]), (11, 0), textcoords="offset points",
        va="center", fontsize=6,
    )  # fmt: skip
    panels.letter(ranks, "d", "Effective rank of each group")
    ranks.set(ylabel="Effective rank", yscale="log", ylim=(1, 2.5 * counts.max()))
    ranks.set_yticks([1, 10, 100], ["1", "10", "100"])
    ranks.set_xticks(range(len(names)), [f"{NAMES[name]}\n{counts[name]}" for name in names])
    ranks.tick_params(axis="x", length=0)
    ranks.set_xlim(-0.5, len(names) - 0.5)
    panels.key(part, _handles(table, colour), loc="outside upper center", ncols=3)


def _bars(ax: Axes, rows: pd.DataFrame, names: list[str], column: str, colour, shift) -> None:
    """One force: chronological split as bars with standard errors; shuffled, where it counts."""
    at = np.arange(len(names)) + shift
    scored = _one(rows, names)
    if (scored["status"] == "unstable").any():
        style.mark_unstable(ax, list(at))
        return
    ax.bar(
        at, scored[column], BAR, yerr=scored[f"{column}_se"], color=colour, zorder=UNDER, **EDGE,
        error_kw={"elinewidth": 0.7, "capsize": 1.5, "ecolor": style.INK, "zorder": UNDER},
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


def _handles(table: pd.DataFrame, colour: dict) -> dict:
    """What the marks of the scores mean."""
    handles = {}
    for force, rows in table.groupby("force_N"):
        verdict = ", verdicts" if rows["verdict"].any() else ""
        label = f"{force:g} N ({plots.BUCKLING} = {rows['buckling_number'].iloc[0]:.2f}{verdict})"
        handles[label] = Patch(facecolor=colour[force], **EDGE)
    handles["± standard error"] = Line2D([], [], color=style.INK, marker="|", ms=7, mew=0.8, ls="")
    handles["shuffled split"] = Line2D([], [], **SHUFFLED)
    return handles | panels.baseline_and_unstable((table["status"] == "unstable").any())


def _curves(part: SubFigure, table: pd.DataFrame, greedy: pd.DataFrame) -> None:
    """Share of a capacity over the number of signals."""
    scored = _one(table[table["verdict"]], [*groups.REDUCED, "all"])
    for ax, (target, symbol) in zip(part.subplots(1, 2), plots.TOTALS.items()):
        chosen = greedy[greedy["target"] == target]
        if (chosen["status"] == "unstable").any():
            style.mark_unstable(ax, [1.0])
        else:
            _curve(ax, chosen, scored, target)
        ax.set(xscale="log", xlabel="Number of signals", ylabel=f"{symbol} / that of all")
        ax.set_xticks([1, 10, 100], ["1", "10", "100"])
    handles = {
        _name(group): Line2D([], [], marker=marker, **GROUP) for group, marker in MARKED.items()
    }
    panels.key(part, {"chosen signals": Line2D([], [], color=style.INK)} | handles)


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
        0.97, 0.4, f"{needed} signals\nkeep {share:.0%}".replace("%", " %"),
        transform=ax.transAxes, ha="right", va="top",
    )  # fmt: skip
    for group, marker in MARKED.items():
        row = scored.loc[group]
        place = row["n_signals"], row[target] / scored.loc["all", target]
        ax.plot(*place, marker=marker, zorder=5, **GROUP)
    ax.text(rank * 1.15, 0.03, f"effective\nrank {rank:.1f}", fontsize=6)
    ax.set_ylim(0, None)


def _places(part: SubFigure, network: Network, greedy: pd.DataFrame) -> None:
    """The network with the fewest signals that keep the share, for either capacity."""
    for ax, (target, symbol) in zip(part.subplots(1, 2), plots.TOTALS.items()):
        chosen = greedy[greedy["target"] == target]
        _network(ax, network)
        ax.set_title(f"For {symbol}")
        if (chosen["status"] != "unstable").all():
            _fewest(ax, network, chosen)


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
