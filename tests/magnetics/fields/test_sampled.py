"""Fields on grids and of functions: order of the interpolation, files, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
import pyvista

from magnetics.fields.cases import SHAPES, harmonic, near, sampled
from magshell.errors import InputError
from magshell.magnetics.fields import FieldUnknown, FunctionField, SampledField, read_grid

BELOW = np.array([0.0, 0.0, -0.2])
CUBE = [np.linspace(0.0, 0.03, 4), np.linspace(-0.01, 0.01, 5), np.array([0.0, 0.01, 0.025, 0.03])]
GRID = np.stack(np.meshgrid(*CUBE, indexing="ij"), axis=-1)
B = harmonic(GRID.reshape(-1, 3)).reshape(GRID.shape)
INSIDE = np.array([[0.012, 0.003, 0.02], [0.03, 0.01, 0.03]])


def test_polynomials_of_third_degree_are_exact():
    field = SampledField(CUBE, B)
    values, exact = field.own(INSIDE, True), FunctionField(harmonic, 0.1).own(INSIDE, True)
    assert np.abs(values.flux_density - exact.flux_density).max() < 1e-16
    assert np.abs(values.gradient - exact.gradient).max() < 1e-14
    assert np.abs(values.second - exact.second).max() < 1e-8


def test_order_of_the_interpolation():
    """Of B fourth, of the gradient third, of the second derivatives second: a dipole 0.2 m below."""
    shape, errors = SHAPES["dipole"], []

    def function(points):
        return shape.flux_density(points - BELOW)

    exact = shape.values(near() - BELOW, True)
    for step in (0.01, 0.005):
        found = sampled(function, step).own(near(), True)
        errors.append([np.linalg.norm(one - other) for one, other in zip(found, exact, strict=True)])
    ratios = np.divide(*errors)
    assert np.all(ratios > (12.0, 6.0, 3.0))


def test_outside_the_grid():
    field = SampledField(CUBE, B)
    with pytest.raises(
        FieldUnknown, match=r"point \(0\.01, 0\.02, 0\) m is outside the grid, which has X2 from -0\.01"
    ):
        field.own(np.array([[0.01, 0.0, 0.0], [0.01, 0.02, 0.0]]), False)
    assert np.isfinite(field.own(np.array([[0.03 + 1e-13, 0.01, 0.0]]), False).flux_density).all()


@pytest.mark.parametrize(
    ("axes", "values", "message"),
    [
        (CUBE[:2], B, "there are 2 axes"),
        ([CUBE[0][::-1], *CUBE[1:]], B, "along X1 must be finite and increase"),
        ([CUBE[0][:3], *CUBE[1:]], B[:3], "3 coordinates along X1; cubic splines need at least 4"),
        (CUBE, B[..., :2], "flux_density has the shape"),
        (
            CUBE,
            np.where(GRID[..., :1] > 0.02, np.nan, B),
            r"not finite at 40 of 80 positions, first at \(0\.03|first at",
        ),
    ],
)
def test_refused_grids(axes, values, message):
    with pytest.raises(InputError, match=message):
        SampledField(axes, values)


def write_csv(path, rows, header="x1 [mm],x2 [mm],x3 [mm],b1 [mT],b2 [mT],b3 [mT]"):
    path.write_text(header + "\n" + "\n".join(",".join(f"{x!r}" for x in row) for row in rows.tolist()) + "\n")


ROWS = np.concatenate([1e3 * GRID.reshape(-1, 3), 1e3 * B.reshape(-1, 3)], axis=1)


def write(path):
    match path.suffix:
        case ".csv":
            write_csv(path, np.random.default_rng(0).permutation(ROWS))
        case ".npy":
            np.save(path, ROWS)
        case ".npz":
            np.savez(path, x1=1e3 * CUBE[0], x2=1e3 * CUBE[1], x3=1e3 * CUBE[2], B=1e3 * B)
        case ".vtr":
            grid = pyvista.RectilinearGrid(*(1e3 * axis for axis in CUBE))
            grid.point_data["B"] = 1e3 * B.transpose(2, 1, 0, 3).reshape(-1, 3)
            grid.point_data["other"] = np.zeros((grid.n_points, 3))
            grid.save(path)


@pytest.mark.parametrize("suffix", [".csv", ".npy", ".npz", ".vtr"])
def test_files_of_every_kind_give_the_same_field(tmp_path, suffix):
    path = tmp_path / f"B{suffix}"
    write(path)
    field = read_grid(path, "mT", "mm")
    assert np.allclose(field.own(INSIDE, False).flux_density, harmonic(INSIDE), rtol=1e-12, atol=1e-17)


COMSOL = "% Model,B.mph\n% Dimension,3\n% Nodes,80\n% Length unit,mm\n% x,y,z,mf.Bx (mT),mf.By (mT),mf.Bz (mT)\n"


@pytest.mark.parametrize("separator", [",", "   "])
def test_an_export_of_comsol(tmp_path, separator):
    rows = "\n".join(separator.join(map(repr, row)) for row in ROWS.tolist())
    (tmp_path / "B.csv").write_text(COMSOL + rows + "\n")
    field = read_grid(tmp_path / "B.csv", "mT", "mm")
    assert np.allclose(field.own(INSIDE, False).flux_density, harmonic(INSIDE), rtol=1e-12, atol=1e-17)
    with pytest.raises(InputError, match="its lengths are in 'mm', but length_unit says 'm'"):
        read_grid(tmp_path / "B.csv", "mT", "m")
    (tmp_path / "B.csv").write_text(COMSOL + rows.replace(repr(float(ROWS[0, 5])), "NaN", 1))
    with pytest.raises(InputError, match=r"B\.csv: .*not finite at 1 of 80 positions"):
        read_grid(tmp_path / "B.csv", "mT", "mm")
    for text, message in (
        ("1,2,3,4\n", "its rows have 4 numbers; they must have six"),
        ("", "its rows have no numbers"),
    ):
        (tmp_path / "B.csv").write_text(COMSOL + text)
        with pytest.raises(InputError, match=message):
            read_grid(tmp_path / "B.csv", "mT", "mm")
    (tmp_path / "B.csv").write_text(COMSOL + "1,2,3,4,5,six\n")
    with pytest.raises(InputError, match=r"B\.csv: could not convert"):
        read_grid(tmp_path / "B.csv", "mT", "mm")


def test_a_vtk_image(tmp_path):
    grid = pyvista.ImageData(dimensions=(4, 5, 6), spacing=(0.01, 0.02, 0.01), origin=(-0.01, 0.0, 0.1))
    grid.point_data["flux"] = harmonic(np.asarray(grid.points))
    grid.save(tmp_path / "B.vti")
    inside = np.array([[0.004, 0.033, 0.12]])
    found = read_grid(tmp_path / "B.vti").own(inside, False).flux_density
    assert np.allclose(found, harmonic(inside), rtol=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda rows: rows[1:], r"4 × 5 × 4 different coordinates, and the position \(0, -10, 0\) is missing"),
        (lambda rows: np.concatenate([rows, rows[:1]]), r"the position \(0, -10, 0\) is there more than once"),
    ],
)
def test_grids_with_holes_and_doubles(tmp_path, change, message):
    np.save(tmp_path / "B.npy", change(ROWS))
    with pytest.raises(InputError, match=r"B\.npy: its .*" + message):
        read_grid(tmp_path / "B.npy", "mT", "mm")


def test_refused_files(tmp_path):
    for name, message in (
        ("B.txt", "no such file"),
        ("B.xls", "a grid is read from .csv"),
        ("B.vtu", "is none of them"),
    ):
        with pytest.raises(InputError, match=message):
            read_grid(tmp_path / name)
    (tmp_path / "B.csv").write_text("b1,b2,b3\n1,2,3\n")
    with pytest.raises(InputError, match="has no columns x1,x2,x3"):
        read_grid(tmp_path / "B.csv")
    write_csv(tmp_path / "B.csv", ROWS)
    with pytest.raises(InputError, match=r"b1 is in 'mT', but flux_density_unit says 'T'"):
        read_grid(tmp_path / "B.csv")
    with pytest.raises(InputError, match=r"'furlong' is not a unit of length"):
        read_grid(tmp_path / "B.csv", "mT", "furlong")
    for suffix in (".npz", ".npy", ".vti"):
        (tmp_path / f"bad{suffix}").write_bytes(b"no array")
        with pytest.raises(InputError, match="bad"):
            read_grid(tmp_path / f"bad{suffix}")
    np.savez(tmp_path / "B.npz", x1=CUBE[0], x2=CUBE[1], y=CUBE[2], B=B)
    with pytest.raises(InputError, match="has no array 'x3'"):
        read_grid(tmp_path / "B.npz")
    np.savez(tmp_path / "B.npz", x1=CUBE[0], x2=CUBE[1], x3=CUBE[2], B=np.where(B > -1, np.nan, B))
    with pytest.raises(InputError, match=r"B\.npz: .*not finite at 80 of 80"):
        read_grid(tmp_path / "B.npz")
    pyvista.Sphere().save(tmp_path / "ball.vtk")
    with pytest.raises(InputError, match="holds a PolyData; a grid is an image"):
        read_grid(tmp_path / "ball.vtk")
    pyvista.ImageData(dimensions=(4, 4, 4)).save(tmp_path / "empty.vti")
    with pytest.raises(InputError, match="needs a point array 'B' of three components; those of three are: none"):
        read_grid(tmp_path / "empty.vti")


def swirl(points):
    """A field with curl and divergence: nothing is projected."""
    x, y, z = points.T
    return np.stack([np.sin(x) * y, x * z**2, np.cos(y) + z], axis=1)


def swirl_gradient(points):
    x, y, z = points.T
    zero, one = np.zeros_like(x), np.ones_like(x)
    rows = [[np.cos(x) * y, np.sin(x), zero], [z**2, zero, 2 * x * z], [zero, -np.sin(y), one]]
    return np.moveaxis(np.array(rows), 2, 0)


def test_a_function_with_and_without_its_gradient():
    points = near() + 0.5
    by_differences, given = (
        FunctionField(swirl, 1.0, gradient).own(points, True) for gradient in (None, swirl_gradient)
    )
    assert np.abs(by_differences.gradient - swirl_gradient(points)).max() < 1e-12
    assert np.array_equal(given.gradient, swirl_gradient(points))
    x, y, _ = points.T
    for values, allowed in ((by_differences, 1e-9), (given, 1e-11)):
        assert np.abs(values.second[:, 0, 0, 0] + np.sin(x) * y).max() < allowed
        assert np.abs(values.second[:, 0, 0, 1] - np.cos(x)).max() < allowed
        assert np.abs(values.second[:, 1, 2, 2] - 2 * x).max() < allowed
        assert np.array_equal(values.second, values.second.swapaxes(2, 3))
        assert np.abs(values.second[:, 2, 0]).max() < allowed


@pytest.mark.parametrize(
    ("function", "length", "message"),
    [
        ("B", 1.0, "must be functions of positions"),
        (swirl, 0.0, "length is 0.0 m; it must be positive"),
        (lambda points: points[:, :2], 1.0, r"an array of shape \(228, 2\); it must be \(228, 3\)"),
        (lambda points: np.where(points > 0.0, np.nan, points), 1.0, r"the function is not finite at \(.*\) m"),
    ],
)
def test_refused_functions(function, length, message):
    with pytest.raises(InputError, match=message):
        FunctionField(function, length).own(near(), False)
