"""The loops of the kirchhoff engine over nodes and edges, and the energy they derive from."""

from __future__ import annotations

import numpy as np

from fiberweb.engines.jit import kernel


@kernel
def stretch_pass(x0, x1, y0, y1, tx, ty, inverse):
    """Unit tangents and inverse lengths of the edges."""
    for i in range(tx.shape[0]):
        dx = x1[i] - x0[i]
        dy = y1[i] - y0[i]
        r = 1.0 / np.sqrt(dx * dx + dy * dy)
        tx[i] = dx * r
        ty[i] = dy * r
        inverse[i] = r


@kernel
def turn_pass(tx0, tx1, ty0, ty1, over_span, curvature, slope):
    """Curvature at inner nodes, and its derivative by the angle."""
    for i in range(curvature.shape[0]):
        sine = tx0[i] * ty1[i] - ty0[i] * tx1[i]
        cosine = tx0[i] * tx1[i] + ty0[i] * ty1[i]
        w = 1.0 / (2.0 + cosine)
        scaled = 3.0 * over_span[i] * w
        curvature[i] = scaled * sine
        slope[i] = scaled * w * (1.0 + 2.0 * cosine)


@kernel
def tension_pass(curvature0, curvature1, inverse, axial, edge, tension, bowing, half):
    """Tension of each edge with its bow, and the derivative of its energy by curvature.

    The energy of an edge of length l = l0 / g is EA l0 (1/g - 1 + log g + (1/g - 1) B + B^2 / 2),
    with B = b^2 / 24 what its bow adds to its length: that of the stress law at l + l0 B to the
    order that matters, and bounded below however far the edge is compressed.
    """
    for i in range(tension.shape[0]):
        g = edge[i] * inverse[i]
        reach = half * edge[i]
        b = reach * (curvature0[i] + curvature1[i])
        longer = b * b * (1.0 / 24.0)
        tension[i] = axial[i] * (1.0 - g + longer)
        bowing[i] = axial[i] * edge[i] * reach * b * (1.0 / g - 1.0 + longer) * (1.0 / 12.0)


@kernel
def moment_pass(
    moment, slope, c, c_up, c_up2, c_down, c_down2, s, s_up, s_up2, s_down, s_down2,
    bowing0, bowing1,
):  # fmt: skip
    """Moment at inner nodes, of the spline through five of them and of the bows."""
    for i in range(moment.shape[0]):
        near = c[i] * s[i] + c_up[i] * s_up[i] + c_down[i] * s_down[i]
        far = c_up2[i] * s_up2[i] + c_down2[i] * s_down2[i]
        moment[i] = slope[i] * (near + far + bowing0[i] + bowing1[i])


@kernel
def force_pass(tx, ty, inverse, tension, moment0, moment1, fx, fy):
    """Force in each edge: tension along it, moment difference across it."""
    for i in range(fx.shape[0]):
        shear = (moment0[i] - moment1[i]) * inverse[i]
        fx[i] = tension[i] * tx[i] - shear * ty[i]
        fy[i] = tension[i] * ty[i] + shear * tx[i]


@kernel
def kick_pass(x, v, f0, f1, outer, kick, decay, step):
    """Velocity by the net force, then position by the velocity (one direction)."""
    for i in range(v.shape[0]):
        new = decay * v[i] + kick[i] * (f1[i] - f0[i] + outer[i])
        v[i] = new
        x[i] += step * new


@kernel
def strain_energy(x, y, chain, work):
    """Elastic energy of the fibres at given positions (J); the potential of the passes, whose
    scratch it uses."""
    axial, edge, over_span, c, c_up, c_up2 = chain[:6]
    half = chain[13]
    tx, ty, inverse, k, slope = work[0][1:], work[1][1:], work[2][1:], work[8], work[9]
    stretch_pass(x[:-1], x[1:], y[:-1], y[1:], tx, ty, inverse)
    turn_pass(tx[:-1], tx[1:], ty[:-1], ty[1:], over_span[1:-1], k[1:-1], slope[1:-1])
    total = 0.0
    for i in range(k.shape[0] - 2):
        total += k[i] * (0.5 * c[i] * k[i] + c_up[i] * k[i + 1] + c_up2[i] * k[i + 2])
    for i in range(edge.shape[0]):
        g = edge[i] * inverse[i]
        longer = (half * edge[i] * (k[i] + k[i + 1])) ** 2 / 24.0
        e = 1.0 / g - 1.0
        total += axial[i] * edge[i] * (e + np.log(g) + (e + 0.5 * longer) * longer)
    return total
