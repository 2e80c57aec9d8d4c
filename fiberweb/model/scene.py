"""A scene: all of one run that is physics, and nothing that is numerics."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, fields
from typing import Annotated, Literal, get_type_hints

import numpy as np
from pydantic import Field, TypeAdapter, ValidationError

from fiberweb.arguments import plain, shown, spelt
from fiberweb.errors import sentence
from fiberweb.model import authors, buckling
from fiberweb.model.network import Network, from_spec

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False, strict=True)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False, strict=True)]
PositiveOrPinned = Annotated[float, Field(gt=0, strict=True)]  # infinity: one point
Seed = Annotated[int, Field(ge=0, le=2**32 - 1, strict=True)]  # what numpy's generator takes

# What each setup does where the scene leaves a field open. `described`: the paper's text, and where
# that leaves something open the authors' code, less its numerics. `compliant`: crossings that give,
# one way in which a web could remember; its three numbers are calibrated (study `calibration`).
# `published`: the authors' code.
NO_NUMERICS = dict(filter_order=0, dead_band=False)
DESCRIBED = dict(
    crossing_stiffness=math.inf, crossing_damping=0.0, damping=10.0, ends="sliding",
    layout="exact", **NO_NUMERICS
)  # fmt: skip
COMPLIANT = dict(
    crossing_stiffness=70.0, crossing_damping=3.0, damping=2.5, ends="clamped",
    layout="exact", **NO_NUMERICS
)  # fmt: skip
SETUPS = {
    "described": dict.fromkeys(authors.PHYSICS, DESCRIBED),
    "published": authors.PHYSICS,
    "compliant": dict.fromkeys(authors.PHYSICS, COMPLIANT),
}


@spelt
@dataclass(frozen=True)
class Scene:
    """One run: network, material, crossings, ends, drive and recording, in SI units.

    A field left at None takes the value of the setup.

    Attributes:
        network: from `crosshatch` or `polygon`.
        setup: "described" (the paper's text), "published" (the authors' code) or "compliant" (with
            crossings that give).
        force: F_max (N), which the input multiplies; Eq. 3 if None.
        tension: constant pull along each fibre at its far end (N).
        duration: s.
        seed: of the input.
        sample_rate: of the recording (Hz).
        drive_rate: knots of the input per second (Hz).
        diameter: of the fibres (m).
        youngs_modulus: E (Pa); the shear modulus is E/3 (incompressible).
        density: kg/m^3.
        crossing_stiffness: k of the spring between fibres (N/m); infinity: one common point.
        crossing_damping: nu of the damper beside it (N s/m).
        damping: rate at which velocity decays (1/s).
        filter_order: of the Laplace filter applied to velocities at every step, up to 6; 0 for
            none.
        dead_band: bend as the authors' rotations do, which see no angle between neighbouring
            elements below some 1e-5 rad (`fiberweb.engines.authors_rotations`).
        ends: "clamped" near end, free far end; "sliding": pinned near end, far end free to
            slide along the fibre and to turn; "pinned": pinned near end, free far end.
        layout: "exact": fibres cross where the network says and are pushed in one point;
            "authors": what is tied, read and pushed are nodes of the authors' 10 mm elements, five
            of them pushed in a crosshatch (`fiberweb.model.authors_mesh`); at any accuracy.
        tension_ramp: time over which the tension grows from zero (s).
        disturbance: lateral displacement of the driven point at the start (m), for perturbed
            pairs of runs.
        centre_lines: record every node of the fibres as well, to draw them.

    Raises:
        ValueError: one sentence naming the field, its value and what would be right.
    """

    network: Network
    setup: Literal[tuple(SETUPS)] = "described"
    force: Positive | None = None
    tension: NotNegative = 0.01
    duration: Positive = 100.0
    seed: Seed = authors.SEED
    sample_rate: Positive = 250.0
    drive_rate: Positive = 5.0
    diameter: Positive = 2e-3
    youngs_modulus: Positive = 1e8
    density: Positive = 1000.0
    crossing_stiffness: PositiveOrPinned | None = None
    crossing_damping: NotNegative | None = None
    damping: NotNegative | None = None
    filter_order: Annotated[int, Field(ge=0, le=6, strict=True)] | None = None
    dead_band: Annotated[bool, Field(strict=True)] | None = None
    ends: Literal["clamped", "sliding", "pinned"] | None = None
    layout: Literal["exact", "authors"] | None = None
    tension_ramp: NotNegative = 0.25
    disturbance: NotNegative = 0.0
    centre_lines: Annotated[bool, Field(strict=True)] = False

    def __post_init__(self):
        if not isinstance(self.network, Network):
            raise ValueError(
                f"network = {shown(self.network)} is not a network; make one with crosshatch(...) "
                "or polygon(...)"
            )
        for name, adapter in _ADAPTERS.items():
            try:
                value = adapter.validate_python(plain(getattr(self, name)))
            except ValidationError as error:
                raise ValueError(sentence(error, name)) from None
            object.__setattr__(self, name, value)
        for name, value in SETUPS[self.setup][self.network.topology].items():
            if getattr(self, name) is None:
                object.__setattr__(self, name, value)
        gaps = self.layout == "authors" and self.network.topology == "polygon"
        if gaps and math.isinf(self.crossing_stiffness):
            raise ValueError(
                "layout = 'authors' of a polygon starts with gaps at its crossings, which take "
                "springs: give crossing_stiffness a finite value, or take layout = 'exact'"
            )
        if self.force is None:
            object.__setattr__(self, "force", self._reference_force())

    def _reference_force(self) -> float:
        if self.setup == "published":
            return float(authors.reference_force(self.network.spacing))
        return float(buckling.reference_force(self.network.spacing, self.bending_stiffness))

    @property
    def area(self) -> float:
        """Cross-section (m^2)."""
        return math.pi * self.diameter**2 / 4

    @property
    def bending_stiffness(self) -> float:
        """EI (N m^2)."""
        return self.youngs_modulus * buckling.second_moment(self.diameter)

    @property
    def axial_stiffness(self) -> float:
        """EA (N)."""
        return self.youngs_modulus * self.area

    @property
    def wave_speed(self) -> float:
        """Of axial waves, sqrt(E / rho) (m/s)."""
        return math.sqrt(self.youngs_modulus / self.density)

    @property
    def buckling_number(self) -> float:
        """B of Eq. 4, dimensionless."""
        return float(
            buckling.buckling_number(self.force, self.network.spacing, self.bending_stiffness)
        )

    @property
    def samples(self) -> int:
        """Recorded instants; the first is t = 0."""
        return max(2, round(self.duration * self.sample_rate))

    @property
    def times(self) -> np.ndarray:
        """Of the recording, shape (samples,), s."""
        return np.arange(self.samples) / self.sample_rate

    def to_json(self) -> str:
        """The whole scene as one line of JSON; `from_json` reads it back."""
        values = {f.name: getattr(self, f.name) for f in fields(self) if f.name != "network"}
        return json.dumps({"network": self.network.spec()} | values)

    def distinct(self) -> dict:
        """What tells it from other scenes: network, setup, force, and every field with another
        value than the setup's own. A field that is added later is not among them."""
        own = {f.name: f.default for f in fields(self)}
        own |= SETUPS[self.setup][self.network.topology] | {"setup": None, "force": None}
        values = {name: getattr(self, name) for name in own if name != "network"}
        changed = {name: value for name, value in values.items() if value != own[name]}
        return {"network": self.network.spec()} | changed

    @classmethod
    def from_json(cls, text: str) -> Scene:
        """The scene that `to_json` wrote."""
        values = json.loads(text)
        return cls(from_spec(values.pop("network")), **values)


_ADAPTERS = {
    name: TypeAdapter(hint)
    for name, hint in get_type_hints(Scene, include_extras=True).items()
    if name != "network"
}
