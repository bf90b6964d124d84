"""Linear buckling where the part moves before it buckles, against formulas and the bifurcations of paths."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse.linalg import eigsh

import magshell as ms
from magshell.cli import main
from magshell.equations.discretisation import Discretisation
from magshell.linalg import make_solver, nested_dissection
from magshell.mesh import Mesh
from magshell.solver.buckling import FAR
from magshell.solver.linear_path import LinearPath
from magshell.solver.newton import System

THICKNESS, LENGTH, SHEAR = 0.2e-3, 0.1, 100e3
MICRO = ms.MicropolarStVenantKirchhoff(SHEAR, 0.0, SHEAR / 10, THICKNESS / 100)


def on_edge(width=4e-3, force=1e-6, held=None, material=MICRO, stages=(), history=None, **options):
    """A cantilever on edge, pressed down at its tip by a force or by a displacement; without Poisson's effect."""
    mesh = ms.mesh.rectangle(LENGTH, width, (20, 2))
    shell = ms.Shell(mesh, THICKNESS, material, **options)
    clamp = ms.Clamp("left")
    if held is not None:
        return ms.Model(shell, [clamp, ms.Prescribe("right", "u", 2, held)])
    return ms.Model(shell, [clamp], loads=[ms.Force("right", (0, -force, 0), history=history)], stages=stages)


def in_field(field=20e-6):
    """The same, half as long and magnetised along its axis, in a field downwards; with the couple law, unsymmetric."""
    mesh = ms.mesh.rectangle(LENGTH / 2, 4e-3, (20, 2))
    shell = ms.Shell(mesh, THICKNESS, MICRO, ms.remanence.constant((0.1, 0, 0)))
    return ms.Model(shell, [ms.Clamp("left")], ms.UniformField((0, -field, 0)))


def whole(mesh, points=None):
    """The mesh with all its elements as a group."""
    groups = {"all": np.arange(len(mesh.elements))}
    return Mesh(mesh.points if points is None else points, mesh.elements, groups, mesh.edge_groups, mesh.node_groups)


def ring(defect, share=1.0):
    """A quarter of a ring under a share of its buckling pressure 3 D/R³, out of round by a defect."""
    radius, sides = (
        20e-3,
        [("start", (0, 0, 1)), ("end", (0, 0, 1)), ("angle-start", (0, 1, 0)), ("angle-stop", (1, 0, 0))],
    )
    mesh = ms.mesh.cylinder(radius, 4e-3, (16, 1), angle=(0, 90))
    angle, points = np.arctan2(mesh.points[:, 1], mesh.points[:, 0]), mesh.points.copy()
    points[:, :2] *= (1.0 + defect / radius * np.cos(2.0 * angle))[:, None]
    supports = [ms.SymmetryPlane(*side) for side in sides]
    pressure = share * 3.0 * 2.0 * SHEAR * THICKNESS**3 / 12.0 / radius**3
    return ms.Model(ms.Shell(whole(mesh, points), THICKNESS, MICRO), supports, loads=[ms.Pressure("all", -pressure)])


def arch(half, pressure, thickness=0.5e-3):
    """A clamped circular arch of twice an angle (degrees) under so many times D/R³."""
    radius = 20e-3
    mesh = whole(ms.mesh.cylinder(radius, 2e-3, (24, 1), angle=(90 - half, 90 + half)))
    shell = ms.Shell(mesh, thickness, MICRO._replace(length_scale=thickness / 100))
    supports = [ms.Clamp("angle-start"), ms.Clamp("angle-stop")]
    supports += [ms.SymmetryPlane(name, (0, 0, 1)) for name in ("start", "end")]
    unit = 2.0 * SHEAR * thickness**3 / 12.0 / radius**3
    return ms.Model(shell, supports, loads=[ms.Pressure("all", -pressure * unit)])


def plate(size=40e-3, thickness=0.1e-3):
    """A thin simply supported square plate, pressed along one side by 1.02 times 4 π² D / a."""
    material = ms.MicropolarStVenantKirchhoff(SHEAR, SHEAR, SHEAR / 10, thickness / 100)  # ν = 1/4
    bending = 2.5 * SHEAR * thickness**3 / 12.0 / (1.0 - 0.25**2)
    held = [("left", 1), ("left", 3), ("right", 3), ("bottom", 2), ("bottom", 3), ("top", 3)]
    return ms.Model(
        ms.Shell(ms.mesh.rectangle(size, size, (10, 10)), thickness, material),
        [ms.Prescribe(group, "u", component) for group, component in held],
        loads=[ms.Force("right", (-1.02 * 4.0 * np.pi**2 * bending / size, 0, 0))],
    )


def first(model, **options):
    """The first positive multiplier."""
    return next(mode for mode in ms.buckling(model, **options).modes if mode.load_factor > 0.0)


def bifurcation(model):
    """Load factor of the first bifurcation of the path."""
    path = ms.solve(model, ms.Settings(largest_step=0.2))
    assert path.critical_points[0].kind == "bifurcation"
    return path.critical_points[0].load_factor


@pytest.mark.parametrize(
    ("width", "formula", "path"), [(4e-3, 0.303, 0.308), (8e-3, 0.605, 0.624)], ids=["4 mm", "8 mm"]
)
def test_a_cantilever_on_edge_tips_over_sideways(width, formula, path):
    """4.013 √(EI GJ) / L² in µN, and the path's bifurcation; K0 + t K' says .057 and .361."""
    stiffness = np.sqrt(2.0 * SHEAR * width * THICKNESS**3 / 12.0 * SHEAR * width * THICKNESS**3 / 3.0)
    assert 1e6 * 4.013 * stiffness / LENGTH**2 == pytest.approx(formula, rel=5e-3)
    found = ms.buckling(on_edge(width), modes=2)
    loads = [mode.load_factor for mode in found.modes]
    assert loads[0] == pytest.approx(path, rel=6e-3)
    assert loads[1] == pytest.approx(-loads[0], rel=1e-6)
    assert found.complete
    assert found.counted >= loads[0]
    assert not found.doubts
    mode = found.modes[0].mode
    assert np.abs(mode[:, 2]).max() == pytest.approx(1.0)
    assert np.abs(mode[:, :2]).max() < 0.05


def line_of(model):
    """The linear path of a model from its undeformed state."""
    discretisation = Discretisation(model, nested_dissection)
    system = System(discretisation, make_solver("superlu"), model.course(0), ms.Settings())
    return LinearPath(system, discretisation.undeformed())


def test_to_first_order_it_would_tip_at_a_fifth_of_the_load():
    """K0 + t K' alone lacks the square of what the path changes of the strain operator: with it, all is there."""
    line, solver = line_of(on_edge()), make_solver("superlu")
    start, ahead, back = (line.tangent(s) for s in (0.0, 1e-2, -1e-2))
    first, second = 50.0 * (ahead - back), 5e3 * (ahead + back - 2.0 * start)
    ratio = eigsh(-first, k=1, M=start, which="LA", v0=np.ones(start.shape[0]), return_eigenvectors=False)[0]
    assert line.unit / ratio == pytest.approx(0.0573, rel=1e-2)
    for share, pivots in ((0.99, 0), (1.01, 1)):
        s = share * 0.30658 / line.unit
        assert solver.factorise(start + s * first + s**2 * second).negative_pivots() == pivots


def test_the_linear_path_has_the_rotation_and_strain_of_a_beam():
    """A cantilever turns by P L² / 2 E I at its end; its strain P x y / E I is taken at the points of the rule."""
    width, force = 4e-3, 1e-6
    line = line_of(on_edge(width, force))
    bending = 2.0 * SHEAR * width**3 * THICKNESS / 12.0
    assert line.rotation == pytest.approx(line.unit * force * LENGTH**2 / (2.0 * bending), rel=2e-2)
    inside = 0.5 * (1.0 - 3.0**-0.5)  # of an element's sides, the distance of the first point from its edge
    x, y = LENGTH * (1.0 - inside / 20), 0.5 * width * (1.0 - inside)
    assert line.strain == pytest.approx(line.unit * force * x * y / bending, rel=1e-2)
    assert max(line.rotation, line.strain) == pytest.approx(0.02)


@pytest.mark.parametrize("width", [4e-3, 8e-3], ids=["4 mm", "8 mm"])
def test_it_tips_where_the_path_bifurcates(width):
    assert first(on_edge(width)).load_factor == pytest.approx(bifurcation(on_edge(width)), rel=5e-3)


@pytest.mark.parametrize(
    "options",
    [
        {"material": MICRO._replace(coupling_modulus=0.0, length_scale=0.0), "micro_rotation": False},
        {"thickness_stretch": "plane-stress", "material": MICRO._replace(lame_lambda=2.0 * SHEAR)},
        {"thickness_stretch": "none"},
    ],
    ids=["7 parameters", "plane stress", "no stretch"],
)
def test_the_same_for_other_shells(options):
    assert first(on_edge(**options)).load_factor == pytest.approx(bifurcation(on_edge(**options)), rel=5e-3)


def test_lateral_buckling_in_a_field():
    mode = first(in_field())
    assert mode.load_factor == pytest.approx(bifurcation(in_field()), rel=5e-3)
    assert mode.flux_density == pytest.approx([0.0, -20e-6 * mode.load_factor, 0.0])


def test_half_of_the_load_first_comes_closer_to_the_path():
    once = first(on_edge()).load_factor
    stages, half = (ms.Stage(), ms.Stage()), 0.15
    twice = first(on_edge(stages=stages, history=(half, 1.0))).load_factor
    true = bifurcation(on_edge())
    assert abs(half + (1.0 - half) * twice - true) < 0.5 * abs(once - true)


@pytest.mark.parametrize("defect", [0.0, 0.25, 1.0], ids=["round", "quarter", "whole"])
def test_a_ring_out_of_round_buckles_at_the_pressure_of_a_round_one(defect):
    """The growth of the path has its pole there; K0 + t K' says .694 and .268 of it."""
    mode = first(ring(defect * THICKNESS), modes=1)
    assert mode.load_factor == pytest.approx(1.0, rel=2e-3)


def test_a_ring_out_of_round_grows_towards_that_pressure():
    """At a share p of it the defect has grown by 1/(1 - p), with the multiplier as the unit of p."""
    defect, share = 0.01 * THICKNESS, 0.5
    model = ring(defect, share)
    ends = model.shell.mesh.nodes_of("angle-start")
    pole = first(model, modes=1).load_factor
    moved = [ms.solve(one).steps[-1].state.u[ends, 0].mean() for one in (model, ring(0.0, share))]
    assert (defect + moved[0] - moved[1]) / defect == pytest.approx(1.0 / (1.0 - 1.0 / pole), rel=2e-2)


@pytest.mark.parametrize(("half", "pressure", "error"), [(90, 8.2, 2e-3), (45, 33.0, 2e-2)], ids=["half circle", "90°"])
def test_an_arch_under_pressure_sways_where_the_path_bifurcates(half, pressure, error):
    assert first(arch(half, pressure), modes=1).load_factor == pytest.approx(
        bifurcation(arch(half, pressure)), rel=error
    )


def test_a_plate():
    mode = first(plate(), modes=1)
    assert mode.load_factor == pytest.approx(1.0 / 1.02, rel=1e-2)
    assert mode.load_factor == pytest.approx(bifurcation(plate()), rel=2e-3)


MODELS = {
    "force": lambda size: on_edge(force=size * 1e-6),
    "displacement": lambda size: on_edge(held=-size * 1e-3),
    "field": lambda size: in_field(size * 20e-6),
    "pressure": lambda size: ring(0.25 * THICKNESS, size),
}


@pytest.mark.parametrize("kind", MODELS)
def test_multipliers_do_not_depend_on_the_size_of_the_load(kind):
    """Over ten decades and more: their product with it is the same, as are the modes' order, rotation and strain."""
    expected = ms.buckling(MODELS[kind](1.0), modes=2)
    for size in (1e-8, 1e-5, 1e2, 1e5):
        found = ms.buckling(MODELS[kind](size), modes=2)
        for mode, other in zip(found.modes, expected.modes, strict=True):
            assert size * mode.load_factor == pytest.approx(other.load_factor, rel=1e-6), size
            assert (mode.rotation, mode.strain) == pytest.approx((other.rotation, other.strain), rel=1e-6)
        assert size * found.reach == pytest.approx(expected.reach, rel=1e-9)


def test_a_load_that_moves_nothing_of_any_size():
    """A strip magnetised against the field stays straight: the scale is that of the tangent alone."""
    loads = []
    for size in (1e-8, 1e-4, 1.0, 1e2):
        mesh = ms.mesh.rectangle(17.2e-3, 5e-3, (8, 1))
        shell = ms.Shell(
            mesh, 0.84e-3, ms.MicropolarNeoHookean(303e3, 7.3e6, 30.3e3, 0.84e-4), ms.remanence.constant((143e-3, 0, 0))
        )
        found = ms.buckling(ms.Model(shell, [ms.Clamp("left")], ms.UniformField((-8e-3 * size, 0, 0))), modes=2)
        loads.append([size * mode.load_factor for mode in found.modes])
        assert found.reach == np.inf
        assert not found.doubts
    for other in loads[1:]:
        assert other == pytest.approx(loads[0], rel=1e-7)


def test_it_is_told_that_the_linear_path_has_gone_too_far():
    """A shallow arch snaps at .6 of the estimate, which is no bound."""
    found = ms.buckling(arch(20, 240.0), modes=1)
    (mode,) = found.modes
    path = ms.solve(arch(20, 240.0), ms.Settings(largest_step=0.1))
    assert path.critical_points[0].load_factor < 0.7 * mode.load_factor
    assert mode.far
    assert mode.rotation > FAR
    (doubt,) = found.doubts
    assert doubt.startswith("mode 1: the part turns by up to 3.9")


def test_a_part_that_bends_at_once_has_no_multipliers(tmp_path, capsys):
    """The same strip under a field across: K0 + t K' gave pairs of tiny multipliers of both signs."""
    assert main(["buckling", "strip-10", "--out", str(tmp_path)]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "no multiplier up to a load factor of ±0.0289" in said
    assert "mode 1" not in said
    assert (tmp_path / "buckling.csv").read_text().splitlines() == ["number,load_factor,B1,B2,B3,mode,strain,rotation"]
