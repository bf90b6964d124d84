"""Rows of the nodal arrays: nodes of the mesh, rigid bodies, jumps, and one more for each further sheet or section.

At a joint several sheets meet, each with a director of its own; at a border the thickness, layers, material or offset
change. There elements have rows of their own. Rows share unknowns with others, and depend on them:

* All rows of a node share u. Those of one piece (`sheets.py`) share the micro-rotation.
* Sections of one sheet share the director; the further ones have a stretch s of it.
* At a joint, where the piece has several sheets, the micro-rotation R carries the directors, d = (1 + s) R D.
* On a rigid body u and R are those of its reference point, u = u_r + (R - I)(X - X_r), d = R D.
* A row of a node that is the image of another (`images.py`) has all its unknowns from there, in a turned frame; from
  one cell to the next u has a jump more, with a row of its own for all nodes of an edge.

The thickness stretch φ is each row's own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, TypeVar

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.model.constraints import FRAME_OF_FIELD, Constraints
from magshell.model.images import NO_IMAGES, Beyond, ImageRows, Images
from magshell.model.reflection import in_mirror_planes
from magshell.model.rigid_body import members_of
from magshell.model.row_checks import check_hinges, check_images, check_micro_rotation
from magshell.model.sheets import Sheets, sheets_of
from magshell.model.shell import Shell
from magshell.model.supports import SymmetryPlane
from magshell.shell.normals import corner_normals
from magshell.shell.ties import FREE, RIGID, STRETCHED, TURNED
from magshell.shell.unknowns import COLUMNS, COMPONENTS

# Thicknesses that differ by less, relative, are the same.
SAME = 1e-9
U, W, PHI, OMEGA, S = (COLUMNS[field] for field in ("u", "w", "phi", "omega", "s"))

Columns = TypeVar("Columns", bound=AnyArray)


class Rows(NamedTuple):
    """Numbering of the rows: the nodes of the mesh, then rigid bodies, jumps, and the further rows of nodes.

    Attributes
    ----------
    nodes, places : int
        Number of mesh nodes, and of mesh nodes, bodies and jumps.
    of : ndarray, shape (rows,)
        Mesh node, body or jump; that of the first rows is their own number.
    elements : ndarray, shape (elements, 8)
        Rows of the elements.
    source : ndarray, shape (rows, 11)
        Row whose unknown this one is.
    carried : ndarray of bool, shape (rows, 11)
        Which unknowns a row has for itself.
    kind : ndarray, shape (rows,)
        What the director is: `FREE`, `STRETCHED`, `TURNED` (by the micro-rotation) or `RIGID`.
    piece, sheet : ndarray, shape (rows,)
        First row of the piece and of the sheet of each.
    body : ndarray, shape (rows,)
        Row of the rigid body that moves this one; -1 for none.
    points, normals : ndarray, shape (rows, 3)
        Undeformed position, m, and unit normal of the sheet; zero for bodies. The point of a jump is the period.
    carriers : mapping of str to (places,) ndarray of bool
        Which places have the fields u, w, phi and omega.
    joined : ndarray, shape (joints,)
        Mesh nodes at which a rotation carries the directors of several sheets.
    hinged : ndarray, shape (n,)
        Mesh nodes at which pieces share u only.
    jumps : ndarray, shape (periodic,)
        Rows of the jumps from cell to cell.
    images : ImageRows
    """

    nodes: int
    places: int
    of: IntArray
    elements: IntArray
    source: IntArray
    carried: AnyArray
    kind: IntArray
    piece: IntArray
    sheet: IntArray
    body: IntArray
    points: FloatArray
    normals: FloatArray
    carriers: Mapping[str, AnyArray]
    joined: IntArray
    hinged: IntArray
    jumps: IntArray
    images: ImageRows

    @property
    def plain(self) -> bool:
        """Whether every row has all its unknowns for itself."""
        return len(self.of) == self.nodes and not self.images.rows.size

    @property
    def bodies(self) -> slice:
        """Rows of the rigid bodies."""
        return slice(self.nodes, self.places - len(self.jumps))

    @property
    def place(self) -> IntArray:
        """Mesh node or body (rows, 11) at which each unknown is."""
        return self.of[self.source]

    def words(self, row: int) -> str:
        """The node or the rigid body of a row in messages."""
        place = int(self.of[row])
        if place < self.nodes:
            return f"node {place}"
        body = place - self.nodes + 1
        return f"rigid body {body}" if place < self.bodies.stop else f"jump {place - self.bodies.stop + 1}"

    def shared(self, nodal: Columns) -> Columns:
        """Nodal columns (rows, 11) whose shared ones are those of their source."""
        if not self.plain:
            nodal[:] = nodal[self.source, np.arange(COMPONENTS)]
        return nodal

    def jumped(self, nodal: FloatArray) -> FloatArray:
        """Nodal columns (rows, 11) whose u beyond a jump is that of its root and the jump."""
        rows, roots, steps = self.images.beyond
        if rows.size:
            nodal[rows, U] = nodal[roots, U] + steps @ nodal[self.jumps, U]
        return nodal

    def folded(self, forces: FloatArray) -> FloatArray:
        """Forces (rows, 11) summed at those that share their unknowns: the transpose of `shared` and `jumped`."""
        if self.plain:
            return forces
        total = np.zeros_like(forces)
        np.add.at(total, (self.source, np.arange(COMPONENTS)), forces)
        rows, roots, steps = self.images.beyond
        if rows.size:
            np.add.at(total[:, U], roots, total[rows, U])
            total[self.jumps, U] += steps.T @ total[rows, U]
            total[rows, U] = 0.0
        return total

    def constraints(self, constraints: Constraints) -> Constraints:
        """Constraints of the places, for every row. A held φ is that of all sections and sheets."""
        if self.plain:
            return constraints
        place, columns = self.place, np.arange(COMPONENTS)
        frame_of = np.stack(
            [constraints.frame_of[place[:, COLUMNS[field].start], n] for field, n in FRAME_OF_FIELD.items()], axis=1
        )
        fixed, values = constraints.fixed[place, columns].copy(), constraints.values[:, place, columns].copy()
        own = place[:, PHI.start]
        clamped = (self.kind == TURNED) & fixed[:, OMEGA].all(axis=1) & constraints.fixed[own, W].all(axis=1)
        fixed[clamped, S] = True
        frames = self.images.turn_frames(frame_of, constraints.frames)
        return constraints._replace(fixed=fixed, values=values, frame_of=frame_of, frames=frames)


class _Table:
    """Rows under construction: the mesh node, piece (as its first row) and sheet (likewise) of each."""

    def __init__(self, places: int) -> None:
        self.of, self.piece, self.sheet = (list(range(places)) for _ in range(3))

    def add(self, node: int) -> int:
        """One more row of a node, a piece and a sheet of its own."""
        row = len(self.of)
        self.of.append(node)
        self.piece.append(row)
        self.sheet.append(row)
        return row


def rows_of(shell: Shell, planes: Sequence[SymmetryPlane] = ()) -> Rows:
    """The rows of a shell; on mirror planes normals lie in the plane.

    Raises
    ------
    InputError
        Sheets meet in a shell without micro-rotation; a hinge or a rigid body does not fit the mesh.
    """
    mesh, nodes, bodies, images = shell.mesh, len(shell.mesh.points), shell.rigid, shell.images
    jumps = nodes + len(bodies) + np.arange(len(shell.periodic))
    places, sheets = nodes + len(bodies) + len(jumps), sheets_of(mesh, shell.hinges, images)
    owner = members_of(mesh, bodies)
    elements, table = _numbered(shell, sheets, places)
    of, piece, sheet = (np.array(one) for one in (table.of, table.piece, table.sheet))
    several = np.zeros(len(of), dtype=bool)
    several[piece[sheet != piece]] = True
    several[:nodes] |= sheets.sprung
    turned = several[piece] | _sprung(sheets, of, nodes)
    body = np.full(len(of), -1)
    inside = of < nodes
    body[inside] = np.where(owner[of[inside]] >= 0, nodes + owner[of[inside]], -1)
    rigid = body >= 0
    check_hinges(shell, owner)
    check_images(shell, owner)
    check_micro_rotation(shell, of, turned | rigid)
    rows = np.arange(len(of))
    source = np.repeat(rows[:, None], COMPONENTS, axis=1)
    source[:, U] = np.where(rigid, body, of)[:, None]
    source[:, OMEGA] = np.where(rigid, body, piece)[:, None]
    source[:, W] = np.where(turned | rigid, rows, sheet)[:, None]
    kind = np.where(rigid, RIGID, np.where(turned, TURNED, np.where(rows != sheet, STRETCHED, FREE)))
    points = np.concatenate(
        [
            mesh.points,
            *(one.reference_point(mesh)[None] for one in bodies),
            *(one.period(mesh)[None] for one in shell.periodic),
        ]
    )[of]
    independent = Rows(
        nodes=nodes,
        places=places,
        of=of,
        elements=elements,
        source=source,
        carried=_carried(shell, elements, of, source, kind, jumps),
        kind=kind,
        piece=piece,
        sheet=sheet,
        body=body,
        points=points,
        normals=_normals(shell, elements, of, sheet, planes),
        carriers=_carriers(shell, kind, places),
        joined=np.unique(of[turned & inside]),
        hinged=np.unique(of[(piece != of) & inside]),
        jumps=jumps,
        images=NO_IMAGES,
    )
    return _with_images(independent, images, mesh.elements) if images.found.size else independent


def _with_images(rows: Rows, images: Images, nodes: IntArray) -> Rows:
    """Rows for nodes that are images, of each row there that elements have; `nodes` (elements, 8) are the elements'."""
    count = len(images.root)
    corners = np.flatnonzero(images.root[nodes] != nodes)
    pairs = np.column_stack([nodes.ravel()[corners], rows.elements.ravel()[corners]])
    pairs, which = np.unique(pairs, axis=0, return_inverse=True)
    first = np.append(True, np.diff(pairs[:, 0]) > 0)
    own = np.where(first, pairs[:, 0], len(rows.of) + np.cumsum(~first) - 1)
    roots, elements = pairs[:, 1], rows.elements.copy()
    elements.ravel()[corners] = own[which.ravel()]
    turns = images.rotation[pairs[:, 0]]
    source = rows.source[roots]
    beyond = images.steps[pairs[:, 0]].any(axis=1)
    source[beyond, U] = pairs[beyond, :1]
    extended: dict[str, AnyArray] = {
        "of": pairs[:, 0],
        "source": source,
        "carried": np.zeros((len(own), COMPONENTS), dtype=bool),
        "kind": rows.kind[roots],
        "piece": _within(own, pairs[:, 0], rows.piece[roots]),
        "sheet": _within(own, pairs[:, 0], rows.sheet[roots]),
        "body": rows.body[roots],
        "points": rows.points[pairs[:, 0]],
        "normals": np.einsum("nij,nj->ni", turns, rows.normals[roots]),
    }
    made: dict[str, Any] = {}
    for name, values in extended.items():
        there = getattr(rows, name)
        made[name] = np.concatenate([there, np.zeros((np.sum(~first), *there.shape[1:]), dtype=there.dtype)])
        made[name][own] = values
    carriers = {field: carries.copy() for field, carries in rows.carriers.items()}
    for carries in carriers.values():
        carries[:count] = carries[images.root]
    jumping = Beyond(own[beyond], rows.source[roots[beyond], U.start], images.steps[pairs[beyond, 0]])
    return rows._replace(elements=elements, carriers=carriers, images=ImageRows(own, roots, turns, jumping), **made)


def _within(own: IntArray, node: IntArray, label: IntArray) -> IntArray:
    """First row of each label at each node."""
    _, first, which = np.unique(np.column_stack([node, label]), axis=0, return_index=True, return_inverse=True)
    return np.asarray(own[first[which.ravel()]])


def _sprung(sheets: Sheets, of: IntArray, nodes: int) -> AnyArray:
    """Rows at hinges with a spring, which acts on the rotations that carry the directors."""
    return np.append(sheets.sprung, False)[np.minimum(of, nodes)]


def _numbered(shell: Shell, sheets: Sheets, places: int) -> tuple[IntArray, _Table]:
    """Rows of the elements, in a table of all rows."""
    rest, count = shell.element.rest_nodes, len(shell.mesh.points)
    elements, table = shell.images.root[shell.mesh.elements], _Table(places)
    kind, measures = _sections(shell)
    section = np.full(elements.shape, -1)
    section[:, :rest] = np.arange(len(elements) * rest).reshape(-1, rest)
    corners = elements.flatten()
    special = np.zeros(count, dtype=bool)
    special[sheets.nodes] = True
    special[_differing(elements[:, :rest].ravel(), kind, measures, count)] = True
    order = np.flatnonzero(special[corners])
    order = order[np.argsort(corners[order], kind="stable")]
    for group in np.split(order, np.flatnonzero(np.diff(corners[order])) + 1) if order.size else ():
        node = int(corners[group[0]])
        heads: list[tuple[int, int, int, int]] = []
        for at in group.tolist():
            owner, slot = divmod(at, 8)
            piece, sheet, here = sheets.piece[owner, slot], sheets.sheet[owner, slot], section[owner, slot]
            alike = [head for head in heads if head[:2] == (piece, sheet)]
            row = next((row for *_, head, row in alike if here < 0 or _same(kind, measures, here, head)), None)
            if row is None:
                row = table.add(node) if heads else node
                table.piece[row] = next((head[3] for head in heads if head[0] == piece), row)
                table.sheet[row] = alike[0][3] if alike else row
                heads.append((piece, sheet, here, row))
            elements[owner, slot] = row
    return elements, table


class _Section(NamedTuple):
    layered: bool
    laws: tuple[type, ...]
    parameters: tuple[tuple[float, ...], ...]


def _sections(shell: Shell) -> tuple[IntArray, FloatArray]:
    """Part of each corner (corners,), the thickness of its layers and the offset (corners, most layers + 1)."""
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


def _differing(corners: IntArray, kind: IntArray, measures: FloatArray, count: int) -> IntArray:
    """Nodes at which corners of different sections meet."""
    first = np.empty(count, dtype=np.int64)
    first[corners[::-1]] = np.arange(corners.size)[::-1]
    return np.asarray(corners[~_same(kind, measures, np.arange(corners.size), first[corners])])


def _same(kind: IntArray, measures: FloatArray, one: Any, other: Any) -> Any:
    """Whether corners are of one section."""
    scale = np.abs(measures[other]).max(axis=-1)
    near = np.abs(measures[one] - measures[other]).max(axis=-1) <= SAME * scale
    return (kind[one] == kind[other]) & near


def _carried(
    shell: Shell, elements: IntArray, of: IntArray, source: IntArray, kind: IntArray, jumps: IntArray
) -> AnyArray:
    nodes, images = len(shell.mesh.points), shell.images
    at_node = of < nodes
    carried = np.zeros((len(of), COMPONENTS), dtype=bool)
    for field, carries in shell.carriers.items():
        carried[at_node, COLUMNS[field]] = carries[of[at_node], None]
    carried[images.found] = False
    carried[~at_node, U] = carried[~at_node, OMEGA] = True
    carried[jumps, OMEGA] = False
    carried[:, S] = ((kind == STRETCHED) | (kind == TURNED))[:, None] & carried[:, W].any(axis=1, keepdims=True)
    carried[kind >= TURNED, W] = False
    carried &= source == np.arange(len(of))[:, None]
    if carried[:, PHI].any():
        plain = np.concatenate([part.elements for part in shell.parts if not part.layered] or [np.empty(0, dtype=int)])
        soft = plain[~np.all(kind[elements[plain]] == RIGID, axis=1)]
        carried[:, PHI] = False
        carried[elements[soft, : shell.element.stretch_nodes], PHI] = True
    return carried


def _carriers(shell: Shell, kind: IntArray, places: int) -> dict[str, AnyArray]:
    """Fields of the places: at joints and on rigid bodies the directors follow the micro-rotation."""
    bodies, jumps = len(shell.rigid), len(shell.periodic)
    own = {"u": (True, True), "w": (False, False), "phi": (False, False), "omega": (True, False)}
    carriers = {
        field: np.append(carries, np.repeat(own[field], (bodies, jumps))) for field, carries in shell.carriers.items()
    }
    carriers["w"] &= kind[:places] < TURNED
    return carriers


def _normals(
    shell: Shell, elements: IntArray, of: IntArray, sheet: IntArray, planes: Sequence[SymmetryPlane]
) -> FloatArray:
    """Unit normals (rows, 3), averaged over the elements of a sheet."""
    total, mesh, images = np.zeros((len(of), 3)), shell.mesh, shell.images
    each = images.back(corner_normals(mesh.points, mesh.elements), mesh.elements)
    np.add.at(total, sheet[elements].ravel(), each.reshape(-1, 3))
    for node, axis in zip(images.on_axis, images.axes, strict=True):
        at = of == node
        total[at] = (total[at] @ axis)[:, None] * axis
    length = np.linalg.norm(total, axis=1, keepdims=True)
    normals = np.divide(total, length, out=np.zeros_like(total), where=length > 0.0)[sheet]
    return in_mirror_planes(normals, [(np.isin(of, shell.nodes_of(p.group)), p.unit_normal) for p in planes])
