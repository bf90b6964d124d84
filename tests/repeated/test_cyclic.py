"""A sector is what it is in the whole: displacements, reactions, balance; with joints and hinges on the cut."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import magshell as ms
from magshell import solve
from magshell.evaluation.converged import converged
from magshell.model.hinge import Hinge
from magshell.model.region import Layer, Region
from magshell.shell.elements import ELEMENTS
from magshell.solver.settings import Settings
from repeated.bodies import AXIS, POINT, RUBBER, SECTORS, Sector, copied, remanence, shell

ANGLE = 2.0 * np.pi / SECTORS
FIELD = 1e-7


def halves(mesh):
    """The two halves of the sector as groups, and the line between them."""
    side = np.arange(len(mesh.elements)) % 2
    groups = {"first": np.flatnonzero(side == 0), "second": np.flatnonzero(side == 1)}
    shared = np.intersect1d(*(np.unique(mesh.elements[members]) for members in groups.values()))
    lines = np.concatenate([mesh.elements[:, [0, 1, 4]], mesh.elements[:, [1, 2, 5]], mesh.elements[:, [2, 3, 6]]])
    lines = np.unique([line for line in lines if np.isin(line, shared).all()], axis=0)
    _, first = np.unique(lines[:, 2], return_index=True)
    return ms.mesh.Mesh(mesh.points, mesh.elements, groups, {**mesh.edge_groups, "crease": lines[first]})


def roof(r, a):
    """Ridges on the cuts, valleys between them."""
    return 0.9 * r * np.abs(a - 0.5 * ANGLE)


SECTIONS = [Region("first", thickness=0.12, offset="top"), Region("second", thickness=0.07)]


def layers(vectors):
    return {"layers": [Layer(0.03, RUBBER, ms.remanence.per_element(vectors), 1.0), Layer(0.05, RUBBER, density=2.0)]}


BODIES = {
    "flat": Sector(),
    "cone": Sector(height=lambda r, a: 0.6 * r),
    "triangles": Sector(height=lambda r, a: 0.3 * r**2, split=True),
    "kink on the cut": Sector(height=roof, groups=halves),
    "kink on the cut, layers": Sector(height=roof, groups=halves, made=layers),
    "sections on the cut": Sector(groups=halves, made=lambda vectors: {"regions": SECTIONS}),
    "hinge on the cut": Sector(height=roof, groups=halves, made=lambda vectors: {"hinges": [Hinge("start", 0.02)]}),
    "hinges": Sector(
        height=roof,
        groups=halves,
        made=lambda vectors: {"hinges": [Hinge("crease", 0.03), Hinge("start", 0.02)], "regions": SECTIONS},
    ),
}
LOADS = {
    "none": [],
    "pressure": [ms.Pressure(None, 2e-3)],
    "weight": [ms.Gravity(tuple(-0.02 * AXIS))],
    "twist": [ms.Moment("outer", tuple(4e-3 * AXIS))],
}


def of_sector(body, loads=(), element="quadratic", magnets=remanence, **model):
    mesh = body.mesh
    cyclic = ms.Cyclic("start", "stop", sectors=SECTORS, axis=AXIS, point=POINT)
    made = shell(mesh, body.made(magnets(mesh)), magnets(mesh), element=element, repeated=[cyclic])
    return solve(_model(made, loads, **model), Settings(tolerance=1e-11))


def of_whole(body, loads=(), element="quadratic", magnets=remanence, **model):
    mesh, turns = body.mesh, [Rotation.from_rotvec(k * ANGLE * AXIS).as_matrix() for k in range(SECTORS)]
    whole, nodes = copied(mesh, [(Q, POINT - Q @ POINT) for Q in turns])
    vectors = np.concatenate([magnets(mesh) @ Q.T for Q in turns])
    made = shell(whole, body.made(vectors), vectors, element=element)
    many = [one if isinstance(one, ms.Gravity | ms.Pressure) else _times(one, SECTORS) for one in loads]
    return solve(_model(made, many, **model), Settings(tolerance=1e-11)), nodes


def _model(made, loads, supports=(), along=FIELD):
    return ms.Model(made, [ms.Clamp("inner"), *supports], ms.UniformField(tuple(along * AXIS)), loads=loads)


def _times(load, count):
    return type(load)(load.group, tuple(count * np.array(load.total)))


def agree(sector, whole, nodes, accuracy=1e-8):
    here, there = sector.steps[-1], whole.steps[-1]
    count = len(sector.discretisation.mesh.points)
    size = np.abs(there.state.u).max()
    assert size > 1e-3
    assert np.abs(here.state.u[:count] - there.state.u[nodes[0]]).max() < accuracy * size
    for balance in (here.balance, there.balance):
        assert balance.force_imbalance < 1e-8
        assert balance.moment_imbalance < 1e-8


def test_hinge_on_the_cut_of_one_element():
    body = Sector(height=lambda r, a: 0.5 * r, around=1, made=lambda vectors: {"hinges": [Hinge("start", 0.02)]})
    agree(of_sector(body), *of_whole(body))


def test_node_on_the_axis():
    body = Sector(height=lambda r, a: 0.2 * r**2, inner=0.0)
    sector, (whole, nodes) = of_sector(body), of_whole(body)
    agree(sector, whole, nodes)
    centre = int(np.argmin(np.linalg.norm(sector.discretisation.mesh.points - POINT, axis=1)))
    u = sector.steps[-1].state.u[centre]
    assert np.linalg.norm(u - (u @ AXIS) * AXIS) < 1e-12 * np.linalg.norm(u)


@pytest.mark.parametrize("loads", LOADS.values(), ids=LOADS)
def test_loads_are_those_of_a_sector(loads):
    sector, (whole, nodes) = of_sector(BODIES["cone"], loads), of_whole(BODIES["cone"], loads)
    agree(sector, whole, nodes)
    one, all_ = (of_support(path) for path in (sector, whole))
    assert SECTORS * one.force @ AXIS == pytest.approx(all_.force @ AXIS, rel=1e-7, abs=1e-12)
    moments = [reaction.moment + np.cross(reaction.point - POINT, reaction.force) for reaction in (one, all_)]
    assert SECTORS * moments[0] @ AXIS == pytest.approx(moments[1] @ AXIS, rel=1e-7, abs=1e-12)


def of_support(path):
    return converged(path.discretisation, path.steps[-1]).reactions[0]


@pytest.mark.parametrize("element", ELEMENTS)
def test_element_types(element):
    agree(of_sector(BODIES["cone"], element=element), *of_whole(BODIES["cone"], element=element))


def test_supports_on_the_cut_hold_in_its_frame():
    wall = [ms.SymmetryPlane("stop", np.cross(AXIS, (1.0, 0.0, 0.0)))]
    with pytest.raises(ms.InputError, match="contradict"):
        of_sector(BODIES["cone"], supports=[*wall, ms.Prescribe("start", "u", value=(0.1, 0.0, 0.0))])


@pytest.mark.parametrize("body", BODIES.values(), ids=BODIES)
def test_sector_is_part_of_the_whole(body):
    agree(of_sector(body), *of_whole(body))
