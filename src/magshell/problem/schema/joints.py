"""The tables `rigid` and `hinges`."""

from __future__ import annotations

from magshell.problem import fields as f
from magshell.problem.schema.table import Table


class RigidTable(Table):
    """A group that moves as one rigid body."""

    group: f.Name
    name: f.Name | None = None
    point: f.Position | None = None
    moment: f.MagneticMoment | None = None
    mass: f.PositiveMass | None = None


class HingeTable(Table):
    """Edges along which the sheets on their sides may turn against each other."""

    group: f.Name
    stiffness: f.HingeStiffness | None = None
