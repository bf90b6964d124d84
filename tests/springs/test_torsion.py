"""Torsion springs on rigid bodies: angle, energy, couples and tangent; the moment of one that holds a turned end."""

from __future__ import annotations

import numpy as np
import pytest
from joints.bodies import FLAT, extruded
from problem_files import JOINTED, changed

import magshell as ms
from magshell import cli, problem, solve
from magshell.evaluation.converged import converged
from magshell.model.places import Places
from magshell.model.rows import rows_of
from magshell.shell import rotation
from magshell.shell.state import State

AXIS = np.array([1.0, -2.0, 0.5])
K = 1.7
MESH = extruded(FLAT, size=0.02, width=0.01)
RUBBER = ms.MicropolarNeoHookean(1e6, 1e6)
SHELL = ms.Shell(MESH, 1e-3, RUBBER, rigid=[ms.RigidBody("far", "handle")])
ROW = SHELL.body_row("handle")


def spring():
    return ms.TorsionSpring("handle", K, AXIS).applied(SHELL, Places(MESH, rows_of(SHELL).carriers, SHELL.rigid))


def turned(*vectors):
    """The state after spins, one after the other."""
    state = State.undeformed(len(MESH.points) + 1, len(MESH.elements), SHELL.element.vectors)
    q = state.q.copy()
    for vector in vectors:
        q[[ROW]] = rotation.product(rotation.exponential(np.array([vector])), q[[ROW]])
    return state._replace(q=q)


@pytest.mark.parametrize("angle", [-5.0, -1.0, 0.3, 3.5, 6.0])
def test_about_its_own_axis(angle):
    """Couple -k ψ along the axis, also beyond half a turn."""
    axis = AXIS / np.linalg.norm(AXIS)
    state = turned(0.5 * angle * axis, 0.5 * angle * axis)
    assert spring().energy(state) == pytest.approx(0.5 * K * angle**2)
    assert spring().forces(state)[ROW, 7:10] == pytest.approx(-K * angle * axis)


def test_forces_and_tangent_are_derivatives_of_the_energy():
    """Central differences along spins of any direction at a large rotation."""
    base, step, made = (np.array([0.4, 1.1, -0.7]), np.array([-0.6, 0.2, 0.9])), 1e-5, spring()
    state = turned(*base)
    couple, (K_spins,) = made.forces(state)[ROW, 7:10], made.stiffness(state)
    for spin in np.eye(3):
        ahead, behind = turned(*base, step * spin), turned(*base, -step * spin)
        slope = (made.energy(ahead) - made.energy(behind)) / (2.0 * step)
        assert -couple @ spin == pytest.approx(slope, rel=1e-8, abs=1e-8)
        change = (made.forces(ahead) - made.forces(behind))[ROW, 7:10] / (2.0 * step)
        assert K_spins[0] @ spin == pytest.approx(-change, rel=1e-7, abs=1e-7)


def test_it_takes_the_moment_of_an_end():
    """A moment turns a strip against bending and the spring: the reaction is k times the angle."""
    stiffness = 2e-4
    model = ms.Model(
        SHELL,
        [ms.Clamp("near")],
        loads=[ms.Moment("handle", (0, -1e-4, 0))],
        springs=[ms.TorsionSpring("handle", stiffness, (0, 1, 0))],
    )
    path = solve(model)
    reached = converged(path.discretisation, path.steps[-1])
    angle = reached.body_motions[0, 1, 1]
    held = next(one for one in reached.reactions if one.name == "handle")
    assert abs(angle) > 0.1
    assert held.moment == pytest.approx([0.0, -stiffness * angle, 0.0], abs=1e-9)
    assert path.summary["springs"] == pytest.approx(0.5 * stiffness * angle**2)


@pytest.mark.parametrize(
    ("made", "message"),
    [
        (ms.TorsionSpring("joint", K, AXIS), "springs on 'joint': it is no rigid body; a torsion spring acts on"),
        (ms.TorsionSpring("handel", K, AXIS), r"springs on 'handel': There is no group or rigid body.*'handle'\?"),
        (ms.TorsionSpring("handle", 0.0, AXIS), "springs on 'handle': stiffness is 0.0; it must be positive"),
        (ms.TorsionSpring("handle", K, (0, 0, 0)), r"springs on 'handle': axis is \(0, 0, 0\); it must not be zero"),
    ],
)
def test_refused(made, message):
    with pytest.raises(ms.InputError, match=message):
        ms.Model(SHELL, [ms.Clamp("near")], loads=[ms.Force("handle", (0, 0, 1e-4))], springs=[made])


def test_in_a_problem_file(tmp_path, capsys):
    file = tmp_path / "sprung.toml"
    block = '[[springs]]\nkind = "torsion"\ngroup = "magnet"\nstiffness = "2 N mm/rad"\n'
    block += 'axis = [0, 1, 0]\nname = "twist"\n\n'
    file.write_text(changed(JOINTED, ("[[loads]]", block + "[[loads]]")))
    assert cli.main(["check", str(file)]) == 0
    assert "magnet 2 N mm/rad about (0, 1, 0), reaction 'twist'" in " ".join(capsys.readouterr().out.split())
    *_, made = problem.load(file).model.springs
    assert (made.stiffness, made.axis, made.name) == (2e-3, (0, 1, 0), "twist")
