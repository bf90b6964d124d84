"""Strips with rigid ends: rolled by a turned end and by a moment, and bent by a magnet at their tip."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

import magshell as ms
from magshell.shell import rotation

SCALES = {"h/10": 0.1, "h/100": 0.01}
"""Length scales over the thickness."""
MU = 1e5
TURNS = 2.0
LENGTH, WIDTH, ELEMENTS = 0.12, 0.01, 32


class Row(NamedTuple):
    """A comparison.

    Attributes
    ----------
    case, scale, quantity : str
    found, reference : float
    whole : float
        What the difference is relative to.
    """

    case: str
    scale: str
    quantity: str
    found: float
    reference: float
    whole: float

    @property
    def difference(self) -> float:
        """Relative."""
        return (self.found - self.reference) / self.whole


def row(case: str, scale: str, quantity: str, found: float, reference: float) -> Row:
    """A comparison relative to the reference."""
    return Row(case, scale, quantity, float(found), float(reference), float(reference))


def rubber(thickness: float, scale: float) -> ms.MicropolarStVenantKirchhoff:
    """Without Poisson's effect, so that strips are beams: E = 2 μ."""
    return ms.MicropolarStVenantKirchhoff(MU, 0.0, MU, scale * thickness)


def bending(width: float, thickness: float, scale: float) -> float:
    """D = E I + μ l² A, N m²: the couple stress bears a part."""
    return 2.0 * MU * width * thickness**3 / 12.0 + MU * (scale * thickness) ** 2 * width * thickness


def circle(model: ms.Model, path: ms.Path) -> float:
    """Farthest distance of a node from where the rolled strip has it, over the strip's length."""
    points = model.shell.mesh.points
    radius = LENGTH / (2.0 * np.pi * TURNS)
    angle = points[:, 0] / radius
    expected = np.column_stack([radius * np.sin(angle), points[:, 1], radius * (1.0 - np.cos(angle))])
    found = points + path.steps[-1].state.displacement(len(points))
    return float(np.linalg.norm(found - expected, axis=1).max()) / LENGTH


def rolled(name: str, by_moment: bool) -> Iterator[Row]:
    """A strip rolled through two turns."""
    scale, thickness = SCALES[name], LENGTH / 240.0
    stiffness, curvature = bending(WIDTH, thickness, scale), 2.0 * np.pi * TURNS / LENGTH
    end = ms.RigidBody("right", name="end")
    mesh, material = ms.mesh.rectangle(LENGTH, WIDTH, (ELEMENTS, 1)), rubber(thickness, scale)
    supports: list = [ms.Clamp("left")]
    if by_moment:
        shell = ms.Shell(mesh, thickness, material)
        loads = [ms.Moment("right", (0.0, -stiffness * curvature, 0.0))]
    else:
        shell, loads = ms.Shell(mesh, thickness, material, rigid=[end]), []
        supports.append(ms.Prescribe("end", "omega", value=(0.0, -2.0 * np.pi * TURNS, 0.0)))
    model = ms.Model(shell, supports, loads=loads)
    path = ms.solve(model)
    case = "strip rolled twice by " + ("an end moment D κ" if by_moment else "a turned rigid end")
    yield Row(case, name, "farthest from the circle / L", circle(model, path), 0.0, 1.0)
    if not by_moment:
        yield row(case, name, "moment at the clamp / D κ", last(path)["left.M2"] / (stiffness * curvature), 1.0)


def last(path: ms.Path) -> dict:
    """The history of the last step."""
    return dict(zip(path.history.columns, path.history.rows(path.steps)[-1], strict=True))


def tip_magnet(name: str) -> Iterator[Row]:
    """A passive strip with a magnet at its tip, in a field at right angles: θ = Q cos θ."""
    scale, thickness, field = SCALES[name], 1e-3, 10e-3
    for Q in (1.0, 5.0):
        moment = Q * bending(WIDTH, thickness, scale) / (LENGTH * field)
        shell = ms.Shell(
            ms.mesh.rectangle(LENGTH, WIDTH, (ELEMENTS, 1)),
            thickness,
            rubber(thickness, scale),
            rigid=[ms.RigidBody("right", name="magnet", moment=(moment, 0, 0))],
        )
        path = ms.solve(ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0, 0, field))))
        turned = rotation.logarithm(path.steps[-1].state.q[[path.discretisation.rows.nodes]])[0]
        expected = brentq(lambda θ, Q=Q: θ - Q * np.cos(θ), 0.0, 0.5 * np.pi)
        yield row(f"magnet of Q = {Q:g} at the tip", name, "angle (rad)", -turned[1], expected)
