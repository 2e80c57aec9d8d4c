"""Series for small angles."""

from __future__ import annotations

from fiberweb.engines.jit import both


@both
def sine_cosine(angle):
    """Sine and cosine, to round-off up to 0.03 rad and to 2e-10 up to 0.3 rad."""
    q = angle * angle
    less = q * (1 / 6 - q * (1 / 120 - q * (1 / 5040)))
    cosine = 1.0 - q * (0.5 - q * (1 / 24 - q * (1 / 720 - q * (1 / 40320))))
    return angle - angle * less, cosine


@both
def angle_over_sine(h):
    """theta / sin(theta) by h = 1 - cos(theta): arcsin(z) / (z sqrt(1 - z^2)) for z^2 = h / 2, to
    2e-9 up to 0.3 rad."""
    q = h * h
    return (1.0 + h * (1 / 3)) + q * ((2 / 15 + h * (2 / 35)) + q * (8 / 315))
