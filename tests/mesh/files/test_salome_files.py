"""Universal and MED files: elements, groups with their names, units and coordinate systems."""

from __future__ import annotations

import importlib.util
import pathlib
import shutil

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError

from .same import described

DATA = pathlib.Path(__file__).parent / "data"
needs_h5py = pytest.mark.skipif(importlib.util.find_spec("h5py") is None, reason="needs h5py")
PLATE = ms.mesh.rectangle(20e-3, 5e-3, (4, 2))


def dataset(number, *lines):
    return "\n".join(["    -1", f"{number:6d}", *lines, "    -1", ""])


def whole(*numbers):
    return "".join(f"{number:10d}" for number in numbers)


def reals(*numbers):
    return "".join(f"{number:25.16E}".replace("E", "D") for number in numbers)


NODES = [line for n, x in enumerate(1e3 * PLATE.points, 1) for line in (whole(n, 1, 1, 11), reals(*x))]
ROUND = [0, 4, 1, 5, 2, 6, 3, 7]
SHELLS = [
    line for e, row in enumerate(PLATE.elements, 1) for line in (whole(e, 95, 1, 1, 7, 8), whole(*(row[ROUND] + 1)))
]
LINES = [
    line
    for e, (a, b, m) in enumerate(PLATE.edge_groups["left"], 101)
    for line in (whole(e, 24, 1, 1, 7, 3), whole(0, 1, 1), whole(a + 1, m + 1, b + 1))
]
GROUPS = [
    whole(1, 0, 0, 0, 0, 0, 0, 3), "linke Hälfte (M+)", whole(8, 1, 0, 0, 8, 2, 0, 0), whole(8, 5, 0, 0),
    whole(2, 0, 0, 0, 0, 0, 0, 3), "left", whole(8, 101, 0, 0, 8, 102, 0, 0), whole(7, 1, 0, 0),
    whole(3, 0, 0, 0, 0, 0, 0, 2), "tip", whole(7, 9, 0, 0, 8, 999, 0, 0),
]  # fmt: skip
UNITS = ["         5mm (milli-newton)             2", reals(1000.0, 1.0, 1.0), reals(273.15)]
SYSTEM = ["         1", "part", whole(1, 0, 8), "global", *(reals(*row) for row in np.eye(4, 3))]


def unv(*, nodes=NODES, shells=SHELLS, more=""):
    return dataset(2411, *nodes) + dataset(2412, *shells, *LINES) + dataset(2467, *GROUPS) + more


def test_a_universal_file(tmp_path):
    """Datasets in any order; names with blanks; nodes that are those of a group's elements are no group."""
    (tmp_path / "part.unv").write_text(
        dataset(164, *UNITS) + dataset(2420, *SYSTEM) + unv() + dataset(2414, "x"), "utf-8"
    )
    mesh = ms.mesh.read(tmp_path / "part.unv")
    assert mesh.origin.unit == "mm"
    assert described(mesh)["elements"] == described(PLATE)["elements"]
    assert {name: rows.tolist() for name, rows in mesh.element_groups.items()} == {"linke Hälfte _M+_": [0, 1, 4]}
    assert described(mesh)["edge groups"] == {"left": described(PLATE)["edge groups"]["left"]}
    assert {name: rows.tolist() for name, rows in mesh.node_groups.items()} == {"tip": [8]}
    assert "1 members of groups left out, which are not in the file" in mesh.origin.changes


def test_what_gmsh_writes_and_crashes_on():
    """Groups of surfaces, curves and a point."""
    mesh = ms.mesh.read(DATA / "gmsh_q8.unv", unit="mm")
    groups = (mesh.element_groups, mesh.edge_groups, mesh.node_groups)
    assert {name: len(rows) for each in groups for name, rows in each.items()} == {
        "left_panel__M+_": 52, "right_panel_M-": 52, "whole_robot": 104,
        "clamped_edge": 4, "Außenrand": 44, "hinge_line": 4, "tip_point": 1,
    }  # fmt: skip
    for name, x in (("clamped_edge", 0.0), ("hinge_line", 10e-3)):
        assert np.allclose(mesh.points[mesh.edge_groups[name], 0], x)
    assert len(mesh.boundary_edges) == 44 + 4


def moved(kind=0, origin=(0.0, 0.0, 1.0)):
    return dataset(2420, "         1", "part", whole(1, kind, 8), "own", *(reals(*row) for row in (*np.eye(3), origin)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (moved() + unv(), r"line \d+: node 1 is given in the coordinate system 1, which is turned or moved"),
        (moved(1, (0, 0, 0)) + unv(), "which is cylindrical"),
        (moved(2, (0, 0, 0)) + unv(), "which is spherical"),
        (unv(nodes=[NODES[0].replace(whole(1, 1), whole(1, 9)), *NODES[1:]]), "system 9, which is not there"),
        (dataset(164, "         7in", reals(39.37, 1, 1)) + unv(), "units of which 39.37 make a metre"),
        (unv(shells=[SHELLS[0].replace("95", "96"), *SHELLS[1:]]), "1 of type 96.*holes"),
        (unv(shells=[SHELLS[0].replace("95", "94"), *SHELLS[1:]]), "element 1 of type 94 has 8 nodes, not 4"),
        (unv(shells=[SHELLS[0].replace("95", "115"), *SHELLS[1:]]), "has 1 solid elements"),
        (unv(more=dataset(780, "x")), r"dataset 780 \(elements\) is of an old kind"),
        (unv(nodes=[*NODES, *NODES[:2]]), "node 1 is given a second time"),
        (unv(nodes=NODES[2:]), "has node 1, which is not there"),
        (unv()[:-8], "is begun here and not ended"),
        (unv(nodes=[NODES[0], "nan 0 0", *NODES[2:]]), "expected three coordinates"),
        ("x", "line 1: not a universal file"),
    ],
)  # fmt: skip
def test_universal_files_that_are_refused(tmp_path, text, message):
    (tmp_path / "part.unv").write_text(text, "utf-8")
    with pytest.raises(InputError, match=rf"^part.unv.*{message}"):
        ms.mesh.read(tmp_path / "part.unv", unit="mm")


def test_a_unit_that_the_user_contradicts(tmp_path):
    (tmp_path / "part.unv").write_text(dataset(164, *UNITS) + unv(), "utf-8")
    with pytest.raises(InputError, match=r"unit: is 'm', but part.unv says that its lengths are in mm"):
        ms.mesh.read(tmp_path / "part.unv", unit="m")


@needs_h5py
def test_a_med_file():
    """As gmsh writes it, which names groups without a name itself."""
    mesh, right = (ms.mesh.read(DATA / f"two-plates{end}", unit="mm") for end in (".med", "-41.msh"))
    found, wanted = described(mesh), described(right)
    names = {"surface-7": "G_2D_7", "curve-4": "G_1D_4"}
    for kind in ("element groups", "edge groups", "node groups"):
        assert found[kind] == {names.get(name, name): members for name, members in wanted[kind].items()}
    assert found["elements"] == wanted["elements"]


@pytest.fixture
def med(tmp_path):
    """A copy to change, and its mesh and step."""
    h5py = pytest.importorskip("h5py")
    shutil.copy(DATA / "two-plates.med", tmp_path / "part.med")
    with h5py.File(tmp_path / "part.med", "r+") as file:
        mesh = next(iter(file["ENS_MAA"].values()))
        yield file, mesh, next(iter(mesh.values())), tmp_path / "part.med"


def fails(med, message):
    med[0].close()
    with pytest.raises(InputError, match=rf"^part.med: {message}"):
        ms.mesh.read(med[3], unit="mm")


@pytest.mark.parametrize(("system", "name"), [(1, "cylindrical"), (2, "spherical")])
def test_med_in_other_coordinates(med, system, name):
    med[1].attrs["REP"] = system
    fails(med, f"coordinates are {name}")


def test_med_with_polygons(med):
    polygons = med[2]["MAI"].create_group("POG")
    polygons.attrs["CGS"] = 1
    polygons["INN"], polygons["NOD"] = [1, 6], [1, 2, 3, 4, 5]
    fails(med, ".*1 of type POG.*holes")


def test_med_with_two_meshes(med):
    med[0].copy(med[1], med[0]["ENS_MAA"], name="other")
    fails(med, r"holds 2 meshes \(other, two-plates-41\)")


def test_med_says_its_unit(med):
    med[1].attrs["UNI"] = np.bytes_("".join(f"{unit:<16}" for unit in ("cm", "cm", "cm")))
    med[0].close()
    assert ms.mesh.read(med[3]).origin.unit == "cm"


def test_med_in_feet(med):
    med[1].attrs["UNI"] = np.bytes_(f"{'ft':<16}" * 3)
    fails(med, "lengths are in ft")


def test_med_with_a_group_of_nodes(med):
    file, mesh, step, path = med
    group = file[f"FAS/{mesh.name.rpartition('/')[2]}"].create_group("NOEUD/corners")
    group.attrs["NUM"] = 3
    name = np.zeros((1, 80), np.int8)
    name[0, :7] = np.frombuffer(b"Ecke 1\0", np.int8)
    group["GRO/NOM"] = name
    belongs = step["NOE/FAM"][()]
    belongs[[0, 2]] = 3
    step["NOE/FAM"][...] = belongs
    points = step["NOE/COO"][()].reshape(3, -1).T[[0, 2]]
    file.close()
    mesh = ms.mesh.read(path, unit="mm")
    assert sorted(map(tuple, 1e3 * mesh.points[mesh.node_groups["Ecke 1"]])) == sorted(map(tuple, points))


@needs_h5py
def test_what_is_no_med_file(tmp_path):
    (tmp_path / "part.med").write_bytes(b"x")
    with pytest.raises(InputError, match=r"part.med: is not a MED file"):
        ms.mesh.read(tmp_path / "part.med", unit="mm")
