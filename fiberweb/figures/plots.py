"""What figures of capacities share: points with bars, one line a spacing, and the baselines."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.figure import FigureBase
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from matplotlib.transforms import offset_copy

from fiberweb.figures import style

TOTALS = {"c_nl": r"$C_\mathrm{nl}$", "c_m": r"$C_\mathrm{m}$"}
BASELINES = {"u": "$u$", "derivatives": "$u\\,…\\,u'''$", "powers": "$u\\,…\\,u^3$"}
BASELINE_LINE = {"color": style.GREY, "lw": 0.7, "ls": (0, (4, 2))}
INPUT_ALONE = "readouts made of the input alone"
LABEL_GAP = 0.075  # share of the axis: baselines closer than this share a label
BUCKLING = r"$\mathcal{B}$"
ENDS = {"c_nl": 1.0, "c_m": 0.7}  # of the scales, so that force, size and tension compare


def rows_of(table: pd.DataFrame, study: str, setup: str) -> pd.DataFrame:
    """The rows of one setup; ValueError, one sentence, if there are none."""
    rows = table[table["setup"] == setup]
    if rows.empty:
        raise ValueError(f"the {study} table has no run of the {setup} setup to draw")
    return rows


def colours(values: Iterable[float]) -> dict[float, np.ndarray]:
    """Colour of each value, such as N or a spacing, dark to light as it grows."""
    distinct = sorted(set(values))
    return dict(zip(distinct, style.colours(len(distinct)), strict=True))


def points(
    ax: Axes, rows: pd.DataFrame, x: str, name: str, shift: float = 0.0, **look: object
) -> None:
    """A capacity over column x with its standard errors as bars.

    A shift (typographic points) to the side parts bars that would lie on one another; it is not
    in the data, so set the limits of x yourself.
    """
    if shift:
        look["transform"] = offset_copy(ax.transData, ax.figure, x=shift, units="points")
    # marks without an edge, and bars on hollow ones, because the errors are small
    look = {"mew": 0.0, "elinewidth": 0.5, "barsabove": True} | look
    ax.errorbar(*rows[[x, name, f"{name}_se"]].to_numpy(float).T, **look)


def lines(
    ax: Axes, rows: pd.DataFrame, x: str, name: str, colour: dict, shift: float = 0.0,
    **look: object,
) -> None:  # fmt: skip
    """A capacity over column x, one line a spacing, each shifted from the one before; and the X's
    of unstable runs, each in the colour of its spacing at the foot of the axes."""
    look = {"marker": "o", "ms": 2.6, "lw": 0.7} | look
    for place, (spacing, frame) in enumerate(rows.sort_values(x).groupby("spacing_m")):
        aside = shift * (place - (len(colour) - 1) / 2)
        points(ax, frame, x, name, aside, color=colour[spacing], **look)
    unstable = rows[rows["status"] == "unstable"]
    for at, frame in unstable.groupby(x):
        for place, spacing in enumerate(sorted(frame["spacing_m"].unique())):
            ax.plot(
                [at], [0.04 + 0.05 * place], transform=ax.get_xaxis_transform(), zorder=5,
                gid="unstable", **style.UNSTABLE | {"mfc": colour[spacing], "mew": 0.6},
            )  # fmt: skip


def top(rows: pd.DataFrame, baselines: pd.DataFrame, name: str) -> float:
    """A round end for the scale of a capacity, above its greatest value and every baseline."""
    return np.ceil(20 * np.fmax(rows[name].max(), baselines[name].max()) + 0.2) / 20


def scale(ax: Axes, rows: pd.DataFrame, baselines: pd.DataFrame, name: str) -> None:
    """The scale and the label of a capacity: the same in every figure that its values fit."""
    ax.set(ylim=(0.0, max(ENDS[name], top(rows, baselines, name))), ylabel=TOTALS[name])


def logarithmic(axis: Axis) -> None:
    """A log scale with plain numbers, at decades, or at 1, 2 and 5 where there are few of them;
    call it when the limits are final."""
    low, high = axis.get_view_interval()
    subs = (1.0,) if high / low > 100 else (1.0, 2.0, 5.0)
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def baselines(ax: Axes, table: pd.DataFrame, name: str, **look: object) -> None:
    """What readouts of the input alone score, labelled beside the axes; call it last, because
    labels that would overlap on the final scale are put together."""
    for value in table[name]:
        ax.axhline(value, **{"zorder": 0} | BASELINE_LINE | look)
    for value, label in baseline_labels(table, name, LABEL_GAP * np.ptp(ax.get_ylim())):
        ax.annotate(
            label, (1.0, value), (2.0, 0.0), xycoords=("axes fraction", "data"),
            textcoords="offset points", va="center", fontsize=6,
        )  # fmt: skip


def baseline_labels(table: pd.DataFrame, name: str, gap: float) -> list[tuple[float, str]]:
    """Place and words of the labels of the baselines, one for all that are closer than gap."""
    groups: list[list[tuple[float, str]]] = []
    for value, readout in sorted(zip(table[name], table["readout"], strict=True)):
        if groups and value - groups[-1][-1][0] < gap:
            groups[-1].append((value, readout))
        else:
            groups.append([(value, readout)])
    return [
        (
            float(np.mean([value for value, _ in group])),
            ", ".join(
                BASELINES.get(readout, readout) for _, readout in sorted(group, key=_simplest)
            ),
        )
        for group in groups
    ]


def _simplest(baseline: tuple[float, str]) -> int:
    """Order of the baselines in a label: the input itself comes first."""
    return [*BASELINES, baseline[1]].index(baseline[1])


def spacing_bar(figure: FigureBase, axes: Sequence[Axes], colour: dict) -> None:
    """The key of the spacings (m), in mm."""
    in_mm = {1e3 * spacing: shade for spacing, shade in colour.items()}
    colour_bar(figure, axes, in_mm, "Spacing (mm)", pad=0.015, fraction=0.03, aspect=25)


def colour_bar(
    figure: FigureBase, axes: Sequence[Axes], colour: dict, label: str, **place: float
) -> None:
    """A key beside the axes: one field of colour for each value."""
    edges = np.arange(len(colour) + 1) - 0.5
    shades = ScalarMappable(BoundaryNorm(edges, len(colour)), ListedColormap(list(colour.values())))
    bar = figure.colorbar(shades, ax=axes, **place)
    bar.set_label(label)
    bar.set_ticks(range(len(colour)), labels=[f"{value:g}" for value in colour])
    bar.ax.tick_params(length=0)
    bar.minorticks_off()
    bar.outline.set_linewidth(0.4)


def mark_unstable(ax: Axes, rows: pd.DataFrame, x: str) -> None:
    """An X above the axis for each unstable run, at its value of column x."""
    style.mark_unstable(ax, list(rows.loc[rows["status"] == "unstable", x]))


def unstable_key(unstable: bool) -> dict[str, Line2D]:
    """Legend entry of unstable runs, if there are any."""
    return {"unstable run": Line2D([], [], **style.UNSTABLE)} if unstable else {}


def key(rows: pd.DataFrame) -> dict[str, Line2D]:
    """Legend entries that figures of capacities share, by label."""
    handles = {INPUT_ALONE: Line2D([], [], **BASELINE_LINE)}
    if rows[["c_nl_se", "c_m_se"]].notna().any(axis=None):  # too short a run has none
        handles["± standard error"] = Line2D(
            [], [], marker="|", ms=7, mew=0.5, ls="", color=style.INK
        )
    return handles | unstable_key((rows["status"] == "unstable").any())
