"""What the shell and the magnets of rigid bodies exert on what makes the field."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Discretisation
from magshell.evaluation.balance import magnetic_of
from magshell.magnetics.fields import SelfField
from magshell.magnetics.fields.motion import MovingField
from magshell.model.course import Loading
from magshell.shell.state import State


def forces_on_sources(discretisation: Discretisation, state: State, loading: Loading) -> FloatArray:
    """Force and torque on each part of the field but the body's own (parts, 2, 3), N and N m.

    The torque is about the middle of magnets and coils, where they are now, and about the origin for other fields.
    """
    found = []
    for part, own in discretisation.model.field.parts(loading.drives):
        if isinstance(part, SelfField):
            continue
        on_shell = magnetic_of(discretisation, state, part, own)
        middle = np.zeros(3)
        if isinstance(part, MovingField):
            turn, shift = part.placement(own)
            middle = turn @ part.middle + shift
        found.append((-on_shell.force, np.cross(middle, on_shell.force) - on_shell.torque))
    return np.array(found).reshape(-1, 2, 3)
