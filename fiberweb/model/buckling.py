"""The reference force (Eq. 3) and the buckling number (Eq. 4)."""

from __future__ import annotations

import numpy as np

DEFLECTION = 13.3e-3  # m, the lateral deflection that Eq. 3 holds constant (the paper's text)


def second_moment(diameter: float) -> float:
    """Second moment of area of a round fibre (m^4), diameter in m."""
    return np.pi * diameter**4 / 64


def reference_force(spacing: float, bending_stiffness: float) -> float:
    """F_max = 48 delta EI / s^3 (N), Eq. 3, for s in m and EI in N m^2."""
    return 48 * DEFLECTION * bending_stiffness / spacing**3


def critical_force(spacing: float, diameter: float, youngs_modulus: float) -> float:
    """F_max (N) at which B = 1, Eq. 4; spacing and diameter in m, E in Pa."""
    return 2 * np.pi**2 * youngs_modulus * second_moment(diameter) / spacing**2


def buckling_number(force: float, spacing: float, bending_stiffness: float) -> float:
    """B = P s^2 / (pi^2 EI) with P = F_max / 2, Eq. 4; dimensionless."""
    return 0.5 * force * spacing**2 / (np.pi**2 * bending_stiffness)
