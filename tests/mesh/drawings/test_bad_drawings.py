"""What is wrong with a drawing is said with its layer and place."""

from __future__ import annotations

import importlib

import numpy as np
import pytest
from files.same import attempted
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import magshell as ms
from magshell.errors import InputError
from magshell.mesh.drawings.table import read_table

from .sheets import SQUARE, dxf, lines, needs_drawings

WRONG = {
    "open": (lambda s: lines(s, SQUARE, closed=False),
             r"layer 'cut': an outline is open: it begins at \(0, 0\) and ends at \(0, 10\) mm. Close it$"),
    "gap": (lambda s: lines(s, [*SQUARE, (0, 0.5)], closed=False),
            r"ends at \(0, 0.5\) mm. Close it, or let gaps be closed: gap = \"0.53 mm\""),
    "crossing itself": (lambda s: lines(s, [(0, 0), (10, 10), (10, 0), (0, 10)]),
                        r"layer 'cut': an outline crosses or touches itself at \(5, 5\) mm"),
    "crossing another": (lambda s: (lines(s, SQUARE), lines(s, [(5, 5), (15, 5), (15, 8), (5, 8)], "b")),
                         r"layers 'cut' and 'b': two outlines cross at \(10, [58]\) mm"),
    "crossing another of the same layer": (lambda s: (lines(s, SQUARE), lines(s, [(5, 5), (15, 5), (15, 8), (5, 8)])),
                                           r"(?<=dxf: )layer 'cut': two outlines cross at \(10, [58]\) mm"),
    "only text": (lambda s: s.add_text("a"), "draws no lines; entities that are no lines left out: 1 TEXT$"),
    "nothing": (lambda s: None, "draws no lines$"),
    "no length": (lambda s: s.add_line((1, 1), (1, 1)), "none of its lines has a length"),
    "no area": (lambda s: (lines(s, SQUARE), s.add_lwpolyline([(2, 2), (4, 2), (2, 2)], close=True)),
                r"layer '0': an outline crosses or touches itself at \(2, 2\) mm"),
    "branches": (lambda s: (lines(s, SQUARE), lines(s, [(0, 0), (5, 5)], closed=False)),
                 r"layer 'cut': 3 lines meet at \(0, 0\) mm. An outline has no branches"),
    "line inside": (lambda s: (lines(s, SQUARE), lines(s, [(2, 2), (5, 5)], "fold", False)),
                    r"layer 'fold': an outline is open: it begins at \(2, 2\)"),
    "not flat": (lambda s: lines(s, [(0, 0, 0), (10, 0, 0), (10, 10, 5), (0, 10, 5)]),
                 "is not flat: it has lines at z = 0 on layer 'cut' and at z = 5 on layer 'cut'"),
}  # fmt: skip


@needs_drawings
@pytest.mark.parametrize("what", WRONG)
def test_outlines_that_are_none(what, tmp_path):
    draw, message = WRONG[what]
    with pytest.raises(InputError, match=r"^a\.dxf: .*" + message):
        ms.mesh.from_drawing(dxf(tmp_path / "a.dxf", lambda space, _: draw(space)), size=2e-3)


@needs_drawings
def test_units_layers_and_sizes(tmp_path):
    file = dxf(tmp_path / "a.dxf", lambda space, _: lines(space, SQUARE), units=0)
    with pytest.raises(InputError, match=r"^unit: is missing: a\.dxf does not say"):
        ms.mesh.from_drawing(file)
    with pytest.raises(InputError, match="'mile' is not a unit of length"):
        ms.mesh.from_drawing(file, unit="mile")
    with pytest.raises(InputError, match=r"there is no layer 'cot' with lines\. Did you mean 'cut'"):
        ms.mesh.from_drawing(file, unit="mm", holes=["cot"])
    with pytest.raises(InputError, match="draws nothing but holes"):
        ms.mesh.from_drawing(file, unit="mm", holes=["cut"])
    with pytest.raises(InputError, match="size = -1 is not allowed"):
        ms.mesh.from_drawing(file, size=-1, unit="mm")
    with pytest.raises(InputError, match=r"size: 1e-05 mm makes 1e\+12 elements"):
        ms.mesh.from_drawing(file, size=1e-8, unit="mm")


@needs_drawings
@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.dxf", "hello\nthere", "a.dxf: is not a DXF file, or a damaged one"),
        ("a.svg", "<svg><g>", "a.svg, line 1: is not an SVG file"),
        (
            "a.svg",
            "<svg xmlns='http://www.w3.org/2000/svg'><text>a</text></svg>",
            "a.svg: draws no lines; elements that are no lines left out: 1 text",
        ),
        ("a.csv", "", "a.csv: draws no lines"),
        ("a.csv", "1,2\n3,4\n", "a.csv, line 1: the polygon has 2 corners; it needs three or more"),
        ("a.csv", "1,2\n3,nan\n", "a.csv, line 2: 'nan' is not a coordinate"),
        ("a.csv", "x1 [mile],x2\n", "a.csv, line 1: 'mile' is not a unit of length"),
        ("a.csv", "1\n", "a.csv, line 1: has 1 fields; expected x1, x2"),
        ("a.pdf", "", "a.pdf: is not a drawing; these are: .dxf, .svg, .csv"),
    ],
)
def test_files_that_are_no_drawings(name, text, message, tmp_path):
    (tmp_path / name).write_text(text)
    with pytest.raises(InputError, match=f"^{message}"):
        ms.mesh.from_drawing(tmp_path / name, unit="mm")


@pytest.mark.parametrize(("name", "package"), [("a.dxf", "ezdxf"), ("a.svg", "svgelements"), ("a.csv", "shapely")])
def test_packages_that_are_missing(name, package, tmp_path, monkeypatch):
    (tmp_path / name).write_text("")
    reading = importlib.import_module("magshell.mesh.drawings.reading")
    monkeypatch.setattr(reading, "find_spec", lambda wanted: None if wanted == package else True)
    monkeypatch.setattr(reading, "required", lambda name: None)
    with pytest.raises(
        InputError, match=rf'needs {package}, which is not installed: pip install "magshell\[drawings\]"'
    ):
        ms.mesh.from_drawing(tmp_path / name, unit="mm")


@needs_drawings
def test_polygons_that_are_none():
    for corners, holes, message in (
        ([(0, 0), (1, 0)], (), "polygon: corners: the polygon has 2 corners"),
        ([(0, 0, 0), (1, 0, 0), (0, 1, 0)], (), "polygon: corners: are pairs of finite coordinates"),
        ([(0, 0), (1, 1), (1, 0), (0, 1)], (), "polygon: an outline crosses or touches itself at"),
        ([(0, 0), (1, 0), (1, 1)], [[(2, 0), (3, 0), (3, 1)]], "polygon: a hole lies outside"),
        ([(0, 0), (1, 0), (1, 1)], [[(0.5, 0.1), (1.5, 0.1), (1.5, 0.2)]], "polygon: layers .*|polygon: two outlines"),
    ):
        with pytest.raises(InputError, match=message):
            ms.mesh.polygon(corners, 0.2, holes)


@settings(max_examples=200, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.text(alphabet="0123456789.,;\t -+eE\nx[m]#naif", max_size=80))
def test_any_table_is_read_or_refused(tmp_path, text):
    (tmp_path / "a.csv").write_text(text)
    drawing, said = attempted(lambda: read_table(tmp_path / "a.csv", "a.csv"))
    assert said.startswith("a.csv") if drawing is None else all(piece.line for piece in drawing.pieces)


@needs_drawings
@pytest.mark.parametrize("size", ["", 'width="100%" height="100%"'])
def test_an_svg_without_a_size_has_no_unit(size, tmp_path):
    """Such a file is in whatever its program takes for a pixel, 1/72 or 1/96 inch."""
    file = tmp_path / "a.svg"
    file.write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 40 20"><rect width="20" height="10"/></svg>'
    )
    with pytest.raises(InputError, match=r"^unit: is missing: a\.svg does not say"):
        ms.mesh.from_drawing(file)
    assert np.ptp(ms.mesh.from_drawing(file, unit="mm").points, axis=0) == pytest.approx((20e-3, 10e-3, 0.0))
