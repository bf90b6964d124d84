"""A problem of `peers.py` by a corotational shell of Kratos: python benchmarks/peers_kratos.py ELEMENT PROBLEM."""

from __future__ import annotations

import sys
import time
from importlib import metadata

import KratosMultiphysics as km
import KratosMultiphysics.StructuralMechanicsApplication as sma
import numpy as np
from KratosMultiphysics import python_linear_solver_factory
from peers_problems import MOST_ITERATIONS, PROBLEMS, TOLERANCE, Answer, Problem, fewest_steps

ELEMENTS = {
    "thick-4": "ShellThickElementCorotational3D4N",
    "thin-4": "ShellThinElementCorotational3D4N",
    "thick-3": "ShellThickElementCorotational3D3N",
    "thin-3": "ShellThinElementCorotational3D3N",
}
DISPLACEMENT = (km.DISPLACEMENT_X, km.DISPLACEMENT_Y, km.DISPLACEMENT_Z)
ROTATION = (km.ROTATION_X, km.ROTATION_Y, km.ROTATION_Z)


def shell(problem: Problem, element: str) -> km.Model:
    """Nodes, elements and section; triangles halve the quadrilaterals."""
    model = km.Model()
    part = model.CreateModelPart("shell", 2)
    part.ProcessInfo[km.DOMAIN_SIZE] = 3
    for variable in (
        km.DISPLACEMENT,
        km.ROTATION,
        km.REACTION,
        km.REACTION_MOMENT,
        sma.POINT_LOAD,
        km.VOLUME_ACCELERATION,
    ):
        part.AddNodalSolutionStepVariable(variable)
    section = part.CreateNewProperties(1)
    section[km.THICKNESS] = problem.thickness
    section[km.YOUNG_MODULUS] = problem.youngs_modulus
    section[km.POISSON_RATIO] = problem.poissons_ratio
    section[km.DENSITY] = 1.0
    law = sma.ReissnerMindlinShellElasticConstitutiveLaw if element == "thick-4" else sma.LinearElasticPlaneStress2DLaw
    section[km.CONSTITUTIVE_LAW] = law()
    points, cells = problem.grid()
    for number, point in enumerate(points):
        part.CreateNewNode(number + 1, *point)
    if element.endswith("3"):
        cells = np.concatenate([cells[:, [0, 1, 2]], cells[:, [0, 2, 3]]])
    for number, cell in enumerate(cells):
        part.CreateNewElement(ELEMENTS[element], number + 1, (cell + 1).tolist(), section)
    for names, kind in ((DISPLACEMENT, "REACTION"), (ROTATION, "REACTION_MOMENT")):
        for name, axis in zip(names, "XYZ", strict=True):
            km.VariableUtils().AddDof(name, getattr(km, f"{kind}_{axis}"), part)
    return model


def hold_and_load(name: str, part: km.ModelPart, problem: Problem) -> dict[int, np.ndarray]:
    """Supports; and the forces of the full load by node number."""
    m, n = problem.elements
    number = np.arange((m + 1) * (n + 1)).reshape(m + 1, n + 1) + 1
    if name == "annulus":
        for node in number[:, 0]:
            _fix(part, node, "XYZ", "XYZ")
        share = np.full(m + 1, 4.0 * problem.load / m)
        share[[0, -1]] *= 0.5
        return {int(node): np.array([0.0, 0.0, force]) for node, force in zip(number[:, -1], share, strict=True)}
    for node in number[:, 0]:
        _fix(part, node, "Y", "XZ")
    for node in number[:, -1]:
        _fix(part, node, "X", "YZ")
    _fix(part, number[-1, 0], "Z", "")
    return {int(number[-1, 0]): np.array([problem.load, 0, 0]), int(number[-1, -1]): np.array([0, -problem.load, 0])}


def _fix(part: km.ModelPart, node: int, displacements: str, rotations: str) -> None:
    for names, axes in ((DISPLACEMENT, displacements), (ROTATION, rotations)):
        for axis in axes:
            part.GetNode(int(node)).Fix(names["XYZ".index(axis)])


def strategy(part: km.ModelPart) -> km.ResidualBasedNewtonRaphsonStrategy:
    """Newton's method with the sparse LU that the wheel has."""
    solver = python_linear_solver_factory.ConstructSolver(
        km.Parameters('{"solver_type": "LinearSolversApplication.sparse_lu"}')
    )
    criterion = sma.ResidualDisplacementAndOtherDoFCriteria(TOLERANCE, 1e-9)
    scheme = sma.StructuralMechanicsStaticScheme(km.Parameters("{}"))
    builder = km.ResidualBasedBlockBuilderAndSolver(solver)
    newton = km.ResidualBasedNewtonRaphsonStrategy(
        part, scheme, criterion, builder, MOST_ITERATIONS, False, False, True
    )
    newton.SetEchoLevel(0)
    criterion.SetEchoLevel(0)
    newton.Initialize()
    return newton


def attempt(element: str, name: str, steps: int) -> Answer:
    """With equal load steps."""
    problem = PROBLEMS[name]
    model = shell(problem, element)
    part = model["shell"]
    forces = hold_and_load(name, part, problem)
    for number, node in enumerate(forces):
        part.CreateNewCondition("PointLoadCondition3D1N", number + 1, [node], part.GetProperties()[1])
    newton = strategy(part)
    answer = Answer(f"Kratos {metadata.version('KratosMultiphysics')}", ELEMENTS[element], name, steps=steps)
    start = time.process_time()
    for step in range(1, steps + 1):
        part.ProcessInfo[km.STEP] = step
        part.CloneTimeStep(step / steps)
        for node, force in forces.items():
            part.GetNode(node).SetSolutionStepValue(sma.POINT_LOAD, (force * step / steps).tolist())
        newton.InitializeSolutionStep()
        newton.Predict()
        converged = newton.SolveSolutionStep()
        newton.FinalizeSolutionStep()
        answer.solves += part.ProcessInfo[km.NL_ITERATION_NUMBER]
        if not converged:
            answer.reason = f"no convergence in {MOST_ITERATIONS} iterations of step {step} of {steps}"
            return answer
    answer.seconds = time.process_time() - start
    answer.unknowns = sum(not node.IsFixed(variable) for node in part.Nodes for variable in (*DISPLACEMENT, *ROTATION))
    if name == "annulus":
        edge = sorted(forces)
        ends = {"w_A": (edge[0], 2, 1.0), "w_B": (edge[-1], 2, 1.0)}
    else:
        outwards, inwards = forces
        ends = {"inwards": (inwards, 1, -1.0), "outwards": (outwards, 0, 1.0)}
    for key, (node, axis, sign) in ends.items():
        answer.values[key] = sign * part.GetNode(node).GetSolutionStepValue(km.DISPLACEMENT)[axis]
    return answer


def main() -> None:
    """Command line."""
    element, name = sys.argv[1:]
    km.Logger.GetDefaultOutput().SetSeverity(km.Logger.Severity.WARNING)
    fewest_steps(lambda steps: attempt(element, name, steps)).print()


if __name__ == "__main__":
    main()
