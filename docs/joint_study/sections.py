"""Thin-walled beams: torsion of boxes, a folded plate in bending, and the Z-section of NAFEMS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

import magshell as ms
from joint_study.strips import MU, SCALES, Row, row, rubber
from magshell.mesh import Mesh

SMALL = 1e-5
"""Angles: so small that the response is linear."""


def with_ends(mesh: Mesh, walls: Sequence[str]) -> Mesh:
    """The mesh with an edge group `end of WALL` for each of these walls."""
    end = mesh.edge_groups["end"]
    more = {f"end of {wall}": end[np.isin(end, mesh.nodes_of(wall)).all(axis=1)] for wall in walls}
    return Mesh(mesh.points, mesh.elements, mesh.element_groups, {**mesh.edge_groups, **more}, mesh.node_groups)


def box(name: str) -> Iterator[Row]:
    """Boxes under the shear flow of a torque, with ends that warp as they like."""
    for a, b in ((1.0, 1.0), (2.0, 1.0)):
        thickness, length = 0.02, 4.0 * a
        corners = {"A": (0.0, 0.0), "B": (a, 0.0), "C": (a, b), "D": (0.0, b)}
        walls = {"AB": ("A", "B"), "BC": ("B", "C"), "CD": ("C", "D"), "DA": ("D", "A")}
        mesh = with_ends(ms.mesh.profile(corners, walls, length, (2, 8)), tuple(walls))
        pins = {"pins": [mesh.node_at(np.array(point)) for point in ((0.0, 0.0, 0.0), (a, 0.0, 0.0), (a, b, 0.0))]}
        mesh = Mesh(mesh.points, mesh.elements, mesh.element_groups, mesh.edge_groups, pins)
        stiffness = MU * 4.0 * (a * b) ** 2 * thickness / (2.0 * (a + b))
        flow = SMALL * stiffness / (2.0 * a * b)
        loads = []
        for wall, (start, stop) in walls.items():
            along = np.subtract(corners[stop], corners[start])
            loads.append(ms.Force(f"end of {wall}", (*(flow * along), 0.0)))
        supports = [*(ms.Prescribe("start", "u", axis, 0.0) for axis in (1, 2)), ms.Prescribe("pins", "u", 3, 0.0)]
        path = ms.solve(ms.Model(ms.Shell(mesh, thickness, rubber(thickness, SCALES[name])), supports, loads=loads))
        turns = [_turn(path, mesh, a, b, z) for z in (0.25 * length, 0.75 * length)]
        rate = (turns[1] - turns[0]) / (0.5 * length)
        case = f"box {a:g} × {b:g}, h = 0.02, torsion"
        yield row(case, name, "torque / twist rate over 4 A² μ h / perimeter", SMALL / rate, 1.0)


def _turn(path: ms.Path, mesh: Mesh, a: float, b: float, z: float) -> float:
    """Rotation about the axis of a section, whatever its distortion."""
    u = path.steps[-1].state.u
    A, B, D = (u[mesh.node_at(np.array(point))] for point in ((0.0, 0.0, z), (a, 0.0, z), (0.0, b, z)))
    return 0.5 * float((B - A)[1] / a - (D - A)[0] / b)


def folded_plate(name: str) -> Iterator[Row]:
    """A fold of two plates as a cantilever, a force on its rigid end: a deep beam, with its shear."""
    width, slope, thickness, length = 1.0, np.pi / 4.0, 0.02, 10.0
    c, s = width * np.cos(slope), width * np.sin(slope)
    mesh = ms.mesh.profile(
        {"A": (-c, 0.0), "ridge": (0.0, s), "B": (c, 0.0)},
        {"one": ("A", "ridge"), "other": ("ridge", "B")},
        length,
        (3, 16),
        axis=(0, -1, 0),
    )
    inertia, area = 2.0 * thickness * width * s**2 / 12.0, 2.0 * thickness * width
    force = SMALL * 2.0 * MU * inertia / length**2
    shell = ms.Shell(mesh, thickness, rubber(thickness, SCALES[name]), rigid=[ms.RigidBody("end")])
    path = ms.solve(ms.Model(shell, [ms.Clamp("start")], loads=[ms.Force("end", (0, 0, force))]))
    found = path.steps[-1].state.u[path.discretisation.rows.nodes, 2]
    shear = force * length / (5.0 / 6.0 * MU * area * np.sin(slope) ** 2)
    expected = force * length**3 / (3.0 * 2.0 * MU * inertia) + shear
    yield row("folded plate, F L³/3EI and shear", name, "deflection / L", found / length, expected / length)


Z = {"flange": 1.0, "web": 2.0, "young": 210e9, "poisson": 0.3, "torque": 1.2e6}
"""SI. NAFEMS LE5, as manuals of finite-element programs describe it; 0.1 m thick, 10 m long."""
NAFEMS = -108e6
"""Axial stress at the tip of a flange, 2.5 m from the held end, Pa."""


def vlasov(t: float, length: float) -> float:
    """That stress, a quarter of the length from the held end, by the theory of thin-walled open sections, Pa."""
    b, height = Z["flange"], Z["web"]
    shear_modulus = Z["young"] / (2.0 * (1.0 + Z["poisson"]))
    torsion = (2.0 * b + height) * t**3 / 3.0
    web = 0.5 * height * b**2 / (2.0 * b + height)
    tip = 0.5 * height * b - web
    warping = t * (height * web**2 + 2.0 * (tip**3 + web**3) / (1.5 * height))
    decay = np.sqrt(shear_modulus * torsion / (Z["young"] * warping))
    bimoment = Z["torque"] / decay * np.sinh(decay * 0.75 * length) / np.cosh(decay * length)
    return -float(bimoment * tip / warping)


def z_section(divisions: int = 4) -> Iterator[Row]:
    """The Z-section under small forces along its flanges at the free end, which make a torque."""
    b, height, share = Z["flange"], Z["web"], 1e-6
    points = {"A": (-b, 0.5 * height), "B": (0.0, 0.5 * height), "C": (0.0, -0.5 * height), "D": (b, -0.5 * height)}
    walls = {"upper": ("A", "B"), "web": ("B", "C"), "lower": ("C", "D")}
    force = share * Z["torque"] / height
    for thickness, length in ((0.1, 10.0), (0.02, 50.0)):
        mesh = ms.mesh.profile(points, walls, length, (divisions, 8 * divisions), divided={"web": 2 * divisions})
        mesh = with_ends(mesh, ("upper", "lower"))
        material = ms.MicropolarStVenantKirchhoff.from_moduli(
            youngs_modulus=Z["young"], poissons_ratio=Z["poisson"], length_scale=0.01 * thickness
        )
        loads = [ms.Force("end of upper", (-force, 0, 0)), ms.Force("end of lower", (force, 0, 0))]
        shell = ms.Shell(mesh, thickness, material)
        path = ms.solve(ms.Model(shell, [ms.SimpleSupport("start")], loads=loads, local_axis=(0, 0, 1)))
        node = mesh.node_at(np.array([-b, 0.5 * height, 0.25 * length]))
        stress = path.values("N11")[node] / thickness / share
        case, quantity = f"Z-section 2 × 1 × {length:g}, h = {thickness:g}, torsion", "axial stress (MPa)"
        if thickness == 0.1:
            yield row(f"{case}: NAFEMS LE5", "h/100", quantity, stress / 1e6, NAFEMS / 1e6)
        yield row(f"{case}: Vlasov", "h/100", quantity, stress / 1e6, vlasov(thickness, length) / 1e6)
