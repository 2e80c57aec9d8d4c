"""What fibres are made of."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.model import buckling


class Fibres(NamedTuple):
    """Material of every fibre of a network, arrays of shape (fibres,)."""

    diameter: np.ndarray  # m
    youngs_modulus: np.ndarray  # Pa
    density: np.ndarray  # kg/m^3

    @property
    def area(self) -> np.ndarray:
        """Cross-section (m^2)."""
        return np.pi * self.diameter**2 / 4

    @property
    def line_density(self) -> np.ndarray:
        """Mass per length (kg/m)."""
        return self.density * self.area

    @property
    def axial_stiffness(self) -> np.ndarray:
        """EA (N)."""
        return self.youngs_modulus * self.area

    @property
    def bending_stiffness(self) -> np.ndarray:
        """EI (N m^2)."""
        return self.youngs_modulus * [buckling.second_moment(d) for d in self.diameter.tolist()]

    @property
    def rotary_inertia(self) -> np.ndarray:
        """About the cross-section's diameter, per length (kg m): density times `second_moment`,
        multiplied in the order that keeps earlier runs' last bits."""
        # powers by Python's floats: NumPy's of arrays round in another way on some processors
        return self.density * np.pi * [d**4 for d in self.diameter.tolist()] / 64

    @property
    def wave_speed(self) -> np.ndarray:
        """Of axial waves, sqrt(E / rho) (m/s)."""
        return np.sqrt(self.youngs_modulus / self.density)
