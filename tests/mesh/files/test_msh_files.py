"""gmsh's files: what is in them arrives, in every format, and what is written comes back."""

from __future__ import annotations

import importlib.util
import pathlib
import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import magshell as ms
from magshell.errors import InputError
from magshell.mesh import Mesh
from magshell.mesh.files.msh import read_msh
from magshell.mesh.files.raising import raise_order
from magshell.mesh.files.session import session
from magshell.mesh.files.writing import msh

from .same import MISSING, attempted, described, first_order

DATA = pathlib.Path(__file__).parent / "data"
PLATES = ("two-plates-41.msh", "two-plates-22.msh")
needs_gmsh = pytest.mark.skipif(importlib.util.find_spec("gmsh") is None, reason="needs the extra magshell[gmsh]")


@pytest.mark.parametrize("name", PLATES)
def test_groups_of_every_dimension(name):
    """The plates of two-plates.geo, 5 mm × 2 mm, of 3 × 2 and 2 × 2 elements."""
    mesh = ms.mesh.read(DATA / name, unit="mm")
    assert len(mesh.elements) == 10
    assert np.allclose(np.ptp(mesh.points, axis=0), [5e-3, 2e-3, 0], atol=1e-12)
    assert {group: len(rows) for group, rows in mesh.element_groups.items()} == {
        "both": 10,
        "left plate": 6,
        "surface-7": 4,
    }
    assert {group: len(rows) for group, rows in mesh.edge_groups.items()} == {
        "clamped": 2,
        "both-edges": 2,
        "curve-4": 2,
    }
    x = mesh.points[mesh.nodes_of("surface-7")]
    assert (x[:, 0] >= 3e-3 - 1e-12).all()
    assert (np.abs(mesh.points[mesh.nodes_of("clamped"), 0]) < 1e-12).all()
    assert (np.abs(mesh.points[mesh.nodes_of("curve-4"), 0] - 3e-3) < 1e-12).all()
    assert np.allclose(mesh.points[mesh.node_groups["tip"]], [[5e-3, 2e-3, 0]], atol=1e-12)
    assert "the group of edges 'both' is called 'both-edges'" in mesh.origin.changes


def test_both_formats_hold_the_same_mesh():
    one, other = (described(ms.mesh.read(DATA / name, unit="mm")) for name in PLATES)
    assert one == other


@needs_gmsh
def test_binary_files_are_read_through_gmsh():
    text, binary = (ms.mesh.read(DATA / f"two-plates-{kind}.msh", unit="mm") for kind in ("41", "binary"))
    assert described(text) == described(binary)


def test_binary_files_without_gmsh(monkeypatch):
    monkeypatch.setattr("magshell.mesh.files.session.find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"binary file; save it as text .* pip install \"magshell\[gmsh\]\""):
        ms.mesh.read(DATA / "two-plates-binary.msh", unit="mm")


def test_windows_lines_and_other_sections(tmp_path):
    text = (DATA / "two-plates-41.msh").read_text()
    more = (
        "$Comments\n$ nothing $\n$EndComments\n" + text + '$NodeData\n1\n"T"\n1\n0\n3\n0\n1\n1\n1 2.5\n$EndNodeData\n'
    )
    file = tmp_path / "größe mit Leerzeichen.msh"
    file.write_bytes(more.replace("\n", "\r\n").encode())
    assert described(ms.mesh.read(file, unit="mm")) == described(ms.mesh.read(DATA / "two-plates-41.msh", unit="mm"))


def test_the_unit_of_a_file(tmp_path):
    with pytest.raises(InputError, match=r'unit: is missing: two-plates-41.msh does not say .* unit = "mm"'):
        ms.mesh.read(DATA / "two-plates-41.msh")
    with pytest.raises(InputError, match=r"unit: 'mn' is not a unit of length. Did you mean"):
        ms.mesh.read(DATA / "two-plates-41.msh", unit="mn")
    ms.mesh.write(ms.mesh.rectangle(2e-3, 1e-3, (2, 1)), tmp_path / "plate.msh", unit="um")
    mesh = ms.mesh.read(tmp_path / "plate.msh")
    assert mesh.origin.unit == "um"
    assert np.allclose(mesh.points.max(axis=0), [2e-3, 1e-3, 0], rtol=1e-14)
    with pytest.raises(InputError, match=r"unit: is 'mm', but plate.msh says that its lengths are in um"):
        ms.mesh.read(tmp_path / "plate.msh", unit="mm")


def grouped(draw, mesh):
    """The mesh with groups of all kinds, which overlap and need not cover it."""
    chosen = st.lists(st.integers(0, len(mesh.elements) - 1), min_size=1, max_size=4)
    edges = mesh.elements[:, [[0, 1, 4], [1, 2, 5]]].reshape(-1, 3)
    some_edges = st.lists(st.integers(0, len(edges) - 1), min_size=1, max_size=4)
    nodes = st.lists(st.integers(0, len(mesh.points) - 1), min_size=1, max_size=4)
    return Mesh(
        mesh.points,
        mesh.elements,
        {name: draw(chosen) for name in draw(st.sampled_from([(), ("arm",), ("arm", "Fuß 2")]))},
        {name: edges[np.array(draw(some_edges))] for name in draw(st.sampled_from([(), ("fold",), ("fold", "rim")]))},
        {name: draw(nodes) for name in draw(st.sampled_from([(), ("tip",), ("tip", "heel")]))},
    )


@st.composite
def meshes(draw):
    elements = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    mesh = draw(
        st.sampled_from(
            [
                ms.mesh.rectangle(0.03, 0.01, elements),
                ms.mesh.cylinder(7e-3, 0.02, elements, angle=(10, 130)),
                ms.mesh.sphere_patch(1.3, (20, 80), (0, 90), elements),
            ]
        )
    )
    return grouped(draw, mesh)


@settings(deadline=None, max_examples=30)
@given(meshes(), st.randoms(use_true_random=False))
def test_what_is_written_comes_back(tmp_path_factory, mesh, random):
    """The same arrays; and the same mesh if nodes are renumbered, and nodes and elements shuffled."""
    file = tmp_path_factory.mktemp("written") / "mesh.msh"
    ms.mesh.write(mesh, file)
    again = ms.mesh.read(file)
    assert np.array_equal(again.points, mesh.points)
    assert np.array_equal(again.elements, mesh.elements)
    assert again.groups == mesh.groups
    assert described(again) == described(mesh)
    assert again.origin.changes == ()
    file.write_text(shuffled(file.read_text(), random))
    assert described(ms.mesh.read(file)) == described(mesh)


def shuffled(text, random):
    """The file with other node numbers, and nodes and elements in another order."""
    lines = text.splitlines()
    start = lines.index("$Nodes") + 3
    count = int(lines[start - 1].split()[3])
    numbers = random.sample(range(1, 10 * count), count)
    order = random.sample(range(count), count)
    positions = lines[start + count : start + 2 * count]
    lines[start : start + count] = [str(numbers[node]) for node in order]
    lines[start + count : start + 2 * count] = [positions[node] for node in order]
    line = lines.index("$Elements") + 2
    while lines[line] != "$EndElements":
        block = int(lines[line].split()[3])
        rows = [row.split() for row in lines[line + 1 : line + 1 + block]]
        rows = [" ".join([row[0], *(str(numbers[int(node) - 1]) for node in row[1:])]) for row in rows]
        lines[line + 1 : line + 1 + block] = random.sample(rows, block)
        line += 1 + block
    return "\n".join(lines)


@needs_gmsh
def test_gmsh_reads_what_is_written(tmp_path):
    """Elements, nodes and the sizes of all physical groups, as gmsh itself counts them."""
    mesh = ms.mesh.rectangle(4e-3, 3e-3, (4, 3)).select_nodes("corner", x1=0, x2=0).select_edges("low", x2=0)
    mesh = Mesh(mesh.points, mesh.elements, {"a": [0, 1, 2], "b": [2, 5]}, mesh.edge_groups, mesh.node_groups)
    ms.mesh.write(mesh, tmp_path / "plate.msh", unit="mm")
    with session("test") as gmsh:
        gmsh.open(str(tmp_path / "plate.msh"))
        tags, positions, _ = gmsh.model.mesh.getNodes()
        assert len(tags) == len(mesh.points)
        by_tag = np.argsort(tags)
        assert np.allclose(positions.reshape(-1, 3)[by_tag], 1e3 * mesh.points, rtol=1e-14)
        assert len(gmsh.model.mesh.getElementsByType(16)[0]) == 12
        sizes = {}
        for dimension, tag in gmsh.model.getPhysicalGroups():
            name = gmsh.model.getPhysicalName(dimension, tag)
            entities = gmsh.model.getEntitiesForPhysicalGroup(dimension, tag)
            sizes[name] = sum(len(t) for e in entities for t in gmsh.model.mesh.getElements(dimension, e)[1])
    expected = {name: len(rows) for name, rows in (mesh.element_groups | mesh.edge_groups | mesh.node_groups).items()}
    assert sizes == expected


def mixed():
    """Two squares of quadrilaterals, and between them two triangles; curved, in metres."""
    plate = ms.mesh.rectangle(3.0, 1.0, (3, 1))
    points, rows = first_order(plate)
    middle = rows[1]
    halves = [[middle[0], middle[1], middle[2]], [middle[0], middle[2], middle[3]]]
    triangles = [[*corners, corners[2], MISSING, MISSING, corners[2], MISSING] for corners in halves]
    rows = np.array([rows[0], *triangles, rows[2]])
    points = np.stack([np.sin(0.4 * points[:, 0]), points[:, 1], np.cos(0.4 * points[:, 0])], axis=1)
    raised = raise_order(points, rows)
    return Mesh(raised.points, raised.rows, {"left": [0, 1], "right": [2, 3]})


def test_triangles_beside_quadrilaterals(tmp_path):
    """Written and read, by format 4.1 and, through gmsh, 2.2."""
    mesh = mixed()
    assert mesh.triangles.tolist() == [False, True, True, False]
    ms.mesh.write(mesh, tmp_path / "mixed.msh", unit="mm")
    again = ms.mesh.read(tmp_path / "mixed.msh")
    assert described(again) == described(mesh)
    assert again.origin.changes == ()
    assert again.triangles.sum() == 2


@needs_gmsh
def test_triangles_of_gmsh(tmp_path):
    """A rectangle of quadrilaterals that touches a disc of triangles, in every format and order."""
    geometry = "SetFactory('OpenCASCADE');\nRectangle(1) = {0, 0, 0, 4, 2};\nDisk(2) = {2, 3, 0, 1.5};\n"
    geometry += "BooleanFragments{ Surface{1, 2}; Delete; }{}\nRecombine Surface{1};\n"
    (tmp_path / "mixed.geo").write_text(geometry)
    with session("test") as gmsh:
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.6)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        gmsh.open(str(tmp_path / "mixed.geo"))
        gmsh.model.mesh.generate(2)
        for order in (1, 2):
            gmsh.model.mesh.setOrder(order)
            for version in (2.2, 4.1):
                gmsh.option.setNumber("Mesh.MshFileVersion", version)
                gmsh.write(str(tmp_path / f"{order}-{version}.msh"))
        quads = len(gmsh.model.mesh.getElementsByType(16)[0])
        triangles = len(gmsh.model.mesh.getElementsByType(9)[0])
    assert min(quads, triangles) > 10
    for order in (1, 2):
        old, new = (
            ms.mesh.read(tmp_path / f"{order}-{version}.msh", unit="mm", second_order=order == 1)
            for version in (2.2, 4.1)
        )
        assert described(old) == described(new)
        assert (int((~new.triangles).sum()), int(new.triangles.sum())) == (quads, triangles)
        assert ("raised" in " ".join(new.origin.changes)) == (order == 1)


BROKEN = {
    # File, what is replaced in it, by what, what the message says; LINE is the first line that differs.
    "not a mesh": ("41", "$MeshFormat", "solid cube", r"line 1: not a .msh file of gmsh"),
    "no version": ("41", "4.1 0 8", "four", r"line LINE: expected version, file type and data size"),
    "other version": ("41", "4.1 0 8", "1.0 0 8", r"format 1.0; save it in format 4.1 or 2.2"),
    "no elements": ("41", "$Elements", "$Other", r"line \d+: found \$EndElements where \$EndOther is expected"),
    "word for a coordinate": (
        "41",
        "\n3 2 0\n",
        "\n3 two 0\n",
        r"line LINE: expected coordinates of a node, found '3 two 0'",
    ),
    "infinite coordinate": ("41", "\n3 2 0\n", "\n3 1e999 0\n", r"line LINE: .*not a finite number"),
    "two coordinates": (
        "41",
        "\n3 2 0\n",
        "\n3 2\n",
        r"line LINE: expected 3 numbers \(coordinates of a node\), found '3 2'",
    ),
    "node twice": ("41", "0 5 0 1\n5", "0 5 0 1\n4", r"line LINE: node 4 is given a second time"),
    "unknown node": ("22", "16 2 1 1 1 7 32", "16 2 1 1 1 7 99", r"line LINE: the element has node 99"),
    "unknown type": ("22", "8 2 5 3 3 15 16", "26 2 5 3 3 15 16", r"line LINE: element type 26 cannot be used"),
    "too few tags": ("22", "2 8 2 5 3 3 15 16", "2 8", r"line LINE: expected an element"),
    "too many nodes": ("22", "2 8 2 5 3 3 15 16", "2 8 2 5 3 3 15 16 17", r"line LINE: expected 8 whole numbers"),
    "fewer elements": ("22", "$Elements\n27", "$Elements\n28", r"line LINE: says 28 elements, but 27 lines follow"),
    "fewer nodes": ("41", "15 45 1 45", "15 46 1 45", r"line LINE: says 46 nodes, but 45 follow"),
    "absurd block": ("41", "0 5 0 1\n5", "0 5 0 999999999999\n5", r"line LINE: a block of 999999999999 nodes"),
    "negative block": ("41", "0 5 0 1\n5", "0 5 0 -1\n5", r"line LINE: expected dimension, entity"),
    "bad name": ("22", '0 1 "tip"', "0 1 tip", r'line 6: expected a dimension, a number and a name, such as 2 1 "arm"'),
    "bad entity": ("41", "4 5 2 0 1 1", "4 5 2 0 7 1", r"line LINE: expected an entity"),
    "huge tag": ("41", "4 5 2 0 1 1", "1e999 5 2 0 1 1", r"line LINE: expected an entity"),
    "huge number": ("22", "\n5 3 2 0\n", "\n" + "9" * 30 + " 3 2 0\n", r"line LINE: expected a node number"),
    "fraction of a number": ("22", "\n5 3 2 0\n", "\n5.5 3 2 0\n", r"line LINE: .*number is not whole"),
}


@pytest.mark.parametrize("what", BROKEN)
def test_errors_name_the_line(what):
    kind, old, new, message = BROKEN[what]
    text = (DATA / f"two-plates-{kind}.msh").read_text()
    assert text.count(old) >= 1
    changed = text.replace(old, new, 1)
    lines = zip(text.splitlines(), changed.splitlines(), strict=False)
    line = next(number for number, (one, other) in enumerate(lines, start=1) if one != other)
    with pytest.raises(InputError, match=message.replace("LINE", str(line))):
        read_msh(changed.encode(), "part.msh")


@pytest.mark.parametrize("name", PLATES)
def test_a_file_cut_anywhere_is_refused(name):
    """Wherever it ends before its last line, there is an error that names the file, and no other."""
    content = (DATA / name).read_bytes()
    whole = content.rstrip().rfind(b"\n")
    for length in range(0, whole, 29):
        with pytest.raises(InputError, match=r"part.msh"):
            read_msh(content[:length], "part.msh")


@settings(deadline=None, max_examples=150)
@given(st.sampled_from(PLATES), st.data())
def test_damaged_files_give_a_message(name, data):
    """Bytes replaced, taken out or put in: a mesh or an InputError that names the file, nothing else."""
    content = bytearray((DATA / name).read_bytes())
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content) - 1))
        length = data.draw(st.integers(0, 6))
        content[at : at + length] = data.draw(
            st.binary(max_size=6) | st.sampled_from([b"-1", b"1e9", b"nan", b"\n", b"$", b"0"])
        )
    contents, message = attempted(lambda: read_msh(bytes(content), "part.msh"))
    assert "part.msh" in message if contents is None else np.isfinite(contents.points).all()


def test_a_written_file_is_whole_or_absent(tmp_path, monkeypatch):
    def refuse(*_):
        raise OSError(28, "No space left on device")

    mesh = ms.mesh.rectangle(1.0, 1.0, (1, 1))
    (tmp_path / "old.msh").write_bytes(b"old")
    monkeypatch.setattr("os.replace", refuse)
    with pytest.raises(OSError, match="No space left"):
        ms.mesh.write(mesh, tmp_path / "old.msh")
    assert [(file.name, file.read_bytes()) for file in tmp_path.iterdir()] == [("old.msh", b"old")]
    assert msh(mesh, "m").startswith(b"$MeshFormat\n4.1 0 8\n")


@pytest.mark.parametrize(("version", "pattern"), [("22", r"(?m)^(\d+) 16 "), ("41", r"(?m)^(2 2) 16 ")])
def test_surfaces_of_an_unknown_type_are_listed(version, pattern, tmp_path):
    """Some of the elements as if of third order: without them the plate would have a hole."""
    text, changed = re.subn(pattern, r"\1 36 ", (DATA / f"two-plates-{version}.msh").read_text(), count=4)
    assert changed
    (tmp_path / "part.msh").write_text(text)
    with pytest.raises(
        InputError, match=r"^part.msh: has elements of types that cannot be used: 4 of type 36\. .*holes"
    ):
        ms.mesh.read(tmp_path / "part.msh", unit="mm")


@needs_gmsh
def test_surfaces_of_an_unknown_type_in_a_binary_file(tmp_path):
    with session("test") as gmsh:
        gmsh.model.occ.addRectangle(0, 0, 0, 2, 1)
        gmsh.model.occ.synchronize()
        gmsh.option.setNumber("Mesh.MeshSizeMax", 0.5)
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.model.mesh.generate(2)
        gmsh.model.mesh.setOrder(3)
        count = len(gmsh.model.mesh.getElements(2)[1][0])
        gmsh.write(str(tmp_path / "part.msh"))
    with pytest.raises(InputError, match=rf"part.msh: .*cannot be used: {count} of type 21 \(Triangle 10\)"):
        ms.mesh.read(tmp_path / "part.msh", unit="mm")
