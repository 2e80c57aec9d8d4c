"""Sections of the config: every key with its unit, range and place in the paper."""

from __future__ import annotations

import math
from typing import Annotated, Literal, Self, TypeVar

from pydantic import BaseModel, ConfigDict, Field, model_validator

from fiberweb.arguments import plain
from fiberweb.engines import ENGINES
from fiberweb.model.scene import (
    SETUPS,
    NotNegative,
    NotNegativeOrRigid,
    Positive,
    PositiveOrPinned,
    Scene,
    Seed,
)
from fiberweb.scoring.limits import ALPHA
from fiberweb.simulation.plan import ACCURACIES

# sections of the paper
NETWORK = "Fiber network setup"
CAPACITY = "Quantifying physical reservoir capacity"
SIMULATION = "Simulation experiments"
TOPOLOGY = "Fiber network topology"
SCALING = "Scaling behavior of crosshatch networks"
PRETENSION = "Pretension"
FEATURES = "Feature selection"
EXPERIMENTS = "Physical experiments"
VALIDATION = "Experimental validation"

Item = TypeVar("Item")
Some = Annotated[list[Item], Field(min_length=1)]  # a study without a run has no table to draw
Size = Annotated[int, Field(ge=2)]
Angle = Annotated[float, Field(gt=0, lt=90)]  # degrees


def key(default, text: str, unit: str = "", paper: str = "", **constraints):
    """A field: what it means, its unit, and the section of the paper that states it."""
    extra = {"unit": unit, "paper": paper}
    return Field(default, description=text, json_schema_extra=extra, **constraints)


def scene_key(name: str, *labels: str):
    """A field that overrides the scene's own default."""
    return key(Scene.__dataclass_fields__[name].default, *labels)


class Section(BaseModel):
    """Keys that belong together; unknown ones are refused."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True)

    @model_validator(mode="before")
    @classmethod
    def _own_numbers(cls, values):
        return plain(values)


def is_section(annotation: object) -> bool:
    """Whether a field's type is a section of its own."""
    return isinstance(annotation, type) and issubclass(annotation, Section)


class SceneSection(Section):
    """Physics and recording of every run, in every setup."""

    tension: NotNegative = scene_key(
        "tension", "constant pull along each fibre at its far end, F_t", "N", SIMULATION
    )
    duration: Positive = scene_key("duration", "length of the recording", "s", SIMULATION)
    seed: Seed = scene_key("seed", "seed of the input", "", SIMULATION)
    sample_rate: Positive = scene_key("sample_rate", "rate of the recording", "Hz", SIMULATION)
    drive_rate: Positive = scene_key(
        "drive_rate", "random knots of the input per second", "Hz", SIMULATION
    )
    lowest_knot: Literal[-1, 0] = scene_key(
        "lowest_knot",
        "the knots lie between this and 1: -1 pushes to both sides, 0 to one alone",
        "",
        SIMULATION,
    )
    diameter: Positive = scene_key("diameter", "diameter of the fibres", "m", SIMULATION)
    youngs_modulus: Positive = scene_key(
        "youngs_modulus", "Young's modulus E; the shear modulus is E/3", "Pa", SIMULATION
    )
    density: Positive = scene_key("density", "density of the fibres", "kg/m^3", SIMULATION)
    tension_ramp: NotNegative = scene_key(
        "tension_ramp", "time over which the tension grows from zero", "s", ""
    )


class SetupSection(Section):
    """What the paper's text leaves open; null takes the setup's own value."""

    crossing_stiffness: PositiveOrPinned | None = key(
        None, "spring between fibres at a crossing; .inf joins them in one point", "N/m", SIMULATION
    )
    crossing_damping: NotNegative | None = key(
        None, "damper beside that spring", "N s/m", SIMULATION
    )
    bond_stiffness: NotNegativeOrRigid = scene_key(
        "bond_stiffness",
        "spring that keeps the angle between fibres at a crossing: with 0 they are free to turn, "
        "with .inf they turn as one",
        "N m",
    )
    damping: NotNegative | None = key(None, "rate at which velocity decays", "1/s", "")
    loss_factor: NotNegative = scene_key(
        "loss_factor",
        "tan(delta) of the fibres' material, axial and in bending, at loss_frequency; it grows in "
        "proportion to the frequency (Kelvin-Voigt)",
    )
    loss_frequency: Positive = scene_key(
        "loss_frequency", "frequency at which the material has that loss factor", "Hz"
    )
    filter_order: Annotated[int, Field(ge=0, le=6)] | None = key(
        None, "order of the Laplace filter on velocities at every step, 0 for none"
    )
    dead_band: bool | None = key(None, "bend as the authors' rotations do, with a dead band")
    ends: Literal["clamped", "sliding", "pinned", "sprung"] | None = key(
        None,
        "clamped near end and free far end; pinned near end and far end that slides along the "
        "fibre; pinned near end and free far end; or as sliding, on a spring that holds the far "
        "end at scene.tension at rest",
        "",
        NETWORK,
    )
    end_stiffness: Positive | None = key(
        None, "spring along each fibre at its far end, of sprung ends alone", "N/m"
    )
    layout: Literal["exact", "authors"] | None = key(
        None,
        "exact: crossings where the text has them, and a force in one point; authors: both on "
        "nodes of their 10 mm elements, at any accuracy",
    )


class SetupsSection(Section):
    """The setups: the paper's text, the authors' code, and crossings that give."""

    described: SetupSection = SetupSection(**SETUPS["described"]["crosshatch"])
    published: SetupSection = SetupSection()
    compliant: SetupSection = SetupSection(**SETUPS["compliant"]["crosshatch"])

    @model_validator(mode="after")
    def _springs_at_sprung_ends(self) -> Self:
        for name, setup in self:
            ends, stiffness = setup.ends, setup.end_stiffness
            if ends == "sprung" and stiffness is None:
                raise ValueError(
                    f"setups.{name}.ends = 'sprung' needs the stiffness of the springs: give "
                    f"setups.{name}.end_stiffness in N/m, or other ends"
                )
            if ends != "sprung" and stiffness is not None:
                raise ValueError(
                    f"setups.{name}.end_stiffness = {stiffness:g} N/m is of springs, which "
                    f"setups.{name}.ends = {ends!r} has not: give ends: sprung, or leave it out"
                )
        return self


class NumericsSection(Section):
    """How runs are integrated; the published setup fixes its own."""

    accuracy: Literal[tuple(ACCURACIES)] | None = key(
        "standard", "chooses engine, mesh and step; null to choose them by the next keys"
    )
    engine: Literal[tuple(ENGINES)] | None = key(
        None, "kirchhoff: no shear; cosserat: planar PyElastica; elastica: PyElastica itself"
    )
    elements_per_section: Annotated[int, Field(ge=1)] | None = key(
        None, "elements between two crossings"
    )
    time_step: Positive | None = key(None, "at most the stability limit; null takes 0.9 of it", "s")
    force_time_step: bool = key(False, "accept a time step above the limit, to see it fail")

    @model_validator(mode="after")
    def _one_or_the_other(self) -> Self:
        chosen = [name for name in type(self).model_fields if name != "accuracy"]
        chosen = [name for name in chosen if getattr(self, name) not in (None, False)]
        if self.accuracy is not None and chosen:
            raise ValueError(
                f"numerics.accuracy = {self.accuracy!r} chooses numerics.{chosen[0]} as well: "
                f"set accuracy to null to keep {chosen[0]} = {getattr(self, chosen[0])!r}"
            )
        return self


class ScoringSection(Section):
    """How capacities are computed."""

    alpha: Positive = key(ALPHA, "ridge penalty", "", SIMULATION)


class ExperimentSection(Section):
    """The paper's experiment as a scene, a camera and a scoring. What the paper does not report has
    a dash in the last column, and its reason in the text."""

    length: Positive = key(0.52, "fibre length", "m", EXPERIMENTS)
    diameter: Positive = key(0.45e-3, "diameter of the fibres", "m", EXPERIMENTS)
    end_stiffness: Positive = key(52.5, "springs at the far ends", "N/m", EXPERIMENTS)
    # below, 501 knots are more seconds than the motor's table of angles has room for
    drive_rate: Annotated[float, Field(ge=0.1, allow_inf_nan=False)] = key(
        2.0, "random knots of the motor angle per second", "Hz", EXPERIMENTS
    )
    duration: Positive = key(150.0, "length of the recording", "s", EXPERIMENTS)
    sample_rate: Positive = key(
        120.0, "frames per second: the text's, which the scripts divide by too", "Hz", EXPERIMENTS
    )
    youngs_modulus: Positive = key(2.5e9, "nylon monofilament has 2 to 3 GPa", "Pa")
    density: Positive = key(1140.0, "nylon 6", "kg/m^3")
    tension: NotNegative = key(1.0, "pretension: a spring stretched by some 20 mm", "N")
    bond_stiffness: NotNegativeOrRigid = key(
        math.inf, "of crossings against turning: beads of glue far stiffer than the fibre", "N m"
    )
    damping: NotNegative = key(
        5.0, "rate at which velocity decays: about 1 /s of air, the rest of markers and glue", "1/s"
    )
    loss_factor: NotNegative = key(0.05, "tan(delta) at 10 Hz: nylon has 0.02 to 0.1")
    lever: Positive = key(0.07, "arm of the motor, by the authors' scripts", "m")
    direction: Literal[-1, 1] = key(
        -1, "of the pull: away from the springs of vertical fibres, as the scripts' forces point, "
        "or 1, towards them",
    )  # fmt: skip
    element: Positive = key(
        0.04, "longest element of the mesh: 4 a section of a 4x4, 2 of a 6x6. At 50 degrees C_nl "
        "is 0.84, 0.89, 0.82, 0.80 with 2, 4, 8, 16 in the 4x4, whose slack sections buckle, and "
        "0.94 with 2 or 4 in the 6x6", "m",
    )  # fmt: skip
    pixels_per_mm: Positive = key(2.0, "scale of the film: the scripts' crop has 0.5 mm a pixel")
    marker_noise: NotNegative = key(
        0.1, "standard deviation of a marker's position in x and in y: centroids of blobs are good "
        "to a fraction of a pixel", "px",
    )  # fmt: skip
    camera_seed: Seed = key(0, "seed of that noise, beside the name of the run")
    frame_step: Some[Annotated[int, Field(ge=1)]] = key(
        [1, 2], "every so many frames are read, and then taken for consecutive; claims are judged "
        "by the first, the text's, and one of the scripts reads every second",
    )  # fmt: skip
    alpha: Positive = key(1.0, "ridge penalty", "", EXPERIMENTS)
    skip: Annotated[int, Field(ge=0)] = key(500, "first frames dropped, by the scripts")
