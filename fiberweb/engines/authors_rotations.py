"""Rotations as the authors' PyElastica computes them: a dead band in bending made of round-off.

Facts, with no code of theirs: PyElastica 0.3.2 turns an element's directors by products of
rotation matrices and never renormalises them, so that their squared lengths drift by some 1e-11.
The authors replaced its logarithm of a rotation (their repository, commit 444443f): the trace is
clipped at 3 and the quotient theta / sin(theta) taken of arccos of what is left, which is zero, and
with it the couple, wherever the squared angle between two elements is less than the drift of their
lengths. The band does not shrink with the force.

Both loops are compiled without contraction to fused multiply-adds, but for their series: with it
lengths drift differently and the band has another width.

Reference: Gazzola et al., R. Soc. Open Sci. 5, 171628 (2018), Eq. 2.6 and appendix, for the
rotation vector between neighbouring directors.
"""

from __future__ import annotations

from fiberweb.engines.jit import uncontracted
from fiberweb.engines.series import angle_over_sine, sine_cosine


@uncontracted
def couple_pass(c0, s0, c1, s1, length0, length1, bend, half_over_voronoi, couple):
    """Bending couple at inner nodes from the directors (c, s) of the elements beside them; h is 1
    minus the cosine of the angle between them."""
    for i in range(couple.shape[0]):
        e = (length0[i] + length1[i]) * half_over_voronoi[i]
        cosine = c1[i] * c0[i] + s1[i] * s0[i]
        trace = min((cosine + 1.0) + cosine, 3.0)
        h = 1.0 - (0.5 * trace - 0.5)
        quotient = angle_over_sine(h)
        quotient = quotient if h > 0.0 else 0.0
        sine = s1[i] * c0[i] - c1[i] * s0[i]
        couple[i] = (bend[i] / (e * e * e)) * (quotient * sine)


@uncontracted
def rotate_pass(angle, omega, c, s, step):
    """Turn the directors by half a step twice, as position Verlet does, by Rodrigues' matrix.

    In the plane its diagonal is 1 - (1 - cos) a^2 with a = |omega| / (|omega| + 1e-14 / s), which
    rounds to the cosine, and the rest sin a: the sine, at a rate less by 1e-14 / s.
    """
    half = 0.5 * step
    for i in range(angle.shape[0]):
        angle[i] += step * omega[i]
        across, along = sine_cosine(half * omega[i])
        middle = along * c[i] - across * s[i]
        s_middle = along * s[i] + across * c[i]
        c[i] = along * middle - across * s_middle
        s[i] = along * s_middle + across * middle
