"""Material damping of fibres whose elements turn; see `fiberweb.engines.viscosity`."""

from __future__ import annotations

from fiberweb.engines.jit import kernel
from fiberweb.engines.laplace import REACH


@kernel
def damp_elements(viscosity, state, scratch, rods, s):
    """Damp the velocities of fibres whose elements turn by themselves, after all else in a step and
    before the drift: stretches by the nodes' velocities alone, and turns by the elements' spins, so
    that two systems of one diagonal on each side are solved."""
    x, y, vx, vy, _, omega = state[:6]
    stretch, turn, _ = viscosity.compliance
    mm, mm1, tt, tt1 = (
        viscosity.factors.mm, viscosity.factors.mm1, viscosity.factors.tt, viscosity.factors.tt1
    )  # fmt: skip
    bx, by, spin, moment, tension, fx, fy = viscosity[2:9]
    kick_x, kick_y, decay = rods.kick_x, rods.kick_y, rods.decay
    low, high = REACH * s, vx.shape[0] - REACH * s  # beyond are ghosts without a length
    for i in range(low, high):
        j, up = i - s, i + s
        tx, ty = (x[up] - x[i]) / scratch.length[i], (y[up] - y[i]) / scratch.length[i]
        rx, ry = (x[i] - x[j]) / scratch.length[j], (y[i] - y[j]) / scratch.length[j]
        kx, ky = decay * kick_x[i], decay * kick_y[i]
        own = stretch[i] + (kx + decay * kick_x[up]) * tx * tx + (ky + decay * kick_y[up]) * ty * ty
        off = -kx * tx * rx - ky * ty * ry
        tt1[i] = off * tt[j]
        tt[i] = 1.0 / (own - off * tt1[i])
        rate = tx * (vx[up] + bx[up] - vx[i] - bx[i]) + ty * (vy[up] + by[up] - vy[i] - by[i])
        tension[i] = rate - tt1[i] * tension[j]
        ease = rods.spin_kick * rods.spin_decay[j] * rods.ease[j] * rods.edge[j]
        own = rods.spin_kick * rods.spin_decay[i] * rods.ease[i] * rods.edge[i]
        mm1[i] = -ease * mm[j]
        mm[i] = 1.0 / (turn[i] + own + ease + ease * mm1[i])
        moment[i] = omega[i] + spin[i] - omega[j] - spin[j] - mm1[i] * moment[j]
    for i in range(high - 1, low - 1, -1):
        up = i + s
        tension[i] = tension[i] * tt[i] - tt1[up] * tension[up]
        moment[i] = moment[i] * mm[i] - mm1[up] * moment[up]
        fx[i] = tension[i] * (x[up] - x[i]) / scratch.length[i]
        fy[i] = tension[i] * (y[up] - y[i]) / scratch.length[i]
    for i in range(low, high):
        vx[i] += decay * kick_x[i] * (fx[i] - fx[i - s])
        vy[i] += decay * kick_y[i] * (fy[i] - fy[i - s])
        own = rods.spin_kick * rods.spin_decay[i] * rods.ease[i] * rods.edge[i]
        omega[i] += own * (moment[i + s] - moment[i])


@kernel
def elements_power(viscosity, after, s):
    """Power (W) that the viscous stresses of elements take, from velocities after the step."""
    bx, by, spin, moment, _, fx, fy = viscosity[2:9]
    total = 0.0
    for i in range(REACH * s, fx.shape[0] - REACH * s):
        j, up = i - s, i + s
        total += 0.5 * fx[i] * (after.vx[up] + bx[up] - after.vx[i] - bx[i])
        total += 0.5 * fy[i] * (after.vy[up] + by[up] - after.vy[i] - by[i])
        total += 0.5 * moment[i] * (after.omega[i] + spin[i] - after.omega[j] - spin[j])
    return total
