r"""Patch tests: a distorted flat patch whose boundary nodes are given a constant state reproduces it inside.

A state of constant stress P is in equilibrium when the faces are loaded as it asks: by P e3 on the directors and,
where P is not symmetric, by the couple on the micro-rotation. Those loads are put on consistently: stress times
∫ N_I dV.

Bending and twisting are exact on meshes of parallelograms. On other straight-sided quadrilaterals u3 holds ξ²η², which
plain eight-node functions lack (`test_shape_functions`): there they are exact for element types with complete
functions, and the last test measures how the error of the others dies out when the elements are cut.
"""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    THICKNESS,
    TYPES,
    dense,
    each_element,
    each_material,
    free_body,
    homogeneous,
    patch,
    rest_and_stretch,
)
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from magshell.equations.instant import Instant
from magshell.materials.law import evaluate
from shell import oracle

STILL = (0.0, 0.0, 0.0)


def distorted_patch():
    """Nine straight-sided quadrilaterals of a square of side 3, inner corners moved by up to 0.25."""
    return patch((3, 3), distortion=0.25, keep_boundary=True)


def parallelograms():
    """Nine parallelograms of different sizes."""
    shear = np.array([[1.0, 0.4], [-0.2, 0.9]])
    uneven = lambda plane: np.stack(  # noqa: E731
        [
            np.interp(plane[:, 0], range(4), [0.0, 0.7, 2.1, 3.0]),
            np.interp(plane[:, 1], range(4), [0.0, 1.3, 1.9, 3.0]),
        ],
        1,
    )
    return patch((3, 3), map_plane=lambda plane: uneven(plane) @ shear.T)


def inner_nodes(mesh):
    return np.setdiff1d(np.arange(len(mesh.points)), mesh.boundary_edges)


def nodal_volumes(d):
    """∫ N_I dV of the functions of director and micro-rotation (nodes,)."""
    volumes, element = np.zeros(len(d.mesh.points)), d.model.shell.element
    for e, nodes in enumerate(d.mesh.elements):
        for parent, weight in oracle.points(d, e):
            here = oracle.surface(d, e, parent)
            parts = weight * here.rotation[0] * here.area * d.model.shell.thickness
            np.add.at(volumes, nodes[: element.rest_nodes], parts)
    return volumes


def loads(d, P, F):
    """Internal forces (nodes, 11) of a constant stress P with the deformation gradient F, inside the patch."""
    result = np.zeros(d.free.shape)
    result[:, 3:6] = P[:, 2]
    result[:, 7:10] = -np.cross(F.T, P.T).sum(axis=0)
    return result * nodal_volumes(d)[:, None]


# -- any size of deformation -----------------------------------------------------------------------------------------


def stress(material, U):
    return evaluate(material, U)[1]


@each_material
def test_any_homogeneous_state_of_every_law(material):
    check_homogeneous(free_body(distorted_patch(), material, field=STILL), seed=0)


@each_element
@pytest.mark.parametrize("seed", range(3))
def test_any_homogeneous_state(element, seed):
    check_homogeneous(free_body(distorted_patch(), element=element, field=STILL), seed)


def check_homogeneous(d, seed):
    """Any F and R̃, far from the undeformed state: inner nodes feel the consistent loads of the constant stress only."""
    material = d.model.shell.material
    rng = np.random.default_rng(seed)
    turn = Rotation.random(rng=rng).as_matrix()
    F = turn @ (np.eye(3) + rng.uniform(-0.3, 0.3, (3, 3)))
    R = turn @ Rotation.from_rotvec(rng.uniform(-0.5, 0.5, 3)).as_matrix()
    assembly = d.assemble(Instant(homogeneous(d, F, R), d.model.loading(1.0)), tangent=False)
    expected = loads(d, R @ stress(material, R.T @ F), F)
    inner = inner_nodes(d.mesh)
    error = np.abs(assembly.residual[inner] - expected[inner]).max() / np.abs(assembly.residual).max()
    assert error < 1e-13, f"{error:.1e} of the boundary's forces"
    assert assembly.relative["alpha"] < 1e-13, f"enhanced parameters: {assembly.relative['alpha']:.1e}"


@each_material
def test_homogeneous_equilibrium_of_every_law(material):
    check_equilibrium(free_body(distorted_patch(), material, field=STILL), seed=0)


@each_element
@pytest.mark.parametrize("seed", range(3))
def test_homogeneous_equilibrium(element, seed):
    check_equilibrium(free_body(distorted_patch(), element=element, field=STILL), seed)


def check_equilibrium(d, seed):
    """F = Q U with U in plane stress and R̃ = Q: no load at all is needed inside."""
    material = d.model.shell.material
    rng = np.random.default_rng(seed)
    U = np.eye(3)
    U[:2, :2] += rng.uniform(-0.3, 0.3) * np.eye(2) + rng.uniform(-0.2, 0.2) * np.array([[1.0, 0.5], [0.5, -1.0]])

    def normal_stress(thickness_stretch):
        U[2, 2] = thickness_stretch
        return stress(material, U)[2, 2]

    U[2, 2] = brentq(normal_stress, 0.3, 3.0, xtol=1e-15)
    Q = Rotation.random(rng=rng).as_matrix()
    assembly = d.assemble(Instant(homogeneous(d, Q @ U, Q), d.model.loading(1.0)), tangent=False)
    error = np.abs(assembly.residual[inner_nodes(d.mesh)]).max() / np.abs(assembly.residual).max()
    assert error < 1e-10, f"{error:.1e} of the boundary's forces"


# -- small deformations: the patch is solved -------------------------------------------------------------------------


def solve_inside(d, exact, force):
    """Values (nodes, 11) with those of the boundary given and the loads `force` inside."""
    K = dense(d, d.assemble(Instant(d.undeformed(), d.model.loading(0.0))).matrix)
    inside = np.zeros(d.free.shape, dtype=bool)
    inside[inner_nodes(d.mesh)] = True
    f, c = (np.flatnonzero(which) for which in (d.free & inside, d.free & ~inside))
    solution = exact.ravel().copy()
    solution[f] = np.linalg.solve(K[np.ix_(f, f)], force.ravel()[f] - K[np.ix_(f, c)] @ solution[c])
    return solution.reshape(exact.shape)


def inside_error(d, exact, force):
    """Largest error over the largest value (all fields are of the order of one)."""
    return np.abs(solve_inside(d, exact, force) - exact).max() / np.abs(exact).max()


STRAINS = {
    # displacement gradient, micro-rotation; "free" thickness: what plane stress asks for
    "extension along X1": ([[1, 0, 0], [0, 0, 0], [0, 0, "free"]], (0, 0, 0)),
    "extension along X2": ([[0, 0, 0], [0, 1, 0], [0, 0, "free"]], (0, 0, 0)),
    "shear in the plane": ([[0, 1, 0], [1, 0, 0], [0, 0, "free"]], (0, 0, 0)),
    "transverse shear 13": ([[0, 0, 1], [0, 0, 0], [0, 0, 0]], (0, 0.5, 0)),
    "transverse shear 31": ([[0, 0, 0], [0, 0, 0], [1, 0, 0]], (0, -0.5, 0)),
    "transverse shear 23": ([[0, 0, 0], [0, 0, 1], [0, 0, 0]], (-0.5, 0, 0)),
    "transverse shear 32": ([[0, 0, 0], [0, 0, 0], [0, 1, 0]], (0.5, 0, 0)),
    "thickness stretch": ([[0, 0, 0], [0, 0, 0], [0, 0, 1]], (0, 0, 0)),
    "micro-rotation in the plane": ([[0, 0, 0], [0, 0, 0], [0, 0, 0]], (0, 0, 1)),
    "micro-rotation out of it": ([[0, 0, 0], [0, 0, 0], [0, 0, 0]], (1, -2, 0)),
    "rigid rotation": ([[0, -3, 2], [3, 0, -1], [-2, 1, 0]], (1, 2, 3)),
}


@each_element
@pytest.mark.parametrize(("gradient", "spin"), STRAINS.values(), ids=STRAINS)
def test_constant_strain(gradient, spin, element):
    """Membrane, shear and thickness: exact inside any straight-sided patch."""
    d = free_body(distorted_patch(), element=element)
    material, spin = d.model.shell.material, np.array(spin, dtype=float)
    mu, lam, eta = material.shear_modulus, material.lame_lambda, material.coupling_modulus
    in_plane = gradient[0][0] + gradient[1][1]
    H = np.array(
        [[-lam / (lam + 2 * mu) * in_plane if h == "free" else h for h in row] for row in gradient], dtype=float
    )
    exact = np.zeros(d.free.shape)
    exact[:, :3] = d.mesh.points @ H.T
    rest, _ = rest_and_stretch(d)
    exact[rest, 3:6], exact[rest, 7:10] = H[:, 2], spin
    e = H - np.cross(np.eye(3), spin)
    P = lam * np.trace(e) * np.eye(3) + mu * (e + e.T) + eta * (e - e.T)
    error = inside_error(d, exact, loads(d, P, np.eye(3)))
    assert error < 1e-12, f"{error:.1e}"


CURVATURES = {"bending about X2": [[1, 0], [0, 0]], "bending about X1": [[0, 0], [0, 1]], "twist": [[0, 1], [1, 0]]}
each_curvature = pytest.mark.parametrize(
    "curvature", [np.array(c, dtype=float) for c in CURVATURES.values()], ids=CURVATURES
)


def bent(d, curvature):
    """Constant curvature: w = κ x, u3 = -x·κx/2, φ from plane stress at every level, ω = e3 × w: no load inside."""
    material, (rest, stretch), x = d.model.shell.material, rest_and_stretch(d), d.mesh.points[:, :2]
    exact = np.zeros(d.free.shape)
    slope = x @ curvature
    exact[:, 2] = -0.5 * np.sum(slope * x, axis=1)
    exact[rest, 3:5] = slope[rest]
    exact[stretch, 6] = (
        -0.5 * material.lame_lambda / (material.lame_lambda + 2 * material.shear_modulus) * np.trace(curvature)
    )
    exact[rest, 7], exact[rest, 8] = -slope[rest, 1], slope[rest, 0]
    return exact


PLAIN = [element for element in TYPES.values() if not element.complete]
EXACT = [(f"parallelograms-{name}", parallelograms, element) for name, element in TYPES.items()]
EXACT += [(f"any shapes-{name}", distorted_patch, element) for name, element in TYPES.items() if element.complete]


@each_curvature
@pytest.mark.parametrize(("make", "element"), [case[1:] for case in EXACT], ids=[name for name, *_ in EXACT])
@pytest.mark.parametrize("thickness", [THICKNESS, THICKNESS / 10])
def test_constant_curvature(curvature, make, element, thickness):
    """Exact to round-off times the condition of the stiffness, which is some 1/h² for elements of unit size."""
    d = free_body(make(), element=element, thickness=thickness)
    exact = bent(d, curvature)
    error = inside_error(d, exact, np.zeros_like(exact))
    print(f"{error:.1e}")
    assert error < 1e-12, f"{error:.1e}"


def refined(times):
    """The distorted patch with every element cut into times × times, mapped bilinearly, elements of unit size again."""
    coarse, regular = distorted_patch(), patch((3, 3))
    first = regular.points[regular.elements[:, 0], :2]

    def plane(at):
        cell = np.minimum((at / times).astype(int), 2)
        element = [np.flatnonzero(np.all(first == corner, axis=1))[0] for corner in cell]
        corners = coarse.points[coarse.elements[element, :4], :2]
        functions = oracle.four((2.0 * (at / times - cell) - 1.0).T).T
        return times * np.einsum("nc,ncx->nx", functions, corners)

    return patch((3 * times, 3 * times), map_plane=plane)


@each_curvature
@pytest.mark.parametrize("element", PLAIN, ids=lambda element: element.name)
def test_constant_curvature_on_any_quadrilaterals_converges(curvature, element):
    """Not exact (see above): less than 0.1 % on the coarse patch, an eighth of it on half the size, thick or thin."""
    for thickness in (THICKNESS, THICKNESS / 10):
        errors = []
        for times in (1, 2):
            d = free_body(refined(times), element=element, thickness=thickness * times)
            exact = bent(d, curvature)
            errors.append(inside_error(d, exact, np.zeros_like(exact)))
        assert errors[0] < 1e-3, f"coarse patch: {errors[0]:.2e}"
        assert errors[1] < errors[0] / 8.0, f"{errors[0]:.2e}, refined {errors[1]:.2e}"
