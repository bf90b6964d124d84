"""How the faces of sheets meet at kinks and joints.

Where two sheets meet at a kink their faces are mitred: both go through the line in which the faces, laid on as planes,
cut each other; at a corner of several sheets, through the point nearest to all of the planes. With the unit normals n_i
and the heights a_i of the faces it is the least-squares solution of n_i · p = a_i,

    p = Σ_ij n_i W_ij a_j,      W = (n_i · n_j)⁺.

One rotation carries all sheets at a joint, so W is that of the undeformed normals. Where three or more elements meet at
an edge, where a fold is so sharp that the mitre would reach too far, where sections change at the kink, and at hinges
each sheet ends by itself: the bodies of the sheets then overlap at the joint. (Three elements of one sheet on an edge,
as of a fin at less than 30°, end by themselves each.)
"""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.mesh import Mesh
from magshell.mesh.edges import SIDES, Edges, find_edges
from magshell.mesh.junctions import junctions_of
from magshell.model.hinge import Hinge
from magshell.model.rows import Rows, rows_of
from magshell.model.shell import Shell
from magshell.output.tessellation import own_nodes

LONGEST = 2.0
"""Distance of a mitred face from the node, in heights: folds of up to 120° are mitred."""
LOOSE = 0.25
"""Distance between a mitred point and the planes of the faces, in heights, beyond which they do not meet."""
SINGULAR = 1e-2
"""Eigenvalues of n_i · n_j that are smaller, relative to the largest, are zero."""


class Terms(NamedTuple):
    """Sums that give the mitred faces; places are numbered 8 e + n for node n of element e.

    Attributes
    ----------
    at : ndarray, shape (n,)
        Place, rising.
    direction, height : ndarray, shape (n,)
        Places whose normal, and whose height times the weight, are summed.
    swapped : ndarray of bool, shape (n,)
        Whether the upper face at `at` goes with the lower one at `height`.
    weights : ndarray, shape (n,)
    """

    at: IntArray
    direction: IntArray
    height: IntArray
    swapped: AnyArray
    weights: FloatArray


class Mitres(NamedTuple):
    """Terms for points of the faces, for callers that sum them themselves.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        The point, and the rows that director and height belong to.
    numbers : ndarray, shape (n, 2)
        Height over the mesh, m, and weight.
    """

    nodes: IntArray
    numbers: FloatArray

    def after(self, count: int) -> Mitres:
        """The same for points whose numbers come after so many others."""
        nodes = self.nodes.copy()
        nodes[:, 0] += count
        return self._replace(nodes=nodes)


class Joints(NamedTuple):
    """How the faces of the elements of a shell meet.

    Attributes
    ----------
    poles : ndarray, shape (elements, 8)
        Elements that share a pole at a node share their faces there.
    sheets : ndarray, shape (elements, 8)
        Sheet at each node of each element.
    mitred, upside : ndarray of bool, shape (elements, 8)
        Where faces are mitred, and where the upper face of the element is the pole's lower one.
    terms : Terms
    outline : ndarray, shape (k, 3)
        What `outline_of` finds.
    """

    poles: IntArray
    sheets: IntArray
    mitred: AnyArray
    upside: AnyArray
    terms: Terms
    outline: IntArray

    def faces(self, middle: FloatArray, director: FloatArray, heights: FloatArray) -> FloatArray:
        """Positions (2, elements, 8, 3) of the lower and the upper face, m.

        Parameters
        ----------
        middle, director : ndarray, shape (elements, 8, 3)
            Nodes, m, and directors.
        heights : ndarray, shape (2, elements, 8)
            Of both faces, in directors.
        """
        found = middle + heights[..., None] * director
        if self.terms.at.size:
            at, direction, height, swapped, weights = self.terms
            length = np.linalg.norm(director, axis=2)
            normals = (director / length[..., None]).reshape(-1, 3)
            lower, upper = (heights * length).reshape(2, -1)[:, height]
            for face, a in enumerate((np.where(swapped, upper, lower), np.where(swapped, lower, upper))):
                rise = np.zeros_like(normals)
                np.add.at(rise, at, (weights * a)[:, None] * normals[direction])
                found[face][self.mitred] = (middle + rise.reshape(middle.shape))[self.mitred]
        return found

    def mitres(self, rows: IntArray, heights: FloatArray, places: IntArray, upper: AnyArray | bool) -> Mitres:
        """The terms of points on the upper or the lower face, numbered in the order of their places.

        Parameters
        ----------
        rows : ndarray, shape (elements, 8)
            Numbers of the rows that the nodes of the elements have.
        heights : ndarray, shape (elements, 8, 2)
            Of the bottom and the top face over the mesh, m.
        places : ndarray, shape (k,)
        upper : ndarray of bool, shape (k,), or bool
        """
        first, last = (np.searchsorted(self.terms.at, places, side) for side in ("left", "right"))
        point = np.repeat(np.arange(len(places)), last - first)
        term = np.arange(len(point)) - np.repeat(np.cumsum(last - first) - last, last - first)
        direction, height = self.terms.direction[term], self.terms.height[term]
        face = np.broadcast_to(upper, places.shape)[point] ^ self.terms.swapped[term]
        return Mitres(
            np.stack([point, rows.ravel()[direction], rows.ravel()[height]], axis=1),
            np.stack([heights.reshape(-1, 2)[height, face.astype(int)], self.terms.weights[term]], axis=1),
        )


class Sides(NamedTuple):
    """Sides of the elements that are edges.

    Attributes
    ----------
    numbers : ndarray, shape (n,)
        4 e + s for side s of element e.
    partners : ndarray, shape (n,)
        Place in `numbers` of the side of the one neighbour with the same poles; -1 where there is none.
    against : ndarray of bool, shape (n,)
        Whether the neighbour is upside down: both walk the edge in the same sense.
    """

    numbers: IntArray
    partners: IntArray
    against: AnyArray


def sides_of(poles: IntArray) -> Sides:
    """All sides of elements with these poles (elements, 8), each with its neighbour."""
    ends = poles[:, SIDES].reshape(-1, 3)
    numbers, edge, count = _edges_of(poles)
    ends = ends[numbers]
    order = np.argsort(edge, kind="stable")
    pairs = order[count[edge[order]] == 2].reshape(-1, 2)
    partners = np.full(len(numbers), -1)
    partners[pairs[:, 0]], partners[pairs[:, 1]] = pairs[:, 1], pairs[:, 0]
    return Sides(numbers, partners, (partners >= 0) & (ends[:, 0] == ends[partners, 0]))


def _edges_of(poles: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Numbers of the sides that are some, the edge of each, and the number of sides on each edge."""
    ends = poles[:, SIDES].reshape(-1, 3)
    numbers = np.flatnonzero(ends[:, 0] != ends[:, 1])
    keys = np.column_stack([np.sort(ends[numbers, :2], axis=1), ends[numbers, 2]])
    _, edge, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    return numbers, edge.ravel(), count


def outline_of(mesh: Mesh, hinges: Sequence[Hinge] = ()) -> IntArray:
    """Edges (k, 3) that pictures draw thick: free ones, kinks, joints of three or more elements, and hinges."""
    lines = junctions_of(mesh)
    edges = [line.edges for line in (*lines.kinks, *lines.joints)]
    return np.concatenate([mesh.boundary_edges, *edges, *(mesh.edge_groups[hinge.group] for hinge in hinges)])


_kept: weakref.WeakKeyDictionary[Shell, Joints] = weakref.WeakKeyDictionary()


def joints_of(shell: Shell) -> Joints:
    """The joints of a shell, found once."""
    if shell not in _kept:
        _kept[shell] = _found(shell)
    return _kept[shell]


def _found(shell: Shell) -> Joints:
    rows = rows_of(shell)
    sheets, pieces = rows.sheet[rows.elements], rows.piece[rows.elements]
    poles, mitred, upside = sheets.copy(), np.zeros(sheets.shape, dtype=bool), np.zeros(sheets.shape, dtype=bool)
    edges, terms = find_edges(shell.mesh.elements), []
    jointed = np.unique(pieces[sheets != pieces])
    places = np.flatnonzero(np.isin(pieces, jointed))
    places = places[np.argsort(pieces.ravel()[places], kind="stable")]
    starts = np.flatnonzero(np.diff(pieces.ravel()[places], prepend=-1))
    for start, end in pairwise([*starts, len(places)]):
        group = places[start:end]
        turned = _upside(group, edges)
        made = None if turned is None else _mitre(group, turned, sheets.ravel()[group], rows)
        if made is not None:
            poles.ravel()[group], mitred.ravel()[group], upside.ravel()[group] = pieces.ravel()[group[0]], True, turned
            terms.append(made)
    numbers, edge, count = _edges_of(poles)
    owner, side = np.divmod(numbers[count[edge] > 2], 4)
    crowded = owner[:, None], SIDES[side]
    poles[crowded] = poles.max() + 1 + own_nodes(shell.mesh.elements)[crowded]
    empty = np.empty(0, dtype=np.int64)
    terms.append(Terms(empty, empty, empty, empty > 0, np.empty(0)))
    whole = [np.concatenate(each) for each in zip(*terms, strict=True)]
    order = np.argsort(whole[0], kind="stable")
    return Joints(
        poles, sheets, mitred, upside, Terms(*(each[order] for each in whole)), outline_of(shell.mesh, shell.hinges)
    )


def _upside(group: IntArray, edges: Edges) -> AnyArray | None:
    """Which of the places about a node are upside down against the first; None where they are no surface there."""
    owner, slot = np.divmod(group, 8)
    touching = (SIDES[None] == slot[:, None, None]).any(axis=2)
    at, side = np.nonzero(touching)
    number = 4 * owner[at] + side
    real = edges.sides[number, 0] != edges.sides[number, 1]
    at, number = at[real], number[real]
    about: dict[int, list[tuple[int, int]]] = {}
    for place, one in zip(at.tolist(), number.tolist(), strict=True):
        about.setdefault(int(edges.edge_of_side[one]), []).append((place, one))
    linked: list[list[tuple[int, bool]]] = [[] for _ in group]
    for members in about.values():
        if len({one for _, one in members}) > 2:
            return None
        for place, one in members:
            for other, two in members:
                linked[place].append((other, one != two and edges.sides[one, 0] == edges.sides[two, 0]))
    for number_of in range(len(group)):
        linked[number_of] += [(other, False) for other in np.flatnonzero(owner == owner[number_of]).tolist()]
    turned: dict[int, bool] = {0: False}
    reached = [0]
    for place in reached:
        for other, flips in linked[place]:
            if other not in turned:
                turned[other] = turned[place] ^ flips
                reached.append(other)
            elif turned[other] != turned[place] ^ flips:
                return None
    return np.array([turned[place] for place in range(len(group))]) if len(turned) == len(group) else None


def _mitre(group: IntArray, turned: AnyArray, sheets: IntArray, rows: Rows) -> Terms | None:
    """The terms at the places of a node; None where the faces of the sheets do not meet."""
    row_of = rows.elements.ravel()[group]
    found, first = np.unique(row_of, return_index=True)
    if len(found) > len(np.unique(sheets)):
        return None
    normals, sign = rows.normals[found], np.where(turned[first], -1.0, 1.0)
    weights: FloatArray = np.linalg.pinv(normals @ normals.T, rcond=SINGULAR, hermitian=True).astype(np.float64)
    point = normals.T @ weights @ sign
    if np.linalg.norm(point) > LONGEST or np.abs(normals @ point - sign).max() > LOOSE:
        return None
    at, i, j = (axis.ravel() for axis in np.meshgrid(np.arange(len(group)), first, first, indexing="ij"))
    return Terms(group[at], group[i], group[j], turned[at] != turned[j], np.tile(weights.ravel(), len(group)))
