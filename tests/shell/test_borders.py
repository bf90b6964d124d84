"""Where parts meet: patch tests across borders, what is a jump and what is none, and layers that are one."""

from __future__ import annotations

import numpy as np
import pytest
from battery import (
    MATERIAL,
    PATCHES,
    REMANENCE,
    dense,
    each_element,
    example,
    free_body,
    patch,
    random_state,
    scaled_error,
    with_points,
)
from parts import SECOND, THIRD
from scipy.optimize import brentq

from magshell import thickness
from magshell.equations.instant import Instant
from magshell.magnetics import remanence
from magshell.materials.law import evaluate
from magshell.mesh import split
from magshell.model.reference import make_of
from magshell.model.region import Layer, Region
from magshell.shell.geometry import Sections
from magshell.shell.shear_profile import Moduli, profile
from shell.test_patch import inner_nodes
from shell.test_several_laws import evaluated

STILL = (0.0, 0.0, 0.0)
FIRST = example(MATERIAL)
LOOSE = FIRST._replace(shear_modulus=2.5, lame_lambda=0.3)


# -- patches of several parts ----------------------------------------------------------------------------------------


def columns_of_elements():
    """Nine straight-sided quadrilaterals whose corners are moved along the lines X1 = 0, 1, 2 and 3."""
    mesh = patch((3, 3))
    points, rng = mesh.points.copy(), np.random.default_rng(4)
    moved = np.setdiff1d(mesh.corner_nodes, mesh.boundary_edges)
    points[moved, 1] += rng.uniform(-0.25, 0.25, len(moved))
    corners = mesh.elements[:, :4]
    points[mesh.elements[:, 4:]] = 0.5 * (points[corners] + points[np.roll(corners, -1, axis=1)])
    return with_points(mesh, points)


def three_columns(element):
    """Mesh and elements of the columns X1 < 1, 1 to 2, and the rest."""
    mesh = columns_of_elements()
    if element.triangle_rule is not None:
        mesh = split(mesh, "crossed", np.arange(0, 9, 2))
    column = mesh.points[mesh.elements[:, :4], 0].mean(axis=1).astype(int)
    return mesh, [np.flatnonzero(column == number) for number in range(3)]


LAYERS = {  # of each column: layers of thickness and law, and the offset
    "laws and thickness": [[(0.15, FIRST)], [(0.21, LOOSE)], [(0.11, THIRD)]],
    "sandwich": [[(0.15, FIRST)], [(0.05, SECOND), (0.08, LOOSE), (0.05, SECOND)], [(0.12, LOOSE)]],
}


def made(layers, offset="middle"):
    """What a region is given for layers."""
    if len(layers) == 1:
        return {"thickness": layers[0][0], "material": layers[0][1], "offset": offset}
    return {"layers": [Layer(*layer) for layer in layers], "offset": offset}


def stretched(layers, along, across):
    """P of each layer with the stretches `across` X1 and `along` X2, and P33 = 0; stretches of their thickness."""
    stresses, own = [], []
    for _, law in layers:
        at = lambda third, law=law: evaluate(law, np.diag([across, along, third]))[1]  # noqa: E731
        own.append(brentq(lambda third, at=at: at(third)[2, 2], 0.75, 1.5, xtol=1e-15))
        stresses.append(at(own[-1]))
    return np.array(stresses), np.array(own)


def equilibrium(layers, along, force):
    """Stretch across X2 that makes the force per width N11, and that of the director, the mean over the thickness."""
    heights = np.array([height for height, _ in layers])
    missing = lambda across: heights @ stretched(layers, along, across)[0][:, 0, 0] - force  # noqa: E731
    across = brentq(missing, 0.8, 1.3, xtol=1e-15)
    return across, heights @ stretched(layers, along, across)[1] / heights.sum()


def check_patch(element, layers, offsets, force):
    """Columns stretched by 1.1 along X2 with one force N11 in all of them: nothing is missing inside."""
    mesh, columns = three_columns(element)
    regions = [Region(where, **made(*of)) for where, *of in zip(columns[1:], layers[1:], offsets[1:], strict=True)]
    d = free_body(mesh, element=element, regions=regions, field=STILL, **made(layers[0], offsets[0]))
    found = [equilibrium(of, 1.1, force) for of in layers]
    state, starts = d.undeformed(), np.cumsum([0.0] + [across for across, _ in found])
    X = d.mesh.points[d.rows.of]
    deformed = np.interp(X[:, 0], range(4), starts)
    state.u[:, 0], state.u[:, 1] = deformed - X[:, 0], 0.1 * X[:, 1]
    rest, nodes = element.rest_nodes, len(d.mesh.points)
    director = np.zeros(len(d.rows.of))
    for (_, length), where in zip(found, columns, strict=True):
        director[d.rows.elements[where][:, :rest]] = length
    carrying = np.unique(d.rows.elements[:, :rest])
    state.w[carrying, 2] = director[d.rows.of[carrying]] - 1.0
    state.s[nodes:] = director[nodes:] / director[d.rows.of[nodes:]] - 1.0
    assert np.abs(state.s).max() > 1e-3
    residual = d.assemble(Instant(state, d.model.loading(1.0)), tangent=False).residual
    inner = np.isin(d.rows.of, inner_nodes(d.mesh))
    assert np.count_nonzero(inner[nodes:]) > 2
    error = np.abs(residual[inner]).max() / np.abs(residual).max()
    assert error < 1e-12, f"{error:.1e} of the boundary's forces"


@each_element
@pytest.mark.parametrize("layers", LAYERS.values(), ids=LAYERS)
def test_constant_force_across_borders(element, layers):
    """Flush mid-planes: the parts stretch differently, and their directors are of different lengths."""
    check_patch(element, layers, ["middle"] * 3, force=0.02)


@each_element
@pytest.mark.parametrize("layers", LAYERS.values(), ids=LAYERS)
def test_stress_along_steps_with_offset(element, layers):
    """No force crosses the borders, so that the mid-planes may lie anywhere."""
    check_patch(element, layers, ["top", "bottom", 0.03], force=0.0)


# -- what is a jump --------------------------------------------------------------------------------------------------


def test_a_taper_is_no_jump():
    mesh = PATCHES["curved patch"]()
    taper = thickness.function(lambda points: 0.15 + 0.02 * points[..., 0] - 0.01 * points[..., 1] ** 2)
    assert len(free_body(mesh, thickness=taper).rows.of) == len(mesh.points)
    nodal = thickness.per_node(0.1 + 0.01 * np.arange(len(mesh.points)))
    assert len(free_body(mesh, thickness=nodal).rows.of) == len(mesh.points)


@each_element
def test_a_step_in_every_element_jumps_everywhere(element):
    mesh = free_body(PATCHES["flat patch"](), element=element).mesh
    stepped = thickness.per_element(0.1 + 0.01 * np.arange(len(mesh.elements)))
    rows = free_body(mesh, element=element, thickness=stepped).rows
    rest = mesh.elements[:, : element.rest_nodes]
    pairs = len(
        np.unique(np.stack([rest, np.broadcast_to(np.arange(len(rest))[:, None], rest.shape)]).reshape(2, -1), axis=1).T
    )
    assert len(rows.of) == len(mesh.points) + pairs - len(np.unique(rest))


JUMPS = {
    "thickness": {"thickness": 0.16},
    "law": {"material": example(type(THIRD))},
    "parameters": {"material": FIRST._replace(lame_lambda=1.8)},
    "length scale": {"material": FIRST._replace(length_scale=0.21)},
    "offset": {"offset": 0.01},
    "layers": {"layers": [Layer(0.15, FIRST)]},
}
NO_JUMPS = {"remanence": {"remanence": remanence.constant((1.0, 0.0, 0.0))}, "levels": {"levels": 3}}


@pytest.mark.parametrize("change", JUMPS.values(), ids=JUMPS)
def test_what_jumps(change):
    mesh = patch((2, 1))
    rows = free_body(mesh, FIRST, thickness=0.15, regions=[Region([1], **change)]).rows
    border = np.flatnonzero(np.bincount(mesh.elements.ravel()) == 2)
    assert sorted(rows.of[len(mesh.points) :]) == sorted(border)
    assert len(border) == 3


@pytest.mark.parametrize("change", NO_JUMPS.values(), ids=NO_JUMPS)
def test_what_does_not_jump(change):
    mesh = patch((2, 1))
    rows = free_body(mesh, FIRST, thickness=0.15, regions=[Region([1], **change)]).rows
    assert len(rows.of) == len(mesh.points)


@each_element
def test_regions_of_equal_data_are_one_region(element):
    """One region for each element, to the last bit but for the order of sums."""
    one = free_body(PATCHES["curved patch"](), element=element)
    vector = remanence.constant(REMANENCE)
    regions = [Region([e], 0.15, example(MATERIAL), vector) for e in range(len(one.mesh.elements))]
    many = free_body(one.mesh, element=element, regions=regions)
    state = random_state(one, 3)
    first, second = (d.assemble(Instant(state, d.model.loading(1.0))) for d in (one, many))
    errors = {
        "residual": scaled_error(second.residual, first.residual),
        "tangent": scaled_error(dense(many, second.matrix), dense(one, first.matrix)),
    }
    assert max(errors.values()) < 1e-12, errors


# -- layers ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("layers", [2, 3, 5])
@pytest.mark.parametrize("levels", [1, 2])
def test_equal_layers_are_one_layer_integrated_by_the_same_rule(layers, levels):
    magnets, mesh = remanence.constant(REMANENCE), PATCHES["curved patch"]()
    many = free_body(mesh, layers=[Layer(0.15 / layers, FIRST, magnets)] * layers, levels=levels)
    single = free_body(mesh, layers=[Layer(0.15, FIRST, magnets)])
    parent, weights = np.polynomial.legendre.leggauss(levels)
    composite = ((2.0 * np.arange(layers)[:, None] + 1.0 + parent) / layers - 1.0).ravel()
    shares = np.tile(weights, layers) / layers
    count, points = single.reference.geometry.volume.shape[:2]
    shape = (count, points, layers * levels)
    spread = lambda values: np.broadcast_to(values, shape).copy()  # noqa: E731
    own = make_of(single.model)
    rule = own._replace(
        sections=Sections(spread(0.075 * composite), spread(0.075 * shares)),
        levels=np.full(count, layers * levels),
        warping=spread(profile(np.array([0.15]), [Moduli.of(FIRST)], composite, shares)),
        remanence=np.broadcast_to(own.remanence[:, :, :1], (*shape, 3)).copy(),
        material_of=np.zeros((count, layers * levels), dtype=np.int64),
        coupling_of=np.zeros((count, layers * levels), dtype=np.int64),
    )
    state = random_state(many, 5)
    for together, apart in zip(
        evaluated(single, rule, state), evaluated(many, make_of(many.model), state), strict=True
    ):
        assert scaled_error(apart, together) < 1e-12


def test_the_order_of_layers_matters():
    mesh = PATCHES["curved patch"]()
    state, found = None, []
    for layers in ([Layer(0.05, FIRST), Layer(0.1, SECOND)], [Layer(0.1, SECOND), Layer(0.05, FIRST)]):
        d = free_body(mesh, layers=layers)
        state = state or random_state(d, 5)
        found.append(d.assemble(Instant(state, d.model.loading(1.0))).residual)
    assert scaled_error(found[1], found[0]) > 1e-2
