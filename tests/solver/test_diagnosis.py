"""What is measured where a path ends, against closed forms; and that it names the cause."""

from __future__ import annotations

import math

import numpy as np
import pytest
from joints.bodies import FOLD, extruded

import magshell as ms
from magshell import SolveError, solve
from magshell.equations.discretisation import Discretisation
from magshell.linalg import nested_dissection
from magshell.model.hinge import Hinge
from magshell.shell.state import State
from magshell.solver.diagnosis import diagnosis, measure
from solver.models import LENGTH, THICKNESS, rubber, strip

MU0 = 4e-7 * math.pi


def discretised(model: ms.Model) -> Discretisation:
    return Discretisation(model, nested_dissection)


def rolled(discretisation: Discretisation, angle: float) -> State:
    """The strip on a circle, by an angle in all; directors and micro-rotations turn with it."""
    points, state = discretisation.mesh.points, discretisation.undeformed()
    turned = angle * points[:, 0] / LENGTH
    radius = LENGTH / angle
    u = np.stack([radius * np.sin(turned), points[:, 1], radius * (1.0 - np.cos(turned))], axis=1) - points
    w = np.stack([-np.sin(turned), 0.0 * turned, np.cos(turned) - 1.0], axis=1)
    q = np.stack([np.cos(turned / 2), 0.0 * turned, -np.sin(turned / 2), 0.0 * turned], axis=1)
    return state._replace(u=u, w=w, q=q)


@pytest.mark.parametrize("degrees", [15.0, 60.0, 120.0])
def test_angle_turned_within_an_element(degrees: float) -> None:
    """A parabola with the chord and the rise of an arc is twice as steep at its ends as rise over half the chord."""
    discretisation = discretised(strip((4, 1)))
    state = rolled(discretisation, math.radians(4.0 * degrees))
    turn = measure(discretisation, state, discretisation.model.loading(0.0)).turn
    half = math.radians(degrees) / 2.0
    expected = 2.0 * math.degrees(math.atan(2.0 * (1.0 - math.cos(half)) / math.sin(half)))
    assert turn.angle == pytest.approx(max(expected, degrees), rel=1e-9)
    straight = measure(discretisation, state._replace(w=0.0 * state.w), discretisation.model.loading(0.0)).turn
    assert straight.angle == pytest.approx(expected, rel=1e-9)


def test_couple_over_what_the_micro_rotation_transfers() -> None:
    """Unstretched, the limit is 2η; stretched by s in both directions normal to the couple's axis, 2η s²."""
    model = strip(field=(0, 0, 0.1), remanence=(0.143, 0, 0))
    discretisation, eta = discretised(model), model.shell.material.coupling_modulus
    loading, state = model.loading(1.0), discretised(model).undeformed()
    ratio = 0.143 * 0.1 / MU0 / (2.0 * eta)
    plain = measure(discretisation, state, loading).couple
    assert plain.ratio == pytest.approx(ratio, rel=1e-9)
    assert plain.ahead == pytest.approx(0.0, abs=1e-6)
    s = 1.2
    points = discretisation.mesh.points
    stretched = state._replace(u=(s - 1.0) * points, w=(s - 1.0) * discretisation.normals)
    # F B̃ grows by s, the limit by s².
    assert measure(discretisation, stretched, loading).couple.ratio == pytest.approx(ratio / s, rel=1e-9)
    q = np.zeros_like(state.q)
    q[:, 0], q[:, 2] = math.cos(math.radians(10.0)), math.sin(math.radians(10.0))
    assert measure(discretisation, state._replace(q=q), loading).couple.ahead == pytest.approx(20.0, rel=1e-9)


def test_least_determinant() -> None:
    discretisation = discretised(strip((4, 1)))
    state = discretisation.undeformed()
    u = np.zeros_like(state.u)
    last = discretisation.mesh.points[:, 0] > 0.75 * LENGTH
    u[last, 0] = -0.6 * (discretisation.mesh.points[last, 0] - 0.75 * LENGTH)
    squash = measure(discretisation, state._replace(u=u), discretisation.model.loading(0.0)).squash
    assert squash.element == 3
    assert squash.determinant == pytest.approx(0.4, rel=1e-9)


def test_path_ends_at_the_limit_of_the_couple() -> None:
    """With the material held, 2η sin 2θ = B̃ B/μ0 has a solution up to B̃ B/μ0 = 2η, at 45°."""
    mesh = ms.mesh.rectangle(10e-3, 5e-3, (2, 1)).select_nodes("all", x3=0)
    eta, remanence = 30e3, 0.143
    shell = ms.Shell(
        mesh, 1e-3, ms.MicropolarNeoHookean(303e3, 7300e3, eta, 1e-4), ms.remanence.constant((remanence, 0, 0))
    )
    held = [ms.Prescribe("all", field, component, 0.0) for field in ("u", "w") for component in (1, 2, 3)]
    with pytest.raises(SolveError) as caught:
        solve(ms.Model(shell, held, ms.UniformField((0, 0, 1.0))))
    last = caught.value.path.steps[-1]
    assert last.load_factor == pytest.approx(2.0 * eta * MU0 / remanence, rel=1e-4)
    assert 2.0 * math.degrees(math.acos(last.state.q[0, 0])) == pytest.approx(45.0, abs=0.5)
    reason = caught.value.reason
    assert "Likely cause: the couple of the field reaches the limit" in reason, reason
    for part in ("100 % of that", "runs ahead by up to 45°", "coupling_modulus than 30 kPa"):
        assert part in reason, reason
    assert "mesh is too coarse" not in reason, reason


def running_ahead(discretisation: Discretisation, degrees: float) -> State:
    """The undeformed strip with its micro-rotation turned about X2."""
    state, half = discretisation.undeformed(), math.radians(degrees) / 2.0
    q = np.zeros_like(state.q)
    q[:, 0], q[:, 2] = math.cos(half), math.sin(half)
    return state._replace(q=q)


def test_limit_of_the_couple_is_told_where_the_load_factor_turned() -> None:
    """Beyond 45° the couple falls again: the last state alone would not tell of the limit."""
    model = strip(field=(0, 0, 1.0), remanence=(0.143, 0, 0))
    discretisation = discretised(model)
    limit = 2.0 * model.shell.material.coupling_modulus * MU0 / 0.143
    last, turned = discretisation.undeformed(), discretisation.undeformed()
    said = diagnosis(discretisation, last, model.loading(0.3 * limit), None, (turned, model.loading(limit)))
    assert said.startswith("Likely cause: the couple of the field reaches the limit"), said
    assert "it is 100 % of that in element" in said, said
    assert "where the load factor turned, and the micro-rotation runs ahead by up to 0°" in said, said
    alone = diagnosis(discretisation, last, model.loading(0.3 * limit), None)
    assert "nothing stands out" in alone, alone
    assert "the couple is at most 30 %" in alone, alone
    other = diagnosis(discretisation, last, model.loading(limit), None, (turned, model.loading(0.3 * limit)))
    assert "it is 100 % of that" in other, other
    assert "where the load factor turned" not in other, other


@pytest.mark.parametrize(("degrees", "named"), [(8.0, None), (12.0, "is held softly"), (36.0, "reaches the limit")])
def test_soft_coupling_is_told_after_the_mesh(degrees: float, named: str | None) -> None:
    model = strip((4, 1), field=(0, 0, 1e-3), remanence=(0.143, 0, 0))
    discretisation = discretised(model)
    state = running_ahead(discretisation, degrees)
    said = diagnosis(discretisation, state, model.loading(1.0), None)
    assert (named is None) == ("nothing stands out" in said), said
    if named is not None:
        assert said.startswith("Likely cause: the"), said
        assert named in said, said
        assert f"by up to {degrees:.0f}°" in said, said
        assert "larger coupling_modulus than" in said, said


def test_mesh_is_named_before_a_soft_coupling() -> None:
    """A strip rolled up by 40° in each element, with micro-rotations that are 12° further than the material."""
    model = strip((4, 1), field=(0, 0, 1e-3), remanence=(0.143, 0, 0))
    discretisation = discretised(model)
    state = rolled(discretisation, math.radians(160.0))
    half = np.arctan2(-state.q[:, 2], state.q[:, 0]) + math.radians(6.0)
    ahead = np.stack([np.cos(half), 0.0 * half, -np.sin(half), 0.0 * half], axis=1)
    said = diagnosis(discretisation, state._replace(q=ahead), model.loading(1.0), None)
    assert said.startswith("Likely cause: the mesh is too coarse"), said
    assert "Also, the micro-rotation is held softly" in said, said
    aligned = diagnosis(discretisation, state, model.loading(1.0), None)
    assert "micro-rotation" not in aligned, aligned


def test_mesh_too_coarse_is_told_with_the_number_of_elements() -> None:
    """Directors that turn by 70° in the element at the clamp: 2.5 times as many bring it to less than 30°."""
    discretisation = discretised(strip((4, 1)))
    turned = np.minimum(4.0 * discretisation.mesh.points[:, 0] / LENGTH, 1.0) * math.radians(70.0)
    w = np.stack([-np.sin(turned), 0.0 * turned, np.cos(turned) - 1.0], axis=1)
    state = discretisation.undeformed()._replace(w=w)
    said = diagnosis(discretisation, state, discretisation.model.loading(0.0), None)
    assert said.startswith("Likely cause: the mesh is too coarse for the bending: element 0"), said
    assert "at support 'left'" in said, said
    assert "turns by 70° from node" in said, said
    assert "2.5 times as many elements" in said, said
    assert "couple" not in said, said


def test_nothing_stands_out_is_said_with_the_figures() -> None:
    discretisation = discretised(strip())
    said = diagnosis(discretisation, discretisation.undeformed(), discretisation.model.loading(1.0), None)
    assert said.startswith("In the last state nothing stands out: elements turn by at most 0°, det F is at least 1,")
    ratio = 0.143 * 20e-3 / MU0 / (2.0 * rubber(THICKNESS).coupling_modulus)
    assert f"the couple is at most {100 * ratio:.0f} % of what the micro-rotation transfers" in said


def test_inverted_element_at_a_support_is_named() -> None:
    discretisation = discretised(strip())
    said = diagnosis(discretisation, discretisation.undeformed(), discretisation.model.loading(1.0), 0)
    assert "Element 0, which is turned inside out, touches the support 'left'." in said


def test_a_region_is_named_with_its_own_modulus() -> None:
    """The outer half has a hundredth of the coupling modulus and half the remanence: there the limit comes first."""
    model = strip((4, 1), field=(0, 0, 1.0), remanence=(0.143, 0, 0))
    shell = model.shell
    mesh = shell.mesh.select_elements("outer", x1=(0.5 * LENGTH, LENGTH))
    soft = shell.material._replace(coupling_modulus=0.01 * shell.material.coupling_modulus)
    outer = ms.Region("outer", material=soft, remanence=ms.remanence.constant((0.0715, 0, 0)))
    shell = ms.Shell(mesh, THICKNESS, shell.material, shell.remanence, regions=[outer])
    discretisation = discretised(ms.Model(shell, [ms.Clamp("left")], model.field))
    limit = 2.0 * soft.coupling_modulus * MU0 / 0.0715
    state, loading = discretisation.undeformed(), discretisation.model.loading(limit)
    couple = measure(discretisation, state, loading).couple
    assert couple.ratio == pytest.approx(1.0, rel=1e-9)
    assert couple.element in mesh.element_groups["outer"]
    said = diagnosis(discretisation, state, loading, None)
    assert ", in region 'outer'" in said, said
    assert f"coupling_modulus than {soft.coupling_modulus / 1e3:.4g} kPa of region 'outer', or a weaker field" in said


@pytest.mark.parametrize(("hinges", "name"), [((), "joint"), ((Hinge("joint", 1.0),), "hinge")])
def test_an_element_at_a_joint_is_told(hinges, name) -> None:
    """The directors of both sheets are turned alike at the joint: no angle is measured between sheets."""
    mesh, pull = extruded(FOLD, 1, 1), ms.Force("far", (0, 0, 1))
    discretisation = discretised(
        ms.Model(ms.Shell(mesh, 0.1, rubber(), hinges=hinges), [ms.Clamp("near")], loads=[pull])
    )
    state, loading = discretisation.undeformed(), discretisation.model.loading(0.0)
    assert measure(discretisation, state, loading).turn.angle == pytest.approx(0.0, abs=1e-6)
    bent = state.u.copy()
    bent[mesh.elements[1, [4, 6]], 0] -= 0.2
    said = diagnosis(discretisation, state._replace(u=bent), loading, None)
    assert f"element 1 (at (1e+03, 500, 500) mm, at a {name}) turns by 77°" in said
