"""Remanence and templates from files: what is read, and what is refused with its line."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import magshell as ms
from magshell.errors import InputError
from magshell.magnetics import remanence
from magshell.magnetics.remanence.sampled import averaged
from magshell.tables import Columns, read_table
from magshell.units import FLUX_DENSITY, LENGTH

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
    assert np.abs(nearest[0, 0] - 0.5 * (VECTORS[4] + VECTORS[1])).max() < 1e-16
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
        ("b1|b2|b3\n1|2|3\n", "line 1: there is no column 'b1'; the columns are 'b1|b2|b3', separated by commas"),
        ("b1 b2 b3\n1 2 3\n", "'b1 b2 b3', separated by commas (commas, semicolons, tabs are read)"),
        ("b1;b2\n1;2\n", "line 1: there is no column 'b3'; the columns are 'b1;b2', separated by semicolons"),
        ("b1,b2,b3\n1,0,2,0,3,0\n", "with decimal commas the fields must be separated by semicolons or tabs"),
        ("b1;b2;b3\n1,5;2;3\n1;2.5;3\n", "line 3: b2 is '2.5', but line 2 has '1,5'"),
        ("b1\tb2\tb3\n1.5\t2\t3,0\n", "line 2: b3 is '3,0', but line 2 has '1.5'"),
        ("b1;b2;b3\n1.234,5;2;3\n", "b1 is '1.234,5', not a finite number"),
        ("b1;b2;b3\n1,234,5;2;3\n", "b1 is '1,234,5', not a finite number"),
        ("B1,b2,b3,b1,B1\n1,2,3,4,5\nx\n", "line 3: has 1 fields"),
        ("B1,b2,b3, B1\n1,2,3,4\n", "more than one column is named 'b1'"),
        ("b1 [mT],b2,b3\n1,2,3\n", "line 1: b1 is in 'mT', but flux_density_unit says 'T'"),
        ("b1,b2 (Oe),b3\n1,2,3\n", "line 1: b2 is in 'Oe', which is no unit of remanence"),
        ("b1,b2,b3,x1/mm,x2,x3\n1,2,3,4,5,6\n", "line 1: x1 is in 'mm', but length_unit says 'm'"),
        (
            "x1,x2,x3,b1,b2,b3\n1,1,0,5,0,0\n2,1,0,5,0,0\n\n1,1,0,7,0,0\n",
            "line 5: the place (1, 1, 0) has (7, 0, 0), but in line 2 it has (5, 0, 0)",
        ),
        ("x1,x2,x3,b1,b2,b3\n1,1,0,5,0,0\n2,1,0,5,0,0\n1,1.0000000001,0,7,0,0\n", "line 4: the place"),
        (b"b1,b2,b3\n\xff\xfe,1,2\n", "not a text file in UTF-8"),
    ],
)
def test_tables_that_are_none(tmp_path, content, words):
    file = tmp_path / "b.csv"
    file.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(InputError) as caught:
        remanence.from_file(file)
    assert words in str(caught.value), str(caught.value)


PLAIN = "x1,x2,x3,b1,b2,b3\n" + "".join(
    ",".join(f"{number:.4f}" for number in row) + "\n" for row in np.hstack([1e3 * CENTRES, 1e3 * VECTORS]).tolist()
)


def with_commas(separator):
    return PLAIN.replace(",", separator).replace(".", ",")


@pytest.mark.parametrize(
    "text",
    [
        PLAIN.replace(",", ";"),
        PLAIN.replace(",", "\t"),
        with_commas(";"),
        with_commas("\t"),
        PLAIN.upper(),
        PLAIN.replace("x1,x2,x3,b1,b2,b3", "X1 [mm], X2 (mm),x3/mm ,B1 [mT],b2 / mT,B3(mT)"),
        with_commas(";").replace("x1;x2;x3;b1;b2;b3", '"X1 [mm]";X2;X3;"b1 [mT]";B2;B3'),
        "\ufeff# from a spreadsheet; with commas, and tabs\n;;;;;\n" + with_commas(";").replace("\n", "\r\n"),
        PLAIN + PLAIN.splitlines()[3] + "\n",
    ],
)  # fmt: skip
def test_tables_as_programs_write_them(tmp_path, text):
    (tmp_path / "plain.csv").write_text(PLAIN)
    (tmp_path / "b.csv").write_text(text, encoding="utf-8", newline="")
    expected, found = (
        remanence.from_file(tmp_path / name, "mT", "mm")(STRIP, POINTS) for name in ("plain.csv", "b.csv")
    )
    assert np.abs(expected[:, 0] - VECTORS).max() < 1e-7
    assert np.array_equal(found, expected)


@given(
    rows=st.lists(st.lists(st.floats(-1e50, 1e50), min_size=3, max_size=3), min_size=1, max_size=5),
    separator=st.sampled_from([";", "\t"]),
    comma=st.booleans(),
    heading=st.sampled_from(["b{}", "B{}", "B{} [T]", " b{}/T", "b{} (T)"]),
)
def test_numbers_survive_every_spelling(rows, separator, comma, heading, tmp_path_factory):
    file = tmp_path_factory.mktemp("spelled") / "b.csv"
    lines = [separator.join(map(repr, row)) for row in rows]
    text = "\n".join(lines).replace(".", "," if comma else ".")
    file.write_text(separator.join(heading.format(axis) for axis in (1, 2, 3)) + "\n" + text)
    table = read_table(
        file, Columns(("b1", "b2", "b3"), FLUX_DENSITY, "T", "unit"), Columns(("x1",), LENGTH, "m", "unit")
    )
    assert np.array_equal(table.wanted, np.array(rows))


def test_a_unit_with_either_micro_sign(tmp_path):
    (tmp_path / "b.csv").write_text(PLAIN.replace("b1", "b1 [μT]").replace("x1", "x1 [mm]"), encoding="utf-8")
    greek, latin = (
        remanence.from_file(tmp_path / "b.csv", unit, "mm")(STRIP, POINTS) for unit in ("\u03bcT", "\u00b5T")
    )
    assert np.array_equal(greek, latin)
    assert np.abs(1e3 * latin[:, 0] - VECTORS).max() < 1e-7
    with pytest.raises(InputError, match="b1 is in 'μT', but flux_density_unit says 'mT'"):
        remanence.from_file(tmp_path / "b.csv", "mT", "mm")


def test_places_as_near_as_others():
    """Four places around the centre of each of four elements: the mean; two that agree are no doubt."""
    mesh = ms.mesh.rectangle(4.0, 1.0, (4, 1))
    corners = [[x, y, 0.0] for x in range(5) for y in (0.0, 1.0)]
    along = np.array([[x, 0.0, 0.0] for x, _, _ in corners])
    of = remanence.at_places(corners, along)
    points = mesh.points[mesh.elements]
    assert np.abs(of(mesh, points)[:, 0] - [[x + 0.5, 0, 0] for x in range(4)]).max() < 1e-15
    assert averaged(of, mesh, points).tolist() == [0, 1, 2, 3]
    same = remanence.at_places(corners, np.ones((10, 3)))
    assert not averaged(same, mesh, points).size
    assert not averaged(remanence.constant((1, 0, 0)), mesh, points).size
    halves = ms.mesh.Mesh(mesh.points, mesh.elements, {"one": [0, 1], "two": [2, 3]})
    both = remanence.by_group({"one": same, "two": of})
    assert averaged(both, halves, points).tolist() == [2, 3]


def test_one_place_with_two_vectors():
    with pytest.raises(InputError, match=r"places\[0\] and places\[2\] are one place with different vectors"):
        remanence.at_places([[0, 0, 0], [1, 0, 0], [0, 0, 0]], [[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    many = np.zeros((200_000, 3))
    remanence.at_places(many, many)


def test_a_slit_in_a_table_of_displacements(tmp_path):
    file = csv(tmp_path / "u.csv", "x1,x2,x3,u1,u2,u3", np.zeros((2, 3)), np.eye(3)[:2])
    with pytest.raises(InputError, match=r"line 5: the place \(0, 0, 0\) has .* line 4 .* At a slit, leave the places"):
        remanence.displaced_from_file(file)


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
    with pytest.raises(InputError, match=r"'mt' is not a unit of remanence\. Did you mean 'mT'"):
        remanence.from_file(tmp_path / "b.csv", flux_density_unit="mt")
