"""Ways of integrating and stabilising the element with quadratic fields, as element types built from data."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

import magshell as ms
from element_study.cases import built_in, moved
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Instant
from magshell.mesh import Mesh
from magshell.model.constraints import resolve
from magshell.model.course import Loading
from magshell.model.loads import Force
from magshell.shell import body as shell_body
from magshell.shell import geometry
from magshell.shell.elements import PAPER, QUADRATIC, ElementType
from magshell.shell.elements.definition import Rule, gauss
from magshell.shell.normals import nodal_normals

THIN = 0.01
"""Thickness of the unit elements whose eigenvalues are counted."""
ZERO = 1e-12
"""An eigenvalue below this fraction of the largest is zero."""


def weighted(share: float) -> Rule:
    """The 2 × 2 rule, and this share of the 3 × 3 rule."""
    two, three = gauss(2), gauss(3)
    weights = np.concatenate([(1.0 - share) * two.weights, share * three.weights])
    return Rule(np.vstack([two.points, three.points]), weights)


def five(centre: float) -> Rule:
    """The centre with this weight, and four points at which the rule is exact for cubic polynomials."""
    corner = (4.0 - centre) / 4.0
    a = np.sqrt(1.0 / (3.0 * corner))
    points = a * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return Rule(np.vstack([points, [[0.0, 0.0]]]), np.array([corner] * 4 + [centre]))


class Candidate(NamedTuple):
    """An element type, and whether its values at the points are assumed bilinear (`assumed_values`)."""

    title: str
    element: ElementType
    assumed: bool = False


def _quadratic(stretch_nodes: int, rule: Rule) -> ElementType:
    return ElementType("candidate", rest_nodes=8, stretch_nodes=stretch_nodes, rule=rule)


CANDIDATES = [
    Candidate("a: $\\varphi$ on 8 nodes, 2 × 2", _quadratic(8, gauss(2))),
    Candidate("b: as a, 2 % of the 3 × 3 rule", _quadratic(8, weighted(0.02))),
    Candidate("b: as a, 0.5 % of the 3 × 3 rule", _quadratic(8, weighted(0.005))),
    Candidate("c: $\\varphi$ on 4 nodes, five points, centre 0.01", _quadratic(4, five(0.01))),
    Candidate("c: as before, centre 0.05", _quadratic(4, five(0.05))),
    Candidate("d: $\\varphi$ on 4 nodes, 3 × 3", _quadratic(4, gauss(3))),
    Candidate("e: as d, assumed values", _quadratic(4, gauss(3)), assumed=True),
    Candidate("f: $\\varphi$ on 4 nodes, 2 × 2", _quadratic(4, gauss(2))),
    Candidate("g: as f, a bubble in $u$: `quadratic`", QUADRATIC),
    Candidate("`paper`", PAPER),
]


@contextmanager
def assumed_values(wanted: bool) -> Iterator[None]:
    """While it lasts, values at the points of a rule are bilinear through those at the 2 × 2 points.

    This holds for u,α, w, φ and q; the derivatives of w and of q stay their own.
    """
    original = geometry.interpolation

    def assumed(coordinates: Any, normals: Any, element: ElementType, *rest: Any) -> geometry.Interpolation:
        full = original(coordinates, normals, element, *rest)
        two = gauss(2)
        low = original(coordinates, normals, dataclasses.replace(element, rule=two), *rest)
        through = 0.25 * np.prod(1.0 + 3.0 * element.rule.points[:, None] * two.points, axis=2)

        def bilinear(values: np.ndarray) -> np.ndarray:
            return np.ascontiguousarray(np.einsum("pg,eg...->ep...", through, values))

        director, rotation = full.director.copy(), full.rotation.copy()
        director[:, :, 0], rotation[:, :, 0] = bilinear(low.director[:, :, 0]), bilinear(low.rotation[:, :, 0])
        return full._replace(u=bilinear(low.u), director=director, phi=bilinear(low.phi), rotation=rotation)

    if wanted:
        shell_body.interpolation = assumed
    try:
        yield
    finally:
        shell_body.interpolation = original


# -- zero modes ------------------------------------------------------------------------------------------------------


def unit_patch(count: int, curved: bool) -> Mesh:
    """count × count distorted elements of about unit size, flat or doubly curved."""
    regular = ms.mesh.rectangle(count, count, (count, count))
    plane = regular.points.copy()
    at = regular.corner_nodes
    plane[at, :2] += np.random.default_rng(7).uniform(-0.2, 0.2, (len(at), 2))
    mid_sides_between(plane, regular)
    if curved:
        x, y = plane[:, 0], plane[:, 1]
        plane[:, 2] = 0.14 * x**2 - 0.09 * y**2 + 0.12 * x * y + 0.02 * x**3
        plane = plane @ Rotation.from_rotvec([0.7, -0.4, 1.1]).as_matrix().T
    return moved(regular, plane)


def mid_sides_between(points: np.ndarray, mesh: Mesh) -> None:
    """Put mid-side nodes half-way between their corners, in place."""
    corners = mesh.elements[:, :4]
    points[mesh.elements[:, 4:]] = 0.5 * (points[corners] + points[np.roll(corners, -1, axis=1)])


def stiffness(mesh: Mesh, element: ElementType, length_scale: float = 0.1) -> np.ndarray:
    """Stiffness of the undeformed, unsupported body; length scale in thicknesses."""
    material = ms.MicropolarNeoHookean(1.0, 1.7, 0.1, length_scale * THIN)
    shell = ms.Shell(mesh, THIN, material, element=element)
    normals = nodal_normals(mesh.points, mesh.elements)
    body = SimpleNamespace(
        shell=shell, field=ms.UniformField((0.0, 0.0, 0.0)), coupling=ms.MicropolarCouple(), normals=normals,
        constraints=resolve(mesh, (), shell.carriers), applied=(),
    )  # fmt: skip
    discretisation = Discretisation(body, lambda graph: np.arange(graph.shape[0]))
    matrix = discretisation.assemble(
        Instant(discretisation.undeformed(), Loading(np.zeros(3), np.zeros(0), np.zeros((len(mesh.points), 10))))
    ).matrix
    return 0.5 * (matrix.toarray() + matrix.toarray().T)


def eigenvalues(K: np.ndarray) -> np.ndarray:
    """Of the matrix with its diagonal scaled to one, rising."""
    scale = 1.0 / np.sqrt(np.diag(K))
    return np.sort(np.abs(np.linalg.eigvalsh(K * scale * scale[:, None])))


def modes(candidate: Candidate) -> dict[str, list[float]]:
    """Number of zero modes and smallest nonzero eigenvalue of an element and a patch, flat and curved."""
    out = {}
    with assumed_values(candidate.assumed):
        for count in (1, 2):
            for curved in (False, True):
                found = eigenvalues(stiffness(unit_patch(count, curved), candidate.element))
                zeros = int(np.sum(found < ZERO * found[-1]))
                out[f"{'element' if count == 1 else 'patch'}, {'curved' if curved else 'flat'}"] = [
                    zeros, float(found[zeros]),
                ]  # fmt: skip
    return out


def soft_mode(element: ElementType) -> dict[str, float]:
    """The softest mode of one square element.

    Its eigenvalue with l = h/10, the factor by which doubling l raises it, and how nearly its u is the membrane mode
    u_1 = ξ (3 η² - 1), u_2 = -η (3 ξ² - 1), which has no strain at the 2 × 2 points (1: it is that mode).
    """
    square = ms.mesh.rectangle(1.0, 1.0, (1, 1))
    K = stiffness(square, element)
    scale = 1.0 / np.sqrt(np.diag(K))
    vector = scale * np.linalg.eigh(K * scale * scale[:, None]).eigenvectors[:, 6]
    xi, eta = 2.0 * square.points[:, :2].T - 1.0
    shape = np.column_stack([xi * (3 * eta**2 - 1), -eta * (3 * xi**2 - 1)]).ravel()
    carriers = ms.Shell(square, THIN, ms.MicropolarNeoHookean(1.0, 1.7, 0.1, 0.1 * THIN), element=element).carriers
    widths = [3 * carriers["u"][n] + 3 * carriers["w"][n] + carriers["phi"][n] + 3 * carriers["omega"][n]
              for n in range(8)]  # fmt: skip
    first = np.concatenate([[0], np.cumsum(widths)[:-1]])
    u = vector[first[:, None] + np.arange(3)]
    plane = u[:, :2].ravel()
    rigid = _plane_rigid(xi, eta)
    plane = plane - rigid @ np.linalg.lstsq(rigid, plane, rcond=None)[0]
    alike = abs(plane @ shape) / np.linalg.norm(shape) / np.linalg.norm(np.append(plane, u[:, 2]))
    softer = eigenvalues(stiffness(square, element))[6]
    return {
        "eigenvalue": float(softer),
        "doubled": float(eigenvalues(stiffness(square, element, 0.2))[6] / softer),
        "alike": float(alike),
    }


def _plane_rigid(xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
    one, zero = np.ones_like(xi), np.zeros_like(xi)
    return np.stack([np.column_stack(pair).ravel() for pair in ((one, zero), (zero, one), (-eta, xi))], axis=1)


# -- errors ----------------------------------------------------------------------------------------------------------


def thin_strip(element: Any, divisions: tuple[int, int], distortion: float) -> ms.Model:
    """Magnetised strip, length 1, width 0.1, thickness 1/1000, in a field that lifts its tip by a thirtieth.

    `distortion` is how far corners move at random along the strip, in elements.
    """
    length, thickness, mu, lame, remanence = 1.0, 1e-3, 303e3, 7.3e6, 0.1
    plain = ms.mesh.rectangle(length, 0.1, divisions)
    points = plain.points.copy()
    inner = [n for n in plain.corner_nodes if 1e-9 < points[n, 0] < length - 1e-9]
    points[inner, 0] += np.random.default_rng(3).uniform(-distortion, distortion, len(inner)) * length / divisions[0]
    mid_sides_between(points, plain)
    young = 2.0 * mu * (1.0 + 0.5 * lame / (lame + mu))
    field = 0.1 * young * 4e-7 * np.pi * (thickness / length) ** 2 / 12.0 / remanence
    material = ms.MicropolarNeoHookean(mu, lame, mu / 10.0, thickness / 10.0)
    shell = ms.Shell(moved(plain, points), thickness, material, ms.remanence.constant((remanence, 0, 0)), element)
    probes = {"tip": (length, 0.0, 0.0)}
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0.0, 0.0, field)), probes=probes)


def clamped_plate(element: Any, count: int) -> ms.Model:
    """Quarter of a clamped square plate, side over thickness 1000, with a small force at its centre."""
    mesh = ms.mesh.rectangle(0.5, 0.5, (count, count)).select_nodes("centre", x1=0.5, x2=0.5)
    mu, thickness = 1e6, 1e-3
    shell = ms.Shell(mesh, thickness, ms.MicropolarNeoHookean(mu, 1.5 * mu, mu / 10, thickness / 10), element=element)
    supports = [
        ms.Clamp("left"),
        ms.Clamp("bottom"),
        ms.SymmetryPlane("right", (1, 0, 0)),
        ms.SymmetryPlane("top", (0, 1, 0)),
    ]
    force = 1e-2 * mu * thickness**4
    loads = [Force("centre", (0.0, 0.0, force))]
    return ms.Model(shell, supports, probes={"centre": (0.5, 0.5, 0.0)}, loads=loads)


def tip(model: ms.Model, probe: str, component: int) -> float:
    """A displacement at the end of a path of small displacements; not a number where it cannot be solved."""
    try:
        path = ms.solve(model, ms.Settings(first_step=0.25))
    except ms.SolveError:
        return float("nan")
    return float(path.probe(probe).u[-1, component - 1])


def displacements(candidate: Candidate) -> dict[str, float]:
    """At low field: gripper and pump on coarse meshes (mm), and the thin strip on a distorted one."""
    with assumed_values(candidate.assumed):
        element = candidate.element
        return {
            "gripper 15x4": 1e3 * tip(built_in("gripper", (15, 4), element, [2e-5]), "B", 3),
            "pump 6x5": -1e3 * tip(built_in("pump", (6, 5), element, [1e-3]), "B", 1),
            "pump 12x10": -1e3 * tip(built_in("pump", (12, 10), element, [1e-3]), "B", 1),
            "strip": tip(thin_strip(element, (8, 1), 0.0), "tip", 3),
            "plate": tip(clamped_plate(element, 4), "centre", 3),
            "distorted strip": tip(thin_strip(element, (8, 1), 0.3), "tip", 3),
        }
