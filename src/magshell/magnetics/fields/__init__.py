"""Magnetic fields: uniform, of magnets and coils, with a constant gradient, from a grid, of any function.

`field.py` says what a field is to the equations, `shapes.py` what a magnet or a coil is.
"""

from magshell.magnetics.fields.coils import Loop, Polygon, RectangularWinding, Solenoid
from magshell.magnetics.fields.dipoles import Dipole, Sphere
from magshell.magnetics.fields.field import Field, FieldSum, FieldUnknown, Values
from magshell.magnetics.fields.function import FunctionField
from magshell.magnetics.fields.grids import read_grid
from magshell.magnetics.fields.laboratory import CoilSystem, GradientField
from magshell.magnetics.fields.magnets import Cuboid, Cylinder
from magshell.magnetics.fields.motion import Motion
from magshell.magnetics.fields.own import SelfField
from magshell.magnetics.fields.polyhedron import Polyhedron
from magshell.magnetics.fields.rings import CylinderSegment, Ring
from magshell.magnetics.fields.sampled import SampledField
from magshell.magnetics.fields.sets import HALBACH_KEYS, PAIR_KEYS, halbach, helmholtz, maxwell
from magshell.magnetics.fields.shapes import Shape
from magshell.magnetics.fields.sources import Kind, MagnetField, Source
from magshell.magnetics.fields.uniform import UniformField

MAGNETS: dict[str, Kind] = {
    **{shape.kind: Kind(shape, shape.keys) for shape in (Cuboid, Cylinder, Ring, CylinderSegment, Sphere, Dipole)},
    "halbach": Kind(halbach, HALBACH_KEYS),
}
"""Magnets and sets of them by their names in problem files."""
COILS: dict[str, Kind] = {
    **{shape.kind: Kind(shape, shape.keys) for shape in (Loop, Polygon, Solenoid, RectangularWinding)},
    "helmholtz": Kind(helmholtz, PAIR_KEYS),
    "maxwell": Kind(maxwell, PAIR_KEYS),
}
"""Coils and sets of them by their names in problem files."""

__all__ = [
    "COILS",
    "MAGNETS",
    "CoilSystem",
    "Cuboid",
    "Cylinder",
    "CylinderSegment",
    "Dipole",
    "Field",
    "FieldSum",
    "FieldUnknown",
    "FunctionField",
    "GradientField",
    "Kind",
    "Loop",
    "MagnetField",
    "Motion",
    "Polygon",
    "Polyhedron",
    "RectangularWinding",
    "Ring",
    "SampledField",
    "SelfField",
    "Shape",
    "Solenoid",
    "Source",
    "Sphere",
    "UniformField",
    "Values",
    "halbach",
    "helmholtz",
    "maxwell",
    "read_grid",
]
