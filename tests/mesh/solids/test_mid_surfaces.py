"""Mid-surfaces of solids of one thickness, flat and curved, from skins, solid elements and bodies of CAD files."""

from __future__ import annotations

import importlib.util
import pathlib
from itertools import permutations

import numpy as np
import pytest
from drawings.sheets import area, normals
from files.test_skins import box, rounded_plate, sphere

import magshell as ms
from magshell.errors import InputError
from magshell.mesh.files.session import session
from magshell.mesh.solids.pairing import sides_of
from magshell.mesh.solids.skin import skin_from

from .bodies import angle, arch, plate, written

DATA = pathlib.Path(__file__).parent / "data"
NEEDED = ("gmsh", "shapely", "meshio")
needs = pytest.mark.skipif(
    any(importlib.util.find_spec(package) is None for package in NEEDED),
    reason="needs the extras magshell[drawings] and magshell[meshio]",
)
L_SHAPE = [(0, 0), (20, 0), (20, 14), (16, 14), (16, 4), (0, 4)]


def from_outline(points, corners):
    """Distance of points (n, 2) from the sides of a polygon."""
    begin, end = np.array(corners, float), np.roll(np.array(corners, float), -1, axis=0)
    along = end - begin
    share = (((points[:, None] - begin) * along).sum(axis=2) / (along**2).sum(axis=1)).clip(0, 1)
    return np.linalg.norm(points[:, None] - begin - share[..., None] * along, axis=2).min(axis=1)


@needs
@pytest.mark.parametrize(("name", "unit"), [("plate_skin.stl", "mm"), ("plate.step", None)])
def test_the_l_shaped_plate(name, unit):
    """z = 1 mm, the outline of the plate, 2 mm told."""
    mesh = ms.mesh.mid_surface(DATA / name, size=1.5e-3, unit=unit)
    assert mesh.origin.changes[0] == "the mid-surface of a solid 2 mm thick"
    assert mesh.origin.thickness == pytest.approx(2e-3, rel=1e-12)
    off = np.abs(mesh.points[:, 2] - 1e-3).max()
    rim = from_outline(1e3 * mesh.points[np.unique(mesh.boundary_edges), :2], L_SHAPE).max()
    print(f"{name}: off the plane {off:.1e} m, off the outline {1e-3 * rim:.1e} m")
    assert off < 1e-12
    assert rim < 1e-9
    assert area(mesh) == pytest.approx(120e-6, rel=1e-12)
    assert (normals(mesh) > 0).all()


@needs
def test_a_flat_plate_at_an_angle_with_a_hole(tmp_path):
    """Turned in space, from an STL file and a STEP file; the hole of 60 corners is a curve."""
    with session("test") as gmsh:
        occ = gmsh.model.occ
        whole, hole = occ.addBox(0, 0, 0, 20, 10, 1), occ.addCylinder(6, 5, -1, 0, 0, 3, 2.5)
        (body,), _ = occ.cut([(3, whole)], [(3, hole)])
        occ.rotate([body], 0, 0, 0, 1, 2, 3, 0.7)
        occ.synchronize()
        gmsh.write(str(tmp_path / "part.step"))
        gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", 60)
        gmsh.model.mesh.generate(2)
        gmsh.write(str(tmp_path / "part.stl"))
    axis = np.array([1, 2, 3]) / 14**0.5
    cross = np.cross(axis, np.eye(3))
    turn = np.cos(0.7) * np.eye(3) + np.sin(0.7) * cross.T + (1 - np.cos(0.7)) * np.outer(axis, axis)
    for name, unit in (("part.stl", "mm"), ("part.step", None)):
        mesh = ms.mesh.mid_surface(tmp_path / name, size=1.2e-3, unit=unit)
        x = 1e3 * mesh.points @ np.linalg.inv(turn).T
        rim = x[np.unique(mesh.boundary_edges)]
        ring = rim[np.hypot(rim[:, 0] - 6, rim[:, 1] - 5) < 3]
        off = np.abs(np.hypot(ring[:, 0] - 6, ring[:, 1] - 5) - 2.5).max()
        print(f"{name}: off the plane {np.abs(x[:, 2] - 0.5).max():.1e} mm, off the circle {off:.1e} mm")
        assert np.abs(x[:, 2] - 0.5).max() < (1e-9 if unit is None else 1e-6)  # STL files of gmsh have few digits
        assert len(ring) > 20
        assert off < (1e-9 if unit is None else 2.5 * (1 - np.cos(np.pi / 60)))


@needs
def test_curved_bodies_of_step_files(tmp_path):
    """The nodes are on the true mid-surface: a tube's and a spherical zone's."""

    def tube(occ):
        occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, 20, 10.5))], [(3, occ.addCylinder(0, 0, -1, 0, 0, 22, 9.5))])

    def zone(occ):
        centre = occ.addPoint(0, 0, 0)
        ends = [
            occ.addPoint(r * np.cos(t), 0, r * np.sin(t)) for r, t in ((9.5, 0.2), (9.5, 1.2), (10.5, 1.2), (10.5, 0.2))
        ]
        sides = [
            occ.addCircleArc(ends[0], centre, ends[1]), occ.addLine(ends[1], ends[2]),
            occ.addCircleArc(ends[2], centre, ends[3]), occ.addLine(ends[3], ends[0]),
        ]  # fmt: skip
        occ.revolve([(2, occ.addPlaneSurface([occ.addCurveLoop(sides)]))], 0, 0, 0, 0, 0, 1, np.pi / 2)

    for build, axes in ((tube, slice(2)), (zone, slice(3))):
        with session("test") as gmsh:
            build(gmsh.model.occ)
            gmsh.model.occ.synchronize()
            gmsh.write(str(tmp_path / "body.step"))
        mesh = ms.mesh.mid_surface(tmp_path / "body.step", size=3e-3)
        off = np.abs(np.linalg.norm(mesh.points[:, axes], axis=1) - 10e-3).max()
        print(f"{build.__name__}: {len(mesh.elements)} elements, off {off:.1e} m; {mesh.origin.changes}")
        assert off < 1e-9
        assert mesh.origin.thickness == pytest.approx(1e-3, rel=1e-9)
        assert mesh.origin.changes[0] == "the mid-surface of a solid 1 mm thick"


@needs
def test_a_curved_skin(tmp_path):
    """Triangles of the outer side, moved inward; second order by the thickness of the elements."""
    errors = []
    for n in (12, 24):
        file = written(tmp_path / "arch.stl", *arch(cells=(n, n // 2)))
        mesh = ms.mesh.mid_surface(file, unit="mm")
        errors.append(np.abs(np.hypot(mesh.points[:, 0], mesh.points[:, 2]) - 10e-3).max())
        assert mesh.origin.thickness == pytest.approx(1e-3, rel=1e-2)
        outward = np.cross(*(mesh.points[mesh.elements[:, k]] - mesh.points[mesh.elements[:, 0]] for k in (1, 2)))
        assert ((outward * mesh.points[mesh.elements[:, 0]])[:, [0, 2]].sum(axis=1) > 0).all()
    print(f"off the cylinder by {errors} m")
    assert errors[1] < 1e-5
    assert errors[1] < 0.4 * errors[0]
    with pytest.raises(InputError, match=r"^size: arch\.stl is a curved sheet of triangles"):
        ms.mesh.mid_surface(file, size=1e-3, unit="mm")


@needs
def test_an_angle_of_sheet(tmp_path):
    """Both legs halfway, up to the bend."""
    mesh = ms.mesh.mid_surface(written(tmp_path / "angle.stl", *angle()), unit="mm")
    x = 1e3 * mesh.points
    off = np.minimum(np.abs(x[:, 2] - 0.5), np.abs(x[:, 0] - 9.5)).max()
    print(f"off the legs by {off:.1e} mm")
    assert off < 1e-9
    assert mesh.origin.thickness == pytest.approx(1e-3, rel=1e-9)


@needs
def test_tetrahedra_and_hexahedra(tmp_path):
    import meshio

    x, y, z = np.meshgrid(np.arange(5.0), np.arange(4.0), np.arange(3.0) * 0.25, indexing="ij")
    points = np.stack([x, y, z], 3).reshape(-1, 3)
    number = np.arange(60).reshape(5, 4, 3)
    corner = number[:-1, :-1, :-1].ravel()[:, None]
    cubes = corner + np.array([0, 12, 15, 3, 1, 13, 16, 4])
    ways = [
        np.cumsum([0, *(steps[axis] for axis in order)]) for order in permutations(range(3)) for steps in [(12, 3, 1)]
    ]
    tets = np.concatenate([corner + way for way in ways])
    for name, kind, cells in (("cubes.vtu", "hexahedron", cubes), ("tets.msh", "tetra", tets)):
        how = {"file_format": "gmsh22", "binary": False} if name.endswith(".msh") else {}
        meshio.Mesh(points, [(kind, cells)]).write(tmp_path / name, **how)
        mesh = ms.mesh.mid_surface(tmp_path / name, size=1e-3, unit="mm")
        assert mesh.origin.thickness == pytest.approx(0.5e-3, rel=1e-12)
        assert np.abs(mesh.points[:, 2] - 0.25e-3).max() < 1e-12
        assert area(mesh) == pytest.approx(12e-6, rel=1e-12)


def on_the_boss(x, y):
    return abs(x - 10) <= 1 and abs(y - 4) <= 1


REFUSED = {
    "step": (plate(thickness=lambda x, y: 1 + 0.3 * (x > 10)), r"varies: 1.* mm at most places, 1.* mm at \(\d"),
    "wedge": (plate(thickness=lambda x, y: 1 + 0.01 * x), r"varies: 1\.1 mm at most places, 1 mm at \(0\.0"),
    "boss": (plate(thickness=lambda x, y: 1.0 + on_the_boss(x, y)), r"varies: 1 mm at most places, .* mm at \(\d"),
    "rounded": (rounded_plate(), r"is more than a sheet of thickness 1 mm: its volume is .* slanted edge at \("),
    "cube": (box(1, 1, 1), "no two opposite sides can be told from each other, as at"),
    "bar": (box(20, 1, 1), "no two opposite sides can be told from each other, as at"),
    "ball": (sphere(), "no two opposite sides|its thickness varies"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_bodies_without_a_mid_surface(what):
    (points, triangles), message = REFUSED[what]
    with pytest.raises(InputError, match=f"^{what}: .*{message}"):
        sides_of(skin_from(points, triangles, what), None, what)


def test_skins_in_any_sense_and_open_ones():
    points, triangles = plate()
    for given in (
        triangles,
        triangles[:, ::-1],
        np.where(np.arange(len(triangles))[:, None] % 3, triangles, triangles[:, ::-1]),
    ):
        skin = skin_from(points, given, "plate")
        assert skin.volume == pytest.approx(160)
        sides = sides_of(skin, None, "plate")
        assert (sides.thickness, sides.least, sides.greatest) == pytest.approx((1, 1, 1))
        assert skin.normals[sides.upper][:, 2] == pytest.approx(1)
    with pytest.raises(
        InputError, match=r"^plate: is not the closed skin of a solid: the edge at \(.*\) has one triangle"
    ):
        skin_from(points, triangles[1:], "plate")


@needs
def test_files_that_hold_no_solid(tmp_path):
    with session("test") as gmsh:
        gmsh.model.occ.addRectangle(0, 0, 0, 2, 1)
        gmsh.model.occ.synchronize()
        gmsh.write(str(tmp_path / "sheet.step"))
    with pytest.raises(InputError, match=r"sheet\.step: holds no solid; if it is a surface"):
        ms.mesh.mid_surface(tmp_path / "sheet.step")
    with pytest.raises(InputError, match=r"plate\.step says itself in which unit"):
        ms.mesh.mid_surface(DATA / "plate.step", unit="mm")
    with pytest.raises(InputError, match="unit: is missing"):
        ms.mesh.mid_surface(DATA / "plate_skin.stl")
