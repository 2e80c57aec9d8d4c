"""What carries memory: the Laplace filter, the crossings, or the damping of fibres or material."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from fiberweb.figures import panels, plots, style

K, NU, GAMMA = "crossing_stiffness_N_m", "crossing_damping_Ns_m", "damping_per_s"
LOSS = "loss_factor"
# tan(delta) of real fibres near 10 Hz: Ferry, Viscoelastic Properties of Polymers (1980), nylon and
# silicone rubber; Yang et al., J. Appl. Phys. 97 (2005), and Blackledge et al., J. R. Soc.
# Interface 9 (2012), dragline silk
MATERIALS = {"nylon": (0.02, 0.1), "silicone": (0.05, 0.2), "silk": (0.1, 0.3)}
FILTER, ELEMENTS, STEP = "filter_order", "elements_per_section", "time_step_s"
# C_nl and C_m by N of 500 mm crosshatches, from the authors' own density table (their public
# code repository), which Fig. 1 of the paper draws
AUTHORS_TABLE = pd.DataFrame(
    {"c_nl": [0.535, 0.805, 0.908], "c_m": [0.165, 0.375, 0.570]}, [2, 4, 8]
)
NONE, SPRING, FIBRE, NUMERICS, MATERIAL = (style.GREY, *style.colours(5)[:4])
TABLE = {"color": style.INK, "marker": "_", "ms": 10, "mew": 1.4, "ls": ""}
MARK = {"ms": 2.8, "lw": 0.8, "elinewidth": 0.7}  # small, for the bars to show
OFF = {"mfc": "white", "mew": 0.6, "ls": ":"}
ASIDE = 2.5  # points to the side of marks that nearly agree
TINTED = "Numerics (the authors' crossings)"
TINT = "#f1efe9"  # behind what is numerics
AUTHORS_ELEMENT = 10.0  # mm
KEY_LINE = 0.069  # share of the height of panel a
AXIS = (-0.03, 1.03)
COLUMNS = {  # of panel b: title and label of x
    K: ("Crossing\nspring", "$k$ (N/m)"),
    NU: ("Crossing\ndamper", r"$\nu$ (N s/m)"),
    GAMMA: ("Fibre damping,\nsprings, dampers", r"$\gamma$ (1/s)"),
    "pinned": ("Fibre damping,\npinned", r"$\gamma$ (1/s)"),
    LOSS: ("Material,\npinned", r"$\tan\delta$ at 10 Hz"),
    FILTER: ("Numerics:\nLaplace filter", "Element length (mm)"),
}


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw the study, as `fiberweb.figures` says: panels a and b of the compliant setup, of the
    published one the authors' networks with and without the filter.

    Args:
        given: "memory_origin" (`fiberweb.scoring.tables.study`) and "memory_origin_baselines"
            (`input_baselines`).
    """
    rows = plots.rows_of(given["memory_origin"], "memory_origin", setup)
    baseline = given["memory_origin_baselines"]
    if setup == "published":
        figure = style.figure(style.DOUBLE, 66.0)
        style.letter(figure, "a", "Memory of the authors' networks (published setup)")
        _totals(figure, _filter_series(rows), rows, baseline)
    else:
        figure = style.figure(style.DOUBLE, 174.0)
        top, bottom = figure.subfigures(2, 1, height_ratios=[66, 108])
        style.letter(top, "a", "What carries memory (compliant setup)")
        style.letter(bottom, "b", "One thing at a time")
        families = _families(rows)
        _totals(top, _compliant_series(families), rows, baseline)
        _sweeps(bottom, families, baseline)
    return figure


def _families(rows: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """The runs with springs, those with pinned crossings, and those over the authors' crossings,
    which are for the filter."""
    pinned = np.isinf(rows[K])
    same = ["engine", K, NU]  # as a run with the filter has them
    of_filter = (rows[same] == rows.loc[rows[FILTER] > 0, same].iloc[0]).all(axis=1)
    return {
        "springs": rows[~pinned & ~of_filter],
        "pinned": rows[pinned & (rows[LOSS] == 0.0)],
        "material": rows[pinned & (rows[LOSS] > 0.0)],
        "filter": rows[of_filter],
    }


def _base(springs: pd.DataFrame) -> dict[str, float]:
    """What the sweeps start from: the value of each parameter that most runs have."""
    return {name: springs[name].mode()[0] for name in (K, NU, GAMMA)}


def _of(rows: pd.DataFrame, **equal: float) -> pd.DataFrame:
    for name, value in equal.items():
        rows = rows[rows[name] == value]
    return rows


def _compliant_series(families: dict[str, pd.DataFrame]) -> dict:
    """Series of panel a by kind and label: rows and look."""
    springs, pinned, material, filtered = families.values()
    base = _base(springs)
    strongest = pinned[GAMMA].max()
    # the largest that a real fibre has
    lossy = material.loc[material[LOSS] <= max(high for _, high in MATERIALS.values()), LOSS].max()
    physics = {
        rf"none: pinned crossings, $\gamma$ = {base[GAMMA]:g} /s": (
            _of(pinned, **{GAMMA: base[GAMMA]}), {"color": NONE, "marker": "o"}
        ),
        f"crossings: {base[K]:g} N/m, {base[NU]:g} N s/m": (
            _of(springs, **base), {"color": SPRING, "marker": "s"}
        ),
        rf"fibres: pinned, $\gamma$ = {strongest:g} /s": (
            _of(pinned, **{GAMMA: strongest}), {"color": FIBRE, "marker": "D"}
        ),
        rf"material: pinned, $\tan\delta$ = {lossy:g}": (
            _of(material, **{LOSS: lossy}), {"color": MATERIAL, "marker": "v"}
        ),
    }  # fmt: skip
    return {"Physics": physics} | _filter_series(_authors_numerics(filtered))


def _filter_series(rows: pd.DataFrame) -> dict:
    """The authors' crossings with their filter and without it."""
    look = {"color": NUMERICS, "marker": "^"}
    filters = {
        "Laplace filter on": (rows[rows[FILTER] > 0], look),
        "Laplace filter off": (rows[rows[FILTER] == 0], look | OFF),
    }
    return {TINTED: filters}


def _authors_numerics(filtered: pd.DataFrame) -> pd.DataFrame:
    """The runs of each size on the mesh nearest to the authors', at the longest step."""
    away = (_element(filtered) - AUTHORS_ELEMENT).abs()
    nearest = away == away.groupby(filtered["n"]).transform("min")
    return filtered[nearest & (filtered[STEP] == filtered[STEP].max())]


def _element(rows: pd.DataFrame) -> pd.Series:
    """Length of the elements, mm."""
    return 1e3 * rows["spacing_m"] / rows[ELEMENTS].astype(float)


def _totals(part: SubFigure, kinds: dict, rows: pd.DataFrame, baseline: pd.DataFrame) -> None:
    """C_nl and C_m over N, one line a carrier, and the keys of physics and numerics beside them."""
    *axes, beside = part.subplots(1, 3, width_ratios=[1, 1, 1.15])
    sizes = sorted(rows["n"].unique())
    series = {label: one for kind in kinds.values() for label, one in kind.items()}
    for ax, name in zip(axes, plots.TOTALS, strict=True):
        for place, (frame, look) in enumerate(series.values()):
            aside = ASIDE * (place - (len(series) - 1) / 2)
            stable = frame[frame["status"] == "ok"].sort_values("n")
            plots.points(ax, stable, "n", name, aside, **MARK | look)
        known = AUTHORS_TABLE.reindex(sizes)
        ax.plot(sizes, known[name], zorder=4, **TABLE)
        ax.set(xlabel="Fibres in each direction, $N$", ylabel=plots.TOTALS[name])
        ax.set(xticks=sizes, xlim=(sizes[0] - 0.8, sizes[-1] + 0.8), ylim=AXIS)
        lost = pd.concat([frame for frame, _ in series.values()])
        plots.mark_unstable(ax, lost, "n")
        plots.baselines(ax, baseline, name)
    beside.axis("off")
    keys = {
        kind: {label: Line2D([], [], **look) for label, (_, look) in one.items()}
        for kind, one in kinds.items()
    }
    _keys(beside, keys | {"": {"the authors' table": Line2D([], [], **TABLE)} | plots.key(rows)})


def _keys(ax: Axes, keys: dict[str, dict[str, Line2D]]) -> None:
    """Legends one below the other, each under its title; that of the numerics is tinted."""
    above = 1.05
    for title, handles in keys.items():
        legend = ax.legend(
            handles.values(), handles.keys(), title=title, loc="upper left", alignment="left",
            bbox_to_anchor=(-0.02, above), frameon=title == TINTED, facecolor=TINT,
            edgecolor="none", framealpha=1.0, title_fontproperties={"weight": "bold", "size": 6.5},
        )  # fmt: skip
        ax.add_artist(legend)
        above -= KEY_LINE * (len(handles) + 1.8)


def _sweeps(part: SubFigure, families: dict[str, pd.DataFrame], baseline: pd.DataFrame) -> None:
    """C_nl above and C_m below, one column for each thing that is changed."""
    axes = part.subplots(
        2, len(COLUMNS), sharey=True, sharex="col", width_ratios=[1, 1, 1, 1, 1, 1.35]
    )
    springs, pinned, material, filtered = families.values()
    base = _base(springs)
    sizes = sorted(pd.concat(families.values())["n"].unique())
    colour = plots.colours(sizes)
    for row, name in zip(axes, plots.TOTALS, strict=True):
        for ax, column in zip(row, (K, NU, GAMMA), strict=False):
            others = {key: value for key, value in base.items() if key != column}
            _lines(ax, _of(springs, **others), column, name, colour)
        _lines(row[3], pinned, GAMMA, name, colour)
        _lines(row[4], material, LOSS, name, colour)
        for ax, column in zip(row, (K, NU, GAMMA, GAMMA), strict=False):
            ax.axvline(base[column], color=style.FAINT, lw=2.5, zorder=0)
        _filter(row[5], filtered, name, colour)
        for ax in row:
            ax.set_ylim(*AXIS)
            for value in baseline[name] if ax is not row[-1] else ():
                ax.axhline(value, zorder=0, **plots.BASELINE_LINE)
        row[0].set_ylabel(plots.TOTALS[name])
        plots.baselines(row[-1], baseline, name)
    for column, (title, label) in enumerate(COLUMNS.values()):
        axes[0, column].set_title(title)
        axes[1, column].set_xlabel(label)
        axes[1, column].margins(x=0.08)
    _scales(axes[1])
    _key(part, colour, filtered)


def _scales(lowest: np.ndarray) -> None:
    for ax in lowest[[0, 2, 3, 4]]:
        ax.set_xscale("log")
    lowest[1].set_xscale("symlog", linthresh=1.0)
    lowest[1].set_xticks([0, 1, 3, 10], ["0", "1", "3", "10"])
    lowest[0].set_xticks([10.0**power for power in (1, 3, 5)])
    for ax in lowest[2:4]:
        ax.set_xticks([1.0, 10.0, 100.0, 1000.0])
    lowest[4].set_xticks([0.03, 0.1, 0.3, 1.0], ["0.03", "0.1", "0.3", "1"])
    for place, (name, (low, high)) in enumerate(MATERIALS.items()):
        height = 0.98 - 0.09 * place
        lowest[4].plot([low, high], [height, height], color=style.GREY, lw=1.5)
        lowest[4].text(1.15 * high, height, name, fontsize=6, va="center", color=style.GREY)
    for ax in lowest[:5]:
        ax.minorticks_off()


def _lines(ax: Axes, rows: pd.DataFrame, x: str, name: str, colour: dict) -> None:
    """A capacity over column x, one line a size."""
    for n, frame in rows.groupby("n"):
        frame = frame[frame["status"] == "ok"].sort_values(x)
        plots.points(ax, frame, x, name, marker="o", ms=2.2, lw=0.8, color=colour[n])
    plots.mark_unstable(ax, rows, x)


def _filter(ax: Axes, rows: pd.DataFrame, name: str, colour: dict) -> None:
    """A capacity over the length of the elements; one marker a step, wider and hollow without
    filter, so that one without effect is seen within it."""
    ax.set_facecolor(TINT)
    rows = rows.assign(element=_element(rows))
    stable = rows[rows["status"] == "ok"].sort_values("element")
    for step, marker in _markers(rows).items():
        for n, frame in _of(stable, **{STEP: step}).groupby("n"):
            aside = ASIDE * (list(colour).index(n) - (len(colour) - 1) / 2)
            look = {"marker": marker, "color": colour[n], "shift": aside}
            on, off = frame[frame[FILTER] > 0], frame[frame[FILTER] == 0]
            plots.points(ax, off, "element", name, ms=3.6, **look | OFF)
            plots.points(ax, on, "element", name, ms=2.2, **look)
    ax.set_xlim(0.0, 1.15 * rows["element"].max())
    plots.mark_unstable(ax, rows, "element")


def _markers(filtered: pd.DataFrame) -> dict[float, str]:
    """A marker for each step (s), the longest first."""
    return dict(zip(sorted(filtered[STEP].unique(), reverse=True), "oDv^<>", strict=False))


def _key(part: SubFigure, colour: dict, filtered: pd.DataFrame) -> None:
    handles = {f"$N$ = {n}": Line2D([], [], color=shade) for n, shade in colour.items()}
    ink = {"color": style.INK, "ls": ""}
    for step, marker in _markers(filtered).items():
        handles[f"filter on, {1e6 * step:g} µs"] = Line2D([], [], marker=marker, ms=2.2, **ink)
    handles["filter off"] = Line2D([], [], marker="o", ms=3.6, color=style.INK, **OFF)
    handles["setup's own value"] = Line2D([], [], color=style.FAINT, lw=2.5)
    handles["numerics"] = Patch(color=TINT)
    panels.key(part, handles, ncols=len(handles), handlelength=1.2)
