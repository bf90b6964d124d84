"""Linear buckling against the bifurcations of paths: cantilevers on edge, rings, arches, a plate, cylinders."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import magshell as ms
from magshell.mesh import Mesh
from path_study.page import Findings, number, percent, table
from path_study.runs import Runs

SHEAR, SOFT = 100e3, ms.MicropolarStVenantKirchhoff(100e3, 0.0, 10e3, 2e-6)
YOUNG = 2.0 * SHEAR
"""Of `SOFT`, which has no Poisson's effect."""
POISSON = 0.3
STIFF = ms.MicropolarStVenantKirchhoff(
    YOUNG / (2.0 * (1.0 + POISSON)), YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON)), 8e3, 2e-6
)
DECADES = range(-8, 3)


def on_edge(width: float, force: float) -> ms.Model:
    """A cantilever of 100 × width × 0.2 mm on edge, pressed down at its tip."""
    shell = ms.Shell(ms.mesh.rectangle(0.1, width, (40, 4)), 0.2e-3, SOFT)
    return ms.Model(shell, [ms.Clamp("left")], loads=[ms.Force("right", (0, -force, 0))])


def in_field(width: float, field: float) -> ms.Model:
    """A cantilever of 50 × width × 0.2 mm on edge, magnetised along its axis, in a field downwards."""
    shell = ms.Shell(ms.mesh.rectangle(0.05, width, (20, 2)), 0.2e-3, SOFT, ms.remanence.constant((0.1, 0, 0)))
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0, -field, 0)))


def whole(mesh: Mesh, points: Any = None) -> Mesh:
    """The mesh, perhaps with other points, with all its elements as a group."""
    groups = {"all": np.arange(len(mesh.elements))}
    return Mesh(mesh.points if points is None else points, mesh.elements, groups, mesh.edge_groups, mesh.node_groups)


def ring(defect: float) -> ms.Model:
    """A quarter of a ring under the pressure 3 D/R³, out of round by so many thicknesses."""
    radius, thickness = 20e-3, 0.2e-3
    mesh = ms.mesh.cylinder(radius, 4e-3, (24, 2), angle=(0, 90))
    angle, points = np.arctan2(mesh.points[:, 1], mesh.points[:, 0]), mesh.points.copy()
    points[:, :2] *= (1.0 + defect * thickness / radius * np.cos(2.0 * angle))[:, None]
    sides = {"start": (0, 0, 1), "end": (0, 0, 1), "angle-start": (0, 1, 0), "angle-stop": (1, 0, 0)}
    pressure = 3.0 * YOUNG * thickness**3 / 12.0 / radius**3
    shell = ms.Shell(whole(mesh, points), thickness, SOFT)
    supports = [ms.SymmetryPlane(*side) for side in sides.items()]
    return ms.Model(shell, supports, loads=[ms.Pressure("all", -pressure)])


def arch(half: float, pressure: float) -> ms.Model:
    """A clamped arch of 20 mm radius, 0.5 mm thick, of twice an angle in degrees, under so many times D/R³."""
    radius, thickness = 20e-3, 0.5e-3
    mesh = whole(ms.mesh.cylinder(radius, 2e-3, (24, 1), angle=(90.0 - half, 90.0 + half)))
    supports = [ms.Clamp("angle-start"), ms.Clamp("angle-stop")]
    supports += [ms.SymmetryPlane(name, (0, 0, 1)) for name in ("start", "end")]
    unit = YOUNG * thickness**3 / 12.0 / radius**3
    return ms.Model(ms.Shell(mesh, thickness, SOFT), supports, loads=[ms.Pressure("all", -pressure * unit)])


def plate() -> ms.Model:
    """A simply supported square plate of 40 × 40 × 0.1 mm under 1.02 times the force 4 π² D / a along it."""
    size, thickness = 40e-3, 0.1e-3
    force = 1.02 * 4.0 * np.pi**2 * YOUNG * thickness**3 / 12.0 / (1.0 - POISSON**2) / size
    held = [("left", 1), ("left", 3), ("right", 3), ("bottom", 2), ("bottom", 3), ("top", 3)]
    shell = ms.Shell(ms.mesh.rectangle(size, size, (12, 12)), thickness, STIFF)
    supports = [ms.Prescribe(group, "u", component) for group, component in held]
    return ms.Model(shell, supports, loads=[ms.Force("right", (-force, 0, 0))])


def cylinder(share: float) -> ms.Model:
    """A quarter of a cylinder, clamped at one end, its other end round, under a pressure from outside."""
    radius, length, thickness = 20e-3, 20e-3, 0.2e-3
    mesh = whole(ms.mesh.cylinder(radius, length, (16, 8), angle=(0, 90)))
    supports = [ms.Clamp("start"), ms.Prescribe("end", "u", 1), ms.Prescribe("end", "u", 2)]
    supports += [ms.SymmetryPlane("angle-start", (0, 1, 0)), ms.SymmetryPlane("angle-stop", (1, 0, 0))]
    pressure = share * 0.92 * YOUNG * (radius / length) * (thickness / radius) ** 2.5
    return ms.Model(ms.Shell(mesh, thickness, STIFF), supports, loads=[ms.Pressure("all", -pressure)])


@dataclass(frozen=True)
class Case:
    """A model that buckles below its load.

    Attributes
    ----------
    words : str
    model : callable
    """

    words: str
    model: Callable[[], ms.Model]


CASES = [
    Case("cantilever on edge, 2 mm high", lambda: on_edge(2e-3, 0.2e-6)),
    Case("4 mm", lambda: on_edge(4e-3, 0.4e-6)),
    Case("8 mm", lambda: on_edge(8e-3, 0.8e-6)),
    Case("16 mm", lambda: on_edge(16e-3, 1.6e-6)),
    Case("the same in a field, 4 mm", lambda: in_field(4e-3, 25e-6)),
    Case("8 mm", lambda: in_field(8e-3, 25e-6)),
    Case("square plate, pressed", plate),
    Case("cylinder, pressure from outside", lambda: cylinder(1.6)),
    Case("clamped arch of 180°, pressure", lambda: arch(90.0, 10.0)),
    Case("90°", lambda: arch(45.0, 36.0)),
    Case("60°", lambda: arch(30.0, 80.0)),
    Case("50°", lambda: arch(25.0, 110.0)),
    Case("40°", lambda: arch(20.0, 200.0)),
]
RINGS = {"round": 0.0, "out of round by h/4": 0.25, "by h": 1.0}


def estimate(model: ms.Model) -> dict[str, float]:
    """The first positive multiplier, with what moves before it."""
    mode = next(mode for mode in ms.buckling(model, modes=2).modes if mode.load_factor > 0.0)
    return {"cpu": 0.0, "factor": mode.load_factor, "rotation": mode.rotation, "strain": mode.strain}


def study(runs: Runs) -> Findings:
    """Estimates against paths, rings, and loads of any size."""
    rows = []
    for number_of, case in enumerate(CASES):
        found = runs.store.get(f"estimate {number_of}", lambda case=case: estimate(case.model()))
        trace = runs.of(f"buckling {number_of}, {case.words}", case.model, ms.Settings(largest_step=0.2))
        first = trace.critical[0].load_factor if trace.critical else float("nan")
        off = percent(found["factor"], first)
        rows.append((case.words, number(found["factor"]), number(first), off, *_moved(found)))
    header = ("Part and load", "Estimate", "Path", "off (%)", "Rotation before (°)", "Strain before (%)")
    rings = []
    for words, defect in RINGS.items():
        found = runs.store.get(f"ring {words}", lambda defect=defect: estimate(ring(defect)))
        rings.append(
            (f"ring, {words}, pressure", f"{found['factor']:.4f}", "1", percent(found["factor"], 1.0), *_moved(found))
        )
    return Findings({"multipliers": table(header, [*rows, *rings]), "decades": _decades(runs)})


def _moved(found: dict[str, float]) -> tuple[str, str]:
    return f"{np.degrees(found['rotation']):.2f}", f"{100.0 * found['strain']:.3f}"


def _decades(runs: Runs) -> str:
    sizes = [10.0**decade for decade in DECADES]
    loads = [
        size * runs.store.get(f"load of {size:g}", lambda size=size: estimate(on_edge(4e-3, size * 1e-6)))["factor"]
        for size in sizes
    ]
    spread = max(loads) / min(loads) - 1.0
    return (
        f"For reference loads from {sizes[0]:g} to {sizes[-1]:g} µN the cantilever of 4 mm buckles at {loads[0]:.5f} "
        f"µN; all agree to {spread:.0e}."
    )
