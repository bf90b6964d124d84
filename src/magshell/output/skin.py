"""What pictures show of a shell: its mid-surface, or the closed body between its two faces.

A shell of one thickness with the mesh in the middle is shown as its mid-surface. Where thickness, layers or materials
differ, or the mesh lies at a face, both faces are shown at their true heights, with walls at the outer edges and
wherever the faces of two neighbours differ, and lines between the regions. At kinks and joints the faces meet as
`joints.py` says.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.evaluation.converged import Converged
from magshell.mesh.edges import SIDES
from magshell.output.copies import Copy, neighbours, with_copies
from magshell.output.joints import Mitres, joints_of, sides_of
from magshell.output.tessellation import Surface, Tessellation, element_edges, own_nodes

if TYPE_CHECKING:
    from magshell.model.shell import Shell

MOST_ELEMENTS_WITH_EDGES = 4000
SAME = 1e-9
"""Heights that differ by less than this part of the greatest are the same."""


class Placed(NamedTuple):
    """A skin in a state.

    Attributes
    ----------
    surface : Surface
    inner, outer : FloatArray, shape (k, pieces + 1, 3)
        Curves: edges of elements; outer edges, kinks, joints, steps and borders of regions.
    copies : sequence of Copy
        Neighbours of a repeated part.
    """

    surface: Surface
    inner: FloatArray
    outer: FloatArray
    copies: Sequence[Copy] = ()


class Skin(Protocol):
    """What is drawn of a shell."""

    def at_points(self, values: AnyArray) -> AnyArray:
        """Nodal values (nodes, ...) at the points of the surface."""

    def at_corners(self, values: AnyArray) -> AnyArray:
        """Values at the nodes of each element (elements, 8, ...) at the points of the surface."""

    def on_elements(self, values: AnyArray) -> AnyArray:
        """Values of elements (elements, ...) at the points of the surface."""

    def placed(self, reached: Converged) -> Placed:
        """Where it is in a state."""

    def extent(self, reached: Converged) -> FloatArray:
        """Positions (n, 3) of its nodes in a state, with those of its copies, m."""


def skin_of(shell: Shell, pieces: int | None = None) -> Skin:
    """What is drawn of a shell, each element cut into `pieces` × `pieces`."""
    if shell.plain:
        return Sheet(shell, pieces)
    return Hull(shell, shell.part_of, pieces)


class Sheet:
    """The mid-surface."""

    def __init__(self, shell: Shell, pieces: int | None = None) -> None:
        mesh = shell.mesh
        self._mesh, self._cells, self._outline = mesh, Tessellation(mesh.elements, pieces), joints_of(shell).outline
        few = len(mesh.elements) <= MOST_ELEMENTS_WITH_EDGES
        self._edges = element_edges(mesh.elements) if few else self._outline

    def at_points(self, values: AnyArray) -> AnyArray:
        """Nodal values at the points."""
        return self._cells.at_points(values)

    def at_corners(self, values: AnyArray) -> AnyArray:
        """Values at the nodes of each element at the points."""
        return self._cells.at_corners(values)

    def on_elements(self, values: AnyArray) -> AnyArray:
        """Values of elements at the points."""
        return self._cells.on_elements(values)

    def extent(self, reached: Converged) -> FloatArray:
        """Positions of its nodes in a state."""
        return with_copies(self._mesh.points + reached.displacement, neighbours(reached))

    def placed(self, reached: Converged) -> Placed:
        """Where it is in a state."""
        x = self._mesh.points + reached.displacement
        inner, outer = (self._cells.edges(x, edges) for edges in (self._edges, self._outline))
        return Placed(self._cells.surface(x), inner, outer, neighbours(reached))


class Nodal(NamedTuple):
    """A hull as elements of eight nodes, top faces first, each with nodes of its own.

    Attributes
    ----------
    elements : IntArray, shape (m, 8)
    element_of : IntArray, shape (m,)
        The element of the mesh.
    tops : int
        How many are top faces.
    nodes : IntArray, shape (k,)
        The row that each node belongs to, and
    heights : FloatArray, shape (k,)
        its height over the mesh, m.
    inner, outer : IntArray, shape (n, 3)
        Edges: end, end, middle.
    mitres : Mitres
        Nodes that lie elsewhere.
    """

    elements: IntArray
    element_of: IntArray
    tops: int
    nodes: IntArray
    heights: FloatArray
    inner: IntArray
    outer: IntArray
    mitres: Mitres


UPSIDE_DOWN = np.array([0, 3, 2, 1, 7, 6, 5, 4])
"""The nodes of a quadrilateral as seen from below."""
TRIANGLE_UPSIDE_DOWN = np.array([0, 2, 1, 1, 7, 5, 1, 4])


class Hull:
    """The body between two faces.

    Parameters
    ----------
    shell : Shell
    group_of : IntArray, shape (elements,)
        Between elements of different groups a line is drawn.
    pieces : int, optional
        Along the side of an element.
    open_edges : IntArray, shape (k,), optional
        Middle nodes of edges of the boundary without wall and line.
    """

    def __init__(
        self,
        shell: Shell,
        group_of: IntArray,
        pieces: int | None = None,
        open_edges: IntArray | None = None,
    ) -> None:
        mesh, heights, joints = shell.mesh, shell.faces_at_nodes, joints_of(shell)
        self._mesh, self._heights, self._nodes, self._joints = mesh, heights, own_nodes(mesh.elements), joints
        self._cells = Tessellation(self._nodes, pieces)
        sides = sides_of(joints.poles)
        element, side = np.divmod(sides.numbers, 4)
        inner = sides.partners >= 0
        partner = sides.partners[inner]
        at_sides = heights[element[:, None], SIDES[side]]
        across = np.where(
            sides.against[inner, None, None], -at_sides[partner, :, ::-1], at_sides[partner][:, [1, 0, 2]]
        )
        apart = ~joints.mitred[element[:, None], SIDES[side]][inner, :, None]
        step, border = ~inner, np.zeros(len(inner), dtype=bool)
        step[inner] = np.abs(apart * (at_sides[inner] - across)).max(axis=(1, 2)) > SAME * np.abs(heights).max()
        sheet = joints.sheets[element, SIDES[side, 2]]
        different = (group_of[element[inner]] != group_of[element[partner]]) | (sheet[inner] != sheet[partner])
        border[inner] = different & (np.flatnonzero(inner) < partner)
        if open_edges is not None:
            step &= ~np.isin(mesh.elements[element, SIDES[side][:, 2]], open_edges)
        triples = self._nodes[element[:, None], SIDES[side]]
        once = ~inner
        once[inner] = np.flatnonzero(inner) < partner
        few = len(mesh.elements) <= MOST_ELEMENTS_WITH_EDGES
        self._wall_elements = element[step]
        self._walls, self._lines, self._inner = triples[step], triples[step | border], triples[once if few else step]

    def at_points(self, values: AnyArray) -> AnyArray:
        """Nodal values at the points."""
        return self.at_corners(values[self._mesh.elements])

    def at_corners(self, values: AnyArray) -> AnyArray:
        """Values at the nodes of each element at the points."""
        own = values.reshape(-1, *values.shape[2:])
        flat = self._cells.at_points(own)
        along = self._cells.edges(own.reshape(len(own), -1), self._walls)
        on_walls = along.reshape(-1, *values.shape[2:])
        return np.concatenate([flat, flat, on_walls, on_walls])

    def on_elements(self, values: AnyArray) -> AnyArray:
        """Values of elements at the points."""
        flat = self._cells.on_elements(values)
        on_walls = np.repeat(values[self._wall_elements], self._cells.pieces + 1, axis=0)
        return np.concatenate([flat, flat, on_walls, on_walls])

    def nodal(self, rows: IntArray) -> Nodal:
        """The hull as elements, for callers that place its nodes themselves, with `rows` (elements, 8) of the mesh."""
        count, own = len(self._mesh.elements), self._nodes
        below = np.where(self._mesh.triangles[:, None], own[:, TRIANGLE_UPSIDE_DOWN], own[:, UPSIDE_DOWN]) + own.size
        start, end, middle = self._walls.T
        posts = 2 * own.size + np.arange(2 * len(start)).reshape(2, -1)
        up = own.size
        walls = np.stack([start + up, end + up, end, start, middle + up, posts[1], middle, posts[0]], axis=1).reshape(
            -1, 8
        )
        bottom, top = np.moveaxis(self._heights, 2, 0)
        amid = 0.5 * (bottom + top).ravel()
        nodes = rows.ravel()
        return Nodal(
            elements=np.concatenate([own, below, walls]),
            element_of=np.concatenate([np.arange(count), np.arange(count), self._wall_elements]),
            tops=count,
            nodes=np.concatenate([nodes, nodes, nodes[start], nodes[end]]),
            heights=np.concatenate([top.ravel(), bottom.ravel(), amid[start], amid[end]]),
            inner=np.concatenate([self._inner, self._inner + up]),
            outer=np.concatenate([self._lines, self._lines + up]),
            mitres=self._mitres(rows, start, end),
        )

    def _mitres(self, rows: IntArray, start: IntArray, end: IntArray) -> Mitres:
        """Nodes of both faces, then those half-way between them at the ends of the walls."""
        every, posts = np.arange(self._nodes.size), np.concatenate([start, end])
        top, bottom, *halves = (
            self._joints.mitres(rows, self._heights, places, upper)
            for places in (every, posts)
            for upper in (True, False)
        )
        found = (top, bottom.after(every.size), *(half.after(2 * every.size) for half in halves))
        shares = np.repeat([1.0, 1.0, 0.5, 0.5], [len(one.nodes) for one in found])
        numbers = np.concatenate([one.numbers for one in found])
        numbers[:, 1] *= shares
        return Mitres(np.concatenate([one.nodes for one in found]), numbers)

    def faces(self, reached: Converged) -> FloatArray:
        """Positions (2, elements, 8, 3) of the bottom and the top face, m: X + u + z (1 + z φ) d, mitred at kinks."""
        mesh, z = self._mesh, np.moveaxis(self._heights, 2, 0)
        middle = (mesh.points + reached.displacement)[mesh.elements]
        return self._joints.faces(middle, reached.element_directors(), z * (1.0 + z * reached.element_phi()))

    def faces_at_rest(self, normals: FloatArray) -> FloatArray:
        """The same in the undeformed shell with these normals at the nodes of the elements (elements, 8, 3)."""
        return self._joints.faces(self._mesh.points[self._mesh.elements], normals, np.moveaxis(self._heights, 2, 0))

    def extent(self, reached: Converged) -> FloatArray:
        """Positions of its nodes in a state."""
        return with_copies(self.faces(reached).reshape(-1, 3), neighbours(reached))

    def placed(self, reached: Converged) -> Placed:
        """Where it is in a state."""
        return self.between(*self.faces(reached))._replace(copies=neighbours(reached))

    def between(self, bottom: FloatArray, top: FloatArray) -> Placed:
        """Where it is with its faces at given positions (elements, 8, 3), m."""
        below, above = bottom.reshape(-1, 3), top.reshape(-1, 3)
        surfaces = [self._cells.surface(face) for face in (below, above)]
        low, high = (self._cells.edges(face, self._walls) for face in (below, above))
        outward = np.cross(np.gradient(0.5 * (low + high), axis=1), high - low)
        length = np.linalg.norm(outward, axis=-1, keepdims=True)
        outward /= np.where(length > 0.0, length, 1.0)
        lower = np.arange(low[..., 0].size).reshape(low.shape[:2])
        upper = lower + lower.size
        quads = np.stack([lower[:, :-1], lower[:, 1:], upper[:, 1:], upper[:, :-1]], axis=-1).reshape(-1, 4)
        count = len(surfaces[0].points)
        surface = Surface(
            np.concatenate([one.points for one in surfaces] + [low.reshape(-1, 3), high.reshape(-1, 3)]),
            np.concatenate([-surfaces[0].normals, surfaces[1].normals] + 2 * [outward.reshape(-1, 3)]),
            np.concatenate(
                [
                    surfaces[0].triangles[:, ::-1],
                    surfaces[1].triangles + count,
                    np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]) + 2 * count,
                ]
            ),
        )
        inner, outer = (
            np.concatenate([self._cells.edges(face, triples) for face in (below, above)])
            for triples in (self._inner, self._lines)
        )
        return Placed(surface, inner, outer)
