"""What every test of the numerics runs over: registered laws and element types, small meshes, a model nothing holds.

A law joins all tests here by being registered (`material_law`, `coupling_law`), and by having its reference formula in
`materials/reference.py` or `magnetics/reference.py`; an element type by being in `magshell.shell.elements.ELEMENTS`.
All laws meet one element type, all element types meet one pair of laws. The type for meshes with triangles is one of
them: `for_element` gives it triangles. Everything is of the order of one: elements of
unit size, a shear modulus and a permeability of one, so that figures of different kinds can be compared.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from magshell import magnetics, materials
from magshell.equations.discretisation import Discretisation
from magshell.equations.instant import Increment
from magshell.evaluation.converged import Converged
from magshell.magnetics import UniformField, remanence
from magshell.mesh import Mesh, rectangle, split
from magshell.model.constraints import resolve
from magshell.model.course import Loading
from magshell.model.places import Places
from magshell.model.rows import rows_of
from magshell.model.shell import Shell
from magshell.shell.elements import ELEMENTS, QUADRATIC
from magshell.shell.point import INTERNAL
from magshell.shell.state import State

PARAMETERS = {
    "shear_modulus": 1.0,
    "lame_lambda": 1.7,
    "coupling_modulus": 0.3,
    "length_scale": 0.2,
    "extension_limit": 9.0,
    "c20": -0.04,
    "c30": 0.01,
    "vacuum_permeability": 0.8,
}
THICKNESS = 0.15
REMANENCE = (0.9, 0.4, -0.3)
FIELD = (0.2, -0.3, 0.4)


def example(law):
    """An instance of a law; parameters that only this law has keep their defaults."""
    return law(**{name: PARAMETERS[name] for name in law._fields if name in PARAMETERS})


def name_of(law):
    return type(law).__name__


MATERIALS = [example(law) for law in materials.laws()]
COUPLINGS = [example(law) for law in magnetics.laws()]
MATERIAL, COUPLING = materials.MicropolarNeoHookean, magnetics.MicropolarCouple

TRIANGULAR = QUADRATIC.with_triangles
TYPES = ELEMENTS | {"triangles": TRIANGULAR}
"""Element types by name, that of meshes with triangles among them."""
each_element = pytest.mark.parametrize("element", TYPES.values(), ids=TYPES)
each_material = pytest.mark.parametrize("material", MATERIALS, ids=name_of)
each_coupling = pytest.mark.parametrize("coupling", COUPLINGS, ids=name_of)


PAIRS = [
    (material, coupling)
    for material in MATERIALS
    for coupling in COUPLINGS
    if isinstance(material, MATERIAL) or isinstance(coupling, COUPLING)
]
"""Each law with one of the other kind: they meet in a sum only."""


each_pair = pytest.mark.parametrize(("material", "coupling"), PAIRS, ids=["-".join(map(name_of, p)) for p in PAIRS])


def each_combination(function):
    """Run a test over every pair of laws with one element type, and over the other types with one pair."""
    cases = [(QUADRATIC, *pair) for pair in PAIRS]
    others = [element for element in TYPES.values() if element is not QUADRATIC]
    cases += [(element, example(MATERIAL), example(COUPLING)) for element in others]
    named = {element: name for name, element in TYPES.items()}
    labels = [f"{named[element]}-{name_of(material)}-{name_of(coupling)}" for element, material, coupling in cases]
    return pytest.mark.parametrize(("element", "material", "coupling"), cases, ids=labels)(function)


# -- meshes ----------------------------------------------------------------------------------------------------------


def flat(plane):
    """Surface X3 = 0 over points (n, 2)."""
    return np.column_stack([plane, np.zeros(len(plane))])


def bowl(plane):
    """A doubly curved surface without symmetry, radii of curvature of some three elements, turned anyhow."""
    x, y = plane.T
    height = 0.14 * x**2 - 0.09 * y**2 + 0.12 * x * y + 0.02 * x**3
    return np.column_stack([plane, height]) @ Rotation.from_rotvec([0.7, -0.4, 1.1]).as_matrix().T


def patch(counts, distortion=0.0, surface=flat, keep_boundary=False, map_plane=None):
    """Unit elements whose corners are moved at random by up to `distortion`; mid-sides half-way in the plane.

    `map_plane` maps the plane afterwards (corners and mid-sides alike), `surface` lifts it into space.
    """
    regular = rectangle(*counts, counts)
    plane = regular.points[:, :2].copy()
    moved = regular.corner_nodes
    if keep_boundary:
        moved = np.setdiff1d(moved, regular.boundary_edges)
    plane[moved] += np.random.default_rng(7).uniform(-distortion, distortion, (len(moved), 2))
    corners = regular.elements[:, :4]
    plane[regular.elements[:, 4:]] = 0.5 * (plane[corners] + plane[np.roll(corners, -1, axis=1)])
    if map_plane is not None:
        plane = map_plane(plane)
    return with_points(regular, surface(plane))


def with_points(mesh, points):
    """The same mesh at other places."""
    return Mesh(points, mesh.elements, mesh.element_groups, mesh.edge_groups, mesh.node_groups)


def for_element(mesh, element):
    """The mesh; with a type for triangles half of a single element, or of a patch every second one cut into four."""
    if element.triangle_rule is None or mesh.triangles.any():
        return mesh
    if len(mesh.elements) > 1:
        return split(mesh, "crossed", np.arange(0, len(mesh.elements), 2))
    first = split(mesh, "rising").elements[0]
    kept = np.unique(first)
    return Mesh(split(mesh, "rising").points[kept], np.searchsorted(kept, first)[None])


SINGLES = {
    "flat": lambda: patch((1, 1)),
    "distorted": lambda: patch((1, 1), distortion=0.25),
    "curved": lambda: patch((1, 1), distortion=0.2, surface=bowl),
}
PATCHES = {
    "flat patch": lambda: patch((3, 3), distortion=0.25),
    "curved patch": lambda: patch((2, 2), distortion=0.2, surface=bowl),
}


def each_mesh(meshes):
    """Run a test over named meshes, given as functions that make them."""
    return pytest.mark.parametrize("mesh", [pytest.param(make(), id=name) for name, make in meshes.items()])


# -- models and states -----------------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Unsupported:
    """What `Discretisation` needs of a model, for a body that nothing holds (a `Model` refuses that) or hardly."""

    shell: Shell
    field: UniformField
    coupling: object
    supports: tuple = ()
    loads: tuple = ()
    local_axis: tuple = (1.0, 0.0, 0.0)
    outputs: tuple = ()
    springs: tuple = ()

    @cached_property
    def rows(self):
        return rows_of(self.shell)

    @cached_property
    def places(self):
        shell = self.shell
        return Places(shell.mesh, self.rows.carriers, shell.rigid, shell.periodic, shell.images)

    @cached_property
    def constraints(self):
        return self.rows.constraints(resolve(self.places, self.supports))

    @cached_property
    def elastic(self):
        return tuple(spring.applied(self.shell, self.places) for spring in self.springs)

    @cached_property
    def applied(self):
        return tuple(load.applied(self.shell, self.rows) for load in self.loads)

    def loading(self, load_factor):
        held = load_factor * self.constraints.values[0]
        drives = np.array([load_factor, 0.0])
        return Loading(load_factor * self.field.vector, np.full(len(self.loads), load_factor), held, drives)

    @cached_property
    def normals(self):
        return self.rows.normals[: self.rows.nodes]


def free_body(
    mesh,
    material=None,
    coupling=None,
    *,
    element=QUADRATIC,
    stretch="linear",
    thickness=THICKNESS,
    remanent=REMANENCE,
    field=FIELD,
    supports=(),
    loads=(),
    ordering=lambda graph: np.arange(graph.shape[0]),
    **made,
):
    """Discretisation of a mesh that only `supports` hold; `remanent` is a vector or one vector per element.

    The mesh is `for_element`; `made` are further arguments of the shell, with layers in place of what it is made of.
    """
    mesh = for_element(mesh, element)
    vectors = np.broadcast_to(np.asarray(remanent, dtype=float), (len(mesh.elements), 3))
    material, magnets = material or example(MATERIAL), remanence.per_element(vectors)
    whole = {} if "layers" in made else {"thickness": thickness, "material": material, "remanence": magnets}
    shell = Shell(mesh, element=element, thickness_stretch=stretch, **whole, **made)
    body = Unsupported(shell, UniformField(field), coupling or example(COUPLING), tuple(supports), tuple(loads))
    return Discretisation(body, ordering)


def rest_and_stretch(d):
    """Rows that have director and micro-rotation, and rows that have a thickness stretch."""
    carried = d.rows.shared(d.carried.copy())
    return np.flatnonzero(carried[:, 3]), np.flatnonzero(carried[:, 6])


def places(d):
    """Points and normals (rows, 3) of the rows."""
    return d.rows.points, d.rows.normals


def homogeneous(d, F, R):
    """x = F X, d = F D, micro-rotation R everywhere."""
    state, (rest, _), (points, normals) = d.undeformed(), rest_and_stretch(d), places(d)
    state.u[:] = points @ (F - np.eye(3)).T
    state.w[rest] = (normals @ (F - np.eye(3)).T)[rest]
    state.q[rest] = Rotation.from_matrix(R).as_quat(scalar_first=True)
    return state


def random_state(d, seed, strain=0.1, turn=None):
    """A large rotation (vector `turn`, rad; None: at random) and a random strain field of the size `strain` on it."""
    rng = np.random.default_rng(seed)
    turn = Rotation.random(rng=rng) if turn is None else Rotation.from_rotvec(turn)
    nodes, (rest, stretch), (points, normals) = len(d.mesh.points), rest_and_stretch(d), places(d)
    shared = lambda values: values[d.rows.of]  # noqa: E731
    F = turn.as_matrix() @ (np.eye(3) + rng.uniform(-strain, strain, (3, 3)))
    state = d.undeformed()
    u = points @ (F - np.eye(3)).T + shared(0.3 * strain * rng.uniform(-1, 1, (nodes, 3)))
    w, phi, q, s = state.w.copy(), state.phi.copy(), state.q.copy(), state.s.copy()
    w[rest] = (normals @ (F - np.eye(3)).T + shared(strain * rng.uniform(-1, 1, (nodes, 3))))[rest]
    phi[stretch] = strain * rng.uniform(-1, 1, len(stretch)) / mean_thickness(d)
    spins = np.zeros((nodes, 3))
    own = rest[rest < nodes]
    spins[own] = 2.0 * strain * rng.uniform(-1, 1, (len(own), 3))
    q[rest] = (turn * Rotation.from_rotvec(shared(spins)[rest])).as_quat(scalar_first=True)
    s[nodes:] = strain * rng.uniform(-1, 1, len(s) - nodes)
    return State(u, w, phi, q, s, strain * rng.uniform(-1, 1, state.alpha.shape))


def mean_thickness(d):
    """Of all elements, m."""
    return float(np.mean(np.concatenate([part.at_points.sum(axis=2).mean(axis=1) for part in d.model.shell.parts])))


def random_increment(d, seed, size=0.1):
    """An increment, zero where a node does not carry the field."""
    rng = np.random.default_rng(seed)
    nodal = d.rows.shared(size * rng.uniform(-1, 1, d.carried.shape) * d.carried)
    return Increment(nodal, size * rng.uniform(-1, 1, (len(d.mesh.elements), d.reference.body.layout.modes, 3)))


def strain_energy(d, state):
    """Strain energy of each element (elements,)."""
    return Converged(d, state, d.model.loading(1.0)).energies[:, INTERNAL]


def dense(d, matrix):
    """The matrix on (row, component) pairs, zero where a component is fixed or absent: (11 rows, 11 rows)."""
    full = np.zeros((d.free.size, d.free.size))
    at, number = np.flatnonzero(d.free), d.numbering.equations
    full[np.ix_(at, at)] = matrix.toarray()[np.ix_(number, number)]
    return full


def scaled_error(actual, expected):
    """Largest error: of a matrix with rows and columns scaled to unit largest entries, of a vector over its largest."""
    difference = np.abs(actual - expected)
    if expected.ndim == 1:
        return float(difference.max() / np.abs(expected).max())
    rows, columns = np.abs(expected).max(axis=1), np.abs(expected).max(axis=0)
    scale = np.sqrt(np.outer(rows, columns))
    return float((difference / np.where(scale > 0.0, scale, np.abs(expected).max())).max())
