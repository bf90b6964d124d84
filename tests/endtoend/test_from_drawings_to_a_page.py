"""From a DXF, an SVG and the STL of a plate, named in a problem file, to a page; then on a machine without gmsh."""

from __future__ import annotations

import importlib.util
import json
import shutil
from pathlib import Path

import pytest

import magshell as ms
from magshell.cli import main
from magshell.errors import InputError
from magshell.problem import copies

from .test_from_cad_to_browser import magshell

NEEDED = ("gmsh", "ezdxf", "svgelements", "shapely", "meshio")
PROBLEM = Path(__file__).with_name("drawn.toml")
PLATE = Path(__file__).parents[1] / "mesh" / "solids" / "data" / "plate_skin.stl"
SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="20mm" viewBox="0 0 80 40">
<g id="sheet"><path d="M 0 0 H 40 V 16 H 0 Z M 16 8 a 4 4 0 1 0 8 0 a 4 4 0 1 0 -8 0 Z"
 transform="translate(0,24)"/></g>
</svg>"""


def draw_dxf(file: Path) -> str:
    """A plate with a hole on one layer, a magnet on another."""
    import ezdxf

    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    for corners, layer in (
        ([(0, 0), (20, 0), (20, 8), (0, 8)], "plate"),
        ([(13, 0), (20, 0), (20, 8), (13, 8)], "tip"),
    ):
        space.add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
    space.add_circle((7, 4), 2, dxfattribs={"layer": "plate"})
    document.saveas(file)
    return ""


def draw_svg(file: Path) -> str:
    file.write_text(SVG)
    return ""


def copy_plate(file: Path) -> str:
    shutil.copy(PLATE, file)
    return 'unit = "mm"\nmid_surface = true\n'


WAYS = {
    "sheet.dxf": (draw_dxf, "plate, tip, plate-edges, tip-edges, hole-1, end", '["20 mm", 0, 0]'),
    "sheet.svg": (draw_svg, "sheet, sheet-edges, hole-1, end", '["20 mm", 0, 0]'),
    "plate.stl": (copy_plate, "the mid-surface of a solid 2 mm thick", '["20 mm", 0, "1 mm"]'),
}
LONG = ("sheet.svg", "plate.stl")
"""The whole way of these is a part of `make verify`."""


def write_case(name, folder):
    """Draw, and write the problem; words that `magshell check` says of it."""
    for package in NEEDED:
        pytest.importorskip(package, reason=f"{package} is not installed", exc_type=(ImportError, OSError))
    draw, said, tip = WAYS[name]
    more = draw(folder / name)
    text = PROBLEM.read_text().replace('"FILE"\n', f'"{name}"\n{more}')
    text = text.replace('["20 mm", 0, 0]', tip) if name.endswith(".stl") else text
    (folder / "case.toml").write_text(text)
    return said


@pytest.mark.parametrize("name", LONG)
def test_a_check(name, tmp_path, monkeypatch, capsys):
    """The small twin of the whole way."""
    said = write_case(name, tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["check", "case.toml"]) == 0
    told = capsys.readouterr().out
    assert said in told
    assert "warning" not in told


@pytest.mark.parametrize("name", ["sheet.dxf", *(pytest.param(name, marks=pytest.mark.verify) for name in LONG)])
def test_the_whole_way(name, tmp_path, monkeypatch):
    said = write_case(name, tmp_path)
    told = magshell(tmp_path, "check", "case.toml")
    assert said in told
    assert "warning" not in told
    magshell(tmp_path, "run", "case.toml", "--out", "results")
    summary = json.loads((tmp_path / "results" / "summary.json").read_text())
    assert summary["converged"]
    assert abs(summary["probes"]["tip"][2]) > 1e-3
    magshell(tmp_path, "view", "results")
    assert (tmp_path / "results" / "view.html").stat().st_size > 100_000

    # The folder has the mesh: what is read there needs no gmsh, and is what was solved.
    problem = ms.problem.load(tmp_path / "case.toml")

    def no_gmsh(*arguments: object) -> None:
        raise InputError("gmsh is asked for")

    monkeypatch.setattr("magshell.mesh.drawings.reading.required", no_gmsh)
    monkeypatch.setattr("magshell.mesh.solids.mid_surface.required", no_gmsh)
    copy = ms.problem.load(tmp_path / "results" / "problem.toml")
    assert copies.digest(copy) == copies.digest(problem)
    one, other = problem.model.shell.mesh, copy.model.shell.mesh
    assert (one.points == other.points).all()
    assert (one.elements == other.elements).all()
    assert one.groups == other.groups
    assert ms.results.read(tmp_path / "results").path.converged


def test_a_polygon_in_a_problem_file(tmp_path):
    if any(importlib.util.find_spec(package) is None for package in ("gmsh", "shapely")):
        pytest.skip("gmsh or shapely is not installed")
    text = PROBLEM.read_text().replace(
        'file = "FILE"', 'generator = "polygon"\ncorners = [[0, 0], ["20 mm", 0], [0, "8 mm"]]'
    )
    (tmp_path / "case.toml").write_text(text)
    problem = ms.problem.load(tmp_path / "case.toml")
    assert problem.model.shell.mesh.groups == ["side-1", "side-2", "side-3", "end"]
    text, inputs = copies.alone(problem)
    assert list(inputs) == ["inputs/polygon.msh"]
    (tmp_path / "inputs").mkdir()
    (tmp_path / "inputs" / "polygon.msh").write_bytes(inputs["inputs/polygon.msh"])
    (tmp_path / "copy.toml").write_text(text)
    copy = ms.problem.load(tmp_path / "copy.toml")
    assert copies.digest(copy) == copies.digest(problem)
    assert copy.model.shell.mesh.groups == problem.model.shell.mesh.groups
    for corners, said in (
        ("[[0, 0], [0, 1]]", r"mesh.corners: has 2 corners; expected three or more"),
        (
            '[[0, 0], ["2 mm", "2 mm"], ["2 mm", 0], [0, "2 mm"]]',
            "mesh: polygon: an outline crosses or touches itself at",
        ),
    ):
        bad = PROBLEM.read_text().replace('file = "FILE"', f'generator = "polygon"\ncorners = {corners}')
        (tmp_path / "bad.toml").write_text(bad)
        with pytest.raises(InputError, match=said):
            ms.problem.load(tmp_path / "bad.toml")


def test_the_solid_is_not_as_thick_as_the_shell(tmp_path):
    for package in ("gmsh", "shapely", "meshio"):
        pytest.importorskip(package, reason=f"{package} is not installed", exc_type=(ImportError, OSError))
    more = copy_plate(tmp_path / "plate.stl")
    text = PROBLEM.read_text().replace('"FILE"\n', f'"plate.stl"\n{more}').replace("[probes]", "[unused]")
    text = text[: text.index("[unused]")].replace('thickness = "2 mm"', 'thickness = "1 mm"')
    (tmp_path / "case.toml").write_text(text)
    assert "the solid in plate.stl is 2 mm thick, the shell 1 mm: check shell.thickness" in magshell(
        tmp_path, "check", "case.toml"
    )
