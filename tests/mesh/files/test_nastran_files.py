"""Nastran's bulk data: three kinds of fields, coordinate systems of every kind, what would change the surface."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import magshell as ms
from magshell.errors import InputError

from .nastran import card, deck, short
from .same import described

PLATE = ms.mesh.rectangle(20e-3, 5e-3, (4, 2))


def strip(mesh, scale=1e3):
    """Points in mm; nodes with the property, 1 on the left and 2 on the right."""
    middle = mesh.points[mesh.elements[:, :4]].mean(axis=1)[:, 0] > 10e-3
    return scale * mesh.points, [(row, 1 + int(right)) for row, right in zip(mesh.elements, middle, strict=True)]


@pytest.mark.parametrize("form", ["free", "small", "long"])
def test_fields_of_all_kinds(tmp_path, form):
    (tmp_path / "part.bdf").write_text(deck(*strip(PLATE), form=form))
    mesh = ms.mesh.read(tmp_path / "part.bdf", unit="mm")
    assert described(mesh)["elements"] == described(PLATE)["elements"]
    assert {name: rows.tolist() for name, rows in mesh.element_groups.items()} == {
        "surface-1": [0, 1, 4, 5],
        "surface-2": [2, 3, 6, 7],
    }


@pytest.mark.parametrize("suffix", [".nas", ".fem", ".BDF"])
def test_endings_first_order_and_lines(tmp_path, suffix):
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0], [1, 1, 0.0]])
    text = deck(points, [((0, 1, 4, 3), 7), ((1, 2, 4), 8)])
    bars = [card("CBAR", 10, 3, 1, 2), card("CROD", 11, 3, 2, 3), card("PLOTEL", 12, 1, 4)]
    (tmp_path / f"part{suffix}").write_text(text.replace("ENDDATA", "\n".join(bars)))
    mesh = ms.mesh.read(tmp_path / f"part{suffix}", unit="mm", second_order=True)
    assert mesh.triangles.tolist() == [False, True]
    assert {name: len(rows) for name, rows in mesh.edge_groups.items()} == {"curve-3": 2}
    assert list(mesh.element_groups) == ["surface-7", "surface-8"]


def test_what_meshio_reads_of_the_same_file(tmp_path):
    """(Of eight nodes in free fields it drops two.)"""
    meshio = pytest.importorskip("meshio")
    points, elements = strip(PLATE)
    (tmp_path / "part.bdf").write_text(deck(points, [(row[:4], number) for row, number in elements], form="free"))
    found = meshio.read(tmp_path / "part.bdf")
    mesh = ms.mesh.read(tmp_path / "part.bdf", unit="mm", second_order=True)
    used = np.unique(found.cells_dict["quad"])
    assert np.allclose(1e-3 * found.points[used], mesh.points[: len(used)])
    assert np.array_equal(np.searchsorted(used, found.cells_dict["quad"]), mesh.elements[:, :4])


def frame(kind, origin, axes):
    """Cards' nine numbers of a coordinate system: its origin, a point of its third axis, one of the plane 1-3."""
    return (*origin, *(origin + 2 * axes[2]), *(origin + axes[0] + 3 * axes[2]))


def place(kind, x):
    """Coordinates of a kind, angles in degrees, of a position in its frame."""
    if kind == "R":
        return x
    if kind == "C":
        return np.array([np.hypot(x[0], x[1]), np.degrees(np.arctan2(x[1], x[0])), x[2]])
    far = np.linalg.norm(x)
    return np.array([far, np.degrees(np.arccos(x[2] / far)), np.degrees(np.arctan2(x[1], x[0]))])


def turned(rng):
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))


@settings(max_examples=25, deadline=None, derandomize=True, database=None)
@given(kinds=st.tuples(*[st.sampled_from("RCS")] * 2), seed=st.integers(0, 10**6), by_default=st.booleans())
def test_coordinate_systems_one_in_another(tmp_path_factory, kinds, seed, by_default):
    """A plate given in a system that is given in another one: where it was before."""
    rng = np.random.default_rng(seed)
    outer, inner, outer_origin, inner_origin = turned(rng), turned(rng), rng.normal(size=3), rng.normal(size=3)
    points, elements = strip(PLATE, scale=100.0)
    points += (0.3, 0.2, 0.1)
    # The inner system's points A, B, C are written in the outer one's coordinates.
    nine = np.array(frame(kinds[1], inner_origin, inner)).reshape(3, 3)
    nine = np.array([place(kinds[0], outer @ (point - outer_origin)) for point in nine]).ravel()
    more = [
        card(f"CORD2{kinds[1]}", 20, 10, *nine.tolist(), form="long"),
        card(f"CORD2{kinds[0]}", 10, "", *frame(kinds[0], outer_origin, outer), form="long"),
    ]
    if by_default:
        more.append(card("GRDSET", "", 20))
    own = {tuple(point): place(kinds[1], inner @ (point - inner_origin)).tolist() for point in points}
    text = deck(points, elements, "long", lambda n, point: (n, "" if by_default else 20, *own[tuple(point)]), more)
    file = tmp_path_factory.mktemp("systems") / "part.nas"
    file.write_text(text)
    mesh = ms.mesh.read(file, unit="cm")
    assert np.allclose(mesh.points, 0.01 * points, rtol=0, atol=1e-8)


def test_a_system_by_grid_points(tmp_path):
    """CORD1C twice on a card: a quarter of a tube about the axis through points of another system."""
    points, elements = strip(PLATE)
    points = points @ np.diag([1.0, 18.0, 0.0])  # 0 to 20 along, 0 to 90 degrees
    more = [
        card("CORD1C", 5, 101, 102, 103, 6, 101, 103, 102),
        card("CORD2R", 4, "", 1.0, 2.0, 3.0, 1.0, 2.0, 4.0, 2.0, 2.0, 3.0),
        card("GRID", 101, 4, 0.0, 0.0, 0.0),
        card("GRID", 102, 4, 0.0, 0.0, 1.0),
        card("GRID", 103, "", 2.0, 2.0, 3.0),
    ]
    text = deck(points, elements, grid=lambda n, p: (n, 5, 10.0, p[1], p[0]), more=more)
    (tmp_path / "part.bdf").write_text(text)
    mesh = ms.mesh.read(tmp_path / "part.bdf", unit="mm")
    assert np.allclose(np.hypot(*(mesh.points[:, :2] - (1e-3, 2e-3)).T), 10e-3, atol=1e-8)
    assert np.allclose(np.ptp(mesh.points, axis=0), (10e-3, 10e-3, 20e-3), atol=1e-8)
    assert np.isclose(mesh.points[:, 2].min(), 3e-3)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("ENDDATA", "CQUAD4,90,1,1,2,3,4,,0.5", r"line \d+: CQUAD4 90 is offset from its grid points by 0.5"),
        ("ENDDATA", "CSHEAR,90,1,1,2,3,4", r"1 of type CSHEAR.*holes"),
        ("ENDDATA", "CTRAX3,90,1,1,2,3", r"1 of type CTRAX3"),
        ("ENDDATA", "CTETRA,90,1,1,2,3,4", r"1 solid elements"),
        ("ENDDATA", "GRID,90,7,0.,0.,0.", r"line \d+: GRID 90: there is no coordinate system 7"),
        (
            "ENDDATA",
            "CORD2R,7,8,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nCORD2R,8,7,0.,0.,0.,0.,0.,1.\n,1.,0.,0.\nGRID,90,7",
            "in itself",
        ),
        ("ENDDATA", "CORD1R,7,90,2,3\nGRID,90,7", "in itself"),
        ("ENDDATA", "CORD2R,7,,0.,0.,0.,0.,0.,1.\n,0.,0.,2.\nGRID,90,7", "do not span a plane"),
        ("ENDDATA", "CORD3R,7,1,2,3\nGRID,90,7", "CORD3R is not read"),
        ("ENDDATA", "GRID,1,,0.,0.,0.", "grid point 1 is given a second time"),
        ("ENDDATA", "CQUAD8,90,1,1,2,3,4,5", "CQUAD8 90 has 5 grid points, not 4 or 8"),
        ("ENDDATA", "CTRIA3,90,1,1,2,777", "CTRIA3 90 has grid point 777, which is not there"),
        ("ENDDATA", "CTRIA3,90,1,1,2,x", r"line \d+: CTRIA3: expected a number, found 'x'"),
        ("ENDDATA", "GRID,90,,1.x", r"line \d+: GRID: expected a coordinate, found '1.x'"),
        ("ENDDATA", "INCLUDE 'more.bdf'", "INCLUDE is not followed"),
        ("ENDDATA", "DTI,UNITS,1,KG,N,IN,S", "lengths are in IN"),
        ("ENDDATA", "=,*(1)", "repeated cards"),
        ("GRID", "GRIT", "has no GRID cards"),
    ],
)
def test_what_is_refused(tmp_path, old, new, message):
    text = deck(*strip(PLATE))
    (tmp_path / "part.bdf").write_text(text.replace(old, f"{new}\n" if old == "ENDDATA" else new))
    with pytest.raises(InputError, match=rf"^part.bdf.*{message}"):
        ms.mesh.read(tmp_path / "part.bdf", unit="mm")


def test_the_unit_and_what_is_left_out_are_told(tmp_path):
    more = ["DTI,UNITS,1,KG,N,MM,S", "CELAS2,99,1.,1,1,2,2", "CONM2,98,3,,1."]
    (tmp_path / "part.bdf").write_text(deck(*strip(PLATE), more=more))
    mesh = ms.mesh.read(tmp_path / "part.bdf")
    assert mesh.origin.unit == "mm"
    assert mesh.origin.changes == ("1 cards CELAS2 left out", "1 cards CONM2 left out")


@given(st.floats(-1e9, 1e9, allow_subnormal=False).filter(lambda x: x == 0 or abs(x) > 1e-9))
def test_numbers_of_eight_columns(value):
    from magshell.mesh.files.cards import Card
    from magshell.mesh.files.lines import Lines

    for text in (short(value), f"{value:.6E}".replace("E", "D"), repr(value)):
        read = Card("GRID", [text], 0).real(Lines("a", b"a"), 0, "a number")
        assert np.isclose(read, value, rtol=1e-2 if len(text) <= 8 else 1e-5, atol=0)
