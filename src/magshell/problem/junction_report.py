"""What `magshell check` says of the lines at which sheets meet: kinks, joints, hinges, opposite normals, cuts."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from magshell.arrays import IntArray
from magshell.mesh import Mesh
from magshell.mesh.geometry import COINCIDENT
from magshell.mesh.junctions import Line, junctions_of
from magshell.model.hinge import Hinge
from magshell.units import HINGE_STIFFNESS, LENGTH, show
from magshell.wording import counted

MOST_LINES = 4


def lines(mesh: Mesh, hinges: Sequence[Hinge] = ()) -> Iterator[tuple[str, str]]:
    """Label and text of every line of the report; hinges are said apart from kinks and joints."""
    found, hinged = junctions_of(mesh), {hinge.group for hinge in hinges}
    for label, each in (
        ("kinks", found.kinks),
        ("joints of three or more", found.joints),
        ("normals change sign", found.flips),
    ):
        each = [line for line in each if not hinged.intersection(line.groups)]
        if each:
            yield label, _said(mesh, each, angles=label == "kinks", groups=label != "normals change sign")
    for hinge in hinges:
        yield "hinge", _hinge(mesh, hinge)
    if mesh.cuts:
        yield "cuts", ", ".join(f"{name} ({counted(len(mesh.nodes_of(name)), 'node')})" for name in mesh.cuts)


def _hinge(mesh: Mesh, hinge: Hinge) -> str:
    edges = hinge.edges(mesh)
    length = float(np.linalg.norm(mesh.points[edges[:, 1]] - mesh.points[edges[:, 0]], axis=1).sum())
    spring = f"with a spring of {show(hinge.stiffness, HINGE_STIFFNESS)}" if hinge.stiffness else "turns freely"
    return f"{hinge.group}, {counted(len(edges), 'edge')}, {show(length, LENGTH)}, {spring}"


def _said(mesh: Mesh, found: Sequence[Line], angles: bool, groups: bool) -> str:
    nodes = len(np.unique(np.concatenate([line.nodes for line in found])))
    turned = ""
    if angles:
        least, greatest = (np.degrees([line.angle[i] for line in found]) for i in (0, 1))
        span = [f"{value:.4g}" for value in (least.min(), greatest.max())]
        turned = f", {' to '.join(dict.fromkeys(span))}°"
    places = [_named(line, groups) + _place(mesh, line) for line in found[:MOST_LINES]]
    more = [f"and {len(found) - MOST_LINES} more"] if len(found) > MOST_LINES else []
    return f"{counted(len(found), 'line')}, {counted(nodes, 'node')}{turned}: {'; '.join([*places, *more])}"


def _named(line: Line, groups: bool) -> str:
    if not groups:
        return ""
    return f"{', '.join(line.groups)}, " if line.groups else "no group, "


def _place(mesh: Mesh, line: Line) -> str:
    if line.closed:
        return f"a loop through {_point(mesh, line.edges[0, 0])}"
    return f"from {_point(mesh, line.edges[0, 0])} to {_point(mesh, line.edges[-1, 1])}"


def _point(mesh: Mesh, node: IntArray) -> str:
    x = np.where(np.abs(mesh.points[node]) > COINCIDENT * mesh.size, mesh.points[node], 0.0)
    return f"({', '.join(show(value, LENGTH) for value in x)})"
