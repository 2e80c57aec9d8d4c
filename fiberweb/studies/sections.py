"""Sections of the config of the paper's studies, and of ours beside them."""

from __future__ import annotations

from typing import Annotated, Literal, Self, TypeVar

from pydantic import Field, model_validator

from fiberweb.model.scene import NotNegative, Positive, PositiveOrPinned
from fiberweb.sections import NETWORK, TOPOLOGY, Section, key

SCALING = "Scaling behavior of crosshatch networks"
PRETENSION = "Pretension"
FEATURES = "Feature selection"

Item = TypeVar("Item")
Some = Annotated[list[Item], Field(min_length=1)]  # a study without a run has no table to draw
Size = Annotated[int, Field(ge=2)]
EQ3_SPACINGS = [round(0.02 + 0.01 * i, 3) for i in range(14)]
# the authors' 18 forces: Eq. 3 as they round it, 50e-6 / s^3, at each spacing; and four more
GRID = sorted([50e-6 / s**3 for s in EQ3_SPACINGS] + [5.0, 3.75, 2.5, 1.25])
AUTHORS_C_NL = [
    3.75, 1.25, 0.78125, 0.4, 0.231481, 0.231481, 0.145773, 0.145773, 0.0976562, 0.0976562,
    0.0685871, 0.05, 0.05, 0.0375657,
]  # fmt: skip
AUTHORS_C_M = [
    2.5, 1.25, 0.78125, 0.4, 0.231481, 0.145773, 0.145773, 0.0685871, 0.0685871, 0.05, 0.78125,
    0.78125, 0.4, 1.25,
]  # fmt: skip


class DiagonalsSection(Section):
    """Which diagonals of a polygon are fibres, in each setup."""

    described: Literal["all", "skip-one"] = key("all", "as the text says", "", NETWORK)
    published: Literal["all", "skip-one"] = key(
        "skip-one", "as the authors' code does: diameters, and vertices two apart"
    )


class TopologySection(Section):
    """The topology study, Fig. 1."""

    length: Positive = key(
        0.5,
        "fibre length of a crosshatch, diameter of a polygon's circumscribed circle",
        "m",
        TOPOLOGY,
    )
    crosshatch: list[Annotated[int, Field(ge=2)]] = key(
        [2, 4, 6, 8, 10, 12], "numbers of fibres in each direction, N", "", TOPOLOGY
    )
    polygon: list[Annotated[int, Field(ge=6, multiple_of=2)]] = key(
        [6, 8, 10, 12], "numbers of vertices, N", "", TOPOLOGY
    )
    diagonals: DiagonalsSection = DiagonalsSection()

    @model_validator(mode="after")
    def _not_empty(self) -> Self:
        if not (self.crosshatch or self.polygon):
            raise ValueError(
                "topology.crosshatch = [] and topology.polygon = []: list at least one network"
            )
        return self


class RidgeSection(Section):
    """The force-spacing ridge, Fig. 2a and b."""

    n: Size = key(4, "size of the crosshatch, N", "", SCALING)
    spacing: Some[Positive] = key(EQ3_SPACINGS, "spacings", "m", SCALING)
    force: Some[Positive] = key(
        [float(f"{force:.6g}") for force in GRID], "forces, of every spacing", "N", SCALING
    )
    published_forces: Annotated[int, Field(ge=2, multiple_of=2)] = key(
        6, "how many forces about B = 1 the published setup runs of each spacing"
    )


class SizeSection(Section):
    """Size at the best force of each spacing, Fig. 2c."""

    n: Some[Size] = key([2, 4, 6, 8, 10, 12], "sizes of the crosshatch, N", "", SCALING)
    published_n: Some[Size] = key([2], "sizes that the published setup runs")
    published_duration: Positive = key(50.0, "length of the published runs", "s")
    published_c_nl_force: Some[Positive] = key(
        AUTHORS_C_NL, "the authors' best force for C_nl, by spacing of the ridge", "N"
    )
    published_c_m_force: Some[Positive] = key(
        AUTHORS_C_M, "the authors' best force for C_m, by spacing of the ridge", "N"
    )
    stable_step: Positive = key(2.5e-6, "step at which the published runs are repeated", "s")


class PretensionSection(Section):
    """Pretension at the best force of each spacing, Fig. 3."""

    spacing: Some[Positive] = key(
        [0.05, 0.06, 0.07, 0.08, 0.09, 0.1], "spacings, among the ridge's", "m", PRETENSION
    )
    tension: Some[NotNegative] = key(
        [0.01, 0.1, 0.5, 1.0, 2.0, 5.0], "tensions, F_t", "N", PRETENSION
    )
    published_force: Some[Positive] = key(
        [0.4, 0.231481, 0.0976562, 0.0976562, 0.05, 0.05], "the authors' force of each spacing", "N"
    )

    @model_validator(mode="after")
    def _a_force_each(self) -> Self:
        if len(self.published_force) != len(self.spacing):
            raise ValueError(
                f"pretension.published_force = {self.published_force}: give one force for each of "
                f"the {len(self.spacing)} values of pretension.spacing"
            )
        return self


class FeaturesSection(Section):
    """Which readouts matter, Fig. 4."""

    n: Size = key(6, "size of the crosshatch, N", "", FEATURES)
    length: Positive = key(0.5, "fibre length", "m", FEATURES)
    force: Some[Positive] = key(
        [0.1372, 0.2, 0.85], "forces: by Eq. 3, of the authors' scripts, of the text", "N", FEATURES
    )
    alpha: Positive = key(0.1, "ridge penalty", "", FEATURES)
    verdict_force: Positive = key(0.2, "the force by which claims are judged", "N")
    share: Annotated[float, Field(gt=0, lt=1)] = key(
        0.95, "share of a capacity that greedily chosen signals have to keep"
    )

    @model_validator(mode="after")
    def _verdict_was_run(self) -> Self:
        if self.verdict_force not in self.force:
            raise ValueError(
                f"features.verdict_force = {self.verdict_force:g} is not among features.force = "
                f"{self.force}; give one of them"
            )
        return self


class MemoryOriginSection(Section):
    """What carries memory: the filter, the crossings or the fibres' damping."""

    n: Some[Size] = key([2, 4, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    crossing_stiffness: Some[PositiveOrPinned] = key(
        [10.0, 30.0, 70.0, 300.0, 1000.0, 1e6], "springs between fibres", "N/m"
    )
    crossing_damping: Some[NotNegative] = key(
        [0.0, 1.0, 3.0, 10.0], "dampers beside the spring", "N s/m"
    )
    damping: Some[NotNegative] = key(
        [1.0, 10.0, 100.0, 300.0, 1000.0, 3000.0], "rates of velocity damping", "1/s"
    )
    filter_element: Some[Positive] = key(
        [0.01, 0.02, 0.005],
        "lengths of the elements of runs with the Laplace filter, and of the same without",
        "m",
    )
    filter_step: Some[Positive] = key(
        [5e-6, 2.5e-6], "steps with it: the first on every mesh, others on the first", "s"
    )


class CalibrationSection(Section):
    """The described setup's unreported parameters against T1 to T4."""

    n: Some[Size] = key([4, 8], "sizes of the crosshatch, N; 8 among them, for T1 to T4")
    length: Positive = key(0.5, "fibre length", "m")
    crossing_stiffness: Some[Positive] = key([40.0, 70.0, 100.0], "springs", "N/m")
    crossing_damping: Some[NotNegative] = key([2.0, 3.0, 5.0], "dampers", "N s/m")
    damping: Some[NotNegative] = key([2.5, 5.0, 10.0, 20.0], "rates of velocity damping", "1/s")

    @model_validator(mode="after")
    def _has_8(self) -> Self:
        if 8 not in self.n:
            raise ValueError(
                f"calibration.n = {self.n}: T1 to T4 are about the 8x8 crosshatch, so list 8 too"
            )
        return self


class NoiseSection(Section):
    """Readout noise: what a camera or a sensor would leave."""

    n: Some[Size] = key([4, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    noise: Some[Positive] = key(
        [1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3], "standard deviations of the noise", "m"
    )
    seeds: Annotated[int, Field(ge=1)] = key(3, "draws of the noise at each level")


class ChaosSection(Section):
    """Divergence of twin runs about buckling."""

    n: Size = key(4, "size of the crosshatch, N")
    spacing: Positive = key(0.1, "spacing", "m")
    buckling: Some[Positive] = key(
        [0.2, 0.5, 0.8, 0.9, 1.0, 1.1, 1.2, 1.35, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0],
        "buckling numbers of the force",
    )
    disturbance: Positive = key(
        1e-9, "by how much the driven points of twins differ at the start", "m"
    )


class RobustnessSection(Section):
    """Seeds of the input and ridge penalties."""

    n: Some[Size] = key([4, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    seed: Some[Annotated[int, Field(ge=0)]] = key([1234, 1, 2, 3, 4], "seeds of the input")
    alpha: Some[Positive] = key([1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0], "ridge penalties")


class NarmaSection(Section):
    """The NARMA task, Fig. 6, on simulated networks."""

    n: Some[Size] = key([6, 8], "sizes of the crosshatch, N")
    length: Positive = key(0.5, "fibre length", "m")
    order: Some[Literal[2, 5, 10]] = key([2, 5, 10], "orders of the recursion")
    rate: Positive = key(10.0, "rate of the task", "Hz")
    alpha: Positive = key(1.0, "ridge penalty")


class BucklingSection(Section):
    """Snapshots and animations about B = 1."""

    n: Size = key(4, "size of the crosshatch, N")
    spacing: Positive = key(0.1, "spacing", "m")
    buckling: Some[Positive] = key([0.9, 1.2], "buckling numbers: just below and just above")
    frame_rate: Positive = key(25.0, "rate of the animation", "Hz")
    seconds: Positive = key(8.0, "length of the animation", "s")
