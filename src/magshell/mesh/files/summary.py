"""A mesh in words."""

from __future__ import annotations

import numpy as np

from magshell.arrays import IntArray
from magshell.mesh.files.assembling import Origin
from magshell.mesh.files.units import length_unit
from magshell.mesh.geometry import COINCIDENT
from magshell.mesh.mesh import Mesh
from magshell.mesh.quality import worst

MOST_GROUPS = 40


def in_words(mesh: Mesh, origin: Origin) -> list[tuple[str, str]]:
    """Label and text of every line of a report: size, elements, groups, quality, what was changed."""
    lines = [
        ("lengths in", origin.unit),
        ("elements", _counts(mesh)),
        ("nodes", str(len(mesh.points))),
        ("size", _extent(mesh, origin.unit)),
    ]
    if len(mesh.parts) > 1:
        lines.append(("separate parts", str(len(mesh.parts))))
    named = [
        *(_group(name, len(members), "element") for name, members in mesh.element_groups.items()),
        *(
            f"{_group(name, len(members), 'edge')} {_where(mesh, members, origin.unit)}"
            for name, members in mesh.edge_groups.items()
        ),
        *(
            f"{_group(name, len(members), 'node')} {_where(mesh, members, origin.unit)}"
            for name, members in mesh.node_groups.items()
        ),
    ]
    lines += [("group", line) for line in named[:MOST_GROUPS]] or [("groups", "none")]
    if len(named) > MOST_GROUPS:
        lines.append(("groups", f"and {len(named) - MOST_GROUPS} more"))
    quality = worst(mesh)
    for label, key, meaning in (
        ("worst corner", "scaled_jacobian", "scaled Jacobian, 1 is best"),
        ("worst aspect ratio", "aspect_ratio", "longest over shortest side"),
    ):
        found = quality[key]
        lines.append((label, f"{found.value:.3g} ({meaning}) {_at(mesh, found.element, origin.unit)}"))
    return lines + [("changed", change) for change in origin.changes]


def in_a_line(mesh: Mesh, origin: Origin) -> str:
    """The same, in one line."""
    corner = worst(mesh)["scaled_jacobian"]
    return f"{origin.file}: {_counts(mesh)}, {_extent(mesh, origin.unit)}, worst corner {corner.value:.2g}" + "".join(
        f"; {change}" for change in origin.changes
    )


def _counts(mesh: Mesh) -> str:
    return mesh.counts if mesh.triangles.any() else f"{len(mesh.elements)} quadrilaterals"


def _group(name: str, count: int, what: str) -> str:
    return f"{name} ({count} {what}{'s' if count > 1 else ''})"


def _where(mesh: Mesh, nodes: IntArray, unit: str) -> str:
    """What coordinates some nodes have."""
    x = mesh.points[nodes.ravel()]
    x = np.where(np.abs(x) > COINCIDENT * mesh.size, x, 0.0) / length_unit(unit)
    spans = [
        f"{least:.4g}"
        if greatest - least <= COINCIDENT * mesh.size / length_unit(unit)
        else f"{least:.4g} to {greatest:.4g}"
        for least, greatest in zip(x.min(axis=0), x.max(axis=0), strict=True)
    ]
    return f"at ({', '.join(spans)}) {unit}"


def _extent(mesh: Mesh, unit: str) -> str:
    spans = np.ptp(mesh.points, axis=0) / length_unit(unit)
    return " × ".join(f"{span:.4g}" for span in spans) + f" {unit}"


def _at(mesh: Mesh, element: int, unit: str) -> str:
    centre = mesh.points[mesh.elements[element, :4]].mean(axis=0) / length_unit(unit)
    return f"in element {element} at ({', '.join(f'{value:.4g}' for value in centre)}) {unit}"
