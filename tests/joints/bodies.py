"""Jointed bodies that the tests of this folder run over: folded, ribbed, hinged, with rigid ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from battery import COUPLING, FIELD, MATERIAL, REMANENCE, Unsupported, example

import magshell as ms
from magshell.equations.discretisation import Discretisation
from magshell.magnetics import remanence
from magshell.magnetics.fields.uniform import UniformField
from magshell.mesh import Mesh, split
from magshell.model.hinge import Hinge
from magshell.model.region import Layer, Region
from magshell.model.rigid_body import RigidBody
from magshell.model.shell import Shell
from magshell.shell.elements import QUADRATIC

FOLD = [((0, 0), (1, 0)), ((1, 0), (1, 1))]
FLAT = [((0, 0), (1, 0)), ((1, 0), (2, 0))]
UPSIDE_DOWN = [((0, 0), (1, 0)), ((2, 0), (1, 0))]
TEE = [((0, 0), (1, 0)), ((1, 0), (2, 0)), ((1, 0), (1, 1))]
BOX = [((0, 0), (1, 0)), ((1, 0), (1, 1)), ((1, 1), (0, 1)), ((0, 1), (0, 0))]


SECTIONS = [
    Region("sheet1", thickness=0.2, offset="top"),
    Region("sheet2", layers=[Layer(0.05, example(MATERIAL)), Layer(0.1, example(MATERIAL))]),
]


def extruded(lines: Sequence[tuple], per_line: int = 2, across: int = 2, width: float = 1.0, size: float = 1.0) -> Mesh:
    """Straight sheets over lines in the plane X1, X3, extruded along X2.

    Groups: `sheet0` and so on; `joint` are the edges that sheets share, or two pieces of a line; `near` and `far` the
    ends of the first and the last line.
    """
    points: list[np.ndarray] = []
    known: dict[tuple, int] = {}

    def node(x: float, y: float, z: float) -> int:
        key = tuple(np.round((x, y, z), 9))
        if key not in known:
            known[key] = len(points)
            points.append(np.array(key))
        return known[key]

    elements, groups = [], {}
    edges: dict[tuple, list[tuple]] = {}
    for number, (start, end) in enumerate(lines):
        start, end = size * np.array(start, float), size * np.array(end, float)
        first = len(elements)
        for i in range(per_line):
            for j in range(across):
                row = []
                for s, t in ((0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0), (1, 0.5), (0.5, 1), (0, 0.5)):
                    x, z = start + (end - start) * (i + s) / per_line
                    row.append(node(x, width * (j + t) / across, z))
                elements.append(row)
                for k, slots in ((i, (0, 3, 7)), (i + 1, (1, 2, 5))):
                    place = start + (end - start) * k / per_line
                    edges.setdefault(tuple(np.round(place, 9)), []).append([row[slot] for slot in slots])
        groups[f"sheet{number}"] = np.arange(first, len(elements))
    ends = [tuple(np.round(size * np.array(place, float), 9)) for line in lines for place in line]
    shared = [place for place in dict.fromkeys(ends) if ends.count(place) > 1]
    unique = {place: np.unique(np.array(edges[place]), axis=0) for place in edges}
    edge_groups = {"near": unique[ends[0]], "far": unique[ends[-1]]}
    if shared:
        edge_groups["joint"] = np.concatenate([unique[place] for place in shared])
    return Mesh(np.array(points), np.array(elements), element_groups=groups, edge_groups=edge_groups)


def jointed(mesh: Mesh, element=QUADRATIC, coupling=None, hinges=(), rigid=(), regions=(), **given):
    """A body that nothing holds, without symmetry of material or remanence; `given` are fields of `Unsupported`."""
    shell = Shell(
        mesh,
        0.1,
        example(MATERIAL),
        remanence.per_element(np.tile(REMANENCE, (len(mesh.elements), 1))),
        element=element,
        hinges=hinges,
        rigid=rigid,
        regions=regions,
    )
    body = Unsupported(shell, UniformField(FIELD), coupling or example(COUPLING), **given)
    return Discretisation(body, lambda graph: np.arange(graph.shape[0]))


BODIES: dict[str, Callable] = {
    "fold": lambda *given: jointed(extruded(FOLD), *given),
    "flat, upside down": lambda *given: jointed(extruded(UPSIDE_DOWN), *given),
    "tee": lambda *given: jointed(extruded(TEE), *given),
    "box": lambda *given: jointed(extruded(BOX, 1, 1), *given),
    "hinge": lambda *given: jointed(extruded(FLAT), *given, hinges=[Hinge("joint")]),
    "hinged tee": lambda *given: jointed(extruded(TEE), *given, hinges=[Hinge("joint")]),
    "rigid end": lambda *given: jointed(extruded(FLAT), *given, rigid=[RigidBody("far", point=(2.5, 0.1, 0.7))]),
    "rigid sheet": lambda *given: jointed(extruded(TEE), *given, rigid=[RigidBody("sheet2")]),
    "sections at a joint": lambda *given: jointed(extruded(TEE), *given, regions=SECTIONS),
    "triangles": lambda *given: jointed(split(extruded(TEE, 1, 1), "crossed"), QUADRATIC.with_triangles, *given[1:]),
    "rigid joint": lambda *given: jointed(extruded(TEE), *given, rigid=[RigidBody("joint", point=(0.2, 0.1, 0.3))]),
}
"""Functions of an element type and a coupling."""


def folded_arm() -> ms.Model:
    """A model of everything: sprung hinges of a tee, a kink, differing sections, a rigid magnet, springs."""
    lines = [((0, 0), (1, 0)), ((1, 0), (2, 0)), ((1, 0), (1, 1)), ((2, 0), (2.5, 0.6))]
    mesh = extruded(lines, 1, 1, size=1e-2, width=1e-2)
    joint = mesh.edge_groups["joint"]
    hinge = joint[np.isclose(mesh.points[joint[:, 0], 0], 1e-2)]
    mesh = Mesh(mesh.points, mesh.elements, mesh.element_groups, {**mesh.edge_groups, "hinge": hinge})
    rubber = ms.MicropolarNeoHookean(1e5, 3e5, length_scale=1e-5)
    shell = Shell(
        mesh,
        1e-3,
        rubber,
        remanence.constant((0.01, 0, 0)),
        regions=[Region("sheet2", thickness=5e-4)],
        hinges=[Hinge("hinge", 1e-2)],
        rigid=[RigidBody("far", name="magnet", moment=(1e-3, 0, 1e-3), mass=1e-3)],
    )
    return ms.Model(
        shell,
        [ms.Clamp("near"), ms.Prescribe("magnet", "omega", 2, 0.3)],
        UniformField((0, 0, 5e-3)),
        loads=[ms.Force("magnet", (1e-4, 0, 2e-4), follower=True)],
        springs=[ms.Spring("sheet2", 1.0)],
    )
