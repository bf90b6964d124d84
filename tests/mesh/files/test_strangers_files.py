"""What gmsh opens runs nothing: scripts that are more than drawings, option files beside a mesh, settings of a user."""

from __future__ import annotations

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from processes import PATIENCE

import magshell as ms
from magshell.errors import InputError, suggest
from magshell.mesh.files.names import named
from magshell.mesh.files.scripts import put_alone

DATA = pathlib.Path(__file__).parent / "data"
DOCS = pathlib.Path(__file__).parents[3] / "docs" / "meshes"
needs_gmsh = pytest.mark.skipif(importlib.util.find_spec("gmsh") is None, reason="needs the extra magshell[gmsh]")
PLATE = "SetFactory('OpenCASCADE');\nRectangle(1) = {0, 0, 0, 4, 2};\n"
RUN = "SystemCall 'touch ran';"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def opened_by_gmsh(file):
    """Let gmsh open a file as it does without us."""
    program = (
        "import sys, gmsh; gmsh.initialize(readConfigFiles=False, interruptible=False); gmsh.open(sys.argv[1]);"
        " gmsh.finalize()"
    )
    subprocess.run([sys.executable, "-c", program, file], capture_output=True, timeout=PATIENCE, check=False)


REALLY_RUN = {
    "plain": RUN,
    "blocking": "System 'touch ran';",
    "not waited for": "NonBlockingSystemCall 'touch ran'; Sleep 0.5;",
    "between comments": "/* a */ SystemCall /* b */ 'touch ran' // c\n ;",
    "in a macro": f"Macro f\n{RUN}\nReturn\nCall f;\n",
    "in a loop": f"For i In {{1:1}}\n{RUN}\nEndFor\n",
    "in a test": f"If (1) {RUN} EndIf\n",
    "after a test": f"If (0) EndIf {RUN}",
    "in a text of its own": "c = StrCat('touch', ' ran'); SystemCall Str(c);",
    "by a name made of texts": "StringToName['SystemCall'] 'touch ran';",
    "as one": "S2N[StrCat('System', 'Call')] 'touch ran';",
    "in a text that is skipped": "If (0)\nx = E\"EndIf SystemCall 'touch ran'; \"\nEndIf\n",
    "to a file": "Printf('a') > 'ran';",
    "behind a file": "x = 3; f = 'ran'; Printf('%g', x) >> Str(f);",
    "saved": "Save 'ran.msh';",
    "printed": "Mesh 2; Print 'ran.msh';",
    "a folder": "CreateDir 'ran';",
}


@needs_gmsh
@pytest.mark.parametrize("attack", REALLY_RUN.values(), ids=REALLY_RUN)
def test_a_script_that_does_more_than_draw(folder, attack):
    """Refused, with file and line; every one of these does run if gmsh is let to."""
    (folder / "part.geo").write_text(f"{PLATE}{attack}\n")
    with pytest.raises(InputError, match=r"^part.geo, line \d+: "):
        ms.mesh.from_cad("part.geo", 1e-3, "mm")
    assert [path.name for path in folder.iterdir()] == ["part.geo"]
    opened_by_gmsh("part.geo")
    assert list(folder.glob("ran*")), "no attack, so that the test shows nothing"


@pytest.mark.parametrize(
    "attack",
    [
        "OnelabRun('a', 'touch ran');",
        "Macro f SystemCall 'touch ran'; Return",
        "OnelabRun 'a';",
        "Plugin(AnalyseMeshQuality).Run;",
        "General.SaveOptions = 1;",
        "General.OptionsFileName = '../x';",
        "Solver.Executable0 = 'touch ran';",
        "View 'v' {};",
        "Merge Str('part.step');",
        "Merge 'part.py';",
        "Merge 'a.opt';",
        "Include StrCat('a', '.geo');",
        "ShapeFromFile(Str('a.step'));",
        "x = GetEnv('HOME');",
        "RunAnything('touch ran');",
        "RunAnything 'touch ran';",
        "If (0) If abcEndIf General.SaveOptions = 1;",
        "Field[Field[1]] = Structured;",
        "Field[1].CommandLine = 'x';",
        "/* no end",
        f"x = ; {RUN}",
        f"Translate {{1, 0, 0}} {{ bogus; {RUN} }}",
        "If (0) If (\"EndIf EndIf SystemCall 'touch ran'; \") EndIf EndIf",
        f"x = '{1022 * 'a'}; SystemCall \"touch ran\"; ';",
        "Field[1] = ExternalProcess; Field[1].CommandLine = 'touch ran'; Background Field = 1;",
        "x = 'no end;",
        "x = 'no\nend';",
        "x = $y;",
        "\\SystemCall 'x';",
        "x = 'a\0';",
    ],
)
def test_what_else_is_refused(folder, attack):
    for name in ("part.py", "a.opt", "a.geo", "part.step"):
        (folder / name).touch()
    (folder / "part.geo").write_text(f"{PLATE}// line 3\n\n{attack}\n")
    (folder / "alone").mkdir()
    with pytest.raises(InputError, match=r"^part.geo, line 5: "):
        put_alone(folder / "part.geo", folder / "alone")


@needs_gmsh
@pytest.mark.parametrize("suffix", [".msh", ".Msh", ".MSH"])
def test_a_mesh_with_an_option_file_beside_it(folder, suffix):
    """gmsh reads binary files, and would merge part.msh.opt."""
    shutil.copy(DATA / "two-plates-binary.msh", folder / f"part{suffix}")
    (folder / f"part{suffix}.opt").write_text("SystemCall 'touch ran';\nMesh.Algorithm = 5;\n")
    assert len(ms.mesh.read(f"part{suffix}", "mm").elements) == 10
    assert not (folder / "ran").exists()
    opened_by_gmsh(f"part{suffix}")
    assert (folder / "ran").exists(), "no attack, so that the test shows nothing"


@needs_gmsh
@pytest.mark.parametrize("head", ["", "\n", "// ", f"{RUN}\n"])
def test_a_mesh_that_is_a_script(folder, head):
    """gmsh looks at the beginning of a file, and runs what is no mesh to it."""
    binary = f"{head}{RUN}\n$MeshFormat\n4.1 1 8\n"
    (folder / "part.msh").write_text(binary)
    with pytest.raises(InputError, match=r"part.msh, line 1: not a .msh file of gmsh"):
        ms.mesh.read("part.msh", "mm")
    assert not (folder / "ran").exists()


@needs_gmsh
@pytest.mark.parametrize("name", ["part.step", "part.Step", "part.IGS", "part.BREP", "part.Brep"])
def test_a_geometry_that_is_a_script_or_has_options(folder, name):
    """gmsh knows some endings in small and in large letters only: others are scripts to it."""
    (folder / name).write_text(f"{PLATE}{RUN}")
    unit = "mm" if name.lower().endswith("brep") else None
    (folder / f"{name}.opt").write_text(RUN)
    with pytest.raises(InputError):
        ms.mesh.from_cad(name, 1e-3, unit)
    assert not (folder / "ran").exists()


@needs_gmsh
def test_a_script_with_options_beside_it(folder):
    for name in ("part.geo", "sizes.geo"):
        (folder / f"{name}.opt").write_text(RUN)
    (folder / "sizes.geo").write_text("w = 4;")
    (folder / "part.geo").write_text("Include 'sizes.geo';\n" + PLATE)
    assert len(ms.mesh.from_cad("part.geo", 1e-3, "mm").elements)
    assert not (folder / "ran").exists()


@needs_gmsh
def test_settings_of_the_user_change_nothing(folder, monkeypatch):
    plate = folder / "part.geo"
    plate.write_text(f"{PLATE}MeshSize {{1, 2, 3, 4}} = 1;\n")
    usual = ms.mesh.from_cad(plate, None, "mm")
    home = folder / "home"
    home.mkdir()
    for name in (".gmshrc", ".gmsh-options"):
        (home / name).write_text("SystemCall 'touch ran';\nMesh.MeshSizeFactor = 0.3;\n")
    for variable in ("HOME", "GMSH_HOME"):
        monkeypatch.setenv(variable, str(home))
    assert np.array_equal(ms.mesh.from_cad(plate, None, "mm").points, usual.points)
    assert not list(folder.rglob("ran"))


@needs_gmsh
def test_what_a_script_names(folder):
    """Scripts and geometries beside it, in folders, over each other; all checked."""
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.model.occ.addRectangle(0, 0, 0, 4, 2)
        gmsh.model.occ.synchronize()
        gmsh.write("plate.step")
    finally:
        gmsh.finalize()
    (folder / "plate.step.opt").write_text(RUN)
    (folder / "inner").mkdir()
    (folder / "inner" / "sizes.geo").write_text('Include "../more.geo"; // again\n')
    (folder / "more.geo").write_text("w = 3;")
    (folder / "part.geo").write_text(
        "SetFactory('OpenCASCADE');\nInclude 'inner/sizes.geo'; Include 'more.geo';\nMerge \"plate.step\";\n"
        "v() = ShapeFromFile('plate.step'); Physical Surface('all', w) = {1}; Recursive Delete { Surface{v()}; }\n"
    )
    mesh = ms.mesh.from_cad("part.geo", 1e-3, "mm")
    assert mesh.groups == ["all"]
    assert not (folder / "ran").exists()
    (folder / "more.geo").write_text(f"w = 3;\n{RUN}")
    with pytest.raises(InputError, match=r"^more.geo, line 2: says SystemCall"):
        ms.mesh.from_cad("part.geo", 1e-3, "mm")
    (folder / "more.geo").unlink()
    with pytest.raises(InputError, match=r"^sizes.geo, line 1: there is no file \"../more.geo\""):
        ms.mesh.from_cad("part.geo", 1e-3, "mm")


@pytest.mark.parametrize("path", [*DATA.glob("*.geo"), *DOCS.glob("*.geo")], ids=lambda path: path.name)
def test_scripts_that_draw_are_let_through(path, tmp_path):
    copy = put_alone(path, tmp_path)
    lines = path.read_text().count("\n")
    assert copy.read_text().count("\n") in (lines, lines - 1, lines + 1)


WORDS = st.sampled_from(
    [RUN, "SystemCall", "'touch ran'", '"EndIf"', "'", '"', "//", "/*", "*/", "\n", ";", "{", "}", "(", ")", "[", "]",
     "If (0)", "If (1)", "EndIf", "Else", "ElseIf (1)", "For i In {1:2}", "EndFor", "Macro f", "Return", "Call f;", "x",
     "=", "3", ".", "~", "E", "\r", "Printf('a')", ">", "'ran'", "Str", "S2N", "General", "a1EndIf1"]
)  # fmt: skip


@needs_gmsh
@settings(max_examples=25, deadline=None, derandomize=True, database=None)
@given(words=st.lists(WORDS, max_size=14), between=st.sampled_from(["", " "]))
@example(words=["If (0)\n", "x=E", "\"EndIf SystemCall 'touch ran'; \"", ";\nEndIf\n"], between="")
def test_whatever_is_let_through_runs_nothing(words, between, tmp_path_factory):
    folder = tmp_path_factory.mktemp("anything")
    (folder / "part.geo").write_text(between.join(words), newline="")
    (folder / "alone").mkdir()
    try:
        copy = put_alone(folder / "part.geo", folder / "alone")
    except InputError:
        return
    before = os.getcwd()
    os.chdir(folder)
    try:
        opened_by_gmsh(copy)
    finally:
        os.chdir(before)
    assert not list(folder.rglob("ran"))


def test_both_groups_are_suggested_whose_names_become_the_same() -> None:
    """`rim (a)` and `rim [a]` become `rim _a_` and `rim _a_-edges`: who writes an old name is told of both."""
    new = sorted(named(({}, {"rim (a)": 0, "rim [a]": 0}, {}))[0].values())
    for old in ("rim (a)", "rim [a]"):
        assert suggest(old, [*new, "top"]).startswith(f"Did you mean '{new[0]}' or '{new[1]}'?")
    assert suggest("tob", [*new, "top"]).startswith("Did you mean 'top'?")
