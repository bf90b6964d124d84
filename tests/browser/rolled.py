"""A path without a solve: a plate rolled up to a circle by a formula, on a real mesh and its equations."""

from __future__ import annotations

import numpy as np

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.linalg.ordering import nested_dissection
from magshell.mesh import Mesh
from magshell.solver.path import Path
from magshell.solver.step import Step

LENGTH, WIDTH = 0.1, 0.1
FIELD = 50e-3


def plate(elements: tuple[int, int]) -> Mesh:
    """Quadrilaterals."""
    return ms.mesh.rectangle(LENGTH, WIDTH, elements)


def mixed() -> Mesh:
    """Five quadrilaterals, and the last one cut into two triangles."""
    whole = plate((3, 2))
    a, b, c, d, ab, bc, cd, da = whole.elements[-1].tolist()
    ac = len(whole.points)
    points = np.vstack([whole.points, whole.points[[a, c]].mean(axis=0)])
    triangles = [[a, b, c, c, ab, bc, c, ac], [a, c, d, d, ac, cd, d, da]]
    return Mesh(points, np.vstack([whole.elements[:-1], triangles]), edge_groups={"left": whole.edge_groups["left"]})


def rolled(mesh: Mesh, steps: int, probe: str = "tip") -> Path:
    """A plate clamped at one end, with directors and rotations that go with the roll, in a field that rises."""
    rubber = ms.MicropolarNeoHookean(shear_modulus=303e3, lame_lambda=7.3e6, coupling_modulus=30.3e3, length_scale=1e-4)
    shell = ms.Shell(mesh, 1e-3, rubber, ms.remanence.constant([143e-3, 0, 0]))
    model = ms.Model(
        shell,
        supports=[ms.Clamp("left")],
        field=ms.UniformField([0, 0, FIELD]),
        probes={probe: (LENGTH, WIDTH / 2, 0)},
    )
    discretisation = Discretisation(model, nested_dissection)
    path = Path(model, discretisation, ms.Settings(), "none", converged=True)
    path.courses.append(model.course(0))
    rest = discretisation.undeformed()
    s = mesh.points[:, 0]
    zero = np.zeros_like(s)
    for number in range(steps + 1):
        load = number / steps
        angle = 2 * np.pi * load / LENGTH * s
        x = s * np.sinc(angle / np.pi)
        z = s * np.sin(angle / 2) * np.sinc(angle / (2 * np.pi))
        u = np.stack([x - s, zero, z], axis=1)
        w = np.stack([-np.sin(angle), zero, np.cos(angle) - 1], axis=1)
        q = np.stack([np.cos(angle / 2), zero, -np.sin(angle / 2), zero], axis=1)
        state = rest._replace(u=u, w=w, q=q)
        field = load * model.field.vector
        path.steps.append(Step(number, load, state, 4, 0.0, None, float(load), 0, field, np.zeros(0), 0))
    return path
