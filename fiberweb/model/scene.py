"""A scene: all of one run that is physics, and nothing that is numerics."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, fields
from typing import Annotated, Literal, get_type_hints

import numpy as np
from pydantic import Field, TypeAdapter, ValidationError

from fiberweb.arguments import check_magnitude, plain, shown, spelt
from fiberweb.errors import sentence
from fiberweb.model import authors, buckling
from fiberweb.model.material import Fibres
from fiberweb.model.network import Network, from_spec

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False, strict=True)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False, strict=True)]
ByFibre = Positive | tuple[Positive, ...]  # of all fibres, or of one after the other
PositiveOrPinned = Annotated[float, Field(gt=0, strict=True)]  # infinity: one point
Finite = Annotated[float, Field(allow_inf_nan=False, strict=True)]
NotNegativeOrRigid = Annotated[float, Field(ge=0, strict=True)]  # infinity: rigid
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
TOPOLOGIES = (*authors.PHYSICS, "web")
SETUPS = {
    "described": dict.fromkeys(TOPOLOGIES, DESCRIBED),
    "published": authors.PHYSICS,
    "compliant": dict.fromkeys(TOPOLOGIES, COMPLIANT),
}


@spelt
@dataclass(frozen=True)
class Scene:
    """One run: network, material, crossings, ends, drive and recording, in SI units.

    A field left at None takes the value of the setup.

    Attributes:
        network: from `crosshatch`, `polygon` or `web`.
        setup: "described" (the paper's text), "published" (the authors' code) or "compliant" (with
            crossings that give).
        force: F_max (N), which the input multiplies; Eq. 3 if None.
        stroke: displacement (m) that the input multiplies instead: the driven point is carried
            along a line across its fibre, whatever that takes, and there is no force; below 0, the
            other way.
        lever: length (m) of an arm that turns by the input times arcsin(stroke / lever), and
            whose end carries the driven point; None if the stroke is proportional to the input.
        tension: constant pull along each fibre at its far end (N).
        duration: s.
        seed: of the input.
        sample_rate: of the recording (Hz).
        drive_rate: knots of the input per second (Hz).
        lowest_knot: the knots lie between this and 1; -1 or, for an input of one sign, 0.
        diameter: of the fibres (m); this, E and the density are one number, or one for each fibre.
        youngs_modulus: E (Pa); the shear modulus is E/3 (incompressible).
        density: kg/m^3.
        loss_factor: tan(delta) of the material, axial and in bending, at `loss_frequency`; it
            grows in proportion to the frequency (Kelvin-Voigt).
        loss_frequency: Hz.
        crossing_stiffness: k of the spring between fibres (N/m); infinity: one common point.
        crossing_damping: nu of the damper beside it (N s/m).
        bond_stiffness: of a spring that keeps fibres at their angle where they cross (N m); 0:
            they are free to turn, infinity: they turn as one.
        damping: rate at which velocity decays (1/s).
        filter_order: of the Laplace filter applied to velocities at every step, up to 6; 0 for
            none.
        dead_band: bend as the authors' rotations do, which see no angle between neighbouring
            elements below some 1e-5 rad (`fiberweb.engines.authors_rotations`).
        ends: "clamped" near end, free far end; "sliding": pinned near end, far end free to
            slide along the fibre and to turn; "pinned": pinned near end, free far end; "sprung":
            as sliding, but on a spring along the fibre, which holds it at `tension` at rest.
        end_stiffness: of this spring (N/m).
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
    stroke: Finite | None = None
    lever: Positive | None = None
    tension: NotNegative = 0.01
    duration: Positive = 100.0
    seed: Seed = authors.SEED
    sample_rate: Positive = 250.0
    drive_rate: Positive = 5.0
    lowest_knot: Literal[-1, 0] = -1
    diameter: ByFibre = 2e-3
    youngs_modulus: ByFibre = 1e8
    density: ByFibre = 1000.0
    loss_factor: NotNegative = 0.0
    loss_frequency: Positive = 10.0
    crossing_stiffness: PositiveOrPinned | None = None
    crossing_damping: NotNegative | None = None
    bond_stiffness: NotNegativeOrRigid = 0.0
    damping: NotNegative | None = None
    filter_order: Annotated[int, Field(ge=0, le=6, strict=True)] | None = None
    dead_band: Annotated[bool, Field(strict=True)] | None = None
    ends: Literal["clamped", "sliding", "pinned", "sprung"] | None = None
    end_stiffness: Positive | None = None
    layout: Literal["exact", "authors"] | None = None
    tension_ramp: NotNegative = 0.25
    disturbance: NotNegative = 0.0
    centre_lines: Annotated[bool, Field(strict=True)] = False

    def __post_init__(self):
        if not isinstance(self.network, Network):
            raise ValueError(
                f"network = {shown(self.network)} is not a network; make one with crosshatch(...), "
                "polygon(...) or web(...)"
            )
        for name, adapter in _ADAPTERS.items():
            try:
                value = adapter.validate_python(plain(getattr(self, name)))
            except ValidationError as error:
                raise ValueError(sentence(error, name)) from None
            check_magnitude(name, value)
            object.__setattr__(self, name, value)
        topology = self.network.topology
        if topology not in SETUPS[self.setup]:
            known = " or ".join(SETUPS[self.setup])
            raise ValueError(
                f"setup = {self.setup!r} has no {topology}, only {known}; take another setup"
            )
        for name, value in SETUPS[self.setup][topology].items():
            if getattr(self, name) is None:
                object.__setattr__(self, name, value)
        self._check()
        if self.force is None and self.stroke is None:
            object.__setattr__(self, "force", self._reference_force())
            check_magnitude("force", self.force)

    def _check(self) -> None:
        """Raise ValueError for values that exclude one another."""
        polygon = self.network.topology == "polygon"
        if self.layout == "authors" and self.network.topology not in authors.PHYSICS:
            raise ValueError(
                f"layout = 'authors' is of their own networks, and this is a "
                f"{self.network.topology}; take layout = 'exact'"
            )
        if self.layout == "authors" and polygon and math.isinf(self.crossing_stiffness):
            raise ValueError(
                "layout = 'authors' of a polygon starts with gaps at its crossings, which take "
                "springs: give crossing_stiffness a finite value, or take layout = 'exact'"
            )
        if self.layout == "authors" and polygon and self.bond_stiffness:
            raise ValueError(
                f"bond_stiffness = {self.bond_stiffness:g}: layout = 'authors' of a polygon ties "
                "ends of fibres, where there is no angle to keep; take layout = 'exact'"
            )
        if self.layout == "authors" and self.stroke is not None:
            raise ValueError(
                f"stroke = {self.stroke:g}: layout = 'authors' pushes several nodes, and a stroke "
                "carries one; take layout = 'exact'"
            )
        if self.stroke is not None and self.force is not None:
            raise ValueError(
                f"force = {self.force:g} beside stroke = {self.stroke:g}: the driven point is "
                "pushed or carried; give one of the two"
            )
        if self.stroke is not None and self.disturbance:
            raise ValueError(
                f"disturbance = {self.disturbance:g}: with a stroke the driven point is where the "
                "motor carries it; leave one of the two out"
            )
        if self.stroke == 0.0:
            raise ValueError("stroke = 0 moves nothing; give a length, below 0 for the other way")
        if self.stroke is not None and self.drives_one_point:
            raise ValueError(
                f"stroke = {self.stroke:g} carries a crossing whose fibres are one point, which is "
                "not modelled; drive a point between crossings, or give a finite crossing_stiffness"
            )
        if self.lever is not None and not abs(self.stroke or math.inf) <= self.lever:
            raise ValueError(
                f"lever = {self.lever:g} carries a point no further than its length; give a "
                "stroke of at most that"
            )
        if (self.ends == "sprung") != (self.end_stiffness is not None):
            raise ValueError(
                f"ends = {self.ends!r} with end_stiffness = {self.end_stiffness}: springs at the "
                "ends take ends = 'sprung' and an end_stiffness, in N/m"
            )
        fibres = len(self.network.fibres)
        for name in Fibres._fields:
            value = getattr(self, name)
            if isinstance(value, tuple) and len(value) != fibres:
                raise ValueError(
                    f"{name} has {len(value)} values for {fibres} fibres; give one for all, or one "
                    "for each"
                )

    def _reference_force(self) -> float:
        if self.setup == "published":
            return float(authors.reference_force(self.network.spacing))
        return float(buckling.reference_force(self.network.spacing, self.bending_stiffness))

    @property
    def fibres(self) -> Fibres:
        """What each fibre is made of."""
        count = len(self.network.fibres)
        return Fibres(*(np.full(count, getattr(self, name)) for name in Fibres._fields))

    @property
    def thickest(self) -> float:
        """Largest diameter (m)."""
        return float(self.fibres.diameter.max())

    @property
    def area(self) -> float:
        """Cross-section of the driven fibre (m^2)."""
        return float(self.fibres.area[self.network.driven_fibre])

    @property
    def bending_stiffness(self) -> float:
        """EI of the driven fibre (N m^2)."""
        return float(self.fibres.bending_stiffness[self.network.driven_fibre])

    @property
    def axial_stiffness(self) -> float:
        """EA of the most yielding fibre (N)."""
        return float(self.fibres.axial_stiffness.min())

    @property
    def wave_speed(self) -> float:
        """Of axial waves, sqrt(E / rho), in the fibre where they are fastest (m/s)."""
        return float(self.fibres.wave_speed.max())

    @property
    def drives_one_point(self) -> bool:
        """Whether the driven point is a crossing whose fibres are one point."""
        network = self.network
        at = [distance for _, distance in network.stations[network.driven_fibre]]
        return math.isinf(self.crossing_stiffness) and bool(
            np.isclose(at, network.driven_distance).any()
        )

    @property
    def loss_time(self) -> float:
        """Viscosity over Young's modulus, loss factor over angular frequency (s)."""
        return self.loss_factor / (2 * math.pi * self.loss_frequency)

    @property
    def buckling_number(self) -> float:
        """B of Eq. 4, dimensionless; NaN of a stroke, which no force is known of."""
        if self.force is None:
            return math.nan
        return float(
            buckling.buckling_number(self.force, self.network.spacing, self.bending_stiffness)
        )

    @property
    def motor_angle(self) -> float:
        """By which the lever turns for u = 1 (degrees); NaN without one."""
        if self.lever is None:
            return math.nan
        return math.degrees(math.asin(abs(self.stroke) / self.lever))

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
        """The scene that `to_json` wrote; ValueError for any other text."""
        try:
            values = json.loads(text)
            return cls(from_spec(values.pop("network")), **values)
        except (KeyError, TypeError, AttributeError) as error:
            raise ValueError(f"{shown(text)} is no scene as `Scene.to_json` writes it") from error


_ADAPTERS = {
    name: TypeAdapter(hint)
    for name, hint in get_type_hints(Scene, include_extras=True).items()
    if name != "network"
}
