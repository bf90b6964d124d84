"""The closed skin of a solid is refused in every format; what is round all over, or open, or meant, is a shell."""

from __future__ import annotations

import importlib.util

import numpy as np
import pytest

import magshell as ms
from magshell.cli import main
from magshell.errors import InputError
from magshell.mesh.files.orientation import agreeing
from magshell.mesh.files.skins import skin_of_a_solid

from .same import MISSING, first_order

needs_meshio = pytest.mark.skipif(importlib.util.find_spec("meshio") is None, reason="needs the extra magshell[meshio]")
REFUSED = r"is the skin of a solid: .*mid-surface.*write closed = true"


def welded(faces):
    """Points and rows of 3- or 4-cornered faces (n, corners, 3), corners at one place made one."""
    corners = faces.shape[1]
    points, where = np.unique(np.round(faces.reshape(-1, 3), 9), axis=0, return_inverse=True)
    return points, where.reshape(-1, corners)


def box(length, width, height, n=3):
    """Triangles of a box's six sides, seen from outside."""
    s = np.linspace(0.0, 1.0, n + 1)
    a, b = (part.ravel() for part in np.meshgrid(s[:-1], s[:-1]))
    d = 1.0 / n
    quads = np.stack(
        [np.stack([a, b], 1), np.stack([a + d, b], 1), np.stack([a + d, b + d], 1), np.stack([a, b + d], 1)], 1
    )
    sides = []
    for axis in range(3):
        for end in (0.0, 1.0):
            x = np.zeros((*quads.shape[:2], 3))
            x[..., (axis + 1) % 3], x[..., (axis + 2) % 3], x[..., axis] = quads[..., 0], quads[..., 1], end
            sides.append(x if end else x[:, ::-1])
    faces = np.concatenate(sides) * (length, width, height)
    return welded(np.concatenate([faces[:, [0, 1, 2]], faces[:, [0, 2, 3]]]))


def sphere(levels=2, radius=1.0):
    """Triangles of an icosahedron, divided and blown up."""
    g = (1 + 5**0.5) / 2
    x = np.array([[0, s, t * g] for s in (-1, 1) for t in (-1, 1)], float)
    x = np.concatenate([np.roll(x, k, axis=1) for k in range(3)])
    far = np.linalg.norm(x[:, None] - x, axis=2)
    near = (far > 0) & (far < 2.01)
    faces = np.array(
        [[i, j, k] for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[i, k]]
    )
    faces = x[faces]
    for _ in range(levels):
        ab, bc, ca = (0.5 * (faces[:, i] + faces[:, (i + 1) % 3]) for i in range(3))
        a, b, c = faces[:, 0], faces[:, 1], faces[:, 2]
        faces = np.concatenate([np.stack(each, 1) for each in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return welded(radius * faces / np.linalg.norm(faces, axis=2, keepdims=True))


def capsule(around=24):
    """A tube with half spheres at its ends, in strips like those of a CAD program."""
    polar = np.concatenate([np.linspace(0, 90, 7), np.linspace(90, 180, 7)]) * np.pi / 180
    z = np.cos(polar) + np.repeat([2.0, -2.0], 7)
    angle = 2 * np.pi * np.arange(around) / around
    x = np.stack(
        [np.outer(np.sin(polar), np.cos(angle)), np.outer(np.sin(polar), np.sin(angle)), 0 * angle + z[:, None]], 2
    )
    here, there = x, np.roll(x, -1, axis=1)
    quads = np.stack([here[:-1], here[1:], there[1:], there[:-1]], 2).reshape(-1, 4, 3)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    area = np.linalg.norm(np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]), axis=1)
    return welded(faces[area > 1e-9])


def rounded_plate(radius=0.2):
    """A plate 4 × 4 × 1 whose edges are round: the points of a box moved off a smaller one."""
    points, faces = box(4.0, 4.0, 1.0, n=20)
    inner = np.clip(points, radius, np.array([4.0, 4.0, 1.0]) - radius)
    away = points - inner
    length = np.linalg.norm(away, axis=1, keepdims=True)
    return inner + radius * away / np.where(length > 0, length, 1), faces


def rows_of(triangles):
    none = np.full(len(triangles), MISSING)
    rows = np.column_stack([triangles, triangles[:, 2], none, none, triangles[:, 2], none])
    return agreeing(rows)[0]


@pytest.mark.parametrize(
    ("surface", "why"),
    [
        (box(20.0, 5.0, 1.0), "more than 50° along 36 edges"),
        (box(1.0, 1.0, 1.0, n=1), "more than 50° along 12 edges"),
        (rounded_plate(), "two flat faces that are parallel"),
        (sphere(), ""),
        (sphere(1), ""),
        (capsule(), ""),
        (capsule(12), ""),
    ],
    ids=["plate", "coarse cube", "rounded plate", "sphere", "coarse sphere", "capsule", "coarse capsule"],
)
def test_which_surfaces_are_skins(surface, why):
    points, triangles = surface
    reason = skin_of_a_solid(points, rows_of(triangles))
    assert why in reason
    assert bool(why) == bool(reason)
    assert not skin_of_a_solid(points, rows_of(triangles[1:])), "open"


def test_one_of_several_parts_is_a_skin():
    points, triangles = box(20.0, 5.0, 1.0)
    round_points, round_triangles = sphere()
    both = np.concatenate([round_triangles, triangles + len(round_points)])
    reason = skin_of_a_solid(np.concatenate([round_points, points + 100.0]), rows_of(both))
    assert "along 36 edges" in reason


def test_second_order_surfaces_by_their_curved_normals():
    """An eighth of a sphere in every element: flat ones would meet at 70°."""
    corners = np.array(
        [[s, 0, 0] for s in (1, -1)] + [[0, s, 0] for s in (1, -1)] + [[0, 0, s] for s in (1, -1)], float
    )
    faces = np.array(
        [
            [i, 2 + j, 4 + k] if (i + j + k) % 2 == 0 else [2 + j, i, 4 + k]
            for i in (0, 1)
            for j in (0, 1)
            for k in (0, 1)
        ]
    )
    assert skin_of_a_solid(corners, rows_of(faces))
    middles = {}
    rows = rows_of(faces)
    points = list(corners)
    for row in rows:
        for column, (i, j) in ((4, (0, 1)), (5, (1, 2)), (7, (3, 0))):
            key = tuple(sorted((row[i], row[j])))
            if key not in middles:
                middles[key] = len(points)
                middle = corners[key[0]] + corners[key[1]]
                points.append(middle / np.linalg.norm(middle))
            row[column] = middles[key]
    assert not skin_of_a_solid(np.array(points), rows)


def written(points, triangles, suffix, folder):
    """A file of triangles in one of the formats."""
    import meshio

    file = folder / f"skin{suffix}"
    if suffix == ".inp":
        nodes = "".join(f"{n + 1}, {x!r}, {y!r}, {z!r}\n" for n, (x, y, z) in enumerate(points.tolist()))
        elements = "".join(f"{e + 1}, {a + 1}, {b + 1}, {c + 1}\n" for e, (a, b, c) in enumerate(triangles.tolist()))
        file.write_text(f"*NODE\n{nodes}*ELEMENT, TYPE=S3\n{elements}")
    elif suffix == ".msh":
        meshio.Mesh(points, [("triangle", triangles)]).write(file, file_format="gmsh22", binary=False)
    else:
        meshio.Mesh(points, [("triangle", triangles)]).write(file)
    return file


FORMATS = [".stl", ".obj", ".ply", ".off", ".vtu", ".vtk", ".inp", ".msh", ".mesh"]


@needs_meshio
@pytest.mark.parametrize("suffix", FORMATS)
def test_skins_and_balloons_in_every_format(suffix, tmp_path):
    file = written(*box(20.0, 5.0, 1.0), suffix, tmp_path)
    for second_order in (True, False):
        with pytest.raises(InputError, match=rf"^skin\{suffix}: {REFUSED}"):
            ms.mesh.read(file, "mm", second_order=second_order)
    mesh = ms.mesh.read(file, "mm", second_order=True, closed=True)
    assert len(mesh.elements) == 108
    assert not len(mesh.boundary_edges)
    points, triangles = sphere()
    balloon = ms.mesh.read(written(points, triangles, suffix, tmp_path), "mm", second_order=True)
    assert len(balloon.elements) == len(triangles)
    assert not any("skin" in change for change in balloon.origin.changes)


PROBLEM = """
[mesh]
file = "skin.stl"
unit = "mm"
second_order = true
{more}

[shell]
thickness = "0.2 mm"

[material]
law = "micropolar-neo-hookean"
shear_modulus = "100 kPa"
lame_lambda = "2 MPa"
coupling_modulus = "0.1 mu"
length_scale = "0.1 h"

[[remanence]]
kind = "constant"
vector = ["50 mT", 0, 0]

[field]
flux_density = [0, 0, "1 mT"]

[mesh.node_groups.end]
x1 = 0

[[supports]]
kind = "clamp"
group = "end"
"""


@needs_meshio
def test_the_same_words_from_every_command(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    written(*box(20.0, 5.0, 1.0), ".stl", tmp_path)
    (tmp_path / "case.toml").write_text(PROBLEM.format(more=""))
    for command in (["check", "case.toml"], ["run", "case.toml", "--out", "r"], ["mesh", "skin.stl", "--unit", "mm"]):
        assert main(command) == 2
        assert "is the skin of a solid" in " ".join(capsys.readouterr().err.split())
    (tmp_path / "case.toml").write_text(PROBLEM.format(more="closed = true"))
    assert main(["check", "case.toml"]) == 0
    assert main(["mesh", "skin.stl", "--unit", "mm", "--second-order", "--closed"]) == 0


def test_closed_tubes_and_rings_are_open_surfaces():
    points, rows = first_order(ms.mesh.cylinder(1, 2, (12, 2)))
    assert not skin_of_a_solid(points, rows)
