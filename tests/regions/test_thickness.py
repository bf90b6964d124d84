"""Thickness that varies: by a function, along a direction, from arrays and tables."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from regions.models import LENGTH, SOFT, WIDTH, strip


def linear(x):
    return 1e-3 - 0.02 * x[..., 0]


def heights(thickness, mesh=None):
    mesh = mesh or strip()
    (part,) = ms.Shell(mesh, thickness, SOFT).parts
    return mesh, part


def check_linear(thickness):
    mesh, part = heights(thickness)
    x = mesh.points[mesh.elements]
    np.testing.assert_allclose(part.at_nodes[..., 0], linear(x), rtol=1e-12)
    points, _ = ms.Shell(mesh, 1e-3, SOFT).element.integration(x)
    N = ms.Shell(mesh, 1e-3, SOFT).element.functions(8, points, x).values
    np.testing.assert_allclose(part.at_points[..., 0], linear(np.einsum("epn,enx->epx", N, x)), rtol=1e-12)


def test_a_function_of_the_position():
    check_linear(ms.thickness.function(linear))


def test_a_profile():
    check_linear(ms.thickness.profile([2, 0, 0], [0.0, LENGTH], [1e-3, 0.6e-3]))
    _, part = heights(ms.thickness.profile([1, 0, 0], [0.005, 0.01], [1e-3, 0.5e-3]))
    assert (part.at_nodes.max(), part.at_nodes.min()) == (1e-3, 0.5e-3)


def test_values_of_nodes_and_of_elements():
    check_linear(ms.thickness.per_node(linear(strip().points)))
    _, part = heights(ms.thickness.per_element([1e-3, 2e-3, 3e-3, 4e-3]))
    np.testing.assert_array_equal(part.at_nodes[:, :, 0], np.outer([1e-3, 2e-3, 3e-3, 4e-3], np.ones(8)))


def test_places_are_continuous_or_stepped():
    x, y = np.meshgrid(np.linspace(0, LENGTH, 41), np.linspace(0, WIDTH, 11))
    places = np.stack([x.ravel(), y.ravel(), 0 * x.ravel()], axis=1)
    check_linear(ms.thickness.at_places(places, linear(places)))
    mesh, part = heights(ms.thickness.at_places(places, linear(places), stepped=True))
    centres = mesh.points[mesh.elements[:, :4]].mean(axis=1)
    np.testing.assert_allclose(part.at_nodes[:, :, 0], np.repeat(linear(centres)[:, None], 8, axis=1), rtol=1e-12)


def test_of_two_places_as_near_the_mean():
    places = [[0.0, 0.0, 0.0], [0.0, WIDTH, 0.0], [0.015, 0.5 * WIDTH, 0.0]]
    stepped = ms.thickness.at_places(places, [1e-3, 2e-3, 3e-3], stepped=True, tolerance=1.0)
    _, part = heights(stepped)
    np.testing.assert_allclose(part.at_nodes[:, 0, 0], [1.5e-3, 3e-3, 3e-3, 3e-3], rtol=1e-12)


@pytest.mark.parametrize("places", [False, True])
def test_tables(tmp_path, places):
    mesh = strip()
    rows = [
        f"{1e3 * linear(x):.12g}" + (f",{','.join(f'{1e3 * v:.12g}' for v in x)}" if places else "")
        for x in mesh.points
    ]
    (tmp_path / "h.csv").write_text("\n".join(["thickness [mm]" + ",x1,x2,x3" * places, *rows]))
    check_linear(ms.thickness.from_file(tmp_path / "h.csv", "mm", "mm"))


def test_a_table_of_elements(tmp_path):
    (tmp_path / "h.csv").write_text("element;thickness\n0;1,0\n1;0,9\n2;0,8\n3;0,7\n")
    _, part = heights(ms.thickness.from_file(tmp_path / "h.csv", "mm"))
    np.testing.assert_allclose(part.at_nodes[:, 3, 0], [1e-3, 0.9e-3, 0.8e-3, 0.7e-3], rtol=1e-12)


def test_a_layer_may_taper():
    layers = [ms.Layer(ms.thickness.function(linear), SOFT), ms.Layer(0.5e-3, SOFT)]
    shell = ms.Shell(strip(), regions=[ms.Region("inner", 1e-3, SOFT), ms.Region("outer", layers=layers, offset="top")])
    part = shell.parts[1]
    np.testing.assert_allclose(part.at_nodes[..., 0], linear(shell.mesh.points[shell.mesh.elements[2:]]), rtol=1e-12)
    np.testing.assert_allclose(part.offset_at_nodes, 0.5 * part.at_nodes.sum(axis=2), rtol=1e-15)


BAD = {
    "along nowhere": (lambda: ms.thickness.profile([0, 0, 0], [0, 1], [1, 1]), r"along is \[0.0, 0.0, 0.0\]"),
    "falling": (lambda: ms.thickness.profile([1, 0, 0], [1, 0], [1, 1]), "thickness: positions are .* that rise"),
    "too few": (lambda: ms.thickness.profile([1, 0, 0], [0, 1], [1]), "thickness: values has 1 entries; there are 2"),
    "shape": (lambda: heights(ms.thickness.function(lambda x: x)), r"the function returned shape \(16, 3\); expected"),
    "nodes": (lambda: heights(ms.thickness.per_node([1.0])), r"has shape \(1,\); the mesh has 23 nodes"),
    "elements": (lambda: heights(ms.thickness.per_element([1.0])), r"has shape \(1,\); the mesh has 4 elements"),
    "not finite": (
        lambda: heights(ms.thickness.function(lambda x: np.where(x[:, 0] > 0.016, np.nan, 1e-3))),
        r"^shell: thickness is nan m in element 3; it must be positive and finite",
    ),
    "negative": (
        lambda: heights(ms.thickness.function(lambda x: 1e-3 - x[:, 0] / 12)),
        r"^shell: thickness is -[0-9.e-]+ m in element 2; it must be positive",
    ),
    "between the nodes": (
        lambda: heights(ms.thickness.per_element([1e-3, 0.0, 1e-3, 1e-3])),
        r"^shell: thickness is 0 m in element 1; it must be positive",
    ),
    "huge": (lambda: heights(ms.thickness.function(lambda x: 1.0 + x[:, 0])), r"in element 0, larger than the body"),
    "places": (lambda: ms.thickness.at_places([[0, 0]], [1]), "places and values have the shapes"),
    "infinite": (lambda: ms.thickness.at_places([[0, 0, np.inf]], [1]), "not finite"),
    "twice": (lambda: ms.thickness.at_places([[0, 0, 0], [0, 0, 0]], [1, 2]), r"places\[0\] and places\[1\] are one"),
    "far": (lambda: heights(ms.thickness.at_places([[0, 0, 0]], [1e-3])), "has no value near .* Check length_unit"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD, ids=str)
def test_bad_thickness(case):
    made, words = BAD[case]
    with pytest.raises(ms.InputError, match=words):
        made()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("height\n1\n", "no column named 'thickness'|there is no column"),
        ("thickness\n1\n2\n", "has 2 rows and no places; the mesh has 23 nodes and 4 elements"),
        ("thickness\none\n", "line 2: thickness is 'one', not a finite number"),
        ("thickness (cm)\n1\n", "thickness is in 'cm', but thickness_unit says 'mm'"),
        ("thickness,x1,x2,x3\n1,0,0,0\n2,0,0,0\n", r"line 3: the place \(0, 0, 0\) has \(2\), but in line 2"),
    ],
)
def test_bad_tables(tmp_path, text, words):
    (tmp_path / "h.csv").write_text(text)
    with pytest.raises(ms.InputError, match=words):
        heights(ms.thickness.from_file(tmp_path / "h.csv", "mm", "mm"))
