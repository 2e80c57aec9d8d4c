"""The loops of the cosserat engine over nodes and elements, one thing each, and its sums."""

from __future__ import annotations

import numpy as np

from fiberweb.engines.jit import kernel, summing


@kernel
def stress_pass(
    x0, x1, y0, y1, vx0, vx1, vy0, vy1, omega, c, s, edge, over_edge, axial, shear, over_inertia,
    fx, fy, length, alpha,
):  # fmt: skip
    """Forces in the elements, and the angular acceleration from shear and stretching.

    `over_edge` is 1 / edge on elements and 0 in gaps, which carries all that gaps lack.
    """
    for i in range(fx.shape[0]):
        dx = x1[i] - x0[i]
        dy = y1[i] - y0[i]
        q = dx * dx + dy * dy
        r = 1.0 / np.sqrt(q)
        o = over_edge[i]
        over_e = edge[i] * r
        n3 = axial * ((dx * c[i] + dy * s[i]) * o - edge[i] * o)
        ns = shear * ((dy * c[i] - dx * s[i]) * o)
        nx = (n3 * c[i] - ns * s[i]) * over_e
        ny = (n3 * s[i] + ns * c[i]) * over_e
        fx[i] = nx
        fy[i] = ny
        length[i] = q * r
        couple = (dx * ny - dy * nx) * (q * r * o)
        rate = (dx * (vx1[i] - vx0[i]) + dy * (vy1[i] - vy0[i])) * (r * r)
        alpha[i] = couple * (over_inertia * o) + omega[i] * rate


@kernel
def couple_pass(angle0, angle1, length0, length1, bend, half_over_voronoi, couple):
    """Bending couple at inner nodes."""
    for i in range(couple.shape[0]):
        e = (length0[i] + length1[i]) * half_over_voronoi[i]
        couple[i] = bend[i] * (angle1[i] - angle0[i]) / (e * e * e)


@kernel
def velocity_pass(v, f0, f1, outer, kick, decay):
    """Kick and damp one direction of the nodes' velocities."""
    for i in range(v.shape[0]):
        v[i] = decay * (v[i] + kick[i] * (f1[i] - f0[i] + outer[i]))


@kernel
def drift_pass(x, v, step):
    """Positions by velocities."""
    for i in range(x.shape[0]):
        x[i] += step * v[i]


@kernel
def spin_pass(
    omega, alpha, couple0, couple1, length, over_edge, decay, stretched, over_inertia, step
):
    """Kick and damp the angular velocities; the damper's power of dilatation as a series."""
    for i in range(omega.shape[0]):
        e = length[i] * over_edge[i]
        bending = (couple1[i] - couple0[i]) * (e * over_edge[i] * over_inertia)
        a = stretched[i] * (e - 1.0)
        less = decay[i] * (1.0 - a * (1.0 - a * (0.5 - a * (1.0 / 6.0))))
        omega[i] = (omega[i] + step * (alpha[i] + bending)) * less


@kernel
def rotate_pass(angle, omega, c, s, step):
    """Turn each element by step times omega: series for sine and cosine of a small angle."""
    for i in range(angle.shape[0]):
        d = step * omega[i]
        angle[i] += d
        q = d * d
        sine = d * (1.0 - q * (1 / 6) * (1.0 - q * (1 / 20) * (1.0 - q * (1 / 42))))
        cosine = 1.0 - q * 0.5 * (1.0 - q * (1 / 12) * (1.0 - q * (1 / 30) * (1.0 - q * (1 / 56))))
        new = c[i] * cosine - s[i] * sine
        s[i] = s[i] * cosine + c[i] * sine
        c[i] = new


@kernel
def strain_energy(x, y, angle, node_arrays, element_arrays, stride):
    """Elastic energy of the fibres (J): the potential of stretch, and of shear and bending to
    leading order in the stretch, whose factors in PyElastica's equations have none."""
    bend, half_over_voronoi = node_arrays[4], node_arrays[5]
    edge, over_edge, _, _, axial, shear, _ = element_arrays
    length = np.sqrt((x[stride:] - x[:-stride]) ** 2 + (y[stride:] - y[:-stride]) ** 2)
    total = 0.0
    for i in range(angle.shape[0]):
        dx, dy = x[i + stride] - x[i], y[i + stride] - y[i]
        c, s = np.cos(angle[i]), np.sin(angle[i])
        along = (dx * c + dy * s) * over_edge[i]
        across = (dy * c - dx * s) * over_edge[i]
        if over_edge[i] > 0.0:
            total += axial * edge[i] * (along - 1.0 - np.log(along))
            total += 0.5 * shear * edge[i] * across * across
        if bend[i] > 0.0:
            e = (length[i - stride] + length[i]) * half_over_voronoi[i]
            total += 0.5 * bend[i] * (angle[i] - angle[i - stride]) ** 2 / (e * e * e)
    return total


@summing
def squared_spin(omega, weight):
    """Sum of weight times omega^2."""
    total = 0.0
    for i in range(omega.shape[0]):
        total += weight[i] * omega[i] * omega[i]
    return total


@summing
def filter_loss(unfiltered, before, filtered, mass):
    """What the filter takes in a step (J): unfiltered and filtered velocities after the kick,
    and those before it."""
    total = 0.0
    for i in range(mass.shape[0]):
        total += 0.5 * mass[i] * (unfiltered[i] - filtered[i]) * (before[i] + filtered[i])
    return total
