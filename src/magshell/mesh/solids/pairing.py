"""Opposite sides of a solid of constant thickness: found by rays through it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.files.normals import BoolArray
from magshell.mesh.geometry import unit
from magshell.mesh.solids.locating import locator_of
from magshell.mesh.solids.skin import Skin

CREASE = np.cos(np.radians(20.0))
"""Triangles whose normals are further apart meet at an edge of the solid."""
VARIES = 0.01
"""Of the thickness, by which it may vary, beside what flat triangles miss of a curved surface."""
CORNER = 0.998
"""Weight of a triangle's corner in a point near it."""
MANY = 20_000
"""Of more triangles only the centres are measured."""
WHOLE = 0.02
"""Of the volume, by which that of the sides times the thickness may differ."""
EDGE = 1e-9
"""Of the size: a ray this close to a triangle meets it."""
OPPOSITE = np.cos(np.radians(45.0))
"""Faces are opposite if their normals are turned against each other by no more."""
THIN = "it is not thin, or as wide as thick somewhere"
SLANTED = np.sin(np.radians(5.0))


class Sides(NamedTuple):
    """A solid as a thickness and its two sides.

    Attributes
    ----------
    thickness, least, greatest : float
    upper, lower : (k,)
        Triangles of the skin: the side that faces up, or outward, and the other.
    coarse : float
        How far the flat triangles of the sides may be off a curved surface; 0 if flat.
    """

    thickness: float
    least: float
    greatest: float
    upper: IntArray
    lower: IntArray
    coarse: float


def sides_of(skin: Skin, patch: IntArray | None, name: str) -> Sides:
    """Pair opposite faces.

    Parameters
    ----------
    skin : Skin
    patch : (m,), optional
        Number of the face of each triangle; without it, faces end at edges of more than 20°.
    name : str
        Of the file, for messages.

    Raises
    ------
    InputError
        The thickness varies, or no two sides can be told from each other; with a place.
    """
    patch = _patches(skin) if patch is None else patch
    at, distance, hit = _through(skin)
    missed = _sagittas(skin)
    count = int(patch.max()) + 1
    measured = np.isfinite(distance)
    owner, area = at.triangle, skin.areas[at.triangle] * measured
    largest = int(np.bincount(patch, skin.areas, count).argmax())
    chosen = measured & (patch[owner] == largest)
    if not chosen.any():
        raise InputError(f"{name}: nothing lies opposite its largest face: {THIN}")
    thickness = _median(distance[chosen], area[chosen])
    same = np.abs(distance - thickness) <= VARIES * thickness + missed[owner] + missed[hit]
    weight = np.bincount(patch[owner], area, count)
    sheets = np.bincount(patch[owner], area * same, count) > 0.5 * weight
    sheets[largest] = True
    bad = np.flatnonzero(sheets[patch[owner]] & measured & ~same)
    bad = bad[~_at_a_fold(skin, patch, sheets, at.points[bad], 1.5 * thickness)]
    if bad.size:
        worst = bad[np.abs(distance[bad] - thickness).argmax()]
        raise InputError(
            f"{name}: its thickness varies: {thickness:.4g} mm at most places, {distance[worst]:.4g} mm at "
            f"({_place(at.points[worst])}) mm. A mid-surface is made of a solid of one thickness: leave fillets, ribs "
            "and bosses out"
        )
    inside = sheets[patch[owner]] & same
    upper, lower = _two_sides(skin, sheets[patch], owner[inside], hit[inside], name)
    thickness = _median(distance[inside], area[inside])
    _must_be_all(skin, sheets[patch], thickness, upper, lower, name)
    used = missed[np.concatenate([upper, lower])]
    return Sides(
        thickness, float(distance[inside].min()), float(distance[inside].max()), upper, lower, float(used.max())
    )


def _at_a_fold(skin: Skin, patch: IntArray, sheets: BoolArray, points: FloatArray, reach: float) -> BoolArray:
    """Which points (k, 3) are near an edge between two faces of a side: there is nothing opposite outside of a bend."""
    beyond, _ = skin.neighbours
    triangle, side = np.nonzero((patch[:, None] != patch[beyond]) & sheets[patch][:, None] & sheets[patch[beyond]])
    near = np.zeros(len(points), dtype=bool)
    for begin, end in zip(skin.corners[triangle, side], skin.corners[triangle, (side + 1) % 3], strict=True):
        share = ((points - begin) @ (end - begin) / ((end - begin) @ (end - begin))).clip(0.0, 1.0)
        near |= np.linalg.norm(points - begin - share[:, None] * (end - begin), axis=1) <= reach
    return near


class _Samples(NamedTuple):
    points: FloatArray
    triangle: IntArray


def _patches(skin: Skin) -> IntArray:
    """Number of the smooth face of each triangle."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    beyond, _ = skin.neighbours
    count = len(skin.triangles)
    one, other = np.repeat(np.arange(count), 3), beyond.ravel()
    smooth = (skin.normals[one] * skin.normals[other]).sum(axis=1) > CREASE
    graph = coo_matrix((np.ones(smooth.sum()), (one[smooth], other[smooth])), shape=2 * (count,))
    patch: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
    return patch


def _through(skin: Skin) -> tuple[_Samples, FloatArray, IntArray]:
    """Points of the skin, the way from each through the solid along its normal, and the triangle met there.

    The way is infinite where that triangle is not opposite, as near an edge.
    """
    centre = np.full((1, 3), 1.0 / 3.0)
    near = np.full((3, 3), 0.5 * (1.0 - CORNER)) + (CORNER - 0.5 * (1.0 - CORNER)) * np.eye(3)
    weights = centre if len(skin.triangles) > MANY else np.concatenate([centre, near])
    points = np.einsum("wc,tcx->twx", weights, skin.corners).reshape(-1, 3)
    triangle = np.repeat(np.arange(len(skin.triangles)), len(weights))
    hit = _first_hits(skin, points, triangle)
    inward = -skin.normals[triangle]
    slope = (inward * skin.normals[hit]).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = ((skin.corners[hit, 0] - points) * skin.normals[hit]).sum(axis=1) / slope
    distance[(hit == triangle) | ~(slope > OPPOSITE)] = np.inf
    return _Samples(points, triangle), distance, hit


def _first_hits(skin: Skin, points: FloatArray, triangle: IntArray) -> IntArray:
    """The triangle that the ray inward from each point meets first; its own where it meets none."""
    from vtkmodules.vtkCommonCore import mutable

    locator = locator_of(skin.points, skin.triangles)
    inward = -skin.normals[triangle]
    begins = points + 1e-6 * skin.size * inward
    ends = points + 2.0 * skin.size * inward
    found = triangle.copy()
    share, place, local, part, cell = mutable(0.0), [0.0] * 3, [0.0] * 3, mutable(0), mutable(0)
    for number, (begin, end) in enumerate(zip(begins.tolist(), ends.tolist(), strict=True)):
        if locator.IntersectWithLine(begin, end, EDGE * skin.size, share, place, local, part, cell):
            found[number] = int(cell)
    return found


def _sagittas(skin: Skin) -> FloatArray:
    """About how far each triangle (m,) is off the smooth surface that it stands for."""
    beyond, _ = skin.neighbours
    cosine = (skin.normals[:, None] * skin.normals[beyond]).sum(axis=2).clip(-1.0, 1.0)
    angle = np.where(cosine > CREASE, np.arccos(cosine), 0.0)
    angle[angle < 1e-6] = 0.0
    side = np.linalg.norm(np.roll(skin.corners, -1, axis=1) - skin.corners, axis=2)
    height = 2.0 * skin.areas[:, None] / side
    off = (0.25 * angle * height).max(axis=1)
    beside = np.where(cosine > CREASE, off[beyond], 0.0).max(axis=1)
    return np.maximum(off, beside)


def _median(values: FloatArray, weights: FloatArray) -> float:
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(total, 0.5 * total[-1])])


def _two_sides(skin: Skin, sheet: BoolArray, owner: IntArray, hit: IntArray, name: str) -> tuple[IntArray, IntArray]:
    """Triangles of the upper and lower side: connected sheets, paired by what lies opposite."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    beyond, _ = skin.neighbours
    count = len(skin.triangles)
    one, other = np.repeat(np.arange(count), 3), beyond.ravel()
    joined = sheet[one] & sheet[other]
    graph = coo_matrix((np.ones(joined.sum()), (one[joined], other[joined])), shape=2 * (count,))
    _, part = connected_components(graph, directed=False)
    pairs = np.unique(np.column_stack([part[owner], part[hit]]), axis=0)
    opposite = dict(pairs.tolist())
    upper: list[int] = []
    for here, there in pairs.tolist():
        if here == there or not sheet[part == there].all() or opposite[here] != there or opposite.get(there) != here:
            where = _place(skin.corners[np.flatnonzero((part == here) & sheet)[0]].mean(axis=0))
            raise InputError(f"{name}: no two opposite sides can be told from each other, as at ({where}) mm: {THIN}")
        if here < there:
            upper.append(here if _is_up(skin, part == here, part == there) else there)
    top = np.isin(part, upper) & sheet
    return np.flatnonzero(top), np.flatnonzero(sheet & ~top)


def _is_up(skin: Skin, one: BoolArray, other: BoolArray) -> bool:
    """Whether one of two sides faces up, or outward."""
    mean = unit(skin.vectors[one].sum(axis=0) - skin.vectors[other].sum(axis=0))
    flat = np.linalg.norm(skin.vectors[one].sum(axis=0)) > 1e-3 * skin.areas[one].sum()
    axis = int(np.flatnonzero(np.abs(mean) > 1e-6)[-1]) if flat else 0
    return bool(mean[axis] > 0.0) if flat else bool(skin.areas[one].sum() > skin.areas[other].sum())


def _must_be_all(skin: Skin, sheet: BoolArray, thickness: float, upper: IntArray, lower: IntArray, name: str) -> None:
    """Refuse a solid that is more than its two sides and an edge across them."""
    volume = 0.5 * thickness * float(skin.areas[upper].sum() + skin.areas[lower].sum())
    if abs(volume - skin.volume) <= WHOLE * skin.volume:
        return
    beyond, _ = skin.neighbours
    one, other = np.repeat(np.arange(len(skin.triangles)), 3), beyond.ravel()
    rim = sheet[one] & ~sheet[other]
    slant = np.where(rim, np.abs((skin.normals[one] * skin.normals[other]).sum(axis=1)), 0.0)
    worst = int(slant.argmax())
    where = (
        f", as its slanted edge at ({_place(skin.corners[other[worst]].mean(axis=0))}) mm"
        if slant[worst] > SLANTED
        else ""
    )
    raise InputError(
        f"{name}: is more than a sheet of thickness {thickness:.4g} mm: its volume is {skin.volume:.4g} mm³, that of "
        f"the sheet {volume:.4g} mm³. Parts of it have no opposite side{where}"
    )


def _place(point: FloatArray) -> str:
    return ", ".join(f"{value:.4g}" for value in point)
