"""Meshes put together from four-sided blocks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any, NamedTuple

import numpy as np

from magshell.arrays import FloatArray
from magshell.errors import InputError, MeshError, suggest
from magshell.mesh.arguments import divisions
from magshell.mesh.geometry import COINCIDENT, FLAT_CORNER, unit
from magshell.mesh.grid import grid
from magshell.mesh.mesh import Mesh
from magshell.mesh.welding import weld
from magshell.mesh.wording import place


class _Block(NamedTuple):
    name: str
    corners: FloatArray
    divisions: tuple[int, int]


def blocks(corners: Mapping[str, Any], elements: Mapping[str, Sequence[int]] | Sequence[int]) -> Mesh:
    """Quadrilateral blocks with straight sides, joined along the sides that they share, any number of them along one.

    Parameters
    ----------
    corners : mapping of name to (4, 2) or (4, 3)
        Corners of each block, m, counter-clockwise seen against the normal; with two coordinates the block
        lies in the plane X3 = 0 and its normal is +X3.
    elements : (int, int) or mapping of name to (int, int)
        Number of elements along the side from corner 1 to 2 and along the side from corner 2 to 3: of all
        blocks, or of each.

    Returns
    -------
    Mesh
        With one element group for each block. Name edges with `Mesh.select_edges`.

    Raises
    ------
    InputError
        A block without a number of elements, or numbers for a block that does not exist.
    MeshError
        A block that is not convex, or runs clockwise in the plane; two blocks that overlap, that share a side with
        different numbers of elements, or of which one has a corner within a side of the other. The message
        names the blocks.
    """
    if not isinstance(corners, Mapping) or not corners:
        raise InputError(f"blocks: corners = {corners!r} is not allowed; it must map names to four corners each.")
    every = _read(corners, elements)
    stacked = np.concatenate([block.corners for block in every])
    tolerance = COINCIDENT * float(np.linalg.norm(np.ptp(stacked, axis=0)))
    for block in every:
        _check_block(block, np.shape(corners[block.name])[1] == 2)
    for one, other in combinations(every, 2):
        if _overlap(one.corners, other.corners, tolerance):
            raise MeshError(f"Blocks '{one.name}' and '{other.name}' overlap: they may share sides only.")
    _check_sides(every, tolerance)
    _check_corners(every, tolerance)
    points, rows, groups = [], [], {}
    nodes = count = 0
    for block in every:
        pattern = grid(*block.divisions)
        s, t = pattern.parameters.T
        weights = np.stack([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t], axis=1)
        points.append(weights @ block.corners)
        rows.append(pattern.elements + nodes)
        groups[block.name] = count + np.arange(len(pattern.elements))
        nodes, count = nodes + len(pattern.parameters), count + len(pattern.elements)
    return Mesh(*weld(np.concatenate(points), np.concatenate(rows), tolerance), element_groups=groups)


def _read(corners: Mapping[str, Any], elements: Mapping[str, Sequence[int]] | Sequence[int]) -> list[_Block]:
    numbers: Mapping[str, Sequence[int]]
    numbers = elements if isinstance(elements, Mapping) else dict.fromkeys(corners, elements)
    for name in numbers:
        if name not in corners:
            raise InputError(f"blocks: elements are given for '{name}', which is not a block. {suggest(name, corners)}")
    every = []
    for name, given in corners.items():
        if name not in numbers:
            raise InputError(f"blocks: no number of elements is given for block '{name}'. {suggest(name, numbers)}")
        try:
            array = np.array(given, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.zeros(0)
        if array.shape not in ((4, 2), (4, 3)) or not np.isfinite(array).all():
            raise InputError(
                f"blocks: the corners of block '{name}' must be four positions of two or three finite "
                f"coordinates in m, not {given!r}."
            )
        array = np.pad(array, ((0, 0), (0, 3 - array.shape[1])))
        every.append(_Block(name, array, divisions("blocks", numbers[name], f"elements of block '{name}'")))
    return every


def _check_block(block: _Block, flat: bool) -> None:
    x = block.corners
    normal = np.cross(x[2] - x[0], x[3] - x[1])
    angle = np.cross(unit(np.roll(x, -1, axis=0) - x), unit(np.roll(x, 1, axis=0) - x)) @ unit(normal)
    corner = int(np.argmin(angle))
    if angle[corner] <= FLAT_CORNER:
        raise MeshError(
            f"Block '{block.name}' is not convex: the angle inside corner {corner + 1} at "
            f"{place(x[corner])} must be less than 180 degrees, and the corners in the order of a walk "
            "around the block."
        )
    if flat and normal[2] < 0:
        raise MeshError(
            f"Block '{block.name}' runs clockwise: give its corners counter-clockwise, so that its normal "
            "is +X3, as in the order 1, 4, 3, 2 of the given ones."
        )


def _check_sides(every: list[_Block], tolerance: float) -> None:
    """Refuse sides that blocks divide differently."""
    corners = np.concatenate([block.corners for block in every])
    _, numbers = weld(corners, np.arange(len(corners)).reshape(-1, 4), tolerance)
    sharing: dict[frozenset[int], list[tuple[_Block, int]]] = {}
    for block, row in zip(every, numbers.tolist(), strict=True):
        for side in range(4):
            sharing.setdefault(frozenset((row[side], row[(side + 1) % 4])), []).append((block, side))
    for found in sharing.values():
        one, i = found[0]
        for other, j in found[1:]:
            if one.divisions[i % 2] != other.divisions[j % 2]:
                start, end = one.corners[i], one.corners[(i + 1) % 4]
                raise MeshError(
                    f"Blocks '{one.name}' and '{other.name}' share the side from {place(start)} to {place(end)} but "
                    f"divide it into {one.divisions[i % 2]} and {other.divisions[j % 2]} elements: the numbers must be "
                    "equal."
                )


def _check_corners(every: list[_Block], tolerance: float) -> None:
    """Refuse a corner within a side of another block."""
    corners = np.concatenate([block.corners for block in every])
    start, end = corners, np.concatenate([np.roll(block.corners, -1, axis=0) for block in every])
    length = np.linalg.norm(end - start, axis=1)
    along = unit(end - start)
    from_start = corners[:, None] - start
    at = (from_start * along).sum(axis=2)
    aside = np.linalg.norm(from_start - at[:, :, None] * along, axis=2)
    within = np.argwhere((at > tolerance) & (at < length - tolerance) & (aside <= tolerance))
    if len(within):
        corner, side = within[0]
        one, other = every[corner // 4].name, every[side // 4].name
        raise MeshError(
            f"Blocks '{one}' and '{other}' do not match: the corner of '{one}' at {place(corners[corner])} "
            f"lies within the side of '{other}' from {place(start[side])} to {place(end[side])}. Split "
            f"'{other}' there."
        )


def _overlap(one: FloatArray, other: FloatArray, tolerance: float) -> bool:
    """Whether convex quadrilaterals in one plane X3 = constant overlap: no side of either separates them."""
    if np.ptp(np.concatenate([one, other])[:, 2]) > tolerance:
        return False
    sides = np.concatenate([np.roll(x, -1, axis=0) - x for x in (one, other)])
    across = unit(sides[:, [1, 0]] * [1.0, -1.0])
    first, second = across @ one[:, :2].T, across @ other[:, :2].T
    depth = np.minimum(first.max(axis=1) - second.min(axis=1), second.max(axis=1) - first.min(axis=1))
    return bool(depth.min() > tolerance)
