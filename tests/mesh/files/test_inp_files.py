"""Abaqus input files: elements of all kinds, sets in all the ways in which they are written."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import magshell as ms
from magshell.errors import InputError
from magshell.mesh.files.inp import read_inp

from .same import attempted, described


def inp(mesh):
    """A mesh of quadrilaterals as an input file, in mm, with its nodes in two blocks and its elements in two."""
    lines = ["*Heading", " a part; ünïcode", "** a comment", "*Node, nset=all"]
    nodes = [f"{10 * n + 5}, " + ", ".join(repr(1e3 * x) for x in p) for n, p in enumerate(mesh.points.tolist())]
    rows = [", ".join(str(10 * n + 5) for n in row) for row in mesh.elements.tolist()]
    half = len(nodes) // 2
    lines += [*nodes[:half], "*NODE", *nodes[half:]]
    lines += ["*Element, type=S8R, elset=part"]
    for number, row in enumerate(rows[:-1]):
        cut = row.rindex(", ")
        lines += [f"{number + 1}, {row[: cut + 1]}", row[cut + 2 :]]  # an element over two lines
    lines += ["*ELEMENT, TYPE=s8r5, ELSET=Part", f"{len(rows)}, {rows[-1]}"]
    return lines


def test_a_plate_with_sets(tmp_path):
    mesh = ms.mesh.rectangle(4e-3, 2e-3, (4, 2))
    lines = inp(mesh)
    lines += ["*Elset, elset=odd, generate", "1, 7, 2", "*Elset, elset=first", "1, 2,", "3", "*elset, elset=ends"]
    lines += ["first,", "8", "*Nset, nset=corner", " 5,", "*Nset, NSET=two, generate", "5, 15, 10", "*Material, name=x"]
    lines += ["*Elastic", "1., 0.3", "*Step", "*Static", "1., 1.", "*End Step"]
    file = tmp_path / "plate.inp"
    file.write_text("\r\n".join(lines), encoding="utf-8")
    found = ms.mesh.read(file, unit="mm")
    assert described(found)["elements"] == described(mesh)["elements"]
    assert {name: rows.tolist() for name, rows in found.element_groups.items()} == {
        "part": [0, 1, 2, 3, 4, 5, 6, 7],
        "odd": [0, 2, 4, 6],
        "first": [0, 1, 2],
        "ends": [0, 1, 2, 7],
    }
    assert {name: rows.tolist() for name, rows in found.node_groups.items()} == {
        "all": list(range(len(mesh.points) // 2)),
        "corner": [0],
        "two": [0, 1],
    }


def test_first_order_with_a_clamped_node_set(tmp_path):
    """Raised on request; the middles between nodes of a set belong to the set, else the clamp would leave them free."""
    text = "*NODE\n1,0,0,0\n2,1,0,0\n3,2,0,0\n4,0,1,0\n5,1,1,0\n6,2,1,0\n*NODE, NSET=reference\n99,5,5,5\n"
    text += "*ELEMENT, TYPE=S4R\n1,1,2,5,4\n2,2,3,6,5\n*ELEMENT,TYPE=T3D2,ELSET=axis\n7,2,5\n8,1,5\n"
    text += "*NSET,NSET=clamped\n1,4\n"
    (tmp_path / "s4.inp").write_text(text)
    with pytest.raises(InputError, match=r"s4.inp: 2 of 2 elements are of first order.*second_order = true"):
        ms.mesh.read(tmp_path / "s4.inp", unit="m")
    mesh = ms.mesh.read(tmp_path / "s4.inp", unit="m", second_order=True)
    x = mesh.points[mesh.nodes_of("clamped")]
    assert sorted(x.tolist()) == [[0, 0, 0], [0, 0.5, 0], [0, 1, 0]]
    assert mesh.points[mesh.edge_groups["axis"]].tolist() == [[[1, 0, 0], [1, 1, 0], [1, 0.5, 0]]]
    said = "\n".join(mesh.origin.changes)
    for phrase in (
        "raised to second order: 7 mid-side nodes, 0 of them off the straight line",
        "1 lines left out of groups",
        "1 nodes left out",
        "group 'reference' left out",
    ):
        assert phrase in said, said


def test_triangles_and_quadrilaterals():
    """STRI65 as a row of 8; an S4 with a node twice as a triangle."""
    text = "*NODE\n" + "".join(f"{n},{n % 3},{n // 3},0\n" for n in range(9))
    contents = read_inp(f"{text}*ELEMENT,TYPE=STRI65\n1,0,2,6,1,4,3\n".encode(), "t.inp")
    block = contents.blocks[0]
    assert block.kind.rows(block.nodes).tolist() == [[0, 2, 6, 6, 1, 4, 6, 3]]
    from magshell.mesh.files.assembling import _triangles_from_quads

    for corners in ([0, 1, 4, 4], [4, 0, 1, 4], [4, 4, 0, 1], [1, 4, 4, 0]):
        row = _triangles_from_quads(np.array([[*corners, -1, -1, -1, -1]]))[0]
        assert row.tolist() == [*row[:3], row[2], -1, -1, row[2], -1]
        assert sorted(row[:3]) == [0, 1, 4]


START = "*NODE\n1,0,0,0\n"
BROKEN = {
    "empty": ("", "has no \\*NODE block"),
    "word": ("*NODE\n1, 0, zero, 0\n", "line 2: expected a node number and three coordinates, found '1, 0, zero, 0'"),
    "infinite": ("*NODE\n1, 0, inf, 0\n", "line 2: expected a node number"),
    "underscore": ("*NODE\n1, 1_0, 0, 0\n", "line 2: expected a node number"),
    "eight fields": ("*NODE\n1, 0, 0, 0, 0, 0, 1, 0\n", "line 2: expected a node number"),
    "broken number": ("*NODE\n1.5, 0, 0, 0\n", "line 2: expected a node number"),
    "twice": (START + "1,1,0,0\n", "line 3: node 1 is given a second time"),
    "too few nodes": (START + "*ELEMENT, TYPE=S4\n1, 1, 1, 1\n", "line 3: the elements of type S4 need 5 numbers each"),
    "two on a line": (
        START + "*ELEMENT, TYPE=S3\n1, 1, 1, 1, 2, 1\n1, 1\n",
        "line 3: the elements of type S3 need 4 .* begin on a line of their own, but 8 numbers follow on 2 lines",
    ),
    "unknown node": (START + "*ELEMENT, TYPE=S3\n1, 1, 2, 1\n", "line 4: element 1 has node 2"),
    "element twice": (
        START + "*ELEMENT, TYPE=S3\n7, 1, 1, 1\n*ELEMENT, TYPE=S4\n8, 1, 1, 1, 1\n7, 1, 1, 1, 1\n",
        "line 7: element 7 is given a second time; line 4 has it",
    ),
    "mass twice": (
        START + "*ELEMENT, TYPE=S3\n7, 1, 1, 1\n*ELEMENT, TYPE=MASS\n7, 1\n",
        "line 6: element 7 is given a second time; line 4 has it",
    ),
    "no type": (START + "*ELEMENT\n1, 1, 1, 1\n", "line 3: the elements have no type"),
    "bad range": (START + "*NSET, NSET=a, GENERATE\n1, 2, 0\n", "line 4: expected first, last and increment"),
    "set without name": (START + "*NSET\n1\n", "line 3: the set has no name"),
    "set with an empty name": (START + '*NSET, NSET=""\n1\n', "line 3: the set has no name"),
    "unknown set": (
        START + "*NSET, NSET=ab\n1\n*NSET, NSET=c\nabc\n",
        "line 6: there is no set 'abc' above. Did you mean 'ab'",
    ),
    "set in itself": (START + "*NSET, NSET=a\nb\n*NSET, NSET=b\na\n", "line 4: there is no set 'b' above"),
    "unknown parameter": (START + "*NSET, NSET=a, b\n1\n", "line 3: \\*NSET with 'B' is not read.* quotation marks"),
    "parameter twice": (START + "*NSET, NSET=a, NSET=b\n1\n", "line 3: NSET is given twice"),
    "from a file": ("*NODE, INPUT=nodes.txt\n", "line 1: \\*NODE with 'INPUT' is not read"),
    "shortened keyword": (START + "*ELEM, TYPE=S3\n", "line 3: \\*ELEM is not read; write \\*ELEMENT"),
    "included": ("*INCLUDE, INPUT=more.inp\n", "line 1: \\*INCLUDE: other files are not read"),
}


@pytest.mark.parametrize("what", BROKEN)
def test_errors_name_the_line(what):
    text, message = BROKEN[what]
    with pytest.raises(InputError, match=f"part.inp.*{message}"):
        read_inp(text.encode(), "part.inp")


def test_solids_are_refused(tmp_path):
    (tmp_path / "solid.inp").write_text("*NODE\n1,0,0,0\n*ELEMENT, TYPE=C3D10\n1,1,1,1,1,1,1,1,1,1,1\n")
    with pytest.raises(InputError, match=r"solid.inp: has 1 solid elements .* mid-surface"):
        ms.mesh.read(tmp_path / "solid.inp", unit="m")


@settings(deadline=None, max_examples=100)
@given(st.data())
def test_damaged_files_give_a_message(data):
    content = bytearray("\n".join([*inp(ms.mesh.rectangle(2, 1, (2, 1))), "*NSET,NSET=a,GENERATE", "5,25,10"]).encode())
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(content) - 1))
        content[at : at + data.draw(st.integers(0, 5))] = data.draw(
            st.binary(max_size=6) | st.sampled_from([b",", b"*", b"\n", b"-1", b"1e9", b"nan"])
        )
    contents, message = attempted(lambda: read_inp(bytes(content), "part.inp"))
    assert "part.inp" in message if contents is None else np.isfinite(contents.points).all()
