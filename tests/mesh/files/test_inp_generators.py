"""Coordinate systems and keywords that make nodes and elements of others."""

from __future__ import annotations

import numpy as np
import pytest

from magshell.errors import InputError
from magshell.mesh.files.inp import read_inp


def contents(*lines):
    return read_inp("\n".join(lines).encode(), "part.inp")


def points(*lines):
    return contents(*lines).points


def test_cylindrical_coordinates_in_a_system():
    """First from cylindrical to rectangular coordinates, then into the system; the next *SYSTEM ends it."""
    found = points(
        *("*System", "1, 2, 3, 1, 3, 3", "1, 2, 4", "*Node, system=c", "1, 2, 30, 5", "*System"),
        *("*Node, System=R", "2, 2., 30., 5.", "*NODE, SYSTEM=C", "3, 2, -90"),
    )
    x, y = 2 * np.cos(np.pi / 6), 2 * np.sin(np.pi / 6)
    assert found == pytest.approx(np.array([[1 + 5, 2 + x, 3 + y], [2, 30, 5], [0, -2, 0]]))  # axes X2, X3, X1


@pytest.mark.parametrize(
    ("system", "expected"),
    [
        (["*System", "1, 2, 3"], [2, 4, 6]),
        (["*System", "0, 0, 0, 0, 2, 5"], [-2, 1, 3]),  # the first axis is projected onto X1, X2
        (["*System", "0, 0, 0, 0, 0, 7", "0, 1, 5"], [-3, 2, 1]),
        (["*System"], [1, 2, 3]),
    ],
)
def test_system(system, expected):
    assert points(*system, "*Node", "1, 1, 2, 3")[0] == pytest.approx(expected)


def test_coordinates_as_fortran_writes_them():
    """Exponents with D, empty fields, fields left out; what stands behind the coordinates is the normal."""
    found = points(
        *(
            "*Node",
            "1, 1.5D+1, -2.5d-1, .5D0",
            "2, , 3., ",
            "3",
            "4, 1.",
            "5,1,2,3,0.,0.,1.",
            "  6 ,  7. , 8. ,",
            "7,,,9.",
        )
    )
    expected = [[15, -0.25, 0.5], [0, 3, 0], [0, 0, 0], [1, 0, 0], [1, 2, 3], [7, 8, 0], [0, 0, 9]]
    assert found.tolist() == expected


def test_nodes_on_lines():
    """Straight; on an arc about a node or about coordinates in a system of their own; on a parabola."""
    found = points(
        *(
            "*Node",
            "1, 0, 0, 0",
            "5, 4, 0, 8",
            "11, 2, 0",
            "31, 0, 2",
            "99, 0, 0, 0",
            "41, 0, 0",
            "45, 4, 0",
            "98, 2, 1, 0",
        ),
        *("*Ngen", "1, 5", "*Ngen, line=C", "11, 31, 10, 99", "*Ngen, line=P", "41, 45, 1, 98"),
        *("*Node", "51, 1, 1", "53, 0, 2", "*Ngen, line=c, system=c", "51, 53, 1, , 1, 90, 0"),
    )
    assert found[:5].tolist() == [[0, 0, 0], [1, 0, 2], [2, 0, 4], [3, 0, 6], [4, 0, 8]]
    assert found[6] == pytest.approx([2**0.5, 2**0.5, 0])
    assert found[8:13] == pytest.approx(np.array([[0, 0, 0], [1, 0.75, 0], [2, 1, 0], [3, 0.75, 0], [4, 0, 0]]))
    assert found[14] == pytest.approx([0.5**0.5, 1 + 0.5**0.5, 0])


def test_an_arc_in_space():
    """In a rotated system, about given coordinates: on the circle, at equal angles."""
    found = contents(
        *("*System", "5, 0, 0, 5, 0, 1", "5, 1, 0", "*Node, system=C", "10, 3, 20, 1", "15, 3, 120, 1"),
        *("*Ngen, line=C, nset=arc", "10, 15, 1, , 0, 0, 1", "*Nset, nset=ends", "10, 15"),
    )
    angle = np.deg2rad([20, 40, 60, 80, 100, 120])
    expected = np.column_stack([np.full(6, 4.0), 3 * np.sin(angle), 3 * np.cos(angle)])  # axes X3, X2, -X1
    assert found.points == pytest.approx(expected)
    assert found.node_groups["arc"].tolist() == [0, 1, 2, 3, 4, 5]


def test_a_plate_of_generators():
    """Lines filled between two sets, one element made many: the plate of 8-node elements that is written out."""
    lines = [
        *(
            "*Node",
            "1, 0, 0",
            "9, 8, 0",
            "401, 0, 4",
            "409, 8, 4",
            "*Ngen, nset=low",
            "1, 9",
            "*Ngen, nset=high",
            "401, 409",
        ),
        *("*Nfill, nset=all", "low, high, 4, 100", "*Element, type=S8R", "1, 1, 3, 203, 201, 2, 103, 202, 101"),
        *("*Elgen, elset=plate", "1, 4, 2, 1, 2, 200, 10"),
    ]
    found = contents(*lines)
    numbers = [100 * row + column for row in range(5) for column in range(1, 10)]
    assert found.points.tolist() == [[(n - 1) % 100, n // 100, 0] for n in numbers]
    assert sorted(found.node_groups["all"]) == list(range(45))
    (block,) = found.blocks
    assert block.numbers.tolist() == list(range(8))
    expected = [
        [n + 200 * row + 2 * column for n in (1, 3, 203, 201, 2, 103, 202, 101)]
        for row in (0, 1)
        for column in range(4)
    ]
    assert [[numbers[node] for node in element] for element in block.nodes] == expected
    assert block.groups["plate"].tolist() == list(range(8))


def test_copies():
    """Nodes moved and turned, elements on the copies."""
    found = contents(
        *("*Node, nset=N", "1, 0, 0", "2, 1, 0", "3, 1, 1", "4, 0, 1", "*Element, type=S4, elset=E", "1, 1, 2, 3, 4"),
        *("*Ncopy, old set=N, change number=10, new set=M, shift", "0, 0, 1", "0, 0, 0, 1, 0, 0, 90"),
        *("*Elcopy, old set=E, element shift=5, shift nodes=10, new set=F",),
    )
    assert found.points[4:] == pytest.approx(np.array([[0, -1, 0], [1, -1, 0], [1, -1, 1], [0, -1, 1]]))
    assert found.node_groups["M"].tolist() == [4, 5, 6, 7]
    nodes = {name: block.nodes[rows].tolist() for block in found.blocks for name, rows in block.groups.items()}
    assert nodes == {"E": [[0, 1, 2, 3]], "F": [[4, 5, 6, 7]]}


def test_layers_of_elements():
    found = contents(
        "*Node", "1", "99, 1", "*Ngen", "1, 99", "*Element, type=S3", "1, 1, 2, 3", "*Elgen", "1,2,1,1,2,10,5,2,40,50"
    )
    assert {tuple(block.nodes[row] + 1) for block in found.blocks for row in range(len(block.nodes))} == {
        (n, n + 1, n + 2) for n in (1, 2, 11, 12, 41, 42, 51, 52)
    }


def test_nodes_of_a_range_of_elements():
    text = (
        "*Node",
        "1",
        "9",
        "*Ngen",
        "1, 9",
        "*Element, type=S3",
        *(f"{n}, {n}, {n + 1}, {n + 2}" for n in range(1, 6)),
    )
    found = contents(*text, "*Elset, elset=e, generate", "2, 3", "4, 4, 2", "*Nset, nset=n, elset=e")
    assert (found.node_groups["n"] + 1).tolist() == [2, 3, 4, 5, 6]
    assert (found.blocks[0].groups["e"] + 1).tolist() == [2, 3, 4]


def test_an_unsorted_set_is_filled_in_its_order():
    lines = [
        "*Node",
        "1, 0, 0",
        "2, 4, 0",
        "101, 4, 4",
        "102, 0, 4",
        "*Nset, nset=A",
        "1, 2",
        "*Nset, nset=B, unsorted",
        "102, 101",
    ]
    found = points(*lines, "*Nfill", "A, B, 2, 10")
    assert found[2:4].tolist() == [[0, 2, 0], [4, 2, 0]]
    assert points(*(line.replace(", unsorted", "") for line in lines), "*Nfill", "A, B, 2, 10")[2:4].tolist() == [
        [2, 2, 0],
        [2, 2, 0],
    ]


def test_a_shell_of_a_beam_with_a_direction():
    """A node behind those of a beam gives the direction of its section, and is no node of the line."""
    text = ("*Node", "1", "2, 1", "3, 2", "9, 0, 1", "*Element, type=B32, elset=edge", "1, 1, 2, 3, 9", "2, 1, 2, 3, 9")
    (block,) = contents(*text).blocks
    assert block.kind.rows(block.nodes).tolist() == [[0, 2, 1], [0, 2, 1]]


FAULTS = {
    "spherical": (["*Node, system=S", "1, 1, 1, 1"], 1, "SYSTEM=S is not read; R .rectangular. and C"),
    "no axes": (["*System", "0, 0, 0, 1, 0, 0", "2, 0, 0"], 1, "these points define no axes"),
    "axis along X3": (["*System", "0, 0, 0, 0, 0, 1"], 1, "these points define no axes"),
    "word in a system": (["*System", "0, 0, x"], 2, "expected the origin"),
    "increments": (["*Node", "1", "6, 1", "*Ngen", "1, 6, 2"], 5, "not a whole number of increments 2"),
    "no end": (["*Node", "1", "*Ngen", "1, 6"], 4, "there is no node 6 above"),
    "line": (["*Node", "1", "6, 1", "*Ngen, line=X", "1, 6"], 4, "LINE=X is not read"),
    "no centre": (["*Node", "1", "6, 1", "*Ngen, line=C", "1, 6"], 5, "expected two nodes, an increment, a third node"),
    "off the circle": (["*Node", "1, 1", "6, 0, 2", "9", "*Ngen, line=C", "1, 6, 1, 9"], 6, "there is no arc"),
    "half a circle": (["*Node", "1, 1", "6, -1", "9", "*Ngen, line=C", "1, 6, 1, 9"], 6, "there is no arc"),
    "normal of an arc": (
        ["*Node", "1, 1", "6, 0, 1", "9", "*Ngen, line=C", "1, 6, 1, 9, , , , 0, 0, 1"],
        6,
        "an arc given by its normal",
    ),
    "twice": (["*Node", "1", "2, 1", "3, 2", "*Ngen", "1, 3"], 6, "node 2 is given a second time"),
    "sets that differ": (
        ["*Node, nset=a", "1", "*Node, nset=b", "11", "12", "*Nfill", "a, b, 2, 1"],
        7,
        "the sets have 1 and 2 nodes",
    ),
    "bias": (["*Nfill, bias=0.5", "a, b, 2, 1"], 1, r"\*NFILL with 'BIAS' is not read"),
    "no element": (["*Node", "1", "*Elgen", "1, 2"], 4, "there is no element 1 above"),
    "too many": (
        ["*Node", "1", "*Element, type=S3", "1,1,1,1", "*Elgen", "1, 99999, 0, 1, 99999"],
        6,
        "expected an element",
    ),
    "mirrored": (["*Ncopy, old set=a, change number=9, reflect=mirror", "0, 0, 0"], 1, "with 'REFLECT' is not read"),
    "neither": (["*Node, nset=a", "1", "*Ncopy, old set=a, change number=9"], 3, "read with SHIFT"),
    "mapped": (["*Nmap, nset=a"], 1, r"\*NMAP: nodes are not mapped"),
    "imperfection": (["*Imperfection, file=a, step=1"], 1, r"\*IMPERFECTION: imperfections are not read"),
}


@pytest.mark.parametrize("what", FAULTS)
def test_errors_name_the_line(what):
    lines, line, message = FAULTS[what]
    with pytest.raises(InputError, match=f"^part.inp, line {line}: .*{message}"):
        contents(*lines)


def test_transforms_change_no_geometry():
    """*TRANSFORM turns the directions of supports and loads, which are not read."""
    lines = ["*Node, nset=a", "1, 1, 2, 3"]
    assert points(*lines, "*Transform, nset=a, type=C", "0,0,0,0,0,1").tolist() == points(*lines).tolist()
