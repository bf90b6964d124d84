"""`magshell mesh`, and meshes from files in problem files: what is said, what is written, what is refused."""

from __future__ import annotations

import importlib.util
import os
import pathlib
import shutil
import signal
import subprocess
import sys

import numpy as np
import pytest
from processes import PATIENCE, hear_ctrl_c, until

import magshell as ms
from magshell.cli import main
from magshell.errors import InputError
from magshell.problem import load
from magshell.problem.fields import Name
from magshell.problem.reading import check, parse
from magshell.problem.report import describe

from .same import described, first_order

DATA = pathlib.Path(__file__).parent / "data"
needs_gmsh = pytest.mark.skipif(importlib.util.find_spec("gmsh") is None, reason="needs the extra magshell[gmsh]")

PROBLEM = """
[mesh]
{mesh}

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
group = "left plate"
vector = ["50 mT", 0, 0]

[field]
flux_density = [0, 0, "1 mT"]

[[supports]]
kind = "clamp"
group = "clamped"

[probes]
tip = ["5 mm", "2 mm", 0]
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the plates, a space and an umlaut in its name; the commands run in it."""
    home = tmp_path / "Mappe für Netze"
    home.mkdir()
    for name in ("two-plates-41.msh", "two-plates.geo", "two-plates-22.msh"):
        shutil.copy(DATA / name, home)
    monkeypatch.chdir(home)
    return home


def said(capsys, *arguments):
    """Exit status, and what was said and complained."""
    status = main(["mesh", *map(str, arguments)])
    return status, *capsys.readouterr()


def test_what_a_mesh_holds(folder, capsys):
    status, out, _ = said(capsys, "two-plates-41.msh", "--unit", "mm")
    assert status == 0
    for line in (
        "lengths in          mm",
        "elements            10 quadrilaterals",
        "nodes               45",
        "size                5 × 2 × 0 mm",
        "group               left plate (6 elements)",
        "group               clamped (2 edges) at (0, 0 to 2, 0) mm",
        "group               tip (1 node) at (5, 2, 0) mm",
        "worst corner        1 (scaled Jacobian, 1 is best) in element",
        "changed             the group of edges 'both' is called 'both-edges'",
    ):
        assert f"  {line}" in out, out
    assert sorted(path.name for path in folder.iterdir()) == [
        "two-plates-22.msh",
        "two-plates-41.msh",
        "two-plates.geo",
    ]


def test_a_mesh_is_rewritten(folder, capsys):
    """With its unit; a first-order one raised."""
    status, out, _ = said(capsys, "two-plates-22.msh", "--unit", "mm", "--out", "new/plates.msh")
    assert status == 0
    assert 'plates.msh written; in a problem file: [mesh] file = "plates.msh"' in out
    one, other = ms.mesh.read("two-plates-22.msh", unit="mm"), ms.mesh.read("new/plates.msh")
    assert described(one) == described(other)
    points, rows = first_order(ms.mesh.cylinder(1, 2, (12, 2)))
    nodes = "".join(f"{n}, {x!r}, {y!r}, {z!r}\n" for n, (x, y, z) in enumerate(points.tolist()))
    elements = "".join(f"{e}, {', '.join(map(str, row[:4]))}\n" for e, row in enumerate(rows.tolist()))
    pathlib.Path("tube.inp").write_text(f"*NODE\n{nodes}*ELEMENT, TYPE=S4\n{elements}")
    status, out, _ = said(capsys, "tube.inp", "--unit", "m", "--second-order", "--out", "tube.msh")
    assert status == 0
    assert "changed             raised to second order: 60 mid-side nodes, 36 of them off the straight line" in out
    mesh = ms.mesh.read("tube.msh")
    assert np.abs(np.hypot(mesh.points[:, 0], mesh.points[:, 1]) - 1.0).max() < 2e-3


@needs_gmsh
def test_a_geometry_is_meshed(folder, capsys):
    """By its own name, here, in its own unit; made again over what was made, not over what was not."""
    for size, elements in (("1 mm", 10), ("1000 um", 10)):
        status, out, _ = said(capsys, "two-plates.geo", "--unit", "mm", "--size", size)
        assert status == 0
        assert f"elements            {elements} quadrilaterals" in out
        assert 'two-plates.msh written; in a problem file: [mesh] file = "two-plates.msh"' in out
    assert ms.mesh.read("two-plates.msh").origin.unit == "mm"
    shutil.copy("two-plates-41.msh", "two-plates.msh")
    status, _, complaint = said(capsys, "two-plates.geo", "--unit", "mm")
    assert status == 2
    assert "two-plates.msh: exists already and was not made by magshell mesh; say --out two-plates.msh" in complaint
    assert pathlib.Path("two-plates.msh").read_bytes() == (DATA / "two-plates-41.msh").read_bytes()
    assert said(capsys, "two-plates.geo", "--unit", "mm", "--out", "two-plates.msh")[0] == 0


@needs_gmsh
@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
def test_ctrl_c_ends_gmsh_at_once(folder):
    """It computes in a process of its own, here for ever; nothing is written, not even half a file."""
    command = [sys.executable, "-m", "magshell", "mesh", "plate.geo", "--unit", "mm", "--trust-script"]
    forever = "For i In {1:1000000}\nFor j In {1:1000000}\nx = j;\nEndFor\nEndFor\n"
    plate = "SetFactory('OpenCASCADE');\nRectangle(1) = {0, 0, 0, 3, 3};\n"
    pathlib.Path("plate.geo").write_text(f"{plate}SystemCall 'touch begun';\n{forever}")
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, **pipes, text=True, preexec_fn=hear_ctrl_c) as process:
        try:
            until(pathlib.Path("begun").exists, process)
            process.send_signal(signal.SIGINT)
            shown, complaint = process.communicate(timeout=PATIENCE)
        finally:
            process.kill()
    assert process.returncode == 130
    assert shown == "meshing plate.geo with gmsh ...\n"
    assert complaint == "error: interrupted\n"
    assert "plate.msh" not in os.listdir()


REFUSED = {
    "no unit": (["two-plates-41.msh"], "unit: is missing: two-plates-41.msh does not say"),
    "no such unit": (["two-plates-41.msh", "--unit", "inch"], "unit: 'inch' is not a unit of length"),
    "no such file": (["two-plates-4.msh"], "there is no such file. Did you mean 'two-plates-41.msh'?"),
    "size of a mesh": (["two-plates-41.msh", "--size", "1 mm"], "size: two-plates-41.msh is a mesh"),
    "size without unit": (["two-plates.geo", "--unit", "mm", "--size", "1"], "--size: '1' has no unit"),
    "order of a geometry": (
        ["two-plates.geo", "--unit", "mm", "--second-order"],
        "second_order: is for meshes; a geometry",
    ),
    "another format": (["two-plates-41.msh", "--out", "a.vtu"], "--out a.vtu: a mesh is written as .msh"),
    "onto itself": (["two-plates-41.msh", "--out", "two-plates-41.msh"], "is the file that is read"),
    "a folder": (["two-plates-41.msh", "--out", "in.msh"], "--out in.msh: is a folder"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_bad_requests(what, folder, capsys):
    (folder / "in.msh").mkdir()
    arguments, message = REFUSED[what]
    status, out, complaint = said(capsys, *arguments)
    assert status == 2
    assert complaint.startswith("error: ")
    assert message in complaint, complaint
    assert out in ("", "meshing two-plates.geo with gmsh ...\n")


def problem(folder, mesh):
    (folder / "plates.toml").write_text(PROBLEM.format(mesh=mesh), encoding="utf-8")
    return load(folder / "plates.toml")


def test_a_problem_with_a_mesh_file(folder):
    """Selections beside the file's groups; the file is found from the problem's folder, wherever one is."""
    more = '[mesh.edge_groups]\nfar = { x1 = "5 mm" }\n[mesh.node_groups]\nheel = { x1 = 0, x2 = 0 }'
    found = problem(folder, f'file = "two-plates-41.msh"\nunit = "mm"\n{more}')
    mesh = found.model.shell.mesh
    assert len(mesh.edge_groups["far"]) == 2
    assert mesh.node_groups["heel"].size == 1
    assert found.file.files() == [("mesh.file", "two-plates-41.msh")]
    lines = describe(found).sections["Mesh"]
    assert ("file", "two-plates-41.msh, lengths in mm") in lines
    assert ("changed", "the group of edges 'both' is called 'both-edges'") in lines
    assert not any(label == "generator" for label, _ in lines)


TABLES = {
    "neither": ("", "mesh.generator: is missing, and mesh.file as well. There is: annulus, blocks"),
    "both": ('file = "a.msh"\ngenerator = "rectangle"', "mesh.file: is given beside generator"),
    "no unit": ('file = "two-plates-41.msh"', "mesh.unit: is missing: two-plates-41.msh does not say"),
    "bad unit": ('file = "two-plates-41.msh"\nunit = "nm"', "mesh.unit: 'nm' is not a unit of length"),
    "number": ("file = 3", "mesh.file: '3' is not a file name"),
    "unknown key": ('file = "a.msh"\nscale = 3', "mesh.scale: is an unknown key"),
    "key of a generator": ('file = "a.msh"\nelements = [1, 2]', "mesh.elements: is an unknown key"),
    "not a switch": ('file = "a.msh"\nsecond_order = 1', "mesh.second_order: '1' is neither true nor false"),
    "no such file": ('file = "two-plates.msh"\nunit = "mm"', "two-plates.msh: there is no such file. Did you mean"),
    "size": ('file = "two-plates-41.msh"\nunit = "mm"\nsize = "1 mm"', "mesh.size: two-plates-41.msh is a mesh, whose"),
    "layers": (
        'file = "two-plates-41.msh"\nholes = "cut"',
        "mesh.holes: is for drawings (.dxf, .svg, .csv), and two-pl",
    ),
    "raised drawing": ('file = "a.dxf"\nsecond_order = true', "mesh.second_order: makes no sense for a drawing such"),
    "no solid": ('file = "two-plates-41.msh"\nunit = "mm"\nmid_surface = true', "is not the closed skin of a solid"),
    "taken": (
        'file = "two-plates-41.msh"\nunit = "mm"\nedge_groups.tip = { x1 = 0 }',
        "mesh.edge_groups.tip: Two groups have the name 'tip'",
    ),
}


@pytest.mark.parametrize("what", TABLES)
def test_errors_of_the_table(what, folder):
    table, message = TABLES[what]
    with pytest.raises(InputError) as caught:
        problem(folder, table)
    assert str(caught.value).startswith("plates.toml: mesh")
    assert message in str(caught.value)


def test_every_file_that_a_problem_names():
    """With the key where it stands, in the order of the file."""
    text = PROBLEM.format(mesh='file = "a b.msh"') + '[[remanence]]\nkind = "file"\ngroup = "b"\nfile = "b.csv"\n'
    text += 'flux_density_unit = "T"\n[[remanence]]\nkind = "deformed"\ngroup = "c"\nmagnitude = "1 mT"\n'
    text += 'direction = [1, 0, 0]\ndisplacements = "u.csv"\nlength_unit = "mm"\n'
    assert check(parse(text, "x"), "x").files() == [
        ("mesh.file", "a b.msh"),
        ("remanence[1].file", "b.csv"),
        ("remanence[2].displacements", "u.csv"),
    ]


def test_names_that_a_problem_file_can_write():
    """Whatever a file calls its groups, a problem file can; and no two are the same."""
    from pydantic import TypeAdapter

    from magshell.mesh.files.names import named

    strange = ("a/b", "", "(x)", "Flügel 3", "a_b", "-", "tip", "a\tb")
    names, notes = named((dict.fromkeys(strange, 0), {"tip": 0, "a_b": 0}, {"tip": 0, "tip-nodes": 0}))
    assert len(set(names.values())) == len(names) == len(strange) + 4
    adapter = TypeAdapter(Name)
    assert [adapter.validate_python(name) for name in names.values()] == list(names.values())
    assert names[0, "Flügel 3"] == "Flügel 3"
    assert len(notes) == sum(name != new for (_, name), new in names.items())
