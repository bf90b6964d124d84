"""Problems with known stresses and resultants: solved under a small load, values at nodes beside the references."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

import numpy as np

import magshell as ms
from magshell.evaluation.converged import Converged, converged
from magshell.evaluation.outputs import find
from magshell.evaluation.recovery import recovery_of
from magshell.mesh import Mesh
from magshell.model.loads.dead import DeadForces
from magshell.model.loads.load import Load

SMALL = 1e-6
"""Load factor at which the problems are linear."""
LINEAR = ms.Settings(first_step=1.0, tolerance=1e-10)


class Value(NamedTuple):
    """A computed value beside its reference, in the unit of the table; `within` is the share that is claimed."""

    problem: str
    quantity: str
    unit: str
    computed: float
    reference: float
    within: float

    @property
    def error(self) -> float:
        """Over the reference."""
        return self.computed / self.reference - 1.0


@dataclass(frozen=True, eq=False)
class NodalForces(Load):
    """Given forces (nodes, 3) on the displacements, N."""

    kind: ClassVar[str] = "nodal-forces"

    group: str
    nodal: Any
    history: Any = None

    def applied(self, shell: ms.Shell, rows: Any) -> Any:
        """Those forces."""
        return DeadForces(self.nodal)


def classical(youngs_modulus: float, poissons_ratio: float) -> ms.MicropolarStVenantKirchhoff:
    """The classical shell of seven parameters has this law."""
    mu = youngs_modulus / (2.0 * (1.0 + poissons_ratio))
    return ms.MicropolarStVenantKirchhoff(mu, 2.0 * mu * poissons_ratio / (1.0 - 2.0 * poissons_ratio), 0.0, 0.0)


def solved(model: ms.Model) -> Converged:
    """The end of the path."""
    path = ms.solve(model, LINEAR)
    return converged(path.discretisation, path.steps[-1])


def at(reached: Converged, name: str, position: Sequence[float]) -> float:
    """An output at a node."""
    output, component = find(name)
    values = output.evaluate(reached)[reached.mesh.node_at(np.array(position, dtype=float))]
    return float(values if component is None else values[component - 1])


def membrane(count: int) -> list[Value]:
    """NAFEMS LE1: an elliptic membrane under a tension of its outer edge; `count` elements along either side."""
    square = ms.mesh.rectangle(1.0, 1.0, (count, count))
    s, t = square.points[:, :2].T
    angle, outer = 0.5 * np.pi * (1.0 - s), t
    axes = np.array([[2.0, 1.0], [3.25, 2.75]])
    a, b = (axes[0, i] + outer * (axes[1, i] - axes[0, i]) for i in (0, 1))
    points = np.stack([a * np.cos(angle), b * np.sin(angle), 0.0 * s], axis=1)
    mesh = Mesh(points, square.elements, edge_groups=dict(square.edge_groups))
    forces = edge_traction(mesh, mesh.edge_groups["top"], 10e6 * 0.1 * SMALL)
    shell = ms.Shell(mesh, 0.1, classical(210e9, 0.3), micro_rotation=False)
    supports = [ms.Prescribe(side, field, i) for side, i in (("left", 1), ("right", 2)) for field in ("u", "w")]
    supports.append(ms.Prescribe("left", "u", 3))
    reached = solved(ms.Model(shell, supports, loads=[NodalForces("top", forces)]))
    stress = at(reached, "s22_top", (2.0, 0.0, 0.0)) / SMALL
    return [Value("LE1", "σyy at D", "MPa", 1e-6 * stress, 92.66, 5e-3)]


def edge_traction(mesh: Mesh, edges: Any, tension: float) -> np.ndarray:
    """Forces (nodes, 3) of a tension (N/m) normal to edges (k, 3) of a mesh in the plane X3 = 0, outward."""
    parent, weights = np.polynomial.legendre.leggauss(4)
    N = np.stack([parent * (parent - 1) / 2, parent * (parent + 1) / 2, 1 - parent**2], axis=1)
    dN = np.stack([parent - 0.5, parent + 0.5, -2 * parent], axis=1)
    x = mesh.points[edges]
    tangent = np.einsum("pn,enx->epx", dN, x)
    normal = np.cross(tangent, [0.0, 0.0, 1.0])
    outward = np.sum(normal * np.einsum("pn,enx->epx", N, x), axis=2, keepdims=True)
    normal *= np.sign(outward)
    forces = np.zeros((len(mesh.points), 3))
    np.add.at(forces, edges, tension * np.einsum("p,pn,epx->enx", weights, N, normal))
    return forces


def plate(count: int, clamped: bool, ratio: float = 200.0) -> list[Value]:
    """A square plate of unit side under a pressure, a quarter of it, as many elements along a side as `count`."""
    h, young = 1.0 / ratio, 1e9
    mesh = ms.mesh.rectangle(0.5, 0.5, (count, count))
    group = {"plate": np.arange(len(mesh.elements))}
    mesh = Mesh(mesh.points, mesh.elements, group, dict(mesh.edge_groups))
    q = SMALL * young * h**3
    shell = ms.Shell(mesh, h, classical(young, 0.3), micro_rotation=False)
    supports: list[Any] = [ms.SymmetryPlane("left", (1, 0, 0)), ms.SymmetryPlane("bottom", (0, 1, 0))]
    if clamped:
        supports += [ms.Clamp("right"), ms.Clamp("top")]
    else:
        for side, along in (("right", 2), ("top", 1)):
            supports += [ms.Prescribe(side, "u", 3), ms.Prescribe(side, "w", along)]
    reached = solved(ms.Model(shell, supports, loads=[ms.Traction("plate", (0.0, 0.0, q))]))
    D = young * h**3 / (12.0 * (1.0 - 0.3**2))
    scale = 1.0 / q
    centre, middle, corner = (0.0, 0.0, 0.0), (0.5, 0.0, 0.0), (0.5, 0.5, 0.0)
    w = at(reached, "u3", centre) * D * scale
    M = at(reached, "M11", centre) * scale
    name = "clamped plate" if clamped else "simply supported plate"
    if clamped:
        edge = at(reached, "M11", middle) * scale
        return [
            Value(name, "centre deflection", "q a⁴/D", w, 0.00126532, 1e-2),
            Value(name, "moment at the centre", "q a²", M, 0.0229051, 1e-2),
            Value(name, "moment at the edge", "q a²", edge, -0.0513338, 1e-2),
        ]
    size = 0.5 / count
    twist = [at(reached, "M12", (0.5, y, 0.0)) * scale for y in (0.0, 0.5 * size)]
    reaction = at(reached, "Q1", middle) * scale + (twist[1] - twist[0]) / (0.5 * size)
    return [
        Value(name, "centre deflection", "q a⁴/D", w, 0.00406235, 1e-2),
        Value(name, "moment at the centre", "q a²", M, 0.0478864, 1e-2),
        Value(name, "corner force 2 M12", "q a²", abs(2.0 * at(reached, "M12", corner)) * scale, 0.0649647, 1e-2),
        Value(name, "edge reaction Q1 + M12,2", "q a", abs(reaction), 0.4205, 1e-2),
    ]


def clamped_cylinder(count: int) -> list[Value]:
    """A long clamped cylinder under pressure, a sector of it; `count` elements along eight lengths 1/β."""
    radius, h, young, nu = 1.0, 1e-3, 1e9, 0.3
    beta = (3.0 * (1.0 - nu**2)) ** 0.25 / np.sqrt(radius * h)
    mesh = ms.mesh.cylinder(radius, 8.0 / beta, (2, count), angle=(-2.0, 2.0), axis=(1, 0, 0), zero=(0, 0, 1))
    mesh = Mesh(mesh.points, mesh.elements, {"all": np.arange(len(mesh.elements))}, dict(mesh.edge_groups))
    p = SMALL * young * h / radius
    angle = np.radians(2.0)
    supports = [
        ms.Clamp("start"),
        ms.SymmetryPlane("angle-start", (0.0, np.cos(angle), -np.sin(angle))),
        ms.SymmetryPlane("angle-stop", (0.0, np.cos(angle), np.sin(angle))),
    ]
    shell = ms.Shell(mesh, h, classical(young, nu), micro_rotation=False)
    reached = solved(ms.Model(shell, supports, loads=[ms.Pressure("all", p)]))
    end, scale = mesh.points[np.argmin(np.abs(mesh.points - [0, 0, radius]).sum(axis=1))], 1.0 / p
    name = "clamped cylinder"
    return [
        Value(name, "moment at the clamp", "p/2β²", abs(at(reached, "M11", end)) * scale * 2.0 * beta**2, 1.0, 1e-2),
        Value(name, "shear force at the clamp", "p/β", abs(at(reached, "Q1", end)) * scale * beta, 1.0, 1e-2),
    ]


def roof(count: int) -> list[Value]:
    """The roof of Scordelis and Lo, a quarter of it."""
    mesh = ms.mesh.cylinder(25.0, 25.0, (count, count), angle=(0.0, 40.0), axis=(0, 1, 0), zero=(0, 0, 1))
    mesh = Mesh(mesh.points, mesh.elements, {"all": np.arange(len(mesh.elements))}, dict(mesh.edge_groups))
    shell = ms.Shell(mesh, 0.25, classical(4.32e8, 0.0), micro_rotation=False)
    supports = [
        ms.SymmetryPlane("start", (0, 1, 0)),
        ms.SymmetryPlane("angle-start", (1, 0, 0)),
        ms.Prescribe("end", "u", 1),
        ms.Prescribe("end", "u", 3),
    ]
    reached = solved(ms.Model(shell, supports, loads=[ms.Traction("all", (0.0, 0.0, -90.0 * SMALL))]))
    side = mesh.points[mesh.nodes_of("start")]
    place = side[np.argmin(side[:, 2])]
    u = at(reached, "u3", place) / SMALL
    return [
        Value("Scordelis–Lo roof", "u3 at the middle of the side, without shear", "ft", u, -0.300601, 1e-2),
        Value("Scordelis–Lo roof", "the same, customary", "ft", u, -0.3024, 1e-2),
    ]


def pinched_cylinder(count: int) -> list[Value]:
    """A cylinder with diaphragms at its ends, pinched by two forces; an eighth of it."""
    radius, h, young = 300.0, 3.0, 3e6
    mesh = ms.mesh.cylinder(radius, 300.0, (count, count), angle=(0.0, 90.0), axis=(1, 0, 0), zero=(0, 0, 1))
    place = mesh.points[mesh.node_at(np.array([0.0, 0.0, radius]))]
    mesh = Mesh(mesh.points, mesh.elements, {}, dict(mesh.edge_groups), {"top": [mesh.node_at(place)]})
    shell = ms.Shell(mesh, h, classical(young, 0.3), micro_rotation=False)
    supports = [
        ms.SymmetryPlane("start", (1, 0, 0)),
        ms.SymmetryPlane("angle-start", (0, 1, 0)),
        ms.SymmetryPlane("angle-stop", (0, 0, 1)),
        ms.Prescribe("end", "u", 2),
        ms.Prescribe("end", "u", 3),
    ]
    reached = solved(ms.Model(shell, supports, loads=[ms.Force("top", (0.0, 0.0, -0.25))]))
    w = (-at(reached, "u3", place) - shear_work(reached) / 0.25) * young * h
    return [Value("pinched cylinder", "displacement under the force, less that of shear", "P/Eh", w, 164.5, 3e-3)]


def shear_work(reached: Converged) -> float:
    """Twice the energy of the transverse shear, J: what it adds to the work of a small load.

    Under a point force it grows without end as the mesh is refined; theories without shear do not have it.
    """
    d = reached.discretisation
    F = reached.fields.F @ np.swapaxes(recovery_of(d).points, -1, -2)[:, :, None]
    C = np.swapaxes(F, -1, -2) @ F
    density = d.model.shell.material.shear_modulus * (C[..., 0, 2] ** 2 + C[..., 1, 2] ** 2)
    return float(np.sum(d.reference.geometry.volume * density))


def simply_supported_plate(count: int) -> list[Value]:
    """See `plate`."""
    return plate(count, clamped=False)


def clamped_plate(count: int) -> list[Value]:
    """See `plate`."""
    return plate(count, clamped=True)


PROBLEMS: dict[str, tuple[Callable[[int], list[Value]], Sequence[int]]] = {
    "LE1": (membrane, (4, 8, 16)),
    "simply supported plate": (simply_supported_plate, (4, 8, 16)),
    "clamped plate": (clamped_plate, (4, 8, 16)),
    "clamped cylinder": (clamped_cylinder, (16, 32, 64)),
    "roof": (roof, (4, 8, 16)),
    "pinched cylinder": (pinched_cylinder, (8, 16, 32)),
}
"""The problems and the meshes of the table, of which the last keeps what is claimed."""


def solved_problem(name: str) -> list[Value]:
    """The values of a problem on its last mesh."""
    solve, counts = PROBLEMS[name]
    return solve(counts[-1])
