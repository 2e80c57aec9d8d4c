"""The compliant setup once more, in Exudyn: nothing of this project's engines is in it.

Planar geometrically exact beams of three nodes (shear and rotary inertia included), consistent
mass, an implicit generalised-alpha integrator. From the project come the scene's numbers, the
network's geometry and the input's spline. The only module that imports Exudyn, which not every
platform has a wheel of: import it where it is used.

References: Simo and Vu-Quoc, J. Appl. Mech. 53, 849 (1986), for the beam; Gerstmayr,
Exudyn - a C++-based Python package for flexible multibody systems, Multibody Syst. Dyn. 60,
533 (2024), for the code.
"""

from __future__ import annotations

from itertools import pairwise

import exudyn as exu
import numpy as np
from exudyn import itemInterface as items

from fiberweb.model import drive
from fiberweb.model.scene import Scene

SHEAR_FACTOR = 27.0 / 28.0  # of a round section at Poisson's ratio 1/2
# consistent mass of a three-node element of unit mass
CONSISTENT = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]]) / 30.0


def cantilever(load: float, elements: int = 8) -> tuple[float, float]:
    """Tip displacements -u/L and w/L of an end-loaded cantilever without shear or stretch.

    Args:
        load: P L^2 / EI.
        elements: of three nodes.
    """
    model = _Model()
    nodes = model.beam(
        np.linspace([0.0, 0.0], [1.0, 0.0], 2 * elements + 1),
        dict(bendingStiffness=1.0, axialStiffness=1e7, shearStiffness=1e7, massPerLength=1.0,
             crossSectionInertia=0.0),
    )  # fmt: skip
    model.clamp(nodes[0])
    model.force(nodes[-1], [0.0, load])
    model.system.Assemble()
    settings = _settings()
    settings.staticSolver.numberOfLoadSteps = 20
    settings.staticSolver.newton.relativeTolerance = 1e-10
    model.system.SolveStatic(settings)
    tip = model.system.GetNodeOutput(nodes[-1], exu.OutputVariableType.Displacement)
    return -float(tip[0]), float(tip[1])


def respond(scene: Scene, elements: int, step: float, slender: bool = False) -> np.ndarray:
    """Displacement of the crossings, on their first fibre, and of the section midpoints.

    Args:
        scene: of the compliant setup.
        elements: of three nodes, on each section.
        step: s; a whole number of them makes a sample.
        slender: with a tenth of shear compliance and rotary inertia (nought is singular).

    Returns:
        shape (samples, readouts, 2), m, in the order of `fiberweb.simulate`.
    """
    model, network = _Model(), scene.network
    inertia = scene.density * np.pi * scene.diameter**4 / 64
    section = dict(
        massPerLength=scene.density * scene.area,
        crossSectionInertia=inertia * (0.1 if slender else 1.0),
        bendingStiffness=scene.bending_stiffness,
        axialStiffness=scene.axial_stiffness,
        shearStiffness=scene.axial_stiffness * SHEAR_FACTOR / 3.0 * (10.0 if slender else 1.0),
    )
    meeting: dict[int, list[int]] = {}
    crossings, midpoints = {}, []
    ramp = scene.tension_ramp
    u = drive.spline(scene.seed, scene.duration, scene.drive_rate)

    for fibre, (near, far) in enumerate(network.fibres):
        ends = network.sections(fibre)
        along = np.concatenate(
            [[0.0]] + [np.linspace(a, b, 2 * elements + 1)[1:] for a, b in pairwise(ends)]
        )
        direction = (far - near) / ends[-1]
        nodes = model.beam(near + along[:, None] * direction, section, scene.damping)
        model.clamp(nodes[0])
        model.force(nodes[-1], scene.tension * direction,
                    lambda t: min(1.0, t / ramp) if ramp > 0.0 else 1.0)  # fmt: skip
        for number, (crossing, _) in enumerate(network.stations[fibre]):
            node = nodes[2 * elements * (number + 1)]
            meeting.setdefault(crossing, []).append(node)
            crossings.setdefault(crossing, node)
        midpoints += nodes[elements :: 2 * elements]
        if fibre == network.driven_fibre:
            driven = nodes[int(np.argmin(abs(along - network.driven_distance)))]
            lateral = np.array([-direction[1], direction[0]])
            model.force(driven, scene.force * lateral, lambda t: float(u(t)))
    for nodes in meeting.values():
        if len(nodes) == 2:
            model.spring_damper(nodes, scene.crossing_stiffness, scene.crossing_damping)
    return model.integrate([*crossings.values(), *midpoints], scene, step)


class _Model:
    """A system under construction."""

    def __init__(self):
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        ground = self.system.AddNode(items.NodePointGround())
        self.ground = self._coordinate(ground, 0)

    def _coordinate(self, node, coordinate):
        return self.system.AddMarker(
            items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate)
        )

    def beam(self, points, section, damping: float = 0.0) -> list:
        """Nodes of a straight chain of elements of three nodes each, with every point of it
        damped in proportion to its mass."""
        direction = points[-1] - points[0]
        angle = float(np.arctan2(direction[1], direction[0]))
        nodes = [
            self.system.AddNode(items.NodeRigidBody2D(referenceCoordinates=[*point, angle]))
            for point in points
        ]
        damper = np.zeros((3 * len(nodes), 3 * len(nodes)))
        for i in range(0, len(nodes) - 1, 2):
            length = float(np.linalg.norm(points[i + 2] - points[i]))
            self.system.AddObject(
                items.ObjectBeamGeometricallyExact2D(
                    nodeNumbers=nodes[i : i + 3], length=length, **section
                )
            )
            mass = section["massPerLength"] * length * CONSISTENT
            for axis in range(2):
                at = 3 * np.arange(i, i + 3) + axis
                damper[np.ix_(at, at)] += damping * mass
        if damping:
            matrix = exu.MatrixContainer()
            matrix.SetWithDenseMatrix(damper, useDenseMatrix=False)
            self.system.AddObject(
                items.ObjectGenericODE2(
                    nodeNumbers=nodes, dampingMatrix=matrix,
                    visualization=items.VObjectGenericODE2(show=False),
                )
            )  # fmt: skip
        return nodes

    def clamp(self, node) -> None:
        for coordinate in range(3):
            pair = [self.ground, self._coordinate(node, coordinate)]
            self.system.AddObject(items.CoordinateConstraint(markerNumbers=pair))

    def force(self, node, vector, factor=None) -> None:
        """A force (N) on a node, times a function of time."""
        vector = [*map(float, vector), 0.0]
        marker = self.system.AddMarker(items.MarkerNodePosition(nodeNumber=node))
        function = 0
        if factor is not None:

            def function(system, t, load):
                scale = factor(t)
                return [scale * component for component in load]

        self.system.AddLoad(
            items.LoadForceVector(
                markerNumber=marker, loadVector=vector, loadVectorUserFunction=function
            )
        )

    def spring_damper(self, nodes, stiffness: float, damping: float) -> None:
        markers = [self.system.AddMarker(items.MarkerNodePosition(nodeNumber=n)) for n in nodes]
        self.system.AddObject(
            items.ObjectConnectorCartesianSpringDamper(
                markerNumbers=markers,
                stiffness=[stiffness, stiffness, 0.0],
                damping=[damping, damping, 0.0],
            )
        )

    def integrate(self, nodes, scene: Scene, step: float) -> np.ndarray:
        system = self.system
        sensors = [
            system.AddSensor(
                items.SensorNode(
                    nodeNumber=node, storeInternal=True,
                    outputVariableType=exu.OutputVariableType.Displacement,
                )
            )
            for node in nodes
        ]  # fmt: skip
        system.Assemble()
        settings = _settings()
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        time = settings.timeIntegration
        time.endTime = (scene.samples - 1) / scene.sample_rate
        time.numberOfSteps = round(time.endTime / step)
        time.newton.useModifiedNewton = True
        time.newton.relativeTolerance = 1e-8
        time.generalizedAlpha.spectralRadius = 0.9
        settings.solution.sensors.writePeriod = 1.0 / scene.sample_rate
        system.SolveDynamic(settings)
        stored = [system.GetSensorStoredData(sensor) for sensor in sensors]
        assert all(len(data) == scene.samples for data in stored)
        np.testing.assert_allclose(stored[0][:, 0], scene.times, atol=1e-9)
        return np.stack([data[:, 1:3] for data in stored], axis=1)


def _settings():
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    settings.staticSolver.verboseMode = 0
    return settings
