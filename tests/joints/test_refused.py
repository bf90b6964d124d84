"""Joints, hinges, rigid bodies and turned groups that make no sense are refused, with what would be right."""

from __future__ import annotations

import numpy as np
import pytest

import magshell as ms
from joints.bodies import FLAT, FOLD, TEE, extruded
from magshell.equations.discretisation import Discretisation

STRIP = extruded(FLAT, size=0.02, width=0.01)
FOLDED = extruded(FOLD, size=0.02, width=0.01)
RIBBED = extruded(TEE, size=0.02, width=0.01)
MATERIAL = ms.MicropolarNeoHookean(1e6, 1e6)
CLASSICAL = ms.MicropolarNeoHookean(1e6, 1e6, 0.0, 0.0)
HELD = (ms.Clamp("near"),)
LIFT = ms.Force("far", (0, 0, 1e-4))


def model(mesh=STRIP, supports=HELD, material=MATERIAL, springs=(), **given):
    return ms.Model(ms.Shell(mesh, 1e-3, material, **given), supports, loads=[LIFT], springs=springs)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: model(hinges=[ms.Hinge("jiont")]),
            r"hinge on 'jiont': there is no such group.*Did you mean 'joint'\?",
        ),
        (lambda: model(hinges=[ms.Hinge("sheet0")]), "hinge on 'sheet0': it is no group of edges"),
        (lambda: model(hinges=[ms.Hinge("far")]), r"hinge on 'far': the edge between nodes \d+ and \d+ is a free edge"),
        (lambda: model(hinges=[ms.Hinge("joint", 1.0)] * 2), r"hinge on 'joint': the edge .* is of another hinge too"),
        (lambda: ms.Hinge("joint", -1.0), "hinge on 'joint': stiffness is -1.0; it must be a number, 0 or positive"),
        (lambda: ms.Hinge("joint", "1 N"), "hinge on 'joint': stiffness is '1 N'; it must be a number"),
        (lambda: ms.Hinge("joint", np.nan), "hinge on 'joint': stiffness is nan; it must be a number"),
        (
            lambda: model(hinges=[ms.Hinge("joint")], rigid=[ms.RigidBody("sheet1", "lid")]),
            "hinge on 'joint': the edge .* belongs to rigid body 'lid', in which nothing turns; leave these nodes out",
        ),
        (
            lambda: model(rigid=[ms.RigidBody("fra")]),
            r"rigid body 'fra': There is no group 'fra'.*Did you mean 'far'\?",
        ),
        (
            lambda: model(rigid=[ms.RigidBody("far", "a"), ms.RigidBody("joint", "a")]),
            "rigid body 'a': there are two of this name",
        ),
        (
            lambda: model(rigid=[ms.RigidBody("far", "a"), ms.RigidBody("sheet1", "b")]),
            r"rigid body 'b': node \d+ also belongs to rigid body 'a'; a node moves with one body",
        ),
        (
            lambda: model(rigid=[ms.RigidBody("far", "near")]),
            "rigid body 'near': a group of the mesh has this name too",
        ),
        (lambda: ms.RigidBody("far", mass=-1.0), "rigid body 'far': mass is -1.0; it must be a number, 0 or positive"),
        (lambda: ms.RigidBody("far", mass="1 g"), "rigid body 'far': mass is '1 g'; it must be a number"),
        (
            lambda: ms.RigidBody("far", moment=(0, 1)),
            r"rigid body 'far': moment is \(0, 1\); it needs 3 finite numbers",
        ),
        (lambda: ms.RigidBody("far", point=(0, 0, np.inf)), "rigid body 'far': point is .* it needs 3 finite numbers"),
        (
            lambda: model(supports=[ms.Clamp("near"), ms.Clamp("far")], rigid=[ms.RigidBody("far", "magnet")]),
            "support on 'far': node .* belongs to rigid body 'magnet', whose nodes move as one; hold the body, by its",
        ),
        (
            lambda: model(supports=[ms.Clamp("magnte")], rigid=[ms.RigidBody("far", "magnet")]),
            r"no group or rigid body 'magnte'. Did you mean 'magnet'\?",
        ),
        (
            lambda: model(supports=[ms.Prescribe("magnet", "w")], rigid=[ms.RigidBody("far", "magnet")]),
            "support on 'magnet': a rigid body has no 'w', only u and omega",
        ),
        (lambda: model(supports=[], rigid=[ms.RigidBody("far")]), "supports: the body floats freely"),
        (
            lambda: model(supports=[ms.Turn("near", (0, 0, 0), 1.0)]),
            r"support on 'near': axis is \(0, 0, 0\); it needs 3 finite components, not all zero",
        ),
        (
            lambda: model(supports=[ms.Turn("near", (0, 1, 0), np.nan)]),
            "support on 'near': angle is nan; it must be one",
        ),
        (
            lambda: model(supports=[ms.Turn("near", (0, 1, 0), 1.0, through=(1, 2))]),
            r"support on 'near': through is \(1, 2\); it needs 3 finite coordinates",
        ),
        (
            lambda: model(supports=[ms.Turn("near", (0, 1, 0), 1.0, translation=(1, 2))]),
            r"support on 'near': translation is \(1, 2\); it needs 3 finite components",
        ),
        (
            lambda: model(supports=[ms.Turn("near", (0, 1, 0), 1.0), ms.Turn("near", (0, 1, 0), 2.0)]),
            "supports: they contradict each other at rigid body 'near'",
        ),
        (
            lambda: model(FOLDED, [ms.Clamp("near"), ms.Prescribe("joint", "w", 1)]),
            r"support on 'joint': node \d+ is at a joint, whose directors turn with omega, and does not carry 'w'",
        ),
        (
            lambda: model(FOLDED, material=CLASSICAL, micro_rotation=False),
            r"shell: sheets meet at an angle at node \d+, \(20, .*\) mm, and micro_rotation is False; a joint carries",
        ),
        (
            lambda: model(material=CLASSICAL, micro_rotation=False, rigid=[ms.RigidBody("far")]),
            "rigid body 'far': micro_rotation is False, and a rigid body carries the shell by its micro-rotation",
        ),
        (
            lambda: model(material=CLASSICAL, micro_rotation=False, hinges=[ms.Hinge("joint", 1.0)]),
            "hinge on 'joint': micro_rotation is False, and the spring acts on the micro-rotations of both sides",
        ),
    ],
)
def test_refused(make, message):
    with pytest.raises(ms.InputError, match=message):
        make()


def test_some_nodes_of_a_group_at_a_joint():
    """The director of the others may be given, that of these not, and nothing is left out without a word."""
    mesh = FOLDED.select_nodes("edge", x2=0.0)
    with pytest.raises(ms.InputError, match="is at a joint"):
        model(mesh, [ms.Clamp("near"), ms.Prescribe("edge", "w", 2)])
    model(mesh, [ms.Clamp("near"), ms.SymmetryPlane("edge", (0, 1, 0))])


def test_a_middle_without_an_end():
    """The elements of the source have rotations at corners only."""
    middle = STRIP.elements[-1, 5]
    mesh = STRIP.select_nodes("one", *STRIP.points[middle])
    made = model(mesh, element="paper", rigid=[ms.RigidBody("one")])
    with pytest.raises(
        ms.InputError, match=f"node {middle} is a mid-side node and no corner of element .* add the ends"
    ):
        Discretisation(made, lambda graph: np.arange(graph.shape[0]))


HINGE = [ms.Hinge("joint")]
ABOUT = "hinge on 'joint': what it joins turns about it, and nothing resists that"


@pytest.mark.parametrize(
    ("given", "turns"),
    [
        ({"hinges": HINGE}, True),
        ({"hinges": [ms.Hinge("joint", 1e-3)]}, False),
        ({"hinges": HINGE, "supports": [ms.Clamp("near"), ms.SimpleSupport("far")]}, False),
        ({"hinges": HINGE, "supports": [ms.Clamp("near"), ms.Prescribe("far", "u", 1)]}, True),
        ({"hinges": HINGE, "supports": [ms.Clamp("near"), ms.SymmetryPlane("far", (1, 0, 0))]}, False),
        ({"hinges": HINGE, "supports": [ms.Clamp("near"), ms.SymmetryPlane("far", (1, 0, 1))]}, False),
        ({"hinges": HINGE, "springs": [ms.Spring("far", stiffness=1e-3)]}, False),
        ({"hinges": HINGE, "springs": [ms.Spring("far", stiffness=1e-3, direction=(1, 0, 0))]}, True),
        ({"hinges": HINGE, "supports": [ms.Clamp("near"), ms.Turn("far", (0, 1, 0), 0.1)]}, False),
        ({"hinges": HINGE, "mesh": FOLDED, "supports": [ms.Clamp("near"), ms.Prescribe("far", "u", 3)]}, True),
        ({"hinges": HINGE, "mesh": FOLDED, "supports": [ms.Clamp("near"), ms.Prescribe("far", "u", 1)]}, False),
        ({"hinges": HINGE, "mesh": RIBBED, "supports": [ms.Clamp("near"), ms.SimpleSupport("far")]}, True),
    ],
)
def test_what_turns_about_a_free_hinge(given, turns):
    """Refused where nothing resists it: by the supports and springs that reach the far side."""
    if turns:
        with pytest.raises(ms.InputError, match=ABOUT):
            model(**given)
    else:
        model(**given)


@pytest.mark.parametrize(
    ("supports", "rigid", "doubted"),
    [
        ([ms.Prescribe("far", "omega", 2, 0.5)], [], True),
        ([ms.Prescribe("far", "omega", 2, 0.5), ms.Prescribe("far", "w", 2, 0.0)], [], False),
        ([ms.Prescribe("far", "omega", 2, 0.5)], [ms.RigidBody("far")], False),
        ([ms.Turn("far", (0, 1, 0), 0.5)], [], False),
        ([ms.Prescribe("far", "omega", 2)], [], False),
    ],
)
def test_rotations_that_do_not_turn_the_section(supports, rigid, doubted):
    said = model(supports=[ms.Clamp("near"), *supports], rigid=rigid).doubts()
    assert any("support on 'far': omega is that of the micro-rotation alone" in one for one in said) == doubted


@pytest.mark.parametrize(("support", "doubted"), [(ms.Clamp("sheet0"), True), (ms.SimpleSupport("sheet0"), False)])
def test_clamps_that_hold_a_hinge(support, doubted):
    """A panel that is held by u alone lets its neighbours turn."""
    said = model(supports=[support], hinges=[ms.Hinge("joint", 1e-3)]).doubts()
    assert any("the clamp holds both sides of the hinge 'joint'" in one for one in said) == doubted
