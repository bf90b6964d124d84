"""Every kind of load, on groups of every kind: what the tests of loads as such run over. A new load joins here."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import numpy as np
import pytest
from battery import MATERIAL, PATCHES, example
from scipy.spatial.transform import Rotation

import magshell as ms
from loads.bodies import grouped
from magshell.mesh import Mesh
from magshell.model.loads import Applied
from magshell.model.rows import rows_of
from magshell.shell.elements import QUADRATIC
from magshell.shell.normals import nodal_normals
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS

V = (0.7, -0.4, 1.1)
DENSITY = 1.3


class Case(NamedTuple):
    """A load, and what it is by the words of its documentation."""

    load: Any
    turns: bool = False
    """Whether it turns with the deformed body."""
    conservative: bool = True
    micro_rotation: bool = True
    """Without it, of a moment what is normal to the first node's director is meant: the rest is refused."""


def _cases() -> dict[str, Case]:
    cases = {
        "traction": Case(ms.Traction("half", V)),
        "traction on all": Case(ms.Traction(None, V)),
        "pressure on all": Case(ms.Pressure(None, -0.8), turns=True, conservative=False),
        "pressure": Case(ms.Pressure("half", -0.8), turns=True, conservative=False),
        "gravity": Case(ms.Gravity(V)),
        "gravity of a group": Case(ms.Gravity(V, "half")),
    }
    for group, kind in {"top": "edges", "half": "elements", "scattered": "nodes"}.items():
        cases[f"force on {kind}"] = Case(ms.Force(group, V))
        cases[f"moment on {kind}"] = Case(ms.Moment(group, V), conservative=False)
        cases[f"turning force on {kind}"] = Case(ms.Force(group, V, follower=True), True, False)
        cases[f"turning moment on {kind}"] = Case(ms.Moment(group, V, follower=True), True, False)
    cases["moment on a director"] = Case(ms.Moment("corner", V), conservative=False, micro_rotation=False)
    return cases


CASES = _cases()
MESHES = {name: grouped(make()) for name, make in PATCHES.items()}
each_case = pytest.mark.parametrize("case", CASES.values(), ids=CASES)
each_patch = pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)


def shell_of(mesh: Mesh, element: Any = QUADRATIC, micro_rotation: bool = True, thickness: float = 0.15) -> ms.Shell:
    material = example(MATERIAL)
    if not micro_rotation:
        material = material._replace(coupling_modulus=0.0, length_scale=0.0)
    return ms.Shell(mesh, thickness, material, element=element, micro_rotation=micro_rotation, density=DENSITY)


def applied(load: Any, shell: ms.Shell) -> Applied:
    return load.applied(shell, rows_of(shell))


def on_mesh(case: Case, mesh: Mesh, element: Any = QUADRATIC) -> Applied:
    load = case.load
    if not case.micro_rotation:
        D = nodal_normals(mesh.points, mesh.elements)[mesh.nodes_of(load.group)[0]]
        load = dataclasses.replace(load, total=load.total - D @ load.total * D)
    return applied(load, shell_of(mesh, element, case.micro_rotation))


def at_rest(mesh: Mesh) -> State:
    return State.undeformed(len(mesh.points), len(mesh.elements), 0)


def crumpled(mesh: Mesh, seed: int) -> State:
    """Each node moved on its own by a third of an element, its director by a third, and turned anyhow."""
    rng, nodes = np.random.default_rng(seed), len(mesh.points)
    turned = Rotation.random(nodes, rng=rng).as_quat(scalar_first=True)
    u, w = rng.uniform(-0.33, 0.33, (2, nodes, 3))
    return at_rest(mesh)._replace(u=u, w=w, q=turned)


def moved(state: State, increment: np.ndarray) -> State:
    return state.moved(increment, np.zeros_like(state.alpha))


def turned_rigidly(mesh: Mesh, state: State, Q: Rotation) -> State:
    """The deformed body turned about the origin."""
    normals = nodal_normals(mesh.points, mesh.elements)
    u, w = ((rest + change) @ Q.as_matrix().T - rest for rest, change in ((mesh.points, state.u), (normals, state.w)))
    q = (Q * Rotation.from_quat(state.q, scalar_first=True)).as_quat(scalar_first=True)
    return state._replace(u=u, w=w, q=q)


def turned_vectors(load: Any, Q: Rotation) -> Any:
    """The load with every vector that it names turned."""
    vectors = {
        field.name: Q.apply(getattr(load, field.name))
        for field in dataclasses.fields(load)
        if np.shape(getattr(load, field.name)) == (3,)
    }
    return dataclasses.replace(load, **vectors)


def turned_columns(nodal: np.ndarray, Q: Rotation) -> np.ndarray:
    """Nodal columns (nodes, 11) turned; φ is a scalar."""
    turned = nodal.copy()
    for field in ("u", "w", "omega"):
        turned[:, COLUMNS[field]] = nodal[:, COLUMNS[field]] @ Q.as_matrix().T
    return turned


def product(load: Applied, state: State, increment: np.ndarray) -> np.ndarray:
    """The load's part of the tangent times an increment (nodes, 11)."""
    result = np.zeros_like(increment)
    for pairs, blocks in zip(load.pairs, load.stiffness(state), strict=True):
        rows, columns = (COLUMNS[field] for field in (pairs.row_field, pairs.column_field))
        parts = np.einsum("nij,nj->ni", blocks, increment[pairs.columns, columns])
        np.add.at(result[:, rows], pairs.rows, parts)
    return result


def torques(mesh: Mesh, state: State, forces: np.ndarray) -> np.ndarray:
    """Torques (nodes, 3) of the forces on directors and the couples on micro-rotations."""
    directors = nodal_normals(mesh.points, mesh.elements) + state.w
    return np.cross(directors, forces[:, COLUMNS["w"]]) + forces[:, COLUMNS["omega"]]
