"""Triangles beside quadrilaterals: errors on the same divisions, and what the parts of the triangle do."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

import magshell as ms
from element_study.candidates import clamped_plate, thin_strip, tip
from element_study.cases import built_in
from element_study.tables import table
from magshell.mesh import split
from magshell.shell.elements import QUADRATIC, ElementType
from magshell.shell.elements.definition import Rule
from magshell.shell.triangle import on_square

PATTERNS = ("rising", "alternating", "crossed")
RADIUS, THIN = 10.0, 0.04


def hemisphere(element: Any, count: int) -> ms.Model:
    """Quarter of a hemisphere with a hole of 18°, R/h = 250, under small forces at its rim."""
    mesh = ms.mesh.sphere_patch(RADIUS, (18, 90), (0, 90), (count, count))
    mesh = mesh.select_nodes("pulled", x1=RADIUS, x2=0.0).select_nodes("pushed", x1=0.0, x2=RADIUS)
    mu = 1e6
    shell = ms.Shell(mesh, THIN, ms.MicropolarNeoHookean(mu, 1.5 * mu, mu / 10, THIN / 10), element=element)
    supports = [
        ms.SymmetryPlane("left", (0, 1, 0)),
        ms.SymmetryPlane("right", (1, 0, 0)),
        ms.Prescribe("pulled", "u", 3),
    ]
    force = 1e-4 * mu * THIN**3 / RADIUS
    loads = [ms.Force("pulled", (force, 0, 0)), ms.Force("pushed", (0, -force, 0))]
    return ms.Model(shell, supports, probes={"pulled": (RADIUS, 0, 0)}, loads=loads)


Make = Callable[[Any], ms.Model]
CASES: dict[str, tuple[Make, Make, str, int]] = {
    # coarse and fine model of quadrilaterals, probe, component
    "plate 4x4": (lambda e: clamped_plate(e, 4), lambda e: clamped_plate(e, 16), "centre", 3),
    "strip 8x1": (lambda e: thin_strip(e, (8, 1), 0.0), lambda e: thin_strip(e, (32, 4), 0.0), "tip", 3),
    "gripper 15x4": (
        lambda e: built_in("gripper", (15, 4), e, [2e-5]),
        lambda e: built_in("gripper", (45, 12), e, [2e-5]),
        "B",
        3,
    ),
    "pump 12x10": (
        lambda e: built_in("pump", (12, 10), e, [1e-3]),
        lambda e: built_in("pump", (30, 25), e, [1e-3]),
        "B",
        1,
    ),
    "hemisphere 16x16": (lambda e: hemisphere(e, 16), lambda e: hemisphere(e, 40), "pulled", 1),
    "strip-10, 50 mT": (
        lambda e: built_in("strip-10", (20, 2), e, [50e-3]),
        lambda e: built_in("strip-10", (40, 4), e, [50e-3]),
        "tip",
        3,
    ),
}


def cut(model: ms.Model, pattern: str, element: ElementType) -> ms.Model:
    """The same problem on triangles."""
    shell = dataclasses.replace(model.shell, mesh=split(model.shell.mesh, pattern), element=element)
    return dataclasses.replace(model, shell=shell)


def variants() -> dict[str, ElementType]:
    """The triangle without one of its parts."""
    whole = QUADRATIC.with_triangles
    assert whole is not None
    middles = Rule(*on_square(0.5 * (1.0 - np.eye(3)), np.full(3, 1.0 / 3.0)))
    return {
        "without bubble and hold": dataclasses.replace(whole, bubble=0.0),
        "points on the mid-sides": dataclasses.replace(whole, triangle_rule=middles),
    }


def triangle_table() -> str:
    """Errors of quadrilaterals, of triangles by pattern, and of triangles that lack a part."""
    rows: dict[str, list[str]] = {name: [] for name in ("quadrilaterals", *PATTERNS)}
    rows |= {f"rising, {name}": [] for name in variants()}
    for coarse, fine, probe, component in CASES.values():
        limit, model = tip(fine(QUADRATIC), probe, component), coarse(QUADRATIC)
        models = {"quadrilaterals": model} | {pattern: cut(model, pattern, QUADRATIC) for pattern in PATTERNS}
        models |= {f"rising, {name}": cut(model, "rising", element) for name, element in variants().items()}
        for name, one in models.items():
            nodes = len(one.shell.mesh.points)
            rows[name].append(f"{100.0 * (tip(one, probe, component) / limit - 1.0):+.1f} % ({nodes})")
            print(f"{name:34s} {rows[name][-1]}", flush=True)
    return table(("Mesh", *CASES), [[name, *cells] for name, cells in rows.items()])


def bent_strip(divisions: tuple[int, int], pattern: str | None = None) -> ms.Model:
    """Magnetised strip, length 1, width 0.2, thickness 1/1000, in a field that bends it by about a radian."""
    length, width, thickness, mu, remanence = 1.0, 0.2, 1e-3, 1e6, 0.1
    mesh = ms.mesh.rectangle(length, width, divisions)
    if pattern is not None:
        mesh = split(mesh, pattern)
    material = ms.MicropolarNeoHookean(mu, 10.0 * mu, mu / 10.0, thickness / 10.0)
    shell = ms.Shell(mesh, thickness, material, ms.remanence.constant((remanence, 0, 0)))
    field = mu * (thickness / length) ** 2 * 4e-7 * np.pi / remanence
    probes = {"tip": (length, width / 2, 0.0)}
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0.0, 0.0, field)), probes=probes)


def bent_table() -> str:
    """Errors of a thin strip that bends far, beside the longest sides of its triangles over √(length × thickness)."""
    limit, rows = tip(bent_strip((40, 8)), "tip", 3), []
    for divisions in ((10, 2), (20, 4)):
        side = np.hypot(1.0 / divisions[0], 0.2 / divisions[1]) / np.sqrt(1e-3)
        cells = [f"{divisions[0]} × {divisions[1]}", f"{side:.1f}"]
        for pattern in (None, *PATTERNS):
            cells.append(f"{100.0 * (tip(bent_strip(divisions, pattern), 'tip', 3) / limit - 1.0):+.1f} %")
            print(divisions, pattern, cells[-1], flush=True)
        rows.append(cells)
    return table(("Divisions", "Longest side / √(Lh)", "quadrilaterals", *PATTERNS), rows)
