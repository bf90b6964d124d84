"""What makes no sense of hinges, rigid bodies, joints and repeated parts, found when a shell gets its rows."""

from __future__ import annotations

import numpy as np

from magshell.arrays import AnyArray, IntArray
from magshell.errors import InputError
from magshell.model.shell import Shell
from magshell.wording import place


def check_hinges(shell: Shell, owner: IntArray) -> None:
    """Refuse hinges on rigid bodies, where nothing turns."""
    for hinge in shell.hinges:
        edges = hinge.edges(shell.mesh)
        rigid = np.flatnonzero(np.all(owner[edges] >= 0, axis=1))
        if rigid.size:
            one, other = edges[rigid[0], :2]
            raise InputError(
                f"{hinge.label}: the edge between nodes {one} and {other} belongs to "
                f"{shell.rigid[owner[one]].label}, in which nothing turns; leave these nodes out of the body"
            )


def check_images(shell: Shell, owner: IntArray) -> None:
    """Refuse rigid bodies on the sides of a repeated part, and names of jumps that are others' too."""
    taken = {*shell.mesh.groups, *(body.name for body in shell.rigid)}
    for one in shell.periodic:
        if one.name in taken:
            raise InputError(f"{one.label}: the name '{one.name}' is taken; give the jump another")
        taken.add(one.name)
    rigid = np.flatnonzero(shell.images.touched & (owner >= 0))
    if rigid.size:
        node = int(rigid[0])
        raise InputError(
            f"{shell.rigid[owner[node]].label}: node {node} is on a side of the repeated part, where the shell "
            "goes on; leave these nodes out of the body"
        )


def check_micro_rotation(shell: Shell, of: IntArray, turned: AnyArray) -> None:
    """Refuse what a shell without micro-rotation cannot have; `turned` rows have directors that it carries."""
    if shell.micro_rotation:
        return
    if shell.rigid:
        raise InputError(
            f"{shell.rigid[0].label}: micro_rotation is False, and a rigid body carries the shell by its "
            "micro-rotation; leave micro_rotation out"
        )
    if sprung := [hinge for hinge in shell.hinges if hinge.stiffness]:
        raise InputError(
            f"{sprung[0].label}: micro_rotation is False, and the spring acts on the micro-rotations of both sides; "
            "leave micro_rotation out, or stiffness"
        )
    if turned.any():
        node = int(of[np.argmax(turned)])
        raise InputError(
            f"shell: sheets meet at an angle at node {node}, {place(shell.mesh.points[node])}, and micro_rotation is "
            "False; a joint carries its sheets by the micro-rotation, leave micro_rotation out"
        )
