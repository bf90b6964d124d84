"""The mesh: nodes, 8-node quadrilaterals and 6-node triangles, named groups of them, and how to find a place on it."""

from __future__ import annotations

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.drawing import drawing
from magshell.errors import InputError, suggest
from magshell.mesh.angles import check_folded
from magshell.mesh.checks import (
    check_connectivity,
    check_cuts,
    check_groups,
    check_name,
    check_numbers,
    float_rows,
    integer_rows,
    locked,
)
from magshell.mesh.edges import Edges, find_edges, is_triangle
from magshell.mesh.geometry import COINCIDENT, centres, check_shapes, unit
from magshell.mesh.selection import Coordinate, Range, Within, elements_there, items_there
from magshell.mesh.unmatched import check_unmatched
from magshell.mesh.wording import listing, place


@dataclass(frozen=True, eq=False, repr=False)
class Mesh:
    """A surface of 8-node quadrilaterals and 6-node triangles in space, checked when it is made.

    Parameters
    ----------
    points : (nodes, 3)
        Positions, m.
    elements : (elements, 8)
        Node numbers: four corners, counter-clockwise seen against the director D, then the four mid-side
        nodes, starting between corners 1 and 2 (the order of VTK_QUADRATIC_QUAD). A triangle with corners a, b, c is
        the row a, b, c, c, ab, bc, c, ca, see `magshell.mesh.triangle_rows`.
    element_groups : mapping of name to (k,)
        Element numbers.
    edge_groups : mapping of name to (k, 3)
        Edges: the node numbers of one end, the other end and the middle.
    node_groups : mapping of name to (k,)
        Node numbers.
    cuts : sequence of str
        Edge groups along which the surface is cut: nodes may lie on each other there (`magshell.mesh.cut` makes them).

    Any number of elements may share an edge, at any angle, and neighbours may have opposite normals, as the sheets of
    a folded plate, a rib or a Möbius band.

    Nodes and elements are counted from 0, here and in messages; the corners of an element from 1. A name
    belongs to one group only, whatever its kind. The arrays are copied and read-only.

    Raises
    ------
    MeshError
        Wrong shapes or numbers, unused nodes, an element twice, misshapen elements, elements that lie on each other at
        a common edge or touch without being joined, a group or a cut that makes no sense. The message names the
        elements.
    """

    points: FloatArray
    elements: IntArray
    element_groups: Mapping[str, IntArray] = field(default_factory=dict)
    edge_groups: Mapping[str, IntArray] = field(default_factory=dict)
    node_groups: Mapping[str, IntArray] = field(default_factory=dict)
    cuts: Sequence[str] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", float_rows(self.points, 3, "Points"))
        object.__setattr__(self, "elements", integer_rows(self.elements, 8, "Elements"))
        check_numbers(self.points, self.elements)
        check_connectivity(self.points, self.elements, self._edges)
        check_shapes(self.points, self.elements, self.size)
        check_folded(self.points, self.elements, self._edges)
        checked = check_groups(
            self.element_groups, self.edge_groups, self.node_groups, self.points, self.elements, self._edges
        )
        for kind, names in zip(("element_groups", "edge_groups", "node_groups"), checked, strict=True):
            object.__setattr__(self, kind, names)
        object.__setattr__(self, "cuts", check_cuts(self.cuts, self.edge_groups))
        cuts = {name: self.edge_groups[name] for name in self.cuts}
        check_unmatched(self.points, self.elements, self._edges, self.size, cuts)

    def __setstate__(self, state: dict[str, object]) -> None:
        """Of a pickle, which does not say that its arrays are read-only."""
        self.__dict__.update(state)
        for value in state.values():
            for array in value.values() if isinstance(value, dict) else (value,):
                if isinstance(array, np.ndarray):
                    locked(array)

    def __repr__(self) -> str:
        names = ", ".join(self.groups) or "none"
        return f"Mesh({self.counts}, {len(self.points)} nodes, groups: {names})"

    @cached_property
    def triangles(self) -> AnyArray:
        """Which elements (elements,) are triangles."""
        return locked(is_triangle(self.elements))

    @property
    def counts(self) -> str:
        """How many elements there are, in words: `12 elements`, or with triangles `8 quadrilaterals, 4 triangles`."""
        triangles = int(self.triangles.sum())
        if not triangles:
            return f"{len(self.elements)} elements"
        quadrilaterals = f"{len(self.elements) - triangles} quadrilaterals, " if not self.triangles.all() else ""
        return quadrilaterals + f"{triangles} triangles"

    def _repr_html_(self) -> str:
        return str(drawing("mesh_html")(self))

    @cached_property
    def _edges(self) -> Edges:
        return find_edges(self.elements)

    @property
    def _kinds(self) -> dict[str, str]:
        kinds = (("element", self.element_groups), ("edge", self.edge_groups), ("node", self.node_groups))
        return {name: kind for kind, names in kinds for name in names}

    @property
    def groups(self) -> list[str]:
        """Names of all groups: of elements, then edges, then nodes."""
        return list(self._kinds)

    @cached_property
    def corner_nodes(self) -> IntArray:
        """Sorted numbers of the nodes that are corners; the rest are mid-side nodes."""
        return locked(np.unique(self.elements[:, :4]))

    @cached_property
    def boundary_edges(self) -> IntArray:
        """Edges (k, 3) that only one element has: end, end, middle, walked with the surface on the left."""
        return locked(self._edges.sides[self._edges.boundary])

    @cached_property
    def size(self) -> float:
        """Diagonal of the bounding box, m."""
        return float(np.linalg.norm(np.ptp(self.points, axis=0)))

    @cached_property
    def parts(self) -> list[IntArray]:
        """Element numbers of each connected part, by first element; one common node connects."""
        from scipy.sparse import coo_matrix
        from scipy.sparse.csgraph import connected_components

        count, nodes = self.elements.shape[0], len(self.points)
        rows = np.repeat(np.arange(count), 8)
        graph = coo_matrix((np.ones(8 * count), (rows, count + self.elements.ravel())), shape=(count + nodes,) * 2)
        _, labels = connected_components(graph, directed=False)
        order = np.argsort(labels[:count], kind="stable")
        starts = np.flatnonzero(np.diff(labels[order])) + 1
        return sorted((locked(part) for part in np.split(order, starts)), key=lambda part: int(part[0]))

    def elements_of(self, name: str) -> IntArray:
        """Element numbers of an element group.

        Raises
        ------
        InputError
            There is no element group of that name; the message has the nearest one.
        """
        return self._of_kind("element", self.element_groups, name)

    def edges_of(self, name: str) -> IntArray:
        """Edges (k, 3) of an edge group: end, end, middle.

        Raises
        ------
        InputError
            There is no edge group of that name; the message has the nearest one.
        """
        return self._of_kind("edge", self.edge_groups, name)

    def _of_kind(self, wanted: str, groups: Mapping[str, IntArray], name: str) -> IntArray:
        """The members of a group that must be of a kind."""
        if name in groups:
            return groups[name]
        kind = self._kinds.get(name)
        fault = f"'{name}' is a group of {kind}s, not of {wanted}s" if kind else f"There is no {wanted} group '{name}'"
        raise InputError(f"{fault}. {suggest(name, groups)}")

    def nodes_of(self, name: str) -> IntArray:
        """Sorted node numbers of an element, edge or node group, mid-side nodes included.

        Raises
        ------
        InputError
            There is no group of that name; the message has the nearest one.
        """
        kind = self._kinds.get(name)
        if kind is None:
            raise InputError(f"There is no group '{name}' in the mesh. {suggest(name, self.groups)}")
        if kind == "element":
            return np.unique(self.elements[self.element_groups[name]])
        return np.unique(self.edge_groups[name] if kind == "edge" else self.node_groups[name])

    def node_at(self, point: Sequence[float] | FloatArray) -> int:
        """Number of the node at a position (3,), m, to within 1e-6 of the size of the mesh.

        Of nodes that lie on each other at a cut it is that of the lip towards which the position is off the cut.

        Raises
        ------
        InputError
            There is none, and the message has the nearest node and its distance; or several, which lie on each other at
            a cut, and the position is on it.
        """
        target = np.asarray(point, dtype=np.float64)
        if target.shape != (3,) or not np.isfinite(target).all():
            raise InputError(f"A position has three finite coordinates in m, not {point!r}.")
        distance = np.linalg.norm(self.points - target, axis=1)
        node = int(np.argmin(distance))
        if distance[node] > COINCIDENT * self.size:
            raise InputError(
                f"There is no node at {place(target)}. The nearest is node {node} at "
                f"{place(self.points[node])}, {distance[node]:.3g} m away."
            )
        several = np.flatnonzero(distance <= COINCIDENT * self.size)
        return node if len(several) == 1 else self._on_lip(several, target)

    def _on_lip(self, nodes: IntArray, target: FloatArray) -> int:
        """Of nodes that lie on each other, the one whose elements lie where a position is off them."""
        off = target - self.points[nodes[0]]
        if np.linalg.norm(off) <= 1e-3 * COINCIDENT * self.size:
            raise InputError(
                f"Nodes {listing(nodes)} lie on each other at {place(target)}, on the lips of a cut: say which is "
                f"meant by a position that is off the cut to its side, by less than {COINCIDENT * self.size:.1g} m."
            )
        middle = centres(self.points, self.elements)
        towards = [middle[(self.elements == node).any(axis=1)].mean(axis=0) - self.points[node] for node in nodes]
        return int(nodes[np.argmax(unit(np.array(towards)) @ off)])

    def select_edges(
        self,
        name: str,
        x1: Coordinate = None,
        x2: Coordinate = None,
        x3: Coordinate = None,
        groups: Sequence[str] | None = None,
        within: Within = None,
    ) -> Mesh:
        """The same mesh and one more edge group: the boundary edges that lie there with all their nodes.

        Parameters
        ----------
        name : str
            Of the new group.
        x1, x2, x3 : float, (float, float) or None
            Coordinates, or least and greatest, m, met to within 1e-6 of the size of the mesh; None leaves one free.
        groups : sequence of str, optional
            Edge groups to choose from, in place of the boundary.
        within : shape or sequence of shapes, optional
            See `magshell.mesh.in_sphere`, `in_cylinder`, `in_polygon`; or a function of positions (k, 3), m, that
            says for each whether it lies inside, or how far outside, m.

        Raises
        ------
        InputError
            No such edge is there, nothing is given, a coordinate or group makes no sense, or the name is taken.
        """
        if groups is not None:
            edges = np.unique(np.concatenate([self.edges_of(group) for group in groups]), axis=0)
        else:
            edges = self.boundary_edges
        what = "boundary edge" if groups is None else "edge of these groups"
        chosen = self._there(name, what, self.points[edges], (x1, x2, x3), within, groups is not None)
        return self._with_groups(edge_groups={**self.edge_groups, name: locked(edges[chosen])})

    def select_nodes(
        self,
        name: str,
        x1: Coordinate = None,
        x2: Coordinate = None,
        x3: Coordinate = None,
        groups: Sequence[str] | None = None,
        within: Within = None,
    ) -> Mesh:
        """The same mesh with one more node group: the nodes, inside too, that lie there.

        Parameters and errors are those of `select_edges`; `groups` may be of any kind.
        """
        nodes = np.arange(len(self.points))
        if groups is not None:
            nodes = np.unique(np.concatenate([self.nodes_of(group) for group in groups]))
        what = "node" if groups is None else "node of these groups"
        chosen = self._there(name, what, self.points[nodes, None], (x1, x2, x3), within, groups is not None)
        return self._with_groups(node_groups={**self.node_groups, name: locked(nodes[chosen])})

    def select_elements(
        self,
        name: str,
        x1: Range = None,
        x2: Range = None,
        x3: Range = None,
        groups: Sequence[str] | None = None,
        within: Within = None,
    ) -> Mesh:
        """The same mesh with one more element group: the elements that lie there, of some groups or of all.

        Parameters
        ----------
        name : str
            Of the new group.
        x1, x2, x3 : (float, float) or None
            Least and greatest coordinate, m, met to within 1e-6 of the size of the mesh; None leaves one free.
        groups : sequence of str, optional
            Element groups to choose from; by default the whole mesh.
        within : shape or sequence of shapes, optional
            As in `select_edges`; an element belongs to it if its centre does.

        Raises
        ------
        InputError
            No such group, no element is there, one lies across a bound of a range, nothing is given, or the name is
            taken.
        """
        check_name(name, "element", self._kinds)
        members = np.arange(len(self.elements))
        if groups is not None:
            members = np.unique(np.concatenate([self.elements_of(group) for group in groups]))
        ranges = (x1, x2, x3)
        try:
            if groups is None or within is not None or any(bounds is not None for bounds in ranges):
                members = members[elements_there(self.points, self.elements[members], ranges, within)]
        except InputError as error:
            raise InputError(f"Group '{name}': {error}.") from None
        return self._with_groups(element_groups={**self.element_groups, name: locked(members)})

    def _there(
        self,
        name: str,
        what: str,
        positions: FloatArray,
        wanted: Sequence[Coordinate],
        within: Within,
        of_groups: bool,
    ) -> IntArray:
        """Which of the items with these positions (items, nodes, 3) lie there."""
        check_name(name, what.split()[0], self._kinds)
        if not len(positions):
            raise InputError(f"Group '{name}': the surface is closed, it has no {what}.")
        if of_groups and within is None and not any(value is not None for value in wanted):
            return np.arange(len(positions))
        try:
            return items_there(what, positions, wanted, within, self.points)
        except InputError as error:
            raise InputError(f"Group '{name}': {error}.") from None

    def _with_groups(self, **groups: Mapping[str, IntArray]) -> Mesh:
        """A copy that shares the checked arrays."""
        other = copy.copy(self)
        for kind, names in groups.items():
            object.__setattr__(other, kind, dict(names))
        return other
