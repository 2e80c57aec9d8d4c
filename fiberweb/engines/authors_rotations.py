"""Rotations as the authors' PyElastica computes them: a dead band in bending made of round-off.

Facts, with no code of theirs: PyElastica 0.3.2 turns an element's directors by products of
rotation matrices and never renormalises them, so that their squared lengths drift by some 1e-11.
The authors replaced its logarithm of a rotation (their repository, commit 444443f): the trace is
clipped at 3 and the quotient theta / sin(theta) taken of arccos of what is left, which is zero, and
with it the couple, wherever the squared angle between two elements is less than the drift of their
lengths. The band does not shrink with the force.

Both loops are compiled without contraction to fused multiply-adds: with it lengths drift
differently and the band has another width.

Reference: Gazzola et al., R. Soc. Open Sci. 5, 171628 (2018), Eq. 2.6 and appendix, for the
rotation vector between neighbouring directors.
"""

from __future__ import annotations

from fiberweb.engines.jit import uncontracted

TINY = 1e-14  # 1/s; their regularisation of omega / |omega|


@uncontracted
def couple_pass(c0, s0, c1, s1, length0, length1, bend, half_over_voronoi, couple):
    """Bending couple at inner nodes from the directors (c, s) of the elements beside them.

    With h = 1 - cos(theta): theta^2 = 2 h (1 + h / 6 + 2 h^2 / 45 + h^3 / 70 + ...), and
    theta / sin(theta) = 1 + theta^2 / 6 + 7 theta^4 / 360 + 31 theta^6 / 15120 + ...
    """
    for i in range(couple.shape[0]):
        e = (length0[i] + length1[i]) * half_over_voronoi[i]
        cosine = c1[i] * c0[i] + s1[i] * s0[i]
        trace = min((cosine + 1.0) + cosine, 3.0)
        h = 1.0 - (0.5 * trace - 0.5)
        q = 2.0 * h * (1.0 + h * (1 / 6 + h * (2 / 45 + h * (1 / 70))))
        quotient = 1.0 + q * (1 / 6 + q * (7 / 360 + q * (31 / 15120)))
        quotient = quotient if h > 0.0 else 0.0
        sine = s1[i] * c0[i] - c1[i] * s0[i]
        couple[i] = bend[i] * (quotient * sine) / (e * e * e)


@uncontracted
def rotate_pass(angle, omega, c, s, step):
    """Turn the directors by half a step twice, by Rodrigues' matrix, as position Verlet does."""
    half = 0.5 * step
    for i in range(angle.shape[0]):
        angle[i] += step * omega[i]
        speed = abs(omega[i])  # of a square that does not underflow, the root to the bit
        axis = omega[i] / (speed + TINY)
        d = speed * half
        q = d * d
        sine = d * (1.0 - q * (1 / 6) * (1.0 - q * (1 / 20) * (1.0 - q * (1 / 42))))
        cosine = 1.0 - q * 0.5 * (1.0 - q * (1 / 12) * (1.0 - q * (1 / 30) * (1.0 - q * (1 / 56))))
        along = 1.0 - (1.0 - cosine) * (axis * axis)
        across = sine * axis
        middle = along * c[i] - across * s[i]
        s_middle = along * s[i] + across * c[i]
        c[i] = along * middle - across * s_middle
        s[i] = along * s_middle + across * middle
