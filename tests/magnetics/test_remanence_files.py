"""Remanence and templates from files: what is read, and what is refused with its line."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from magshell.errors import InputError
from magshell.magnetics import remanence

STRIP = ms.mesh.rectangle(4e-3, 2e-3, (4, 2))
CENTRES = STRIP.points[STRIP.elements[:, :4]].mean(axis=1)
VECTORS = np.random.default_rng(5).uniform(-0.1, 0.1, CENTRES.shape)
POINTS = STRIP.points[STRIP.elements]


def csv(path, header, *columns):
    rows = np.hstack(columns).tolist()
    path.write_text("\n".join(["# measured", header, "", *(",".join(map(repr, row)) for row in rows)]) + "\n")
    return path


def test_places_in_any_order_and_units(tmp_path):
    order = np.random.default_rng(6).permutation(len(CENTRES))
    file = csv(tmp_path / "b.csv", "b1, b2,b3,x1,x2 ,x3", 1e3 * VECTORS[order], 1e3 * CENTRES[order] + 0.2)
    found = remanence.from_file(file, "mT", "mm")(STRIP, POINTS)
    assert np.abs(found - VECTORS[:, None]).max() < 1e-16


def test_rows_or_an_array_for_the_elements(tmp_path):
    file = csv(tmp_path / "b.csv", "b1,b2,b3,comment", VECTORS, np.zeros((len(VECTORS), 1)))
    assert np.array_equal(remanence.from_file(file)(STRIP, POINTS)[:, 3], VECTORS)
    np.save(tmp_path / "b.npy", 1e4 * VECTORS)
    assert np.abs(remanence.from_file(tmp_path / "b.npy", "G")(STRIP, POINTS)[:, 3] - VECTORS).max() < 1e-16
    np.save(tmp_path / "short.npy", VECTORS[1:])
    with pytest.raises(InputError, match=r"shape \(7, 3\); the mesh needs \(8, 3\)"):
        remanence.from_file(tmp_path / "short.npy")(STRIP, POINTS)


def test_every_element_needs_a_place(tmp_path):
    file = csv(tmp_path / "b.csv", "x1,x2,x3,b1,b2,b3", CENTRES[1:], VECTORS[1:])
    with pytest.raises(
        InputError, match=r"1 of 8 elements have no value near them; the worst is element 0 at \(0\.0005"
    ):
        remanence.from_file(file)(STRIP, POINTS)
    nearest = remanence.from_file(file, tolerance=1.1e-3)(STRIP, POINTS)
    assert np.array_equal(nearest[0, 0], VECTORS[4]) or np.array_equal(nearest[0, 0], VECTORS[1])
    with pytest.raises(InputError, match=r"7 of 8 elements have no value.*Check the unit of the places"):
        remanence.from_file(file, length_unit="mm")(STRIP, POINTS)
    group = remanence.by_group({"all but one": remanence.from_file(file)})
    mesh = ms.mesh.Mesh(STRIP.points, STRIP.elements, {"all but one": np.arange(1, 8)})
    assert np.array_equal(group(mesh, POINTS)[1:, 0], VECTORS[1:])


def test_a_template_from_displacements(tmp_path):
    """The same numbers by place, by row and as an array; Rᵀ b of a quarter turn about X2."""
    u = STRIP.points @ np.array([[0, 0, 1], [0, 1, 0], [-1, 0, 0]]).T - STRIP.points
    order = np.random.default_rng(7).permutation(len(u))
    files = [
        csv(tmp_path / "places.csv", "x1,x2,x3,u1,u2,u3", 1e3 * STRIP.points[order], 1e3 * u[order]),
        csv(tmp_path / "rows.csv", "u1,u2,u3", 1e3 * u),
        tmp_path / "u.npy",
    ]
    np.save(files[2], 1e3 * u)
    for file in files:
        values = remanence.template(remanence.displaced_from_file(file, "mm"), 0.1, (1, 0, 0))(STRIP, POINTS)
        assert np.abs(values - [0, 0, 0.1]).max() < 1e-15, file.name
    short = csv(tmp_path / "short.csv", "x1,x2,x3,u1,u2,u3", STRIP.points[:-1], u[:-1])
    with pytest.raises(InputError, match=f"short.csv has no row for node {len(u) - 1} at"):
        remanence.template(remanence.displaced_from_file(short), 0.1, (1, 0, 0))(STRIP, POINTS)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("", "b.csv: is empty; its first line names the columns x1,x2,x3,b1,b2,b3"),
        ("# nothing\n\n", "is empty"),
        ("b1,b2\n1,2\n", "line 1: there is no column 'b3'"),
        ("b1,b2,b3,x1\n1,2,3,4\n", "line 1: there is no column 'x2'"),
        ("b1,b2,b3,b1\n1,2,3,4\n", "more than one column is named 'b1'"),
        ("b1,b2,b3\n", "no rows"),
        ("b1,b2,b3\n1,2,3\n\n1,2\n", "line 4: has 2 fields; the first line has 3"),
        ("b1,b2,b3\n1,2,x\n", "line 2: b3 is 'x', not a finite number"),
        ("b1,b2,b3\n1,nan,2\n", "line 2: b2 is 'nan', not a finite number"),
        ("b1,b2,b3\n1,2,-1e308\n", "line 2: b3 is '-1e308', more than 1e+60"),
        ("b1;b2;b3\n1;2;3\n", "line 1: there is no column 'b1'; the columns are 'b1;b2;b3'"),
        (b"b1,b2,b3\n\xff\xfe,1,2\n", "not a text file in UTF-8"),
    ],
)
def test_tables_that_are_none(tmp_path, content, words):
    file = tmp_path / "b.csv"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as caught:
        remanence.from_file(file)
    assert words in str(caught.value), str(caught.value)


def test_arrays_that_are_none(tmp_path):
    file = tmp_path / "b.npy"
    for content, words in ((b"", "not an array"), (b"text", "not an array"), (b"\x93NUMPY\x01\x00v", "not an array")):
        file.write_bytes(content)
        with pytest.raises(InputError, match=words):
            remanence.from_file(file)
    for array, words in (
        (np.zeros((3, 2)), r"shape \(3, 2\)"),
        (np.array([["a", "b", "c"]]), "it must be numbers"),
        (np.array([{}], dtype=object), "not an array"),
        (np.array([[1.0, np.inf, 0.0]]), "row 0 is not finite"),
        (np.array([[1.0, 0.0, -1e308]]), "row 0 is over"),
    ):
        np.save(file, array)
        with pytest.raises(InputError, match=words):
            remanence.from_file(file)


def test_files_and_units_that_do_not_exist(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        remanence.from_file(tmp_path / "b.csv")
    with pytest.raises(InputError, match="no such file"):
        remanence.from_file(tmp_path / "b.npy")
    with pytest.raises(InputError, match="cannot be read"):
        remanence.from_file(tmp_path)
    with pytest.raises(InputError, match=r"'mt' is not a unit of magnetic flux density\. Did you mean 'mT'"):
        remanence.from_file(tmp_path / "b.csv", flux_density_unit="mt")
