"""What both planar kernels share: the drive, the recording, and the energy books.

Kinetic and elastic energy are taken at samples, work at every step; what is dissipated is
summed from its rate at intervals well below a network's periods.
"""

from __future__ import annotations

import numpy as np

from fiberweb.engines.jit import kernel, summing

BOOKING = 0.25e-3  # s between two looks at what is dissipated: well below a network's periods


@kernel
def drive_value(coefficients, rate, time):
    """The input's spline at one time."""
    i = min(int(time * rate), coefficients.shape[0] - 1)
    s = time - i / rate
    c = coefficients[i]
    return ((c[0] * s + c[1]) * s + c[2]) * s + c[3]


@kernel
def record(x, y, vx, vy, nodes, weights, rest_x, rest_y, half, out):
    """Displacement of the readouts at a whole step, from positions half a step ahead."""
    for r in range(nodes.shape[0]):
        ux = 0.0
        uy = 0.0
        for k in range(nodes.shape[1]):
            i = nodes[r, k]
            ux += weights[r, k] * (x[i] - half * vx[i] - rest_x[i])
            uy += weights[r, k] * (y[i] - half * vy[i] - rest_y[i])
        out[r, 0] = ux
        out[r, 1] = uy


@kernel
def outer_work(ux, uy, fx, fy):
    """Work of constant forces over displacements (J)."""
    total = 0.0
    for i in range(ux.shape[0]):
        total += fx[i] * ux[i] + fy[i] * uy[i]
    return total


@kernel
def in_bounds(vx, vy, limit):
    """Whether every velocity is finite and below the limit."""
    for i in range(vx.shape[0]):
        if not (abs(vx[i]) < limit and abs(vy[i]) < limit):
            return False
    return True


@summing
def squared_speed(vx, vy, mass):
    """Sum of m v^2 over all nodes (J)."""
    total = 0.0
    for i in range(vx.shape[0]):
        total += mass[i] * (vx[i] * vx[i] + vy[i] * vy[i])
    return total


@kernel
def joint_power(vx, vy, joints, damping):
    """Power that the crossings' dampers take (W)."""
    total = 0.0
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        total += damping[j] * ((vx[b] - vx[a]) ** 2 + (vy[b] - vy[a]) ** 2)
    return total


@kernel
def joint_energy(x, y, joints, stiffness):
    """Energy of the crossings' springs (J); none where the nodes are one point."""
    total = 0.0
    for j in range(joints.shape[0]):
        a, b = joints[j, 0], joints[j, 1]
        if stiffness[j] < np.inf:
            total += 0.5 * stiffness[j] * ((x[b] - x[a]) ** 2 + (y[b] - y[a]) ** 2)
    return total
