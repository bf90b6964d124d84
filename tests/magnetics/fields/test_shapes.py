"""Magnets and coils: constants of coils, exact formulas, Maxwell's equations, derivatives, distances."""

from __future__ import annotations

import magpylib
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from magnetics.fields.cases import SHAPES, around
from magshell.magnetics import fields
from magshell.magnetics.fields import COILS, MAGNETS, FieldUnknown, MagnetField
from magshell.magnetics.fields.differences import harmonic
from magshell.magnetics.fields.dipoles import dipole

MU0 = 4e-7 * np.pi
ORIGIN = np.zeros((1, 3))
NOISE = {"cylinder-segment": 3e-5, "cylinder, magnetised across": 2e-6}
"""Errors of gradients, over |B| / distance, at the worst points, that come from magpylib's own B and no step lowers."""


def size(array):
    """Norm of all but the first index."""
    return np.sqrt((array.reshape(len(array), -1) ** 2).sum(axis=1))


def richardson(function, points, step, direction):
    """Derivative along a unit vector, by central differences of two steps and their extrapolation twice."""
    rows = []
    for k in (1.0, 2.0, 4.0):
        move = k * step[:, None] * direction
        rows.append((function(points + move) - function(points - move)) / (2.0 * k * step[:, None]))
    once = [(4.0 * rows[0] - rows[1]) / 3.0, (4.0 * rows[1] - rows[2]) / 3.0]
    return (16.0 * once[0] - once[1]) / 15.0


def test_every_registered_shape_is_in_the_list():
    kinds = (*MAGNETS.items(), *COILS.items())
    single = {name for name, kind in kinds if isinstance(kind.make, type)}
    assert {shape.kind for shape in SHAPES.values()} >= single


def test_helmholtz_and_maxwell_constants():
    radius, current = 0.07, 3.0
    pair = MagnetField(fields.helmholtz(radius, current, 5)).own(ORIGIN, True)
    assert pair.flux_density[0] * radius / (MU0 * 5 * current) == pytest.approx([0, 0, 0.71554], abs=1e-5)
    assert pair.flux_density[0, 2] * radius / (MU0 * 5 * current) == pytest.approx(0.8**1.5, rel=1e-12)
    # uniform to third order: gradient and second derivatives vanish beside B / R and B / R²
    assert np.abs(pair.gradient).max() * radius < 1e-11 * pair.flux_density[0, 2]
    assert np.abs(pair.second).max() * radius**2 < 1e-8 * pair.flux_density[0, 2]
    opposed = MagnetField(fields.maxwell(radius, current)).own(ORIGIN, True)
    constant = opposed.gradient[0] * radius**2 / (MU0 * current)
    assert constant[2, 2] == pytest.approx(0.64129, abs=1e-5)
    assert constant[2, 2] == pytest.approx(48.0 / 49.0 * np.sqrt(3.0 / 7.0), rel=1e-10)
    assert np.abs(constant - 0.5 * constant[2, 2] * np.diag([-1, -1, 2])).max() < 1e-10


def test_halbach_ring_is_uniform_inside_or_has_four_poles():
    two, four = (MagnetField(fields.halbach(0.05, 16, (0.01, 0.01, 0.03), 1.3, k)).own(ORIGIN, False) for k in (1, 2))
    assert two.flux_density[0, 0] > 0.05
    assert np.abs(two.flux_density[0, 1:]).max() < 1e-12
    assert np.abs(two.gradient).max() * 0.05 < 1e-9 * two.flux_density[0, 0]
    assert np.abs(four.flux_density).max() < 1e-12
    assert four.gradient[0, 0, 0] == pytest.approx(-four.gradient[0, 1, 1], rel=1e-8)
    assert abs(four.gradient[0, 0, 0]) > 1.0


def test_a_long_solenoid_has_its_textbook_field_and_layers_add_up():
    one = fields.Solenoid(0.01, 2.0, 0.5, 4000)
    assert one.flux_density(ORIGIN)[0, 2] == pytest.approx(MU0 * 4000 * 0.5 / 2.0, rel=2e-5)
    layered = fields.Solenoid(0.02, 0.03, 5.0, 200, 2, 0.002)
    single = [fields.Solenoid(diameter, 0.03, 5.0, 100) for diameter in (0.02, 0.024)]
    points = around(layered)
    total = sum(one.flux_density(points) for one in single)
    assert np.abs(layered.flux_density(points) - total).max() < 1e-15


@pytest.mark.parametrize("points", [np.array([[0.0, 0.0, 0.0], [0.004, 0.001, 0.005]]), np.array([[0.03, 0.01, 0.02]])])
def test_a_sheet_of_current_is_the_limit_of_many_loops(points):
    """Within and outside; the sum of N loops at the middles of N turns differs from the sheet as 1/N²."""
    for winding in (fields.Solenoid(0.02, 0.012, 5.0, 60), fields.RectangularWinding((0.03, 0.02), 0.012, 5.0, 60)):
        errors = []
        for count in (40, 80):
            heights = 0.012 * ((np.arange(count) + 0.5) / count - 0.5)
            if winding.kind == "solenoid":
                turn = magpylib.current.Circle(diameter=0.02, current=300.0 / count)
            else:
                corners = 0.5 * np.array([(0.03, 0.02), (-0.03, 0.02), (-0.03, -0.02), (0.03, -0.02), (0.03, 0.02)])
                turn = magpylib.current.Polyline(vertices=np.insert(corners, 2, 0.0, axis=1), current=300.0 / count)
            B = sum(turn.getB(points - [0.0, 0.0, height]).reshape(-1, 3) for height in heights)
            errors.append(np.abs(B - winding.flux_density(points)).max())
        assert errors[1] < 1e-4 * np.abs(winding.flux_density(points)).max()
        assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("name", SHAPES)
def test_derivatives_against_extrapolated_differences(name):
    """All nine and all 27, though only five and seven are differenced: this is Maxwell's equations too."""
    shape, points = SHAPES[name], around(SHAPES[name], 20 if name == "cylinder-segment" else 60)
    values, step = shape.values(points, True), 2e-3 * shape.distance(points)
    assert np.abs(values.flux_density - shape.flux_density(points)).max() < 1e-14 * np.abs(values.flux_density).max()
    scale = size(values.flux_density) / shape.distance(points)
    for j, axis in enumerate(np.eye(3)):
        expected = richardson(shape.flux_density, points, step, axis)
        error = size(values.gradient[:, :, j] - expected) / scale
        assert np.median(error) < (3e-8 if name in NOISE else 1e-9)
        assert error.max() < NOISE.get(name, 2e-8)
        for k in range(3):
            expected = richardson(lambda at, k=k: shape.values(at, False).gradient[:, :, k], points, 4.0 * step, axis)
            error = size(values.second[:, :, k, j] - expected) * shape.distance(points) / scale
            assert np.median(error) < (3e-7 if name in NOISE else 1e-8)
            assert error.max() < 1e3 * NOISE.get(name, 2e-9)


@pytest.mark.parametrize("name", SHAPES)
@settings(max_examples=12)
@given(seed=some.integers(0, 2**31))
def test_neither_curl_nor_divergence(name, seed):
    """From values of B alone."""
    shape, points = SHAPES[name], around(SHAPES[name], 4, seed)
    step = 4e-3 * shape.distance(points)
    gradient = np.stack([richardson(shape.flux_density, points, step, axis) for axis in np.eye(3)], axis=2)
    scale = size(shape.flux_density(points)) / shape.distance(points)
    assert (np.abs(np.trace(gradient, axis1=1, axis2=2)) / scale).max() < NOISE.get(name, 1e-7)
    assert (size(gradient - gradient.swapaxes(1, 2)) / scale).max() < NOISE.get(name, 1e-7)


def test_what_is_differenced_is_symmetric_and_free_of_trace_exactly():
    shape = SHAPES["cuboid"]
    values = harmonic(shape.flux_density, around(shape), np.full(60, 1e-4), True)
    assert np.array_equal(values.gradient, values.gradient.swapaxes(1, 2))
    assert all(np.array_equal(values.second, values.second.swapaxes(1, k)) for k in (2, 3))
    assert np.abs(np.trace(values.gradient, axis1=1, axis2=2)).max() <= 1e-15 * np.abs(values.gradient).max()


def test_exact_formulas_of_dipole_and_sphere_against_differences():
    """Of the same fields by the differences that serve other shapes: what these are worth."""
    for name in ("dipole", "sphere"):
        shape, points = SHAPES[name], around(SHAPES[name])
        exact = shape.values(points, True)
        values = harmonic(shape.flux_density, points, 8e-3 * shape.distance(points), True)
        assert (size(values.gradient - exact.gradient) / size(exact.gradient)).max() < 1e-9
        assert (size(values.second - exact.second) / size(exact.second)).max() < 1e-9


def test_a_sphere_is_uniform_within_and_a_dipole_outside():
    sphere, J = SHAPES["sphere"], np.array(SHAPES["sphere"].polarisation)
    inside = sphere.values(np.array([[0.001, 0.002, -0.003]]), True)
    assert np.array_equal(inside.flux_density[0], 2.0 * J / 3.0)
    assert not inside.gradient.any()
    assert not inside.second.any()
    points = around(sphere)
    moment = J * (np.pi / 6.0 * sphere.diameter**3) / MU0
    assert np.allclose(sphere.values(points, False).flux_density, dipole(1e-7 * moment, points, False).flux_density)


@pytest.mark.parametrize("name", [name for name in SHAPES if name not in ("dipole", "solenoid")])
def test_distance_from_the_surface(name):
    """Against the nearest point of the drawn surface, which is not found by a formula of the class."""
    shape, points = SHAPES[name], around(SHAPES[name], 40)
    wire = 0.02 * shape.size if name in ("loop", "polygon") else 0.0
    assert np.abs(shape.distance(points) - wire - _drawn_distance(shape.surface(), points)).max() < 0.01 * shape.size


def test_distance_from_layers():
    """From the nearest of them; drawn is the outermost."""
    layered, points = SHAPES["solenoid"], around(SHAPES["solenoid"], 40)
    single = [fields.Solenoid(diameter, 0.03, 5.0, 100) for diameter in (0.02, 0.024)]
    found = np.min([_drawn_distance(one.surface(), points) for one in single], axis=0)
    assert np.abs(layered.distance(points) - found).max() < 0.01 * layered.size


def _drawn_distance(surface, points):
    _, closest = surface.triangulate().find_closest_cell(points, return_closest_point=True)
    return np.linalg.norm(closest - points, axis=1)


@pytest.mark.parametrize("name", [name for name, shape in SHAPES.items() if not shape.is_coil and name != "dipole"])
def test_inside_a_magnet_b_jumps_by_its_polarisation(name):
    """curl H = 0 and div B = 0 within too; `inside` says where J adds to μ0 H, which magpylib tells apart itself."""
    shape = SHAPES[name]
    low, high = np.array(shape.surface().bounds).reshape(3, 2).T
    points = np.random.default_rng(2).uniform(1.5 * low - 0.5 * high, 1.5 * high - 0.5 * low, (400, 3))
    inside = shape.inside(points)
    assert 5 < inside.sum() < 395
    found = sum(factor * body.getJ(points) for factor, body in shape.bodies())
    assert np.allclose(found, np.where(inside[:, None], shape.polarisation, 0.0), atol=1e-12)


@pytest.mark.parametrize("name", SHAPES)
def test_on_a_surface_or_wire_there_is_no_field(name):
    """There magpylib gives 0 at edges and in wires, and either side's value on faces."""
    shape = SHAPES[name]
    field, surface = MagnetField([shape]), np.asarray(shape.surface().points)
    corner = {
        "dipole": np.zeros(3),
        "loop": np.array([shape.size, 0.0, 0.0]),
        "polygon": np.array([0.01, 0.0, 0.0]),
        "sphere": np.array([0.0, 0.0, shape.size]),
    }.get(name, surface[np.argmax(surface[:, 0])])
    with pytest.raises(
        FieldUnknown, match=f"on the surface or wire of a {shape.kind}, where its field jumps"
    ) as caught:
        field.at(field.ends(1)[1], np.array([[1.0, 0.0, 0.0], corner]))
    assert np.array_equal(caught.value.position, corner)
    beside = field.at(field.ends(1)[1], (corner + np.array([1e-4, 2e-4, 3e-4]))[None])
    assert all(np.isfinite(array).all() for array in beside)


def test_beside_a_dipole_by_round_off_is_at_it():
    field = MagnetField([SHAPES["dipole"]])
    with pytest.raises(FieldUnknown, match="of a dipole"):
        field.at(field.ends(1)[1], np.array([[1e-19, 0.0, 0.0]]))
