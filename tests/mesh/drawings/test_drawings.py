"""Outlines of drawings become meshes: true curves, holes, layers as groups, lengths by their units."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError

from .sheets import SQUARE, area, dxf, lines, needs_drawings, normals

pytestmark = needs_drawings


def paddle(space, document):
    """A plate with a round end and a hole, a magnet across it, and a line along the end that is clamped."""
    on = {"layer": "plate"}
    space.add_line((0, 0), (30, 0), dxfattribs=on)
    space.add_arc((30, 6), 6, -90, 90, dxfattribs=on)
    space.add_line((0, 12), (30, 12), dxfattribs=on)
    space.add_line((0, 12), (0, 0), dxfattribs=on)
    space.add_circle((30, 6), 2, dxfattribs=on)
    corners = [(12, 0), (20, 0), (20, 12), (12, 12)]
    space.add_lwpolyline(corners, close=True, dxfattribs={"layer": "magnet"})
    space.add_line((0, 3), (0, 9), dxfattribs={"layer": "root"})
    space.add_text("part 7", dxfattribs={"layer": "notes"})


def slit(space, document):
    """A sheet with a slit inside, one in from the rim that another crosses, and a line beside the sheet."""
    space.add_lwpolyline([(0, 0), (40, 0), (40, 20), (0, 20)], close=True, dxfattribs={"layer": "sheet"})
    for one, other in (((4, 10), (10, 10)), ((20, 0), (20, 12)), ((16, 6), (26, 6)), ((50, 0), (50, 9))):
        space.add_line(one, other, dxfattribs={"layer": "slit"})


def test_a_layer_of_cuts(tmp_path):
    """Kirigami: the lines are opened, but for their ends inside the sheet."""
    file = dxf(tmp_path / "kirigami.dxf", slit)
    mesh = ms.mesh.from_drawing(file, size=2e-3, cuts=["slit"])
    assert mesh.cuts == ("slit",)
    assert area(mesh) == pytest.approx(800e-6, rel=1e-12)
    assert len(mesh.parts) == 1

    def nodes_at(x, y):
        return int((np.linalg.norm(mesh.points - [1e-3 * x, 1e-3 * y, 0], axis=1) < 1e-9).sum())

    ends = [(4, 10), (10, 10), (20, 12), (16, 6), (26, 6)]
    assert [nodes_at(*place) for place in (*ends, (20, 0), (20, 6))] == [1, 1, 1, 1, 1, 2, 4]
    lips = mesh.edge_groups["slit"]
    length = np.linalg.norm(mesh.points[lips[:, 1]] - mesh.points[lips[:, 0]], axis=1).sum()
    assert length == pytest.approx(2 * (6 + 12 + 10) * 1e-3)
    with pytest.raises(
        InputError, match=r"layer 'slit': an outline is open: .* if the sheet is cut along it.*\[\"slit\"\]"
    ):
        ms.mesh.from_drawing(file, size=2e-3)
    with pytest.raises(InputError, match="cuts: there is no edge group 'sheet'"):
        ms.mesh.from_drawing(file, size=2e-3, cuts=["slit", "sheet"])


def test_a_dxf_with_a_hole_and_layers(tmp_path):
    mesh = ms.mesh.from_drawing(dxf(tmp_path / "paddle.dxf", paddle), size=1.5e-3)
    assert mesh.groups == ["plate", "magnet", "plate-edges", "magnet-edges", "hole-1", "root"]
    assert (normals(mesh) > 0).all()
    hole = 1e3 * mesh.points[mesh.nodes_of("hole-1"), :2]
    assert np.abs(np.hypot(*(hole - (30, 6)).T) - 2).max() < 1e-9
    whole = 360 + 18 * np.pi - 4 * np.pi
    print(f"area off by {1e6 * area(mesh) / whole - 1:.1e}")
    assert area(mesh) == pytest.approx(1e-6 * whole, rel=1e-4)
    assert area(mesh, mesh.elements_of("magnet")) == pytest.approx(96e-6, rel=1e-12)
    assert len(mesh.elements_of("plate")) + len(mesh.elements_of("magnet")) == len(mesh.elements)
    root = mesh.points[mesh.nodes_of("root")]
    assert np.abs(root[:, 0]).max() == 0.0
    assert (root[:, 1].min(), root[:, 1].max()) == pytest.approx((3e-3, 9e-3))
    said = "; ".join(mesh.origin.changes)
    assert "lengths are in mm, as it says" in said
    assert "left out: 1 TEXT" in said
    assert "'magnet' inside of others: areas of the sheet" in said


SVG = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"
 width="{width}" height="20mm" viewBox="0 0 80 40">
<g inkscape:groupmode="layer" inkscape:label="plate" id="layer1" transform="translate(2,0)">
<path d="M 0 0 H 60 V 40 H 0 Z M 20 20 a 6 6 0 1 0 12 0 a 6 6 0 1 0 -12 0 Z"/>
<circle cx="50" cy="20" r="3" style="display:none"/><text x="3" y="3">part 7</text></g>
<g id="magnet"><rect x="40" y="4" width="16" height="8"/></g></svg>"""


@pytest.mark.parametrize(
    ("width", "unit", "millimetres", "said"),
    [
        ("40mm", None, 0.5, "as it says, each 0.5 mm"),
        ("80px", None, 25.4 / 96, "in px, as it says, each 0.264583 mm"),
        ("40mm", "cm", 10.0, "in cm, as unit says; the drawing says mm (0.5 mm)"),
    ],
)
def test_an_svg_in_its_unit_or_in_another(width, unit, millimetres, said, tmp_path):
    file = tmp_path / "part.svg"
    file.write_text(SVG.format(width=width).replace("20mm", "40px" if width.endswith("px") else "20mm"))
    mesh = ms.mesh.from_drawing(file, unit=unit)
    assert said in mesh.origin.changes[0]
    scale = 1e-3 * millimetres
    low, high = mesh.points.min(axis=0) / scale, mesh.points.max(axis=0) / scale
    assert np.allclose((low[0], high[0], low[1], high[1]), (2, 62, 0, 40), atol=1e-6)
    assert area(mesh, mesh.elements_of("magnet")) / scale**2 == pytest.approx(128, rel=1e-6)
    assert area(mesh) / scale**2 == pytest.approx(2400 - 36 * np.pi, rel=1e-4)
    magnet = mesh.points[mesh.nodes_of("magnet")] / scale
    assert magnet[:, 1].max() == pytest.approx(36, abs=1e-6), "y of an SVG points down"
    hole = mesh.points[mesh.nodes_of("hole-1"), :2] / scale
    assert np.abs(np.hypot(*(hole - (28, 20)).T) - 6).max() < 1e-5


def test_clones_of_an_svg_are_drawn_where_they_are_placed(tmp_path):
    file = tmp_path / "clones.svg"
    file.write_text(
        """<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
 width="40mm" height="20mm" viewBox="0 0 40 20"><defs><circle id="hole" r="2"/></defs>
<rect width="40" height="20"/><use xlink:href="#hole" x="10" y="10"/><use href="#hole" x="30" y="10"/></svg>"""
    )
    mesh = ms.mesh.from_drawing(file, size=3e-3)
    assert {"hole-1", "hole-2"} < set(mesh.groups)
    assert area(mesh) == pytest.approx((800 - 8 * np.pi) * 1e-6, rel=1e-4)


def test_polygons_of_a_table(tmp_path):
    file = tmp_path / "frame.csv"
    file.write_text("x1 [mm];x2\n0;0\n20;0\n20;10\n0;10\n\n5;2,5\n15;2,5\n15;7,5\n5;7,5\n5;2,5\n")
    mesh = ms.mesh.from_drawing(file)
    assert area(mesh) == pytest.approx(150e-6, rel=1e-12)
    assert mesh.groups == ["outline", "outline-edges", "hole-1"]
    assert len(mesh.elements) > 400


def test_a_polygon():
    mesh = ms.mesh.polygon(1e-3 * np.array([(0, 0), (20, 0), (20, 6), (6, 6), (6, 20), (0, 20)]), size=2e-3)
    assert mesh.groups == [f"side-{k}" for k in range(1, 7)]
    assert area(mesh) == pytest.approx(204e-6, rel=1e-12)
    assert (normals(mesh) > 0).all()
    assert np.abs(mesh.points[mesh.nodes_of("side-6"), 0]).max() == 0.0
    clockwise = ms.mesh.polygon([(0, 0), (0, 1), (2, 1), (2, 0)], 0.3, holes=[[(0.5, 0.2), (1, 0.2), (1, 0.8)]])
    assert (normals(clockwise) > 0).all()
    assert area(clockwise) == pytest.approx(2 - 0.15, rel=1e-12)
    assert clockwise.points[clockwise.nodes_of("side-1"), 0].max() == 0.0


def test_short_lines_in_a_row_are_a_curve(tmp_path):
    """200 corners on a circle, a tenth of an element apart, do not make tiny elements."""
    turn = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    ring = [(10 + 5 * np.cos(t), 10 + 5 * np.sin(t)) for t in turn]
    text = "".join(f"{x!r},{y!r}\n" for x, y in ring) + "\n0,0\n30,0\n30,20\n0,20\n"
    (tmp_path / "ring.csv").write_text(text.replace("np.float64(", "").replace(")", ""))
    mesh = ms.mesh.from_drawing(tmp_path / "ring.csv", size=1.5e-3, unit="mm")
    assert len(mesh.elements) < 500
    hole = 1e3 * mesh.points[mesh.nodes_of("hole-1"), :2]
    off = np.abs(np.hypot(*(hole - 10).T) - 5).max()
    print(f"off the circle {off:.1e} mm; its chords are off by {5 * (1 - np.cos(np.pi / 200)):.1e} mm")
    assert off < 5 * (1 - np.cos(np.pi / 200))
    assert any("200 lines shorter than an element" in change for change in mesh.origin.changes)


def block(space, document):
    """A square with two circles of a block, one at half its size."""
    document.blocks.new("B").add_circle((0, 0), 1)
    for place, scale in (((3, 3), 1), ((7, 7), 0.5)):
        space.add_blockref("B", place, dxfattribs={"layer": "cut", "xscale": scale, "yscale": scale, "zscale": scale})
    lines(space, SQUARE)


ADDED = {"layer": "cut"}
WAYS = {
    "lines and a drilled layer": (
        lambda space, _: (lines(space, SQUARE), space.add_circle((5, 5), 2, dxfattribs={"layer": "drill"})),
        {"holes": ["drill"]}, 100 - 4 * np.pi, ["cut", "cut-edges", "drill", "hole-1"],
    ),
    "one side on another layer": (
        lambda space, _: (lines(space, SQUARE, closed=False), lines(space, [(0, 10), (0, 0)], "clamp", False)),
        {}, 100, ["cut", "cut-edges", "clamp"],
    ),
    "side by side, a layer each": (
        lambda space, _: (lines(space, SQUARE), lines(space, [(10, 0), (20, 0), (20, 10), (10, 10)], "b")),
        {}, 200, ["cut", "b", "cut-edges", "b-edges"],
    ),
    "side by side, one layer": (
        lambda space, _: [
            space.add_lwpolyline(corners, close=True, dxfattribs=ADDED)
            for corners in (SQUARE, [(10, 0), (20, 0), (20, 10), (10, 10)])
        ],
        {}, 200, ["cut", "cut-edges"],
    ),
    "a hole, then an area": (
        lambda space, _: (lines(space, SQUARE), space.add_circle((3, 5), 2, dxfattribs=ADDED),
                          lines(space, [(6, 0), (10, 0), (10, 10), (6, 10)], "tip")),
        {}, 100 - 4 * np.pi, ["cut", "tip", "cut-edges", "tip-edges", "hole-1"],
    ),
    "an island in a hole": (
        lambda space, _: [lines(space, [(x, y) for x, y in [(a, a), (10 - a, a), (10 - a, 10 - a), (a, 10 - a)]])
                          for a in (0, 2, 4)],
        {}, 68, ["cut", "cut-edges", "hole-1"],
    ),
    "a notch": (
        lambda space, _: (lines(space, SQUARE),
                          space.add_lwpolyline([(4, 0), (6, 0), (6, 4), (4, 4)], close=True, dxfattribs=ADDED)),
        {}, 92, ["cut", "cut-edges", "hole-1"],
    ),
    "drawn twice": (lambda space, _: [lines(space, SQUARE) for _ in (1, 2)], {}, 100, ["cut", "cut-edges"]),
    "a bulge": (
        lambda space, _: space.add_lwpolyline(
            [(0, 0, 0), (10, 0, 1), (10, 10, 0), (0, 10, 0)], format="xyb", close=True, dxfattribs=ADDED),
        {}, 100 + 12.5 * np.pi, ["cut", "cut-edges"],
    ),
    "ellipses": (
        lambda space, _: [space.add_ellipse((0, 0), (a, 0), 0.5, dxfattribs=ADDED) for a in (10, 3)],
        {}, 45.5 * np.pi, ["cut", "cut-edges", "hole-1"],
    ),
    "blocks": (block, {}, 100 - 1.25 * np.pi, ["cut", "cut-edges", "hole-1", "hole-2"]),
    "a small gap": (
        lambda space, _: lines(space, [(0, 0), (10, 5e-4), (10, 10), (0, 10), (0, 1e-3)], closed=False),
        {}, 100, ["cut", "cut-edges"],
    ),
    "a wide gap that is meant": (
        lambda space, _: lines(space, [(0, 0), (10, 0), (10, 10), (0, 10), (0, 0.5)], closed=False),
        {"gap": 6e-4}, 98.75, ["cut", "cut-edges"],
    ),
    "seen from behind": (
        lambda space, _: space.add_circle((0, 0), 5, dxfattribs={"extrusion": (0, 0, -1), **ADDED}),
        {}, 25 * np.pi, ["cut", "cut-edges"],
    ),
    "inches": (lambda space, _: lines(space, [(x / 25.4, y / 25.4) for x, y in SQUARE]), {"units": 1}, 100,
               ["cut", "cut-edges"]),
}  # fmt: skip


@pytest.mark.parametrize("way", WAYS)
def test_ways_to_draw(way, tmp_path):
    draw, more, square_millimetres, groups = WAYS[way]
    more = dict(more)
    file = dxf(tmp_path / "sheet.dxf", draw, more.pop("units", 4))
    mesh = ms.mesh.from_drawing(file, size=1e-3, **more)
    print(f"{area(mesh) * 1e6:.6g} mm² for {square_millimetres:.6g}; {mesh.origin.changes}")
    assert area(mesh) == pytest.approx(1e-6 * square_millimetres, rel=2e-4)
    assert mesh.groups == groups
    assert (normals(mesh) > 0).all()


def test_what_was_done_is_told(tmp_path):
    def draw(space, document):
        lines(space, [(0, 0), (10, 5e-4), (10, 10), (0, 10), (0, 1e-3)], closed=False)
        lines(space, [(0, 10), (10, 10)], closed=False)
        space.add_spline([(3, 3, 0), (6, 3, 0), (7, 6, 0), (3, 7, 0), (3, 3, 0)], dxfattribs={"layer": "cut"})
        document.layers.add("off").off()
        lines(space, SQUARE, "off")

    said = ms.mesh.from_drawing(dxf(tmp_path / "a.dxf", draw), size=1e-3).origin.changes
    for what in (
        "1 gap between ends of lines closed, up to 0.001 mm",
        "1 line left out, drawn twice",
        "1 splines and other curves followed to within 0.0014 mm",
        "hidden lines left out: 4 on layer 'off'",
    ):
        assert any(what in change for change in said), said
