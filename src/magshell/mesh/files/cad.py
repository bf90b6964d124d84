"""Geometry meshed by gmsh: second-order quadrilaterals where it can, triangles where it cannot."""

from __future__ import annotations

import math
import os
import pathlib
import tempfile
from typing import Any, NamedTuple

import numpy as np

from magshell.errors import InputError, MeshError
from magshell.mesh.files.apart import apart
from magshell.mesh.files.assembling import FileMesh, assemble
from magshell.mesh.files.contents import GROUPED
from magshell.mesh.files.cutting import with_bad_ones_cut
from magshell.mesh.files.from_gmsh import contents_of
from magshell.mesh.files.paths import GEOMETRY, readable, textual
from magshell.mesh.files.scripts import SCRIPTS, put_alone
from magshell.mesh.files.session import required, session
from magshell.mesh.files.units import agreed, length_unit
from magshell.mesh.geometry import diagonal_normals
from magshell.mesh.quality import worst

KNOWS_ITS_UNIT = (".step", ".stp", ".iges", ".igs")
"""Formats that say the unit of their lengths: gmsh turns them into millimetres."""
CONVERTED = "mm"
IGES = (".iges", ".igs")
"""Formats in which a closed surface, as a tube, has its seam twice: the nodes there are joined."""
DEFAULT_ELEMENTS = 800
"""Approximate number of elements if no size is given."""
MOST_ELEMENTS = 1_000_000
GOOD = 0.3
"""Worst scaled Jacobian with which the first mesh is taken; quadrilaterals with a worse one are cut."""
NO_SIZE = 1e21
"""Mesh.MeshSizeMax where no file has set it is larger than this."""

JOINING = (
    "Surfaces that belong together must share the nodes of their common edge: join them before meshing (Coherence, or "
    "BooleanFragments)."
)
UNJOINED = ("not joined", "do not match")


class Attempt(NamedTuple):
    """A way to mesh, by gmsh's numbers: Mesh.Algorithm, Mesh.RecombinationAlgorithm, whether to recombine at all."""

    algorithm: int
    recombination: int
    recombine: bool = True


QUASI_STRUCTURED = Attempt(11, 0)
ATTEMPTS = (
    Attempt(6, 3),  # frontal Delaunay, blossom to quadrilaterals only: fast, sizes as asked; not for periodic surfaces
    QUASI_STRUCTURED,  # the best corners on coarse meshes and tubes; slow and less sure on fine ones
    Attempt(6, 1),  # frontal Delaunay, blossom: keeps a transfinite surface as it is; triangles may remain
    Attempt(5, 1),  # Delaunay, blossom
    Attempt(6, 0, recombine=False),  # triangles: always possible
)
MANY = 5000
"""With more elements than this the quasi-structured attempt is the last before triangles: it takes minutes."""
STRUCTURED = 2
"""The attempt that begins where the file says itself how its surfaces are to be divided."""


class Candidate(NamedTuple):
    """A mesh and how good it is."""

    mesh: FileMesh
    triangles: int
    worst: float
    """Least scaled Jacobian."""

    @property
    def rank(self) -> tuple[float, float, float]:
        return min(self.worst, GOOD), -self.triangles / len(self.mesh.elements), self.worst

    @property
    def good(self) -> bool:
        return not self.triangles and self.worst >= GOOD


def from_cad(
    file: str | os.PathLike[str],
    size: float | None = None,
    unit: str | None = None,
    trust_script: bool = False,
    closed: bool = False,
) -> FileMesh:
    """Mesh a geometry with gmsh (the extra `magshell[gmsh]`).

    Several of gmsh's algorithms are tried until one gives quadrilaterals only, without a bad corner; else the best is
    taken, in which bad quadrilaterals are cut into triangles. The nodes, mid-sides too, lie on the surfaces and curves
    of the geometry.

    Parameters
    ----------
    file : path
        `.geo`, `.step`, `.stp`, `.iges`, `.igs` or `.brep`. Its physical groups become groups; if it has none, every
        surface and curve becomes one, by its own name or as surface-1, curve-1 and so on.
    size : float, optional
        Length of an element's side, m; without it that of the `.geo` file, or such that there are about 800 elements.
    unit : str, optional
        Of the lengths in a `.geo` or `.brep` file; STEP and IGES files say it themselves.
    trust_script : bool
        Whether a `.geo` file may do all that gmsh's scripts can do: run programs, write and read files. Otherwise only
        statements that draw a geometry and say how it is to be meshed are let through, others refused.
    closed : bool
        Whether closed surfaces with sharp edges or parallel faces are meant as shells, as for `read`.

    Returns
    -------
    FileMesh

    Raises
    ------
    InputError
        gmsh is not there; no such file; a unit that is missing or superfluous; a geometry with a volume or without a
        surface; a script that does more than draw; gmsh's own errors.
    """
    path, name = pathlib.Path(file), pathlib.Path(file).name
    suffix = path.suffix.lower()
    if suffix not in GEOMETRY:
        raise InputError(f"{name}: is not a geometry that gmsh meshes; these are: {', '.join(GEOMETRY)}")
    readable(path)
    textual(path)
    if size is not None and not (math.isfinite(size) and size > 0.0):
        raise InputError(f"size = {size!r} is not allowed; it must be a positive length, in m")
    if suffix in KNOWS_ITS_UNIT and unit is not None:
        raise InputError(f"unit: {name} says itself in which unit its lengths are; leave the unit out")
    own = CONVERTED if suffix in KNOWS_ITS_UNIT else agreed(unit, None, name)
    required(name)
    in_unit = None if size is None else size / length_unit(own)
    with tempfile.TemporaryDirectory() as folder:
        opened = path if trust_script else put_alone(path, pathlib.Path(folder))
        return apart(_mesh, opened, name, in_unit, own, closed, program="gmsh", name=name)


def _mesh(path: pathlib.Path, name: str, size: float | None, unit: str, closed: bool) -> FileMesh:
    """What `from_cad` returns; the size in the file's unit."""
    suffix = path.suffix.lower()
    with session(name) as gmsh:
        open_geometry(gmsh, path, name)
        expected = set_size(gmsh, size, unit, suffix)
        structured = suffix in SCRIPTS and "Transfinite" in path.read_text("utf-8", "replace")
        attempts = ATTEMPTS[STRUCTURED:] if structured else ATTEMPTS
        if expected > MANY:
            attempts = tuple(sorted(attempts, key=lambda each: (not each.recombine, each == QUASI_STRUCTURED)))
        return best(gmsh, name, unit, closed, attempts)


def open_geometry(gmsh: Any, path: pathlib.Path, name: str) -> None:
    """Load the geometry; refuse volumes; name surfaces and curves if nothing has a name."""
    gmsh.open(str(path))
    gmsh.model.occ.synchronize()
    if gmsh.model.getEntities(3):
        raise InputError(
            f"{name}: holds {len(gmsh.model.getEntities(3))} solid(s). A shell is the mesh of a mid-surface, and its "
            "thickness is a number in the problem file: export the mid-surface (a sheet or surface body); of a sheet "
            "of one thickness, mid_surface = true (magshell mesh: --mid-surface) finds it"
        )
    if not gmsh.model.getEntities(2):
        raise InputError(f"{name}: has no surface that could be meshed")
    if path.suffix.lower() not in SCRIPTS:
        # Sheets that touch get common curves; of a .geo file this is its own affair (Coherence).
        gmsh.model.occ.removeAllDuplicates()
        gmsh.model.occ.synchronize()
    if not gmsh.model.getPhysicalGroups(2) and not gmsh.model.getPhysicalGroups(1):
        for dimension in (2, 1):
            for _, entity in gmsh.model.getEntities(dimension):
                name_entity(gmsh, dimension, entity)


def name_entity(gmsh: Any, dimension: int, entity: int) -> None:
    """A group by the entity's number, and one by the name that the CAD program gave it."""
    label = gmsh.model.getEntityName(dimension, entity).rpartition("/")[2]
    own = [] if label in ("", "FACE") or label.startswith("Open CASCADE") else [label]
    for name in (f"{GROUPED[dimension]}-{entity}", *own):
        tag = gmsh.model.addPhysicalGroup(dimension, [entity])
        gmsh.model.setPhysicalName(dimension, tag, name)


def set_size(gmsh: Any, size: float | None, unit: str, suffix: str) -> float:
    """The size of elements in the file's unit: as asked, else as the file says, else from the area.

    Returns
    -------
    float
        About how many elements that makes; 0 if the file says the size.

    Raises
    ------
    InputError
        So small that nobody could solve on the mesh.
    """
    if size is None and suffix in SCRIPTS and _says_sizes(gmsh):
        return 0.0
    area = _area(gmsh)
    if size is None:
        size = float(f"{math.sqrt(area / DEFAULT_ELEMENTS):.2g}")
    return use_size(gmsh, size, area, unit)


def use_size(gmsh: Any, size: float, area: float, unit: str) -> float:
    """Make elements of one size, in the file's unit, on an area; about how many elements that makes.

    Raises
    ------
    InputError
        So small that nobody could solve on the mesh.
    """
    if area > MOST_ELEMENTS * size**2:
        least = math.sqrt(area / MOST_ELEMENTS)
        raise InputError(
            f"size: {size:.3g} {unit} makes {area / size**2:.2g} elements; at most {MOST_ELEMENTS:.0e} can be solved: "
            f"give at least {1.05 * least:.2g} {unit}"
        )
    option = gmsh.option.setNumber
    for fixed in ("MeshSizeFromPoints", "MeshSizeFromCurvature", "MeshSizeExtendFromBoundary"):
        option(f"Mesh.{fixed}", 0)
    option("Mesh.MeshSizeFactor", 1)
    option("Mesh.MeshSizeMin", size)
    option("Mesh.MeshSizeMax", size)
    return area / size**2


def _says_sizes(gmsh: Any) -> bool:
    """Whether a script says how large its elements are to be."""
    options = gmsh.option.getNumber("Mesh.MeshSizeMax") < NO_SIZE or gmsh.option.getNumber("Mesh.MeshSizeFromCurvature")
    points = gmsh.model.getEntities(0)
    return bool(options or len(gmsh.model.mesh.field.list()) or np.any(gmsh.model.mesh.getSizes(points)))


def _area(gmsh: Any) -> float:
    """Of all surfaces, measured on a coarse mesh of triangles."""
    gmsh.option.setNumber("Mesh.RecombineAll", 0)
    gmsh.model.mesh.generate(2)
    contents = contents_of(gmsh, "the geometry")
    corners = np.concatenate([block.kind.rows(block.nodes) for block in contents.blocks if block.kind.dimension == 2])
    gmsh.model.mesh.clear()
    return float(np.linalg.norm(diagonal_normals(contents.points[corners[:, :4]]), axis=1).sum())


def best(gmsh: Any, name: str, unit: str, closed: bool, attempts: tuple[Attempt, ...]) -> FileMesh:
    """The first good mesh, else the best one; of triangles only if there is no other."""
    best: Candidate | None = None
    reason = f"{name}: gmsh makes no elements of it"
    for attempt in attempts:
        if best is not None and (best.good or (best.worst >= GOOD and not attempt.recombine)):
            break
        try:
            candidate = meshed(gmsh, name, unit, attempt, closed)
        except InputError as error:
            reason = str(error)
        except Exception as error:  # gmsh raises Exception itself
            reason = f"{name}: gmsh cannot mesh it: {' '.join(str(error).split())}"
        else:
            best = candidate if best is None or candidate.rank > best.rank else best
    if best is None:
        raise InputError(reason)
    return best.mesh


def meshed(gmsh: Any, name: str, unit: str, attempt: Attempt, closed: bool = False) -> Candidate:
    """A mesh of second order made in one way."""
    option = gmsh.option.setNumber
    gmsh.model.mesh.clear()
    option("Mesh.Algorithm", attempt.algorithm)
    option("Mesh.RecombinationAlgorithm", attempt.recombination)
    option("Mesh.RecombineAll", 1 if attempt.recombine else 0)
    option("Mesh.ElementOrder", 1)
    option("Mesh.SecondOrderIncomplete", 1)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)
    if name.lower().endswith(IGES):
        gmsh.model.mesh.removeDuplicateNodes()
    _put_on_surfaces(gmsh)
    try:
        mesh = with_bad_ones_cut(assemble(contents_of(gmsh, name), name, unit, False, closed), GOOD)
    except MeshError as error:
        advice = f" {JOINING}" if any(phrase in str(error) for phrase in UNJOINED) else ""
        raise MeshError(f"{error}{advice}") from None
    triangles = int(mesh.triangles.sum())
    return Candidate(mesh, triangles, worst(mesh)["scaled_jacobian"].value)


def _put_on_surfaces(gmsh: Any) -> None:
    """Move the nodes inside curved surfaces onto them: quasi-structured meshes come 1e-3 of the radius near."""
    for dimension, surface in gmsh.model.getEntities(2):
        if gmsh.model.getType(dimension, surface) in ("Plane", "Discrete surface"):
            continue
        tags, positions, _ = gmsh.model.mesh.getNodes(dimension, surface)
        if not len(tags):
            continue
        closest, _ = gmsh.model.getClosestPoint(dimension, surface, positions)
        for tag, position in zip(tags, np.reshape(closest, (-1, 3)), strict=True):
            gmsh.model.mesh.setNode(tag, position, [])
