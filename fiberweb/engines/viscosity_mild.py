"""Material damping where bending is so slow that a step hardly damps it; see
`fiberweb.engines.viscosity`.

The stiffest bend of a thin fibre is far slower than its stiffest stretch. Where a step takes no
more than `MILD` of the velocity of that bend, viscous moments are explicit: for the curvature k,
elastic moments are taken of k + t dk/dt, t the viscosity over E, with the rate from this step and
the two before (second order). What is left to solve for are the tensions, each with one neighbour
on a side. The moments are then those of the elastic energy's expanded spline, and the others of the
spline itself: trajectories differ by a part of the mesh's error, .1 % at two elements a section.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fiberweb.engines.jit import kernel, summing
from fiberweb.engines.lanes import inverse, load, store
from fiberweb.engines.layout import Layout, packed
from fiberweb.model.mesh import Mesh

# Share of the fastest bend's velocity that a step may take. A mode of frequency w is stable while
# (w h)^2 + 4 share < 4, by Jury's conditions on the recursion of three steps.
MILD = 0.1
# Highest over the usual chain's: 1 + x + x^2, x = 2/3, of `kirchhoff_stiffness.spline_matrix` for
# curvatures of alternating sign.
SPLINE = 19.0 / 9.0


class Curvatures(NamedTuple):
    """Of the two steps before, over nodes, 1/m; empty where moments are solved for."""

    last: np.ndarray
    earlier: np.ndarray
    steps: float  # viscosity over E, in steps


def build_curvatures(mesh: Mesh, layout: Layout, nodes: np.ndarray, step: float) -> Curvatures:
    """Room for the curvatures of so many nodes, if bending of a mesh is mildly damped, and slow
    beside the step whatever its damping."""
    time = mesh.scene.loss_time
    mild = time > 0.0 and step * (time + step / 4.0) * fastest_bend(mesh, layout) ** 2 <= MILD
    return Curvatures(*packed(*np.zeros((2, len(nodes) if mild else 0))), steps=time / step)


def fastest_bend(mesh: Mesh, layout: Layout) -> float:
    """Angular frequency (1/s) that no bending mode of the fibres exceeds.

    Deflections v of alternating sign on the shortest element of a fibre and its lightest node: the
    turns are 4 v / l, and the moments of neighbours make a force of 4 M / l.
    """
    fastest = 0.0
    for fibre, bending in enumerate(mesh.scene.fibres.bending_stiffness):
        own = layout.at[mesh.first[fibre] : mesh.first[fibre + 1]]
        shortest, lightest = layout.edge[own[:-1]].min(), layout.mass[own].min()
        fastest = max(fastest, 4.0 / shortest * np.sqrt(SPLINE * bending / shortest / lightest))
    return fastest


@kernel
def lead_pass(now, curvatures):
    """Add to the curvatures what their rates make of moments."""
    last, earlier, steps = curvatures
    for i in range(now.shape[0]):
        here = now[i]
        now[i] = here + steps * (1.5 * here - 2.0 * last[i] + 0.5 * earlier[i])
        earlier[i] = last[i]
        last[i] = here


@summing
def bending_power(led, curvatures, rods, step, s):
    """Power (W) that viscous moments take, from the curvatures after `lead_pass`."""
    last, c, c_up, c_up2 = curvatures.last, rods.bend, rods.bend_up, rods.bend_up2
    total = 0.0
    for i in range(led.shape[0] - 2 * s):
        here, up, up2 = led[i] - last[i], led[i + s] - last[i + s], led[i + 2 * s] - last[i + 2 * s]
        total += here * (c[i] * here + 2.0 * (c_up[i] * up + c_up2[i] * up2))
    return total / (curvatures.steps * step)


@kernel
def eliminate_tension(zero, viscosity, fibres, i, width):
    """As `viscosity.eliminate`, of the tensions alone."""
    tangent_x, tangent_y, _, kick_x, kick_y, vx, vy, before_x, before_y = fibres
    up, j = i + width, i - width
    tx, ty = load(zero, tangent_x, i), load(zero, tangent_y, i)
    rx, ry = load(zero, tangent_x, j), load(zero, tangent_y, j)
    kx, ky = load(zero, kick_x, i), load(zero, kick_y, i)
    ux = load(zero, vx, up) + load(zero, before_x, up) - load(zero, vx, i) - load(zero, before_x, i)
    uy = load(zero, vy, up) + load(zero, before_y, up) - load(zero, vy, i) - load(zero, before_y, i)
    off = zero - kx * tx * rx - ky * ty * ry
    own = (kx + load(zero, kick_x, up)) * tx * tx + (ky + load(zero, kick_y, up)) * ty * ty
    own = own + load(zero, viscosity.compliance.stretch, i)
    lower = off * load(zero, viscosity.factors.tt, j)
    store(inverse(own - off * lower), viscosity.factors.tt, i)
    store(lower, viscosity.factors.tt1, i)
    store(tx * ux + ty * uy - lower * load(zero, viscosity.tension, j), viscosity.tension, i)


@kernel
def substitute_tension(zero, viscosity, fibres, i, width):
    """As `viscosity.substitute`, of the tensions alone, and their forces."""
    tension, up = viscosity.tension, i + width
    t = load(zero, tension, i) * load(zero, viscosity.factors.tt, i)
    t = t - load(zero, viscosity.factors.tt1, up) * load(zero, tension, up)
    store(t, tension, i)
    store(t * load(zero, fibres[0], i), viscosity.force_x, i)
    store(t * load(zero, fibres[1], i), viscosity.force_y, i)
