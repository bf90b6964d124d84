"""Nearly incompressible bodies with the default element: write a table of `element.md`.

    python docs/make_incompressible_study.py       half a minute

Each case has its closed form, but for Cook's membrane, which is measured against the mesh twice as fine as the finest.
With volumetric locking the response falls short by a factor that grows with 1/(1 - 2 nu), more than a thousand here.
"""

from __future__ import annotations

import pathlib
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from blocks import write_blocks

import magshell as ms

DOCS = pathlib.Path(__file__).parent
COMMAND = "docs/make_incompressible_study.py"
RATIOS = (0.3, 0.49, 0.499, 0.4999)
YOUNG = 1e6
# The load is so small that the response is linear.
SMALL = 1e-6


class Case(NamedTuple):
    """A response to a small load.

    Attributes
    ----------
    name : str
    solve : callable
        Poisson's ratio and elements to the response.
    meshes : sequence of int
    exact : callable or None
        Of Poisson's ratio.
    """

    name: str
    solve: Callable[[float, int], float]
    meshes: Sequence[int]
    exact: Callable[[float], float] | None


EVERYWHERE = "everywhere"


def shell_of(mesh: ms.mesh.Mesh, thickness: float, nu: float) -> ms.Shell:
    """Of the default element, without micro-rotation: closed forms have no couple stress."""
    material = ms.MicropolarNeoHookean.from_moduli(youngs_modulus=YOUNG, poissons_ratio=nu)
    groups = {**mesh.element_groups, EVERYWHERE: np.arange(len(mesh.elements))}
    mesh = ms.mesh.Mesh(mesh.points, mesh.elements, groups, mesh.edge_groups, mesh.node_groups)
    return ms.Shell(mesh, thickness, material, micro_rotation=False)


def solved(model: ms.Model) -> ms.Path:
    """In one step."""
    return ms.solve(model, ms.Settings(first_step=1.0))


def plate(nu: float, count: int) -> float:
    """Deflection of the centre of a clamped square plate under pressure, over q a⁴/D; a quarter, a/h = 1000."""
    thickness = 1e-3
    mesh = ms.mesh.rectangle(0.5, 0.5, (count, count))
    rigidity = YOUNG * thickness**3 / (12.0 * (1.0 - nu**2))
    pressure = SMALL * rigidity
    supports = [
        ms.Clamp("left"),
        ms.Clamp("bottom"),
        ms.SymmetryPlane("right", (1, 0, 0)),
        ms.SymmetryPlane("top", (0, 1, 0)),
    ]
    model = ms.Model(
        shell_of(mesh, thickness, nu),
        supports,
        loads=[ms.Pressure(EVERYWHERE, pressure)],
        probes={"centre": (0.5, 0.5, 0)},
    )
    return abs(solved(model).probe("centre").u[-1, 2]) * rigidity / pressure


def beam(nu: float, count: int) -> float:
    """Deflection of a narrow cantilever under an end force, over F L³/(3 E I); L/h = 1000, free to bend across."""
    length, half, thickness = 1.0, 0.05, 1e-3
    mesh = ms.mesh.rectangle(length, half, (count, 1)).select_nodes("origin", x1=0, x2=0)
    supports = [
        ms.SymmetryPlane("left", (1, 0, 0)),
        ms.SymmetryPlane("bottom", (0, 1, 0)),
        ms.Prescribe("origin", "u", 3),
    ]
    rigidity = YOUNG * half * thickness**3 / 12.0
    force = SMALL * rigidity
    model = ms.Model(
        shell_of(mesh, thickness, nu),
        supports,
        loads=[ms.Force("right", (0, 0, force))],
        probes={"tip": (length, 0, 0)},
    )
    return solved(model).probe("tip").u[-1, 2] * 3.0 * rigidity / force


def tube(nu: float, count: int) -> float:
    """Mean radial displacement of a tube under pressure, clamped at one end, over p R²/(E h); R/h = 100, a quarter."""
    radius, length, thickness = 1.0, 1.0, 0.01
    mesh = ms.mesh.cylinder(radius, length, (4, count), angle=(0, 90))
    supports = [
        ms.Clamp("start"),
        ms.SymmetryPlane("angle-start", (0, 1, 0)),
        ms.SymmetryPlane("angle-stop", (1, 0, 0)),
    ]
    pressure = SMALL * YOUNG * thickness
    model = ms.Model(
        shell_of(mesh, thickness, nu),
        supports,
        loads=[ms.Pressure(EVERYWHERE, pressure)],
    )
    path = solved(model)
    normals, u = model.normals, path.steps[-1].state.u
    radial = abs(np.einsum("nx,nx->n", normals, u))
    z = np.unique(np.round(mesh.points[:, 2], 9))
    on = [np.isclose(mesh.points[:, 2], place).nonzero()[0] for place in z]
    profile = np.array([radial[nodes].mean() for nodes in on])
    weights = np.zeros(len(z))
    for first in range(0, len(z) - 2, 2):  # Simpson's rule in each element
        weights[first : first + 3] += (z[first + 2] - z[first]) / 6.0 * np.array([1.0, 4.0, 1.0])
    return float(weights @ profile) / length * YOUNG * thickness / (pressure * radius**2)


def tube_exact(nu: float) -> float:
    """w = 1 - exp(-βz)(cos βz + sin βz), β⁴ = 3 (1 - ν²)/(R h)², of a long tube."""
    beta = (3.0 * (1.0 - nu**2)) ** 0.25 / np.sqrt(0.01)
    return 1.0 - 1.0 / beta


def cook(nu: float, count: int) -> float:
    """Deflection of the upper corner of Cook's membrane, over F/(E h)."""
    corners = {"membrane": np.array([[0.0, 0.0], [48.0, 44.0], [48.0, 60.0], [0.0, 44.0]])}
    mesh = ms.mesh.blocks(corners, {"membrane": (count, count)})
    mesh = mesh.select_edges("left", x1=0.0).select_edges("right", x1=48.0)
    shell = shell_of(mesh, 1.0, nu)
    force = SMALL * YOUNG
    model = ms.Model(
        shell,
        [ms.Clamp("left")],
        loads=[ms.Force("right", (0, force, 0))],
        probes={"corner": (48.0, 60.0, 0.0)},
    )
    return solved(model).probe("corner").u[-1, 1] * YOUNG / force


CASES = (
    Case("clamped plate under pressure", plate, (4, 6, 8), lambda nu: 0.00126532),
    Case("narrow strip under an end force", beam, (4, 8), lambda nu: 1.0),
    Case("clamped tube under pressure", tube, (16, 32), tube_exact),
    Case("Cook's membrane", cook, (4, 8), None),
)


def table(cases: Sequence[Case] = CASES) -> str:
    """Response over the exact one, by case, mesh and Poisson's ratio."""
    heads = ["Case", "Mesh", *(f"$\\nu = {nu}$" for nu in RATIOS)]
    rows = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for case in cases:
        exact = [case.exact(nu) if case.exact else case.solve(nu, 4 * max(case.meshes)) for nu in RATIOS]
        for count in case.meshes:
            shares = [case.solve(nu, count) / value for nu, value in zip(RATIOS, exact, strict=True)]
            rows.append(f"| {case.name} | {count} | " + " | ".join(f"{share:.4f}" for share in shares) + " |")
    return "\n".join(rows)


if __name__ == "__main__":
    made = table()
    print(made)
    write_blocks(DOCS / "element.md", {"incompressible": made}, COMMAND)
