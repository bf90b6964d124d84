"""Parts, their instances and the assembly; sets, labels and surfaces of each."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError
from magshell.mesh.files.inp import read_inp

SQUARE = ["*Node", "1, 0, 0", "2, 1, 0", "3, 1, 1", "4, 0, 1", "*Element, type=S4", "1, 1, 2, 3, 4"]
SETS = ["*Nset, nset=Left", "1, 4", "*Elset, elset=All", "1,"]


def part(name, *more):
    return [f"*Part, name={name}", *SQUARE, *SETS, *more, "*End Part"]


def assembly(*more):
    return ["*Assembly, name=A", *more, "*End Assembly"]


def instance(name, of, *more):
    return [f"*Instance, name={name}, part={of}", *more, "*End Instance"]


def contents(*blocks):
    return read_inp("\n".join(line for block in blocks for line in block).encode(), "part.inp")


def groups(found):
    """Positions of the nodes of each node group; numbers of elements of each group of elements."""
    nodes = {name: sorted(np.round(found.points[rows], 12).tolist()) for name, rows in found.node_groups.items()}
    elements = {}
    for block in found.blocks:
        for name, rows in block.groups.items():
            elements.setdefault((block.kind.dimension, name), []).extend(block.numbers[rows].tolist())
    return nodes, elements


def test_instances_are_translated_then_rotated():
    """About an axis that goes through (0, 1, 0): by 90° the translated square stands on end."""
    found = contents(
        part("P"),
        assembly(
            *instance("I", "P", "2., 0., 0."),
            *instance("J", "P", "2, 0, 0", "0, 1, 0, 0, 2, 0, 90."),
            *instance("K", "P", "0, 0, 0", "0, 0, 0, 0, 0, 5, 180"),
        ),
    )
    nodes, elements = groups(found)
    assert nodes["I.Left"] == [[2, 0, 0], [2, 1, 0]]
    assert nodes["J.Left"] == [[0, 0, -2], [0, 1, -2]]
    assert np.array(nodes["K.Left"]) == pytest.approx(np.array([[0, -1, 0], [0, 0, 0]]))
    assert elements == {(2, "I.All"): [0], (2, "J.All"): [1], (2, "K.All"): [2]}
    assert found.points[4:8] == pytest.approx(np.array([[0, 0, -2], [0, 0, -3], [0, 1, -3], [0, 1, -2]]), abs=1e-12)


def test_names_of_groups():
    """Plain if no other scope has the name, and of the assembly; else instance.set, as in Abaqus."""
    found = contents(
        part("P", "*Nset, nset=only here", "2,"),
        part("Q"),
        assembly(
            *instance("I", "P"),
            *instance("J", "Q", "5, 0, 0", "*Nset, nset=added", "3,"),
            *("*Nset, nset=LEFT, instance=J", "2, 3"),
            *("*Nset, nset=both, instance=I", "1,", "*Nset, nset=Both, instance=J", "1,"),
            *("*Nset, nset=mixed", "I.2, J.Left, J.added, both"),
        ),
    )
    nodes, elements = groups(found)
    assert nodes == {
        "I.Left": [[0, 0, 0], [0, 1, 0]],
        "J.Left": [[5, 0, 0], [5, 1, 0]],
        "only here": [[1, 0, 0]],
        "added": [[6, 1, 0]],
        "LEFT": [[6, 0, 0], [6, 1, 0]],
        "both": [[0, 0, 0], [5, 0, 0]],
        "mixed": [[0, 0, 0], [1, 0, 0], [5, 0, 0], [5, 1, 0], [6, 1, 0]],
    }
    assert elements == {(2, "I.All"): [0], (2, "J.All"): [1]}


def test_two_instances_make_one_mesh(tmp_path):
    """Two strips side by side, and one that touches: which is refused, as their nodes are not joined."""
    lines = [*part("P"), *assembly(*instance("I", "P"), *instance("J", "P", "3, 0, 0"))]
    (tmp_path / "two.inp").write_text("\n".join(lines), encoding="utf-8")
    mesh = ms.mesh.read(tmp_path / "two.inp", "m", second_order=True)
    assert (len(mesh.elements), len(mesh.parts)) == (2, 2)
    assert sorted(mesh.groups) == ["I.All", "I.Left", "J.All", "J.Left"]
    (tmp_path / "touching.inp").write_text("\n".join(lines).replace("3, 0, 0", "1, 0, 0"), encoding="utf-8")
    with pytest.raises(InputError, match=r"touching.inp: .*not joined"):
        ms.mesh.read(tmp_path / "touching.inp", "m", second_order=True)


def test_nodes_of_an_instance_are_moved_with_it():
    """A part without a mesh, of which the instance has one."""
    found = contents(
        ["*Part, name=P", "*End Part"],
        assembly(*instance("I", "P", "0, 0, 7", *SQUARE, *SETS)),
        ["*Nset, nset=none", "1"],
    )
    nodes, _ = groups(found)
    assert nodes == {"Left": [[0, 0, 7], [0, 1, 7]], "none": []}
    assert "1 members of group 'none' left out, which there are not" in found.notes


def test_a_part_alone_and_one_without_instance():
    nodes, elements = groups(contents(part("P")))
    assert nodes == {"Left": [[0, 0, 0], [0, 1, 0]]}
    assert elements == {(2, "All"): [0]}
    found = contents(part("P"), part("Q"), assembly(*instance("I", "P")))
    assert groups(found)[0] == nodes
    assert "part 'Q' left out, as it has no instance" in found.notes


def test_systems_end_with_their_part():
    found = contents(
        ["*Part, name=P", "*System", "0, 0, 9", *SQUARE, "*End Part"],
        part("Q"),
        assembly(*instance("I", "P"), *instance("J", "Q")),
    )
    assert found.points[:, 2].tolist() == [9, 9, 9, 9, 0, 0, 0, 0]


def test_quoted_labels_keep_their_capitals_and_commas():
    found = contents(
        SQUARE,
        [
            '*Nset, nset="a, b"',
            "1,",
            '*Nset, nset="A, b"',
            "2,",
            "*Nset, nset = plain",
            "3,",
            '*Nset, nset="x.y"',
            "4,",
        ],
        ["*Nset, nset=all", '"a, b", "A, b", PLAIN, "x.y"', '*Nset, nset="Plain"', "1,"],
        ["*Nset, nset=lower", '"a, b", plain', "*Nset, nset=p l a i n", "1,"],
    )
    found_groups = {name: (rows + 1).tolist() for name, rows in found.node_groups.items()}
    assert found_groups == {
        "a, b": [1],
        "A, b": [2],
        "plain": [1, 3],
        "x.y": [4],
        "all": [1, 2, 3, 4],
        "Plain": [1],
        "lower": [1, 3],
    }


def test_an_instance_in_quotation_marks():
    nodes, _ = groups(
        contents(
            part("P.1"),
            assembly(*instance('"in, 1.2"', "p.1"), "*Nset, nset=s", '"in, 1.2".Left', "*Nset, nset=t", '"in, 1.2".3'),
        )
    )
    assert nodes == {"Left": [[0, 0, 0], [0, 1, 0]], "s": [[0, 0, 0], [0, 1, 0]], "t": [[1, 1, 0]]}


def test_names_in_latin_1_stay_apart():
    text = "\n".join([*SQUARE, "*Nset, nset=süd", "1,", "*Nset, nset=söd", "2,"])
    assert list(read_inp(text.encode("latin-1"), "part.inp").node_groups) == ["süd", "söd"]


def test_two_groups_of_one_name():
    """A set in quotation marks differs by capitals alone; a surface may be called as a set."""
    found = contents(SQUARE, ['*Elset, elset="a"', "1,", "*Elset, elset=a", "1,", "*Surface, name=a", '"a", SPOS'])
    assert sorted(groups(found)[1]) == [(2, "a"), (2, "a-2"), (2, "a-3")]
    assert "a second group 'a' is called 'a-2'" in found.notes


def test_edges_of_surfaces():
    """E1 to E4 of quadrilaterals, E1 to E3 of triangles; of sets, of single elements and of instances."""
    mesh = ms.mesh.rectangle(4e-3, 2e-3, (2, 1))
    nodes = [f"{n + 1}, {p[0]}, {p[1]}, {p[2]}" for n, p in enumerate((1e3 * mesh.points).tolist())]
    first = ", ".join(str(n + 1) for n in mesh.elements[0])
    a, b, c, d, ab, bc, cd, da = (mesh.elements[1] + 1).tolist()
    diagonal = len(nodes) + 1
    nodes.append(f"{diagonal}, 3, 1, 0")
    lines = [
        *("*Part, name=P", "*Node", *nodes, "*Element, type=S8R, elset=quad", f"1, {first}"),
        *("*Element, type=S6, elset=tri", f"2, {a}, {b}, {c}, {ab}, {bc}, {diagonal}"),
        *(f"3, {a}, {c}, {d}, {diagonal}, {cd}, {da}", "*Surface, name=low", "quad, E1", "2, E1", "*End Part"),
        *("*Assembly, name=A", *instance("I", "P"), "*Elset, elset=two, instance=I", "2, 3"),
        *("*Surface, name=right, type=element", "I.2, E2", "*Surface, name=diagonal", "I.2, E3", "I.3, E1"),
        *("*Surface, name=top", "I.quad, E3", "two, E2", "*Surface, name=whole", "I.quad, SNEG", "two,"),
        *("*Surface, name=mixed", "I.quad, E4", "I.tri, SPOS", "*Surface, name=none, combine=union", "top, low"),
        *("*Surface, name=corners, type=NODE", f"I.{a}", "*Surface, name=odd", "I.tri, E4", "*End Assembly"),
    ]
    found = read_inp("\n".join(lines).encode(), "part.inp")
    from magshell.mesh.files.assembling import assemble

    joined = assemble(found, "part.inp", "mm", second_order=False)
    edges = {
        name: sorted(np.round(1e3 * joined.points[rows[:, 2], :2], 9).tolist())
        for name, rows in joined.edge_groups.items()
    }
    assert edges == {
        "low": [[1, 0], [3, 0]],
        "right": [[4, 1]],
        "diagonal": [[3, 1]],
        "top": [[1, 2], [3, 2], [4, 1]],
        "mixed-edges": [[0, 1]],
    }
    assert {name: len(rows) for name, rows in joined.element_groups.items()} == {
        "quad": 1,
        "tri": 2,
        "two": 2,
        "whole": 3,
        "mixed": 2,
    }
    assert len(joined.node_groups["corners"]) == 1
    said = "\n".join(joined.origin.changes)
    assert "surface 'none' left out" in said
    assert "surface 'odd': left out 6-node triangles with face 'E4'" in said


def test_faces_of_calculix_and_of_plane_elements():
    """S3 to S6 of shells are their edges in CalculiX; S1 to S4 of plane elements in both programs."""
    lines = [*SQUARE, "*Surface, name=shell", "1, S4", "*Surface, name=face", "1, S2"]
    found = read_inp("\n".join(lines).encode(), "part.inp")
    assert found.blocks[1].nodes.tolist() == [[1, 2]]
    assert list(found.blocks[0].groups) == ["face"]
    plane = "\n".join([*SQUARE, "*Surface, name=edge", "1, S2"]).replace("S4", "CPS4")
    assert read_inp(plane.encode(), "part.inp").blocks[1].nodes.tolist() == [[1, 2]]


FAULTS = {
    "part twice": ([*part("P"), *part("p")], 14, "there is a part 'p' above"),
    "part without end": (["*Part, name=P", *SQUARE, "*Assembly"], 9, r"\*ASSEMBLY stands in the \*PART of line 1"),
    "unknown part": (assembly(*instance("I", "Q")), 2, "there is no part 'Q' above"),
    "near part": ([*part("Plate"), *assembly(*instance("I", "Plat"))], 15, "Did you mean 'Plate'"),
    "no part": (
        assembly("*Instance, name=I, library=old", "*End Instance"),
        2,
        r"\*INSTANCE with 'LIBRARY' is not read",
    ),
    "instance twice": (
        [*part("P"), *assembly(*instance("I", "P"), *instance("i", "P"))],
        17,
        "there is an instance 'i'",
    ),
    "rotated about nothing": (
        [*part("P"), *assembly(*instance("I", "P", "0,0,0", "1,1,1,1,1,1,90"))],
        15,
        "a translation, then two points of an axis and an angle",
    ),
    "unknown instance": (
        [*part("P"), *assembly("*Nset, nset=a, instance=I", "1,")],
        15,
        "there is no instance 'I' above",
    ),
    "unknown set of an instance": (
        [*part("P"), *assembly(*instance("I", "P"), "*Nset, nset=a", "I.Lift")],
        18,
        "there is no set 'Lift' above. Did you mean 'Left'",
    ),
    "instance in a part": ([*part("P", "*Nset, nset=a, instance=P", "1")], 13, "there is no instance 'P'"),
    "unknown set of a surface": ([*SQUARE, "*Surface, name=s", "edge, E1"], 9, "there is no set 'edge' above"),
    "offset": (
        [*SQUARE, "*Shell Section, elset=a, offset=SPOS", "1."],
        8,
        "OFFSET=SPOS puts the mid-surface off the nodes",
    ),
    "node of another part": (
        [*part("P"), "*Part, name=Q", "*Node", "9, 0, 0", "*Element, type=S3", "1, 9, 9, 1", "*End Part"],
        18,
        "element 1 has node 1, which no \\*NODE block of 'Q' has",
    ),
}


@pytest.mark.parametrize("what", FAULTS)
def test_errors_name_the_line(what):
    lines, line, message = FAULTS[what]
    with pytest.raises(InputError, match=f"^part.inp, line {line}: .*{message}"):
        contents(lines)


@pytest.mark.parametrize("offset", ["0", "0.", "MID", "middle", "0.0D0"])
def test_no_offset(offset):
    assert len(contents([*SQUARE, f"*Shell Section, elset=a, offset={offset}", "1."]).points) == 4
