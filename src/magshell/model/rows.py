"""Rows of the nodal arrays: the nodes of the mesh, and one more for each further section that meets at a node.

The stretch φ and the length of the director jump where thickness, layers, material or offset change. Elements on the
two sides of such a border have rows of their own there. They share u, w and the micro-rotation of the mesh node; the
further ones have their own φ and a stretch s of the director.
"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeVar

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.model.shell import Shell
from magshell.model.supports import Constraints
from magshell.shell.unknowns import COLUMNS, COMPONENTS

# Thicknesses that differ by less, relative, are the same.
SAME = 1e-9
SHARED = np.ones(COMPONENTS, dtype=bool)
SHARED[[COLUMNS["phi"].start, COLUMNS["s"].start]] = False

Columns = TypeVar("Columns", bound=AnyArray)


class Rows(NamedTuple):
    """Who has which row.

    Attributes
    ----------
    nodes : int
        Number of mesh nodes.
    of : ndarray, shape (rows,)
        Mesh node; that of the first rows is their own number.
    elements : ndarray, shape (elements, 8)
        Rows of the elements.
    carried : ndarray of bool, shape (rows, 11)
        Which unknowns a row has for itself.
    """

    nodes: int
    of: IntArray
    elements: IntArray
    carried: AnyArray

    @property
    def copies(self) -> AnyArray:
        """Rows that are not the first of their mesh node."""
        return np.arange(self.nodes, len(self.of))

    def shared(self, nodal: Columns) -> Columns:
        """Nodal columns (rows, 11) whose shared ones are those of the mesh nodes."""
        if len(self.of) > self.nodes:
            nodal[np.ix_(self.copies, SHARED)] = nodal[np.ix_(self.of[self.copies], SHARED)]
        return nodal

    def folded(self, forces: FloatArray) -> FloatArray:
        """Forces (rows, 11) summed at those that share their unknowns: the transpose of `shared`."""
        if len(self.of) > self.nodes:
            at = np.ix_(self.copies, SHARED)
            np.add.at(forces, (self.of[self.copies][:, None], np.flatnonzero(SHARED)), forces[at])
            forces[at] = 0.0
        return forces

    def constraints(self, constraints: Constraints) -> Constraints:
        """Constraints of the mesh nodes, for every row. A held φ is that of all sections."""
        fixed, values = constraints.fixed[self.of], constraints.values[:, self.of]
        return constraints._replace(fixed=fixed, values=values, frame_of=constraints.frame_of[self.of])


def rows_of(shell: Shell) -> Rows:
    """The rows of a shell."""
    mesh, count = shell.mesh, len(shell.mesh.points)
    rest = shell.element.rest_nodes
    elements, of = mesh.elements.copy(), list(range(count))
    kind, measures = _sections(shell)
    corners = mesh.elements[:, :rest].ravel()
    first = np.empty(count, dtype=np.int64)
    first[corners[::-1]] = np.arange(corners.size)[::-1]
    differs = ~_same(kind, measures, np.arange(corners.size), first[corners])
    order = np.argsort(corners, kind="stable")
    starts = np.searchsorted(corners[order], np.arange(count + 1))
    for node in np.unique(corners[differs]).tolist():
        heads: list[tuple[int, int]] = []
        for at in order[starts[node] : starts[node + 1]].tolist():
            row = next((row for head, row in heads if _same(kind, measures, at, head)), None)
            if row is None:
                row = len(of) if heads else node
                heads.append((at, row))
                if row != node:
                    of.append(node)
            elements[divmod(at, rest)] = row
    return Rows(count, np.array(of), elements, _carried(shell, elements, np.array(of)))


class _Section(NamedTuple):
    layered: bool
    laws: tuple[type, ...]
    parameters: tuple[tuple[float, ...], ...]


def _sections(shell: Shell) -> tuple[IntArray, FloatArray]:
    """What each corner is of, (corners,), and the thickness of its layers and the offset (corners, most layers + 1)."""
    count, rest = len(shell.mesh.elements), shell.element.rest_nodes
    most = max(len(part.layers) for part in shell.parts)
    kind, measures = np.zeros((count, rest), dtype=np.int64), np.zeros((count, rest, most + 1))
    known: dict[_Section, int] = {}
    for part in shell.parts:
        materials = [layer.material for layer in part.layers]
        section = _Section(part.layered, tuple(map(type, materials)), tuple(map(tuple, materials)))
        kind[part.elements] = known.setdefault(section, len(known))
        measures[part.elements, :, : len(part.layers)] = part.at_nodes[:, :rest]
        measures[part.elements, :, most] = part.offset_at_nodes[:, :rest]
    return kind.ravel(), measures.reshape(count * rest, most + 1)


def _same(kind: IntArray, measures: FloatArray, one: Any, other: Any) -> Any:
    """Whether corners are of one section."""
    scale = np.abs(measures[other]).max(axis=-1)
    near = np.abs(measures[one] - measures[other]).max(axis=-1) <= SAME * scale
    return (kind[one] == kind[other]) & near


def _carried(shell: Shell, elements: IntArray, of: IntArray) -> AnyArray:
    carried = np.zeros((len(of), COMPONENTS), dtype=bool)
    carriers, nodes = shell.carriers, len(shell.mesh.points)
    for field, columns in COLUMNS.items():
        if field in carriers:
            carried[:nodes, columns] = carriers[field][:, None]
    carried[nodes:, COLUMNS["s"]] = True
    φ = COLUMNS["phi"].start
    if carried[:, φ].any():
        plain = np.concatenate([part.elements for part in shell.parts if not part.layered] or [np.empty(0, dtype=int)])
        carried[:, φ] = False
        carried[elements[plain, : shell.element.stretch_nodes], φ] = True
    return carried
