"""Geometry meshed by gmsh: quadrilaterals on the true surface, groups, units, sizes, errors in words."""

from __future__ import annotations

import builtins
import importlib.util
import pathlib
import signal

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError
from magshell.mesh.files.session import DEBIAN, session
from magshell.mesh.junctions import junctions_of
from magshell.mesh.quality import worst

from .same import described

DATA = pathlib.Path(__file__).parent / "data"
FLOWER = pathlib.Path(__file__).parents[3] / "docs" / "meshes" / "flower.geo"
TONGUE = pathlib.Path(__file__).parents[2] / "endtoend" / "tongue.geo"
needs_gmsh = pytest.mark.skipif(importlib.util.find_spec("gmsh") is None, reason="needs the extra magshell[gmsh]")


def made(tmp_path, names, build):
    """Files of a geometry that `build` makes with gmsh's OpenCASCADE kernel."""
    with session("test") as gmsh:
        build(gmsh.model.occ)
        gmsh.model.occ.synchronize()
        for name in names:
            gmsh.write(str(tmp_path / name))
    return [tmp_path / name for name in names]


def tube(occ):
    """Radius 8, length 30, without its ends."""
    solid = occ.addCylinder(0, 0, 0, 0, 0, 30, 8)
    occ.synchronize()
    surfaces = occ.getEntities(2)
    side = max(surfaces, key=lambda entity: occ.getMass(*entity))
    occ.remove([(3, solid)])
    occ.remove([entity for entity in surfaces if entity != side], recursive=True)


@pytest.fixture(scope="module")
def flower():
    return ms.mesh.from_cad(FLOWER, size=1.2e-3, unit="mm")


@needs_gmsh
def test_the_flower(flower):
    """Only good quadrilaterals; petals and rim as groups; the nodes of the rim, mid-sides too, on the circle."""
    assert flower.groups == [*(f"petal-{k}" for k in range(1, 7)), "disc", "rim"]
    assert sum(len(rows) for rows in flower.element_groups.values()) == len(flower.elements)
    assert (flower.elements[:, 2] != flower.elements[:, 3]).all()
    corner = worst(flower)["scaled_jacobian"]
    print(f"{len(flower.elements)} elements, worst corner {corner.value:.3f}")
    assert corner.value > 0.3
    rim = flower.points[flower.nodes_of("rim")]
    off = np.abs(np.hypot(rim[:, 0], rim[:, 1]) - 4e-3).max()
    print(f"rim off its circle {off:.1e} m")
    assert off < 1e-9
    assert flower.origin.changes == ()


@needs_gmsh
def test_a_flower_is_written_and_read(flower, tmp_path):
    ms.mesh.write(flower, tmp_path / "flower.msh", unit="mm")
    again = ms.mesh.read(tmp_path / "flower.msh")
    assert described(again) == described(flower)
    assert np.abs(again.points - flower.points).max() < 1e-15 * flower.size / 1e-3


@needs_gmsh
def test_step_iges_and_brep_of_one_tube(tmp_path):
    """In metres whatever the file; closed along its seam; every node on the cylinder."""
    for file, unit in zip(
        made(tmp_path, ("tube.step", "tube.iges", "tube.brep"), tube), (None, None, "mm"), strict=True
    ):
        mesh = ms.mesh.from_cad(file, size=4e-3, unit=unit)
        off = np.abs(np.hypot(mesh.points[:, 0], mesh.points[:, 1]) - 8e-3).max()
        ends = np.isin(np.round(mesh.points[mesh.boundary_edges, 2], 9), (0.0, 0.03))
        print(f"{file.name}: {len(mesh.elements)} elements, off the cylinder {off:.1e} m, {mesh.groups}")
        assert off < 1e-8
        assert ends.all()
        assert np.isclose(np.ptp(mesh.points[:, 2]), 0.03, rtol=1e-9)
        assert list(mesh.element_groups) == ["surface-1"]
        assert any(name.startswith("curve-") for name in mesh.edge_groups)


@needs_gmsh
def test_a_part_in_inches(tmp_path):
    (file,) = made(tmp_path, ["plate.step"], lambda occ: occ.addRectangle(0, 0, 0, 2, 1))
    text, millimetre = file.read_text(), "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );"
    assert text.count(millimetre) == 1
    inch = f"( CONVERSION_BASED_UNIT('INCH',#900) LENGTH_UNIT() NAMED_UNIT(#901) );\n#902 = {millimetre}\n"
    inch += "#900 = LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#902);\n"
    inch += "#901 = DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);"
    file.write_text(text.replace(millimetre, inch))
    mesh = ms.mesh.from_cad(file, size=8e-3)
    assert mesh.origin.unit == "mm"
    assert np.allclose(np.ptp(mesh.points, axis=0), (50.8e-3, 25.4e-3, 0.0), rtol=1e-12)


@needs_gmsh
def test_the_size_of_the_elements(tmp_path):
    """As asked; of the file if it says one; else about 800 elements."""
    count = {size: len(ms.mesh.from_cad(DATA / "two-plates.geo", size, "mm").elements) for size in (None, 1e-3)}
    assert count == {None: 10, 1e-3: 10}  # its divisions are its own: transfinite
    text = "SetFactory('OpenCASCADE'); Rectangle(1) = {0, 0, 0, 20, 10};"
    sizes = {}
    for name, extra, size in (
        ("asked", "", 2e-3),
        ("said", "MeshSize {1, 2, 3, 4} = 5;", None),
        ("over", "MeshSize {1, 2, 3, 4} = 5;", 2e-3),
        ("free", "", None),
    ):
        (tmp_path / f"{name}.geo").write_text(f"{text}{extra}\n")
        mesh = ms.mesh.from_cad(tmp_path / f"{name}.geo", size, "mm")
        sizes[name] = 1e3 * (20e-3 * 10e-3 / len(mesh.elements)) ** 0.5
    print(sizes)
    assert 1.2 < sizes["asked"] < 2.4
    assert 2.0 < sizes["said"] < 6.0
    assert sizes["over"] == sizes["asked"]
    assert 0.3 < sizes["free"] < 0.7


@needs_gmsh
def test_faces_that_touch_are_joined(tmp_path):
    """Two rectangles of a STEP file, each with its own edge where they meet."""
    (file,) = made(
        tmp_path, ["two.step"], lambda occ: (occ.addRectangle(0, 0, 0, 4, 2), occ.addRectangle(4, 0, 0, 2, 2))
    )
    mesh = ms.mesh.from_cad(file, size=1e-3)
    assert len(mesh.parts) == 1
    assert np.isclose(mesh.points[mesh.boundary_edges[:, :2]].max(), 6e-3)


@needs_gmsh
def test_what_cannot_be_meshed(tmp_path):
    cases = {
        "box.geo": ("SetFactory('OpenCASCADE'); Box(1) = {0, 0, 0, 1, 1, 1};", r"holds 1 solid\(s\).*mid-surface"),
        "points.geo": ("Point(1) = {0, 0, 0};", "has no surface that could be meshed"),
        "wrong.geo": (
            "Point(1) = {0, 0, 0\nLine(1) = {1, 7};",
            r"wrong.geo: gmsh cannot do it: line 2: syntax error",
        ),
        "apart.geo": (
            "SetFactory('OpenCASCADE'); Rectangle(1) = {0, 0, 0, 4, 2}; Rectangle(2) = {4, 0, 0, 2, 2};",
            "apart.geo: Elements .*Coherence",
        ),
        "ended.geo": (
            "SetFactory('OpenCASCADE'); Rectangle(1) = {0, 0, 0, 4, 2};\nExit;",
            "ended.geo: ends gmsh .* Exit",
        ),
        "empty.step": ("", r"empty.step: .*"),
        "damaged.step": ("ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\n#1=CART", r"damaged.step: .*"),
        "part.txt": ("", "part.txt: is not a geometry"),
    }
    for name, (text, message) in cases.items():
        (tmp_path / name).write_text(text)
        unit = "mm" if name.endswith(".geo") else None
        with pytest.raises(InputError, match=message):
            ms.mesh.from_cad(tmp_path / name, size=0.5e-3, unit=unit)
    with pytest.raises(InputError, match=r"there is no such file. Did you mean 'box.geo'"):
        ms.mesh.from_cad(tmp_path / "bax.geo", unit="mm")
    with pytest.raises(InputError, match=r"unit: is missing: box.geo"):
        ms.mesh.from_cad(tmp_path / "box.geo")
    with pytest.raises(InputError, match=r"unit: empty.step says itself in which unit its lengths are"):
        ms.mesh.from_cad(tmp_path / "empty.step", unit="inch")
    with pytest.raises(InputError, match=r"size: 1e-05 mm makes 2.8e\+12 elements; .* give at least 0.017 mm$"):
        ms.mesh.from_cad(FLOWER, size=1e-8, unit="mm")
    (tmp_path / "plate.geo").write_text("SetFactory('OpenCASCADE'); Rectangle(1) = {0, 0, 0, 2, 1};")
    with pytest.raises(InputError, match=r"give at least 0.0015 mm$"):  # the root of 2e-6 is 0.00141
        ms.mesh.from_cad(tmp_path / "plate.geo", size=1e-8, unit="mm")
    with pytest.raises(InputError, match=r"size = -1.0 is not allowed"):
        ms.mesh.from_cad(tmp_path / "box.geo", size=-1.0, unit="mm")


@needs_gmsh
@pytest.mark.parametrize("end", ["", "\n"])
def test_a_script_and_what_it_includes(tmp_path, end):
    """The last line counts, also without an end; other files are sought beside the script."""
    (tmp_path / "sizes ä.geo").write_text(f"w = 4;{end}", "utf-8")
    (tmp_path / "part ä.geo").write_text(
        "SetFactory('OpenCASCADE');\nInclude \"sizes ä.geo\";\nRectangle(1) = {0, 0, 0, w, 2}; "
        f"Physical Surface('all') = {{1}};{end}",
        "utf-8",
    )
    mesh = ms.mesh.from_cad(tmp_path / "part ä.geo", 1e-3, "mm")
    assert mesh.groups == ["all"]
    assert np.allclose(np.ptp(mesh.points, axis=0), (4e-3, 2e-3, 0.0))


@needs_gmsh
def test_gmsh_is_called_in_another_process(tmp_path, capfd):
    """So it leaves no trace in this one: no word, no signal's handler; and who uses it here is not disturbed."""
    import gmsh

    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGPIPE)]
    (tmp_path / "wrong.geo").write_text("Line(1) = {1, 7};")
    assert len(ms.mesh.from_cad(TONGUE, size=2e-3, unit="mm").elements)
    with pytest.raises(InputError):
        ms.mesh.from_cad(tmp_path / "wrong.geo", unit="mm")
    assert tuple(capfd.readouterr()) == ("", "")
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGPIPE)] == before
    assert not gmsh.isInitialized()
    with session("test"):
        gmsh.model.add("of somebody else")
        assert len(ms.mesh.from_cad(TONGUE, size=2e-3, unit="mm").elements)
        assert gmsh.model.getCurrent() == "of somebody else"


def test_without_gmsh(monkeypatch):
    """The extra is named; and the packages, if the wheel is there but its libraries are not."""
    monkeypatch.setattr("magshell.mesh.files.session.find_spec", lambda name: None)
    with pytest.raises(InputError, match=r'flower.geo: needs gmsh.*pip install "magshell\[gmsh\]"'):
        ms.mesh.from_cad(FLOWER, unit="mm")
    real = builtins.__import__

    def refuse(name, *rest):
        if name == "gmsh":
            raise OSError("libGLU.so.1: cannot open")
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", refuse)
    with pytest.raises(InputError, match=rf"does not load \(libGLU.so.1.*apt-get install {DEBIAN}"), session("a.geo"):
        pass


def test_a_geometry_is_not_read_as_a_mesh():
    with pytest.raises(InputError, match=r"flower.geo: is a geometry, not a mesh. Mesh it first: magshell mesh"):
        ms.mesh.read(FLOWER, unit="mm")


@needs_gmsh
@pytest.mark.parametrize("size", [0.8e-3, 1.2e-3, 1.6e-3])
def test_a_round_tip_has_no_bad_corners(size):
    """Where a quadrilateral would fill half a turn of a smooth boundary, two triangles do."""
    tongue = ms.mesh.from_cad(TONGUE, size=size, unit="mm")
    corner = worst(tongue)["scaled_jacobian"]
    print(f"{len(tongue.elements)} elements, {tongue.triangles.sum()} triangles, worst corner {corner.value:.3f}")
    assert corner.value > 0.3
    assert tongue.triangles.mean() < 0.2
    cut = [change for change in tongue.origin.changes if "cut into triangles" in change]
    assert bool(cut) == tongue.triangles.any()


RIB = """
SetFactory("OpenCASCADE");
Rectangle(1) = {0, 0, 0, 20, 10};
Rectangle(2) = {0, 0, 0, 10, 5};
Rotate {{1, 0, 0}, {0, 0, 0}, Pi/2} { Surface{2}; }
Translate {5, 5, 0} { Surface{2}; }
Coherence;
Physical Surface("plate") = {1, 3};
Physical Surface("rib") = {2};
"""


@needs_gmsh
def test_a_rib_on_a_plate(tmp_path):
    """Joined by gmsh along the foot of the rib; not joined, it is refused with the way out."""
    file = tmp_path / "rib.geo"
    file.write_text(RIB)
    mesh = ms.mesh.from_cad(file, size=2.5e-3, unit="mm")
    (joint,) = junctions_of(mesh).joints
    assert len(mesh.parts) == 1
    ends = mesh.points[[joint.edges[0, 0], joint.edges[-1, 1]]]
    assert np.abs(np.sort(ends[:, 0]) - [5e-3, 15e-3]).max() < 1e-12
    file.write_text(RIB.replace("Coherence;", "").replace("{1, 3}", "{1}"))
    with pytest.raises(InputError, match=r"rib.geo: Elements \d+ and \d+ are not joined: node .*T-joint.*Coherence"):
        ms.mesh.from_cad(file, size=2.5e-3, unit="mm")


@needs_gmsh
def test_a_box_with_a_wall_inside(tmp_path):
    """From BREP, where faces that touch are joined by magshell; three sheets at each edge of the wall."""

    def build(occ):
        for z in (0, 5):
            occ.addRectangle(0, 0, z, 20, 10)
        for y in (0, 4, 10):
            wall = occ.addRectangle(0, 0, 0, 20, 5)
            occ.rotate([(2, wall)], 0, 0, 0, 1, 0, 0, np.pi / 2)
            occ.translate([(2, wall)], 0, y, 0)

    (file,) = made(tmp_path, ["box.brep"], build)
    mesh = ms.mesh.from_cad(file, size=5e-3, unit="mm")
    found = junctions_of(mesh)
    assert len(mesh.parts) == 1
    assert (len(found.kinks), len(found.joints)) == (4, 2)
    assert all(abs(np.degrees(line.angle) - 90).max() < 1e-6 for line in found.kinks)
