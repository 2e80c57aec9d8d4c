"""What makes the published capacities: filter and dead band on and off."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure, SubFigure
from matplotlib.lines import Line2D

from fiberweb.figures import panels, plots, style
from fiberweb.model.authors import LISTED_AT_100MM, LISTED_AT_500MM

NEITHER, BAND, FILTER, BOTH = style.colours(4)
# (filter on, dead band on): label and look, drawn in this order
VARIANTS = {
    (False, False): ("neither", {"color": NEITHER, "marker": "v"}),
    (False, True): ("dead band alone", {"color": BAND, "marker": "s"}),
    (True, False): ("filter alone", {"color": FILTER, "marker": "^"}),
    (True, True): ("both", {"color": BOTH, "marker": "o"}),
}
# the described setup, by layout
CONVERGED = {
    "authors": ("neither, converged", {"color": style.INK, "marker": "D", "mfc": "white"}),
    "exact": (
        "the text's network, converged",
        {"color": style.GREY, "marker": "o", "mfc": "white"},
    ),
}
AUTHORS = {"color": style.INK, "marker": "x", "ms": 5, "mew": 1.0, "ls": "", "zorder": 6}
MARK = {"ms": 3.0, "lw": 0.8, "elinewidth": 0.6}
MARK_ONLY = {"ms": 3.5, "lw": 0.8}
AXIS = (-0.03, 1.03)
SAME_FORCE = 1e-3  # relative: the authors' lists are rounded


@style.drawing
def draw(given: dict, setup: str) -> Figure:
    """Draw the study, as `fiberweb.figures` says.

    Args:
        given: "capacity_origin" (`tables.table`), "capacity_origin_baselines" (`input_baselines`),
            "dead_band" (`band.growth`) and "dead_band_histogram" (`band.histogram`).
    """
    rows, baselines = given["capacity_origin"], given["capacity_origin_baselines"]
    figure = style.figure(style.DOUBLE, 176.0)
    top, middle, bottom = figure.subfigures(3, 1, height_ratios=[56, 62, 58])
    sizes = rows[rows["force_choice"] == "eq3"]
    style.letter(top, "a", f"Over size, at the force of Eq. 3 ({setup} setup)")
    listed = {n: c for n, c in LISTED_AT_500MM.items() if n in set(sizes["n"])}
    _totals(top, sizes, "n", listed, baselines)
    for ax in top.axes:
        ax.set(xlabel="Fibres in each direction, $N$", xticks=sorted(sizes["n"].unique()))
    forces = rows[(rows["force_choice"] == "grid")]
    n = int(forces["n"].iloc[0])
    style.letter(middle, "b", f"Over the force, {n}×{n}, {_mm(forces)} mm spacing")
    _totals(middle, forces, "force_N", _listed_forces(forces), baselines)
    for ax in middle.axes:
        ax.set(xlabel=r"Force $F_\mathrm{max}$ (N)", xscale="log")
        plots.logarithmic(ax.xaxis)
    _key(middle, rows)
    left, centre, right = bottom.subfigures(1, 3, width_ratios=[1, 1, 1.5])
    style.letter(left, "c", "Angles against the band")
    _histogram(left, given["dead_band_histogram"])
    style.letter(centre, "d", "Growth of the band")
    _growth(centre, given["dead_band"])
    style.letter(right, "e", f"Mesh and step, {n}×{n}")
    _meshes(right, rows[rows["force_choice"] == "mesh"])
    return figure


def _variant(rows: pd.DataFrame, filtered: bool, banded: bool) -> pd.DataFrame:
    """The published runs with filter and band on or off."""
    chosen = (rows["filter_order"] > 0) == filtered
    return rows[(rows["setup"] == "published") & chosen & (rows["dead_band"] == banded)]


def _totals(part: SubFigure, rows, x: str, listed: dict, baselines: pd.DataFrame) -> None:
    """C_nl and C_m over a column x: each variant, the converged answer and the authors' own."""
    series = [(_variant(rows, *which), look) for which, (_, look) in VARIANTS.items()]
    described = rows[rows["setup"] == "described"]
    for layout, (_, look) in CONVERGED.items():
        series.append((described[described["layout"] == layout], look | {"mew": 0.7}))
    for column, (ax, name) in enumerate(zip(part.subplots(1, 2), plots.TOTALS, strict=True)):
        for frame, look in series:
            stable = frame[frame["status"] == "ok"].sort_values(x)
            plots.points(ax, stable, x, name, **MARK | look)
        ax.plot(list(listed), [values[column] for values in listed.values()], **AUTHORS)
        plots.mark_unstable(ax, rows, x)
        ax.set(ylabel=plots.TOTALS[name], ylim=AXIS)
        plots.baselines(ax, baselines, name)


def _listed_forces(rows: pd.DataFrame) -> dict:
    """The authors' points at the forces that were run, if theirs is the network."""
    if rows["n"].iloc[0] != 4 or abs(_mm(rows) - 100.0) > 1e-6:
        return {}
    forces = rows["force_N"].unique()
    return {
        at: values for at, values in LISTED_AT_100MM.items()
        if (abs(forces - at) < SAME_FORCE * at).any()
    }  # fmt: skip


def _mm(rows: pd.DataFrame) -> float:
    return round(1e3 * rows["spacing_m"].iloc[0], 1)


def _key(part: SubFigure, rows: pd.DataFrame) -> None:
    looks = {**dict(VARIANTS.values()), **dict(CONVERGED.values())}
    handles = {label: Line2D([], [], **MARK_ONLY | look) for label, look in looks.items()}
    handles |= {"the authors' tables": Line2D([], [], **AUTHORS)}
    handles |= panels.baseline_and_unstable((rows["status"] == "unstable").any())
    panels.key(part, handles, ncols=4)


def _histogram(part: SubFigure, table: pd.DataFrame) -> None:
    ax = part.subplots()
    for name, colour, label in (("turn", NEITHER, "angle"), ("band", BOTH, "half width of band")):
        ax.stairs(table[name], [*table["from_rad"], table["to_rad"].iloc[-1]], color=colour,
                  label=label, lw=1.0)  # fmt: skip
    ax.set(xscale="log", xlabel="Angle between elements (rad)", ylabel="Share of nodes and looks")
    ax.set_xlim(1e-8, 1e-1)
    ax.set_ylim(0.0, 1.3 * ax.dataLim.y1)  # the key stands above the curves
    ax.set_xticks([1e-8, 1e-6, 1e-4, 1e-2])
    ax.minorticks_off()
    ax.legend(loc="upper left", fontsize=6, handlelength=1.0)


def _growth(part: SubFigure, table: pd.DataFrame) -> None:
    ax = part.subplots()
    after = table[table["time_s"] > 0]
    for name, colour, label in (("turn", NEITHER, "angle"), ("band", BOTH, "half width of band")):
        low, middle, high = (after[f"{name}_{share:g}_rad"] for share in (0.1, 0.5, 0.9))
        ax.plot(after["time_s"], middle, color=colour, lw=0.8, label=label)
        ax.fill_between(after["time_s"], low, high, color=colour, alpha=0.2, lw=0.0)
    ax.set(yscale="log", xlabel="Time (s)", ylabel="Angle (rad)")
    ax.minorticks_off()


def _meshes(part: SubFigure, rows: pd.DataFrame) -> None:
    """C_nl and C_m over the length of the elements, one marker a step."""
    rows = rows.assign(element=1e3 * rows["spacing_m"] / rows["elements_per_section"].astype(float))
    steps = dict(zip(sorted(rows["time_step_s"].unique(), reverse=True), "oDv^", strict=False))
    for ax, name in zip(part.subplots(1, 2), plots.TOTALS, strict=True):
        for which in ((True, False), (False, True)):
            look = VARIANTS[which][1]
            for step, marker in steps.items():
                at = (rows["time_step_s"] == step) & (rows["status"] == "ok")
                frame = _variant(rows[at], *which).sort_values("element")
                shown = {"color": look["color"], "marker": marker}
                plots.points(ax, frame, "element", name, **MARK | shown)
        plots.mark_unstable(ax, rows, "element")
        ax.set(xlabel="Element (mm)", ylabel=plots.TOTALS[name], ylim=AXIS)
        ax.set_xlim(0.0, 1.15 * rows["element"].max())
    handles = [
        Line2D([], [], color=style.INK, marker=marker, ls="", ms=3, label=f"{1e6 * step:g} µs")
        for step, marker in steps.items()
    ]
    ax.legend(handles=handles, loc="upper right", fontsize=6, handlelength=1.0)
