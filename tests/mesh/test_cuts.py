"""Cuts: nodes doubled along edges, and what a mesh allows there."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
from isoparametric import area

from magshell.errors import InputError, MeshError
from magshell.mesh import Mesh, cut, profile, rectangle, split
from magshell.mesh.edges import find_edges
from magshell.mesh.junctions import junctions_of


def lines_in(mesh, **lines):
    """The mesh with more edge groups: edges whose three nodes are where a function of x, y says so."""
    rows = find_edges(mesh.elements).real
    x, y = np.moveaxis(mesh.points[rows][..., :2], -1, 0)
    groups = {name: rows[where(x, y).all(axis=1)] for name, where in lines.items()}
    return Mesh(mesh.points, mesh.elements, mesh.element_groups, mesh.edge_groups | groups, mesh.node_groups, mesh.cuts)


def near(x, value):
    return np.abs(x - value) < 1e-9


def sheet():
    """Six by four squares with a slit inside, one in from the rim, one across it, and one all across."""
    return lines_in(
        rectangle(6, 4, (6, 4)),
        slit=lambda x, y: near(y, 2) & (x > 0.9) & (x < 4.1),
        notch=lambda x, y: near(x, 3) & (y < 1.1),
        cross=lambda x, y: near(x, 2) & (y > 0.9) & (y < 3.1),
        whole=lambda x, y: near(x, 5),
        short=lambda x, y: near(y, 2) & (x > 2.9) & (x < 4.1),
    )


def copies(mesh, *place):
    return int((np.abs(mesh.points[:, :2] - place).max(axis=1) < 1e-9).sum())


def test_a_slit_inside_ends_at_single_nodes():
    mesh = sheet()
    made = cut(mesh, "slit")
    assert made.cuts == ("slit",)
    assert len(made.points) == len(mesh.points) + 5
    assert [copies(made, x, 2) for x in (1, 1.5, 2, 2.5, 3, 3.5, 4)] == [1, 2, 2, 2, 2, 2, 1]
    assert area(made) == pytest.approx(24)
    assert len(made.parts) == 1
    assert len(made.boundary_edges) == len(mesh.boundary_edges) + 6
    lips = made.edge_groups["slit"]
    assert len(lips) == 6
    below = np.isin(lips, np.unique(made.elements[:12]))
    assert below.all(axis=1).sum() == 3, "three edges on the lower lip"
    assert (made.edge_groups["left"] == mesh.edge_groups["left"]).all()


def test_a_cut_to_the_rim_opens_there():
    made = cut(sheet(), ["notch"])
    assert [copies(made, 3, y) for y in (0, 0.5, 1)] == [2, 2, 1]


def test_cuts_that_cross_make_four_corners():
    made = cut(sheet(), ["slit", "cross"])
    assert copies(made, 2, 2) == 4
    assert [copies(made, 2, y) for y in (1, 1.5, 2.5, 3)] == [1, 2, 2, 1]
    assert made.cuts == ("slit", "cross")
    again = cut(cut(sheet(), "cross"), "slit")
    assert len(again.points) == len(made.points)
    assert copies(again, 2, 2) == 4


def test_a_cut_across_parts_the_sheet():
    made = cut(sheet(), "whole")
    assert [len(part) for part in sorted(made.parts, key=len)] == [4, 20]


def test_groups_have_both_lips():
    mesh = sheet()
    mesh = mesh.select_nodes("middle", x1=3.0, x2=2.0)
    made = cut(lines_in(mesh, row=lambda x, y: near(y, 2)), "slit")
    assert len(made.nodes_of("middle")) == 2
    assert len(made.edge_groups["row"]) == 6 + 3
    assert (made.edge_groups["row"][:, 0] != made.edge_groups["row"][:, 1]).all()


@pytest.mark.parametrize("pattern", ["rising", "crossed"])
def test_triangles_are_cut_too(pattern):
    mesh = split(sheet(), pattern)
    made = cut(mesh, "slit")
    assert len(made.points) == len(mesh.points) + 5
    assert made.triangles.all()
    assert len(split(cut(sheet(), "slit"), pattern).boundary_edges) == len(made.boundary_edges)


def test_a_fold_and_a_joint_can_be_cut():
    """Each of three walls gets its own edge."""
    mesh = profile(
        {"a": (0, 0), "b": (1, 0), "c": (2, 0), "d": (1, 1)},
        {"left": ("a", "b"), "right": ("b", "c"), "fin": ("b", "d")},
        2.0,
        (2, 2),
    )
    made = cut(mesh, "b")
    assert len(made.parts) == 3
    assert len(made.edge_groups["b"]) == 6
    assert not junctions_of(made).joints


def test_a_cut_mesh_is_made_again_from_its_arrays():
    made = cut(sheet(), "slit")
    groups = made.element_groups, made.edge_groups, made.node_groups
    assert Mesh(made.points, made.elements, *groups, cuts=["slit"]).cuts == ("slit",)
    assert pickle.loads(pickle.dumps(made)).cuts == ("slit",)
    assert made.select_nodes("end", x1=0.0).cuts == ("slit",)
    with pytest.raises(MeshError, match=r"are not joined.*at \(1.5, 2, 0\) m.*edge group of a cut.*5 such places"):
        Mesh(made.points, made.elements, *groups)


def test_a_position_on_both_lips_is_refused_beside_them_it_is_found():
    made = cut(sheet(), "slit")
    with pytest.raises(InputError, match=r"Nodes \d+, \d+ lie on each other at \(2, 2, 0\) m.*less than 7e-06 m"):
        made.node_at((2, 2, 0))
    lips = {made.node_at((2, 2 + off, 0)): off for off in (-1e-6, 1e-6)}
    for node, off in lips.items():
        beside = made.points[made.elements[(made.elements == node).any(axis=1)]]
        assert (np.sign(off) * (beside[..., 1] - 2) >= 0).all()
    assert len(lips) == 2
    assert made.points[made.node_at((1, 2, 0))].tolist() == [1, 2, 0]


def test_one_lip_is_enough_to_name_a_slit():
    made = cut(sheet(), "slit")
    lip = made.edge_groups["slit"][::2]
    assert len(Mesh(made.points, made.elements, edge_groups={"lip": lip}, cuts="lip").points) == len(made.points)


def test_lips_may_be_divided_differently():
    """A cut all across with four elements on one side and three on the other."""
    one, other = rectangle(2, 1, (2, 4)), rectangle(2, 1, (2, 3))
    points = np.concatenate([one.points, other.points + np.array([2, 0, 0])])
    start = len(one.points)
    lips = np.concatenate([one.edge_groups["right"], other.edge_groups["left"] + start])
    rows = np.concatenate([one.elements, other.elements + start])
    assert len(Mesh(points, rows, edge_groups={"lips": lips}, cuts=["lips"]).parts) == 2
    for groups in ({}, {"lips": lips}):
        with pytest.raises(MeshError, match="are not joined"):
            Mesh(points, rows, edge_groups=groups)


@pytest.mark.parametrize(
    ("names", "error", "message"),
    [
        ("slot", InputError, "cuts: there is no edge group 'slot'. Did you mean 'slit'"),
        ("left", MeshError, r"Cut 'left', from \(0, .*no nodes lie on each other there, as its edges are free"),
        (
            "short",
            InputError,
            r"'short' has a cut inside the surface that is one edge long, from \(4, 2, 0\) m to \(3, 2",
        ),
    ],
)
def test_cuts_that_make_no_sense(names, error, message):
    with pytest.raises(error, match=message):
        cut(sheet(), names)


def test_a_mesh_does_not_open_cuts_by_itself():
    mesh = sheet()
    with pytest.raises(MeshError, match=r"Cut 'slit'.*elements share its edges; mesh\.cut doubles their nodes"):
        Mesh(mesh.points, mesh.elements, edge_groups=mesh.edge_groups, cuts=["slit"])
    with pytest.raises(InputError, match="cuts: there is no edge group 'row'"):
        Mesh(mesh.points, mesh.elements, edge_groups=mesh.edge_groups, cuts=["row"])
