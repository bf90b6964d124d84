"""Parts that stand for many alike, and the many: sectors about an axis, cells of a sheet."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from battery import MATERIAL, example

import magshell as ms
from magshell import mesh as meshes
from magshell.evaluation.converged import converged
from magshell.evaluation.patches import patches_of
from magshell.evaluation.strain import FACES
from magshell.mesh import Mesh
from magshell.mesh.edges import find_edges
from magshell.mesh.welding import merged

SECTORS = 5
AXIS, POINT = np.array([1.0, 2.0, 2.0]) / 3.0, np.array([0.3, -0.2, 0.5])
# From X3 to the axis, so that nothing is along the global axes.
TURNED = np.linalg.qr(np.column_stack([AXIS, (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)]))[0][:, [1, 2, 0]]
TURNED[:, 2] *= np.sign(TURNED[:, 2] @ AXIS)
TURNED[:, 1] = np.cross(TURNED[:, 2], TURNED[:, 0])
RUBBER = example(MATERIAL)


@dataclass(frozen=True)
class Sector:
    """A sector with the groups start, stop and inner, by radii and angles; heights over these; what it is made of."""

    height: Callable[[np.ndarray, np.ndarray], np.ndarray] = lambda r, a: 0.0 * r
    inner: float = 0.5
    across: int = 2
    around: int = 2
    made: Callable[[np.ndarray], dict] = lambda vectors: {}
    split: bool = False
    groups: Callable[[Mesh], Mesh] = field(default=lambda mesh: mesh)

    @property
    def mesh(self) -> Mesh:
        width = 360.0 / SECTORS
        if self.inner:
            plane = meshes.annulus(self.inner, 1.0, (self.across, self.around), angle=(10.0, 10.0 + width))
        else:
            plane = to_the_centre(np.radians(10.0), np.radians(width))
        plane = self.groups(plane)
        r, a = np.hypot(*plane.points[:, :2].T), np.arctan2(plane.points[:, 1], plane.points[:, 0]) - np.radians(10.0)
        points = plane.points + self.height(r, np.mod(a + 1e-9, np.radians(width)) - 1e-9)[:, None] * (0.0, 0.0, 1.0)
        placed = Mesh(points @ TURNED.T + POINT, plane.elements, plane.element_groups, plane.edge_groups)
        return meshes.split(placed, "rising") if self.split else placed


def to_the_centre(start: float, width: float) -> Mesh:
    """Two rings of triangles about the centre; group inner is the outer edge."""
    r = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
    points, known = [], {}

    def node(i: int, j: float) -> int:
        key = (i, j if i else 0)
        if key not in known:
            a = start + width * j / 4
            known[key] = len(points)
            points.append((r[i] * np.cos(a), r[i] * np.sin(a), 0.0))
        return known[key]

    rows = [
        [node(0, 0), node(2, 0), node(2, 4), node(1, 0), node(2, 2), node(1, 4)],
        [node(2, 0), node(4, 0), node(4, 4), node(3, 0), node(4, 2), node(3, 2)],
        [node(2, 0), node(4, 4), node(2, 4), node(3, 2), node(3, 4), node(2, 2)],
    ]
    sides = {
        "start": [[node(0, 0), node(2, 0), node(1, 0)], [node(2, 0), node(4, 0), node(3, 0)]],
        "stop": [[node(0, 0), node(2, 4), node(1, 4)], [node(2, 4), node(4, 4), node(3, 4)]],
        "inner": [[node(4, 0), node(4, 4), node(4, 2)]],
    }
    groups = {name: np.array(edges) for name, edges in sides.items()}
    return Mesh(np.array(points), meshes.triangle_rows(np.array(rows)), edge_groups=groups)


def remanence(mesh: Mesh) -> np.ndarray:
    """One vector for each element."""
    return np.random.default_rng(len(mesh.elements)).uniform(-1.0, 1.0, (len(mesh.elements), 3))


def shell(mesh: Mesh, made: dict, vectors: np.ndarray, **further) -> ms.Shell:
    whole = {} if "layers" in made else {"material": RUBBER, "remanence": ms.remanence.per_element(vectors)}
    thickness = {} if "layers" in made or "thickness" in made else {"thickness": 0.08}
    return ms.Shell(mesh, **whole, **thickness, density=1.0, **made, **further)


def copied(mesh: Mesh, motions: list[tuple[np.ndarray, np.ndarray]]) -> tuple[Mesh, np.ndarray]:
    """Copies of a mesh under rotations and translations, welded, and the node (copies, nodes) of each."""
    count = len(mesh.points)
    points = np.concatenate([mesh.points @ Q.T + shift for Q, shift in motions])
    standing = merged(points, 1e-7)
    kept, number = np.unique(standing, return_inverse=True)
    nodes = number.reshape(len(motions), count)
    elements = np.concatenate([own[mesh.elements] for own in nodes])
    groups = {
        name: np.concatenate([members + k * len(mesh.elements) for k in range(len(motions))])
        for name, members in mesh.element_groups.items()
    }
    edges = {
        name: np.unique(np.concatenate([_sorted(own[group]) for own in nodes]), axis=0)
        for name, group in mesh.edge_groups.items()
    }
    there = {tuple(_sorted(side[None])[0]) for side in find_edges(elements).sides}
    edges = {name: np.array([e for e in group if tuple(e) in there]) for name, group in edges.items()}
    return Mesh(points[kept], elements, groups, edges), nodes


def _sorted(edges: np.ndarray) -> np.ndarray:
    return np.column_stack([np.sort(edges[:, :2], axis=1), edges[:, 2]])


def recovered_alike(part, whole, accuracy):
    """Strain, stress and resultants at the nodes of a part's elements are those of the first elements of the whole."""
    here, there = (converged(path.discretisation, path.steps[-1]) for path in (part, whole))
    rows, of_whole = (patches_of(path.discretisation.model.shell).elements for path in (part, whole))
    for name in ("log_strain", "cauchy"):
        for face in FACES:
            one, other = here.at_face(name, face)[rows], there.at_face(name, face)[of_whole[: len(rows)]]
            assert np.abs(one - other).max() < accuracy * np.abs(other).max(), (name, face)
    for name in ("forces", "moments", "couples", "axes"):
        one, other = here.resultant(name)[rows], there.resultant(name)[of_whole[: len(rows)]]
        assert np.abs(one - other).max() < accuracy * np.abs(other).max(), name
