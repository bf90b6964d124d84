"""What breaks the mirror planes of a model: field, loads, or where its shell lies (see `reflection.py`)."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from typing import NamedTuple, Protocol

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.magnetics.fields import UniformField
from magshell.mesh import Mesh
from magshell.mesh.geometry import COINCIDENT
from magshell.model import repetition
from magshell.model.loads import Load
from magshell.model.reflection import TYPED, angle_to_plane, in_plane, is_normal, polar
from magshell.model.repetition import Repeating, flux_densities
from magshell.model.support import Support
from magshell.model.supports import mirror_planes
from magshell.shell.normals import nodal_normals
from magshell.units import FLUX_DENSITY, Dimension, show

logger = logging.getLogger(__name__)

MIRRORED, REVERSED = 1, -1
# Degrees by which a coarse curved mesh may miss a right angle between shell and plane.
FOLD = 15.0
WHOLE = "Model the whole part, or choose other planes"


class Plane(NamedTuple):
    """A mirror plane: its group, unit normal (3,) and the nodes held in it."""

    group: str
    normal: FloatArray
    nodes: IntArray


class Mirrored(Repeating, Protocol):
    """What a model must offer here."""

    @property
    def supports(self) -> Sequence[Support]: ...


def planes(model: Mirrored) -> list[Plane]:
    """The mirror planes of a model."""
    return [
        Plane(support.group, support.unit_normal, model.shell.nodes_of(support.group))
        for support in mirror_planes(model.supports, model.shell.rigid)
    ]


def remanence_sign(model: Mirrored, plane: Plane) -> int | None:
    """How the other half must be magnetised: `MIRRORED` or `REVERSED` (mirrored and reversed); None: in no way.

    Without a field or without remanence it is `MIRRORED`, and nothing depends on it.
    """
    if not isinstance(model.field, UniformField):
        signs = [sign for _, sign in _signs_in_space(model, plane)]
        return MIRRORED if not signs else signs[0] if len(set(signs)) == 1 else None
    fields = [vector for _, vector in _fields(model)]
    if all(in_plane(vector, plane.normal) for vector in fields):
        return MIRRORED
    return REVERSED if all(is_normal(vector, plane.normal) for vector in fields) else None


def broken(model: Mirrored) -> list[str]:
    """What breaks the model's mirror planes and repetitions, in sentences: what it is, and what would be right."""
    found = []
    for plane in planes(model):
        faults = (*_of_place(model.shell.mesh, plane), *_of_field(model, plane), *_of_loads(model, plane))
        found += [f"symmetry '{plane.group}': {fault}" for fault in faults]
    return found + repetition.broken(model)


def _of_place(mesh: Mesh, plane: Plane) -> Iterator[str]:
    """Nodes that are not in one plane, a shell that is not on one side of it, or meets it at an angle."""
    heights = mesh.points[plane.nodes] @ plane.normal
    if np.ptp(heights) > COINCIDENT * mesh.size:
        low, high = plane.nodes[np.argmin(heights)], plane.nodes[np.argmax(heights)]
        yield (
            f"its nodes do not lie in one plane with the normal {_vector(plane.normal)}: along it, nodes {low} and "
            f"{high} are {np.ptp(heights):.3g} m apart. Check normal and group"
        )
        return
    normals = nodal_normals(mesh.points, mesh.elements)[plane.nodes]
    angle = np.array([angle_to_plane(normal, plane.normal) for normal in normals])
    worst = int(np.argmax(angle))
    if angle[worst] > FOLD:
        node, fold = plane.nodes[worst], 2.0 * angle[worst]
        yield (
            f"at node {node} the normal of the shell is {angle[worst]:.3g}° off the plane, in which it must lie: with "
            f"its image the shell is folded there by {fold:.3g}°. Check normal, unless such a fold is meant"
        )
    touching = np.isin(mesh.elements, plane.nodes).any(axis=1)
    centres = mesh.points[mesh.elements[touching]].mean(axis=1) @ plane.normal - heights.mean()
    if centres.min() < -COINCIDENT * mesh.size and centres.max() > COINCIDENT * mesh.size:
        yield (
            "the shell lies on both sides of the plane, so nothing is mirrored in it. Keep one side, or leave the "
            "support out"
        )


def _of_field(model: Mirrored, plane: Plane) -> Iterator[str]:
    """A field that is neither in the plane nor normal to it, or that changes between the two."""
    if not model.shell.magnetised or remanence_sign(model, plane) is not None:
        return
    several = len(model.stages) > 1
    seen: dict[int, int] = {}
    for stage, sign in _signs_in_space(model, plane):
        if sign is None:
            where = f" in stage {stage + 1}" if several else ""
            yield f"the field{where} differs beyond the plane from its image; place its sources alike. {WHOLE}"
            return
        seen.setdefault(sign, stage)
    for stage, vector in _fields(model):
        if in_plane(vector, plane.normal):
            seen.setdefault(MIRRORED, stage)
        elif is_normal(vector, plane.normal):
            seen.setdefault(REVERSED, stage)
        else:
            where = f" in stage {stage + 1}" if several else ""
            yield (
                f"the field {_shown(vector, FLUX_DENSITY)}{where} is {angle_to_plane(vector, plane.normal):.3g}° off "
                "the plane: it must lie in it (the other half then has the mirrored remanence) or be normal to it "
                f"(mirrored and reversed). {WHOLE}"
            )
            return
    uniform = isinstance(model.field, UniformField)
    one, other = ("lies in the plane", "is normal to it") if uniform else ("is its own image", "the opposite of it")
    yield (
        f"the field {one} in stage {seen[MIRRORED] + 1} and {other} in stage {seen[REVERSED] + 1}: "
        "the other half would need the mirrored remanence in the one, and the mirrored and reversed one in the other. "
        f"{WHOLE}"
    )


def _fields(model: Mirrored) -> Iterator[tuple[int, FloatArray]]:
    """Stage and flux density (3,) at multiplier 1 of all fields of the path.

    Of one that turns there are three, which are in the plane (normal to it) only if all on the way are.
    """
    field = model.field
    if not isinstance(field, UniformField) or not field.magnitude:
        return
    for number in range(len(model.stages)):
        start, end = (model.course(number).amounts(load_factor).drives.tolist() for load_factor in (0.0, 1.0))
        if start[0] or end[0]:
            turn = float(np.clip(end[1] - start[1], -2.0, 2.0))
            for angle in {end[1], end[1] - 0.5 * turn, end[1] - turn}:
                yield number, field.turned(angle)


def _signs_in_space(model: Mirrored, plane: Plane) -> Iterator[tuple[int, int | None]]:
    """Stage, and sign σ of B(S x) = σ S B(x) at the nodes of a field that varies; None: it has neither.

    States without field, and those whose field is unknown beyond the plane, tell nothing.
    """
    if isinstance(model.field, UniformField):
        return
    points, offset = model.shell.mesh.points, float((model.shell.mesh.points[plane.nodes] @ plane.normal).mean())
    images = polar(points, plane.normal) + 2.0 * offset * plane.normal
    for number, here, there in flux_densities(model, points, images):
        size = float(np.linalg.norm(here, axis=1).max())
        if size > 0.0:
            mirrored = polar(here, plane.normal)
            off = {sign: np.linalg.norm(there - sign * mirrored, axis=1).max() for sign in (MIRRORED, REVERSED)}
            alike = [sign for sign, gap in off.items() if gap <= 2.0 * TYPED * size]
            yield number, (MIRRORED if alike == [MIRRORED] else REVERSED if alike else None)


def _of_loads(model: Mirrored, plane: Plane) -> Iterator[str]:
    """Weight and loads in the plane that are not their own image, and loads of an area that jump there."""
    mesh = model.shell.mesh
    for load in model.loads:
        at_nodes, at_elements = _acts_in(mesh, load, plane), _ends_at(mesh, load, plane)
        effect, vector = load.beyond(at_nodes, at_elements), load.vector
        if vector is None or not effect:
            continue
        given = load.kind if load.group is None else f"{load.kind} on '{load.group}'"
        given += f" {_shown(vector, load.amount[1])}"
        off = angle_to_plane(vector, plane.normal)
        if not load.axial and not in_plane(vector, plane.normal):
            yield f"{given} is {off:.3g}° off the plane: {effect}. {WHOLE}"
        if load.axial and at_nodes and not is_normal(vector, plane.normal):
            yield (
                f"{given} is {90.0 - off:.3g}° off the normal of the plane, whose support takes all the rest. {WHOLE}"
            )


def _acts_in(mesh: Mesh, load: Load, plane: Plane) -> bool:
    """Whether an edge or a node of its group, which must not be one of elements, lies in the plane."""
    group = str(load.group)
    if group in mesh.edge_groups:
        return bool(np.isin(mesh.edge_groups[group], plane.nodes).all(axis=1).any())
    return group in mesh.node_groups and bool(np.isin(mesh.node_groups[group], plane.nodes).any())


def _ends_at(mesh: Mesh, load: Load, plane: Plane) -> bool:
    """Whether an element of its group has an edge in the plane."""
    whole = load.group is None and load.on == "elements"
    members = mesh.elements if whole else mesh.elements[mesh.element_groups.get(str(load.group), [])]
    return bool((np.isin(members, plane.nodes).sum(axis=1) > 2).any())


def _shown(vector: FloatArray, dimension: Dimension) -> str:
    small = 1e-9 * float(np.linalg.norm(vector))
    return f"({', '.join(show(x if abs(x) > small else 0.0, dimension) for x in vector.tolist())})"


def _vector(components: FloatArray) -> str:
    return f"({', '.join(f'{component:.4g}' for component in components)})"
