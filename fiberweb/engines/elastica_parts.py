"""What PyElastica is given beside its own rods, joints and dampers: the order of operations of the
authors' version, the drive, ends that slide or spring, walls, and an exact damper."""

from __future__ import annotations

import fiberweb.engines.jit  # noqa: F401  (first: it says where PyElastica's kernels are kept, too)

# isort: split
from itertools import chain

import elastica as ea
import numpy as np
from elastica._rotations import _inv_rotate
from numba import njit

from fiberweb.engines.stepping import drive_value


class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing, ea.Connections, ea.Damping):
    """Rods with everything a fibre network needs."""


class DampedFirst(Simulator):
    """The order of PyElastica 0.3.2, which the authors ran: damper, filter, constraints."""

    def constrain_rates(self, time):
        """Damp, filter and then hold velocities."""
        for act in chain(self._feature_group_damping, self._feature_group_constrain_rates):
            act(time=time)


class Drive(ea.NoForces):
    """A force pattern times the input u(t)."""

    def __init__(self, nodes, load, coefficients, rate):
        super().__init__()
        self.nodes, self.load = nodes, load
        self.coefficients, self.rate = coefficients, rate

    def apply_forces(self, system, time=0.0):
        """Add the load at this time."""
        u = drive_value(self.coefficients, self.rate, time)
        system.external_forces[:, self.nodes] += u * self.load


class Guide(ea.ConstraintBase):
    """A node that slides along a slanted line."""

    def __init__(self, *_, node, along, **kwargs):
        super().__init__(**kwargs)
        self.node, self.along = node, along

    def constrain_values(self, system, time):
        """Its position follows from its velocity."""

    def constrain_rates(self, system, time):
        """Leave it the part of its velocity along the line."""
        velocity = system.velocity_collection[:, self.node]
        velocity[:] = (self.along @ velocity) * self.along


class Motor(ea.ConstraintBase):
    """A node whose motion is given: the one of all that a motor carries."""

    def __init__(self, *_, node, rest, path, coefficients, rate, step, decay, **kwargs):
        super().__init__(**kwargs)
        self.node, self.rest, self.path = node, rest, path
        self.coefficients, self.rate = coefficients, rate
        self.step, self.decay = step, decay

    def constrain_values(self, system, time):
        """Its position follows from its velocity."""

    def constrain_rates(self, system, time):
        """What takes it along in a step, before the damper has its part; time is in mid-step."""
        if time == 0.0:  # the simulator tries all constraints before it starts
            return
        u = drive_value(self.coefficients, self.rate, time + self.step)
        way = self.rest + self.path * u - system.position_collection[:, self.node]
        system.velocity_collection[:, self.node] = way / (self.step * self.decay)


class Spring(ea.NoForces):
    """A spring along the fibre at one of its nodes, to where this rests."""

    def __init__(self, node, rest, root):
        super().__init__()
        self.node, self.rest, self.root = node, rest, root

    def apply_forces(self, system, time=0.0):
        """Pull the node back."""
        along = self.root @ (system.position_collection[:, self.node] - self.rest)
        system.external_forces[:, self.node] -= along * self.root


class Wall(ea.NoForces):
    """Bending moment of a clamp on the first element: the curvature of the half cell between
    wall and element centre (see `fiberweb.engines.layout`)."""

    def __init__(self, rod):
        super().__init__()
        self.directors = np.repeat(rod.director_collection[..., :1], 2, axis=2)
        self.stiffness = np.diag(rod.bend_matrix[..., 0]) / (0.5 * rod.rest_lengths[0])

    def apply_torques(self, system, time=0.0):
        """Turn the first element back towards the wall's direction."""
        _wall_torque(
            self.directors, system.director_collection, self.stiffness, system.dilatation,
            system.external_torques,
        )  # fmt: skip


@njit(cache=True)
def _wall_torque(pair, directors, stiffness, dilatation, torques):
    pair[:, :, 1] = directors[:, :, 0]
    turn = _inv_rotate(pair)
    e = 0.5 * (1.0 + dilatation[0])
    for i in range(3):
        torques[i, 0] -= stiffness[i] * turn[i, 0] / e**3


class ExactDamper(ea.DamperBase):
    """The decay of all velocities, exact for constant forces: what PyElastica's kick by the step
    lacks of `cosserat.kick_before_decay` is added before it."""

    def __init__(self, rate, step, missing, free_nodes, free_elements, **kwargs):
        super().__init__(**kwargs)
        self.decay = np.exp(-rate * step)
        self.of_nodes, self.of_elements = missing * free_nodes, missing * free_elements

    def dampen_rates(self, system, time=0.0):
        """Correct and damp; constraints have acted already, so what they hold is left alone."""
        system.velocity_collection += self.of_nodes * system.acceleration_collection
        system.omega_collection += self.of_elements * system.alpha_collection
        system.velocity_collection *= self.decay
        system.omega_collection *= self.decay
