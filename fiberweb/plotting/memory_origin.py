"""What carries memory: the Laplace filter, the crossings, or the damping of the fibres.

Drawing only: every number comes from the tables.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from fiberweb.plotting import style
from fiberweb.plotting.sweep import FLOOR_LINE, TOTALS, floors, rows_of

K, NU, GAMMA = "crossing_stiffness_N_m", "crossing_damping_Ns_m", "damping_per_s"
FILTER, ELEMENTS, STEP = "filter_order", "elements_per_section", "time_step_s"
# C_nl and C_m by N of 500 mm crosshatches, from the authors' own density table (their public
# code repository), which Fig. 1 of the paper draws
AUTHORS_TABLE = pd.DataFrame(
    {"c_nl": [0.535, 0.805, 0.908], "c_m": [0.165, 0.375, 0.570]}, [2, 4, 8]
)
NONE, SPRING, FIBRE, NUMERICS = (style.GREY, *style.colours(4)[:3])
TABLE = {"color": style.INK, "marker": "_", "ms": 10, "mew": 1.4, "ls": ""}
OFF = {"mfc": "white", "mew": 0.8}
TINT = "#f1efe9"  # behind what is numerics
AUTHORS_ELEMENT = 10.0  # mm
AXIS = (-0.03, 1.03)
COLUMNS = {  # of panel b: title and label of x
    K: ("Physics:\ncrossing spring", "$k$ (N/m)"),
    NU: ("Physics:\ncrossing damper", "ν (N s/m)"),
    GAMMA: ("Physics: fibre damping,\nsprings and dampers", "γ (1/s)"),
    "pinned": ("Physics: fibre damping,\npinned crossings", "γ (1/s)"),
    FILTER: ("Numerics:\nLaplace filter", "Element length (mm)"),
}


def draw(tables: dict[str, pd.DataFrame], setup: str, path: str | Path) -> Figure:
    """Draw the study for one setup and write it as PNG and PDF.

    Args:
        tables: "memory_origin", from `fiberweb.tables.study`, and "memory_origin_floors".
        setup: "described": panels a and b; "published": the authors' networks with and without
            the filter.
        path: of the figure.

    Returns:
        The figure.

    Raises:
        ValueError: the table has no run of this setup.
    """
    rows = rows_of(tables["memory_origin"], "memory_origin", setup)
    floor = tables["memory_origin_floors"]
    with style.applied():
        if setup == "published":
            figure = style.figure(style.DOUBLE, 58.0)
            style.letter(figure, "a", "Memory of the authors' networks (published setup)")
            _totals(figure, _published_series(rows), rows, floor)
        else:
            figure = style.figure(style.DOUBLE, 152.0)
            top, bottom = figure.subfigures(2, 1, height_ratios=[56, 96])
            style.letter(top, "a", "What carries memory (described setup)")
            style.letter(bottom, "b", "One thing at a time")
            families = _families(rows)
            _totals(top, _described_series(families), rows, floor)
            _sweeps(bottom, families, floor)
        style.save(figure, path)
    return figure


def _families(rows: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """The runs with springs, those with pinned crossings, and those over the authors' crossings,
    which are about the filter."""
    pinned = np.isinf(rows[K])
    same = ["engine", K, NU]  # as a run with the filter has them
    about_filter = (rows[same] == rows.loc[rows[FILTER] > 0, same].iloc[0]).all(axis=1)
    return {
        "springs": rows[~pinned & ~about_filter],
        "pinned": rows[pinned],
        "filter": rows[about_filter],
    }


def _base(springs: pd.DataFrame) -> dict[str, float]:
    """What the sweeps start from: the value of each parameter that most runs have."""
    return {name: springs[name].mode()[0] for name in (K, NU, GAMMA)}


def _of(rows: pd.DataFrame, **equal: float) -> pd.DataFrame:
    for name, value in equal.items():
        rows = rows[rows[name] == value]
    return rows


def _described_series(families: dict[str, pd.DataFrame]) -> dict:
    """Series of panel a by label: rows and look."""
    springs, pinned, filtered = families.values()
    base = _base(springs)
    strongest = pinned[GAMMA].max()
    authors = _authors_numerics(filtered)
    on, off = authors[authors[FILTER] > 0], authors[authors[FILTER] == 0]
    return {
        f"nothing: pinned crossings, γ = {base[GAMMA]:g} /s": (
            _of(pinned, **{GAMMA: base[GAMMA]}), {"color": NONE, "marker": "o"}
        ),
        f"physics: springs and dampers, {base[K]:g} N/m, {base[NU]:g} N s/m": (
            _of(springs, **base), {"color": SPRING, "marker": "s"}
        ),
        f"physics: fibre damping, pinned, γ = {strongest:g} /s": (
            _of(pinned, **{GAMMA: strongest}), {"color": FIBRE, "marker": "D"}
        ),
        "numerics: Laplace filter, the authors' crossings": (
            on, {"color": NUMERICS, "marker": "^"}
        ),
        "the same, filter off": (off, {"color": NUMERICS, "marker": "^", "ls": ":"} | OFF),
    }  # fmt: skip


def _authors_numerics(filtered: pd.DataFrame) -> pd.DataFrame:
    """The runs of each size on the mesh nearest to the authors', at the longest step."""
    away = (_element(filtered) - AUTHORS_ELEMENT).abs()
    nearest = away == away.groupby(filtered["n"]).transform("min")
    return filtered[nearest & (filtered[STEP] == filtered[STEP].max())]


def _element(rows: pd.DataFrame) -> pd.Series:
    """Length of the elements, mm."""
    return 1e3 * rows["spacing_m"] / rows[ELEMENTS].astype(float)


def _published_series(rows: pd.DataFrame) -> dict:
    return {
        "the authors' code, with its Laplace filter": (
            rows[rows[FILTER] > 0], {"color": NUMERICS, "marker": "^"}
        ),
        "the same, filter off": (
            rows[rows[FILTER] == 0], {"color": NUMERICS, "marker": "^", "ls": ":"} | OFF
        ),
    }  # fmt: skip


def _totals(part: SubFigure, series: dict, rows: pd.DataFrame, floor: pd.DataFrame) -> None:
    """C_m and C_nl over N, one line a carrier, and the key beside them."""
    *axes, beside = part.subplots(1, 3, width_ratios=[1, 1, 1.05])
    sizes = sorted(rows["n"].unique())
    for ax, name in zip(axes, ("c_m", "c_nl"), strict=True):
        for frame, look in series.values():
            frame = frame[frame["status"] == "ok"].sort_values("n")
            ax.errorbar(frame["n"], frame[name], frame[f"{name}_se"], elinewidth=0.7, **look)
        known = AUTHORS_TABLE.reindex(sizes)
        ax.plot(sizes, known[name], zorder=4, **TABLE)
        ax.set(xlabel="N", ylabel=TOTALS[name], xticks=sizes, ylim=AXIS)
        ax.margins(x=0.1)
        lost = pd.concat([frame for frame, _ in series.values()])
        style.mark_unstable(ax, list(lost.loc[lost["status"] == "unstable", "n"]))
        floors(ax, floor, name)
    handles = {label: Line2D([], [], **look) for label, (_, look) in series.items()}
    handles["the authors' table"] = Line2D([], [], **TABLE)
    handles["readouts made of the input alone"] = Line2D([], [], **FLOOR_LINE)
    if (rows["status"] == "unstable").any():
        handles["unstable run"] = Line2D([], [], **style.UNSTABLE)
    beside.axis("off")
    beside.legend(handles.values(), handles.keys(), loc="center left", labelspacing=0.8)


def _sweeps(part: SubFigure, families: dict[str, pd.DataFrame], floor: pd.DataFrame) -> None:
    """C_m above and C_nl below, one column for each thing that is changed."""
    axes = part.subplots(2, len(COLUMNS), sharey=True, sharex="col")
    springs, pinned, filtered = families.values()
    base = _base(springs)
    sizes = sorted(pd.concat(families.values())["n"].unique())
    colour = dict(zip(sizes, style.colours(len(sizes)), strict=True))
    for row, name in zip(axes, ("c_m", "c_nl"), strict=True):
        for ax, column in zip(row, (K, NU, GAMMA), strict=False):
            others = {key: value for key, value in base.items() if key != column}
            _lines(ax, _of(springs, **others), column, name, colour)
            ax.axvline(base[column], color=style.FAINT, lw=2.5, zorder=0)
        _lines(row[3], pinned, GAMMA, name, colour)
        _filter(row[4], filtered, name, colour)
        for ax in row:
            ax.set_ylim(*AXIS)
            for value in floor[name] if ax is not row[-1] else ():
                ax.axhline(value, zorder=0, **FLOOR_LINE)
        row[0].set_ylabel(TOTALS[name])
        floors(row[-1], floor, name)
    for column, (title, label) in enumerate(COLUMNS.values()):
        axes[0, column].set_title(title)
        axes[1, column].set_xlabel(label)
        axes[1, column].margins(x=0.08)
    _scales(axes[1])
    _key(part, colour, filtered)


def _scales(lowest: np.ndarray) -> None:
    for ax in lowest[[0, 2, 3]]:
        ax.set_xscale("log")
    lowest[1].set_xscale("symlog", linthresh=1.0)
    lowest[1].set_xticks([0, 1, 3, 10], ["0", "1", "3", "10"])
    lowest[0].set_xticks([10.0**power for power in (1, 3, 5)])
    for ax in lowest[2:4]:
        ax.set_xticks([1.0, 10.0, 100.0, 1000.0])
    for ax in lowest[:4]:
        ax.minorticks_off()


def _lines(ax: Axes, rows: pd.DataFrame, x: str, name: str, colour: dict) -> None:
    """A capacity over column x, one line a size."""
    for n, frame in rows.groupby("n"):
        frame = frame[frame["status"] == "ok"].sort_values(x)
        ax.plot(frame[x], frame[name], marker="o", ms=2.6, color=colour[n])
    style.mark_unstable(ax, list(rows.loc[rows["status"] == "unstable", x]))


def _filter(ax: Axes, rows: pd.DataFrame, name: str, colour: dict) -> None:
    """A capacity over the length of the elements; one marker a step, hollow without filter."""
    ax.set_facecolor(TINT)
    rows = rows.assign(element=_element(rows))
    stable = rows[rows["status"] == "ok"].sort_values("element")
    for step, marker in _markers(rows).items():
        for n, frame in _of(stable, **{STEP: step}).groupby("n"):
            on, off = frame[frame[FILTER] > 0], frame[frame[FILTER] == 0]
            ax.plot(on["element"], on[name], marker=marker, ms=3.2, color=colour[n])
            ax.plot(off["element"], off[name], marker + ":", ms=3.2, color=colour[n], **OFF)
    style.mark_unstable(ax, list(rows.loc[rows["status"] == "unstable", "element"]))


def _markers(filtered: pd.DataFrame) -> dict[float, str]:
    """A marker for each step (s), the longest first."""
    return dict(zip(sorted(filtered[STEP].unique(), reverse=True), "oDv^<>", strict=False))


def _key(part: SubFigure, colour: dict, filtered: pd.DataFrame) -> None:
    handles = {f"N = {n}": Line2D([], [], color=shade) for n, shade in colour.items()}
    ink = {"color": style.INK, "ls": "", "ms": 3.2}
    for step, marker in _markers(filtered).items():
        handles[f"filter on, {1e6 * step:g} µs"] = Line2D([], [], marker=marker, **ink)
    handles["filter off"] = Line2D([], [], marker="o", **ink | OFF)
    handles["setup's own value"] = Line2D([], [], color=style.FAINT, lw=2.5)
    legend = part.legend(
        handles.values(), handles.keys(), ncols=len(handles), loc="upper right",
        bbox_to_anchor=(0.995, 1.0), handlelength=1.2, columnspacing=1.2,
    )  # fmt: skip
    legend.set_in_layout(False)  # it shares the line of the title, which reserves the room
