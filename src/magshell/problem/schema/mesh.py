"""The table `mesh`: a generator and its numbers, or a file; and named selections."""

from __future__ import annotations

from typing import Annotated, Any, Literal, TypeAlias, get_args

from pydantic import BeforeValidator, Discriminator, Field, StrictBool, Tag, model_validator

from magshell.errors import InputError, suggest
from magshell.mesh import in_cylinder, in_polygon, in_sphere
from magshell.mesh.shapes import Shape
from magshell.problem import fields as f
from magshell.problem.schema.table import Table, key_error


class Sphere(Table):
    """Inside of a sphere, or between two."""

    centre: f.Position = (0.0, 0.0, 0.0)
    radius: f.Radius


class Round(Table):
    """Inside of an endless cylinder, or between two."""

    through: f.Position = (0.0, 0.0, 0.0)
    axis: f.Direction = (0.0, 0.0, 1.0)
    radius: f.Radius


class _Selected(Table):
    """What lies in shapes and belongs to groups."""

    sphere: Sphere | None = None
    cylinder: Round | None = None
    polygon: f.Outline | None = None
    groups: f.Names | None = None

    @model_validator(mode="after")
    def _selects_something(self) -> _Selected:
        if all(value is None for _, value in self):
            raise InputError(f"selects nothing; give at least one of {', '.join(sorted(type(self).model_fields))}")
        return self

    @property
    def shapes(self) -> list[Shape] | None:
        """Those that are given."""
        found = []
        if self.sphere is not None:
            found.append(in_sphere(self.sphere.centre, self.sphere.radius))
        if self.cylinder is not None:
            found.append(in_cylinder(self.cylinder.through, self.cylinder.axis, self.cylinder.radius))
        if self.polygon is not None:
            found.append(in_polygon(self.polygon))
        return found or None


class Selection(_Selected):
    """The edges on the boundary, or the nodes, that lie there; of some groups or of all."""

    x1: f.Coordinate | None = None
    x2: f.Coordinate | None = None
    x3: f.Coordinate | None = None


class Elements(_Selected):
    """The elements that lie there, of some groups or of all."""

    x1: f.LengthRange | None = None
    x2: f.LengthRange | None = None
    x3: f.LengthRange | None = None


class _Groups(Table):
    element_groups: dict[f.Name, Elements] = {}
    edge_groups: dict[f.Name, Selection] = {}
    node_groups: dict[f.Name, Selection] = {}


class Rectangle(_Groups):
    """Rectangle in the plane X1-X2 with a corner at the origin; edge groups left, right, bottom, top."""

    generator: Literal["rectangle"]
    length: f.PositiveLength
    width: f.PositiveLength
    elements: f.Divisions


class Block(Table):
    """Four-sided block between its corners, itself an element group."""

    corners: f.Corners
    elements: f.Divisions | None = None


class Blocks(_Groups):
    """Welded four-sided blocks; `elements` holds for the blocks that do not say their own."""

    generator: Literal["blocks"]
    elements: f.Divisions | None = None
    blocks: Annotated[dict[f.Name, Block], BeforeValidator(f.not_empty)]

    @model_validator(mode="after")
    def _every_block_is_divided(self) -> Blocks:
        for name in self.blocks:
            self.divisions(name)
        return self

    def divisions(self, name: str) -> tuple[int, int]:
        """Numbers of elements of a block."""
        own = self.blocks[name].elements or self.elements
        if own is None:
            raise key_error(f"blocks.{name}.elements", "is missing, and mesh.elements as well")
        return own


class Annulus(_Groups):
    """Flat ring about X3 or sector of one; edge groups inner, outer and, unless it is closed, start, stop."""

    generator: Literal["annulus"]
    inner_radius: f.PositiveLength
    outer_radius: f.PositiveLength
    elements: f.Divisions
    angle: f.AngleRange = (0.0, 360.0)
    slit: StrictBool = False


class Cylinder(_Groups):
    """Tube or sector of one; edge groups start, end and, for a sector, angle-start, angle-stop."""

    generator: Literal["cylinder"]
    radius: f.PositiveLength
    length: f.PositiveLength
    elements: f.Divisions
    angle: f.AngleRange = (0.0, 360.0)
    axis: f.Direction = (0.0, 0.0, 1.0)
    zero: f.Direction = (1.0, 0.0, 0.0)


class SpherePatch(_Groups):
    """Patch of a sphere about the origin, polar angle from +X3; edge groups top, bottom, left, right."""

    generator: Literal["sphere-patch"]
    radius: f.PositiveLength
    polar: f.AngleRange
    azimuth: f.AngleRange
    elements: f.Divisions


class Wall(Table):
    """Straight wall of a profile between two of its points, itself an element group."""

    between: f.NamePair
    elements: f.Count | None = None


class Profile(_Groups):
    """Thin-walled cross-section, extruded; edge groups start, end and every point."""

    generator: Literal["profile"]
    points: Annotated[dict[f.Name, f.PlaneCorner], BeforeValidator(f.not_empty)]
    walls: Annotated[dict[f.Name, Wall], BeforeValidator(f.not_empty)]
    length: f.PositiveLength
    elements: f.Divisions
    axis: f.Direction = (0.0, 0.0, 1.0)
    first: f.Direction = (1.0, 0.0, 0.0)

    @property
    def divided(self) -> dict[str, int]:
        """Numbers of elements across the walls that say their own."""
        return {name: wall.elements for name, wall in self.walls.items() if wall.elements is not None}


class Miura(_Groups):
    """Miura-ori in a folded state; edge groups mountain, valley, left, right, bottom, top."""

    generator: Literal["miura"]
    sides: f.LengthPair
    sector: f.Degrees
    fold: f.Degrees
    cells: f.Divisions
    elements: f.Divisions


class Polygon(_Groups):
    """Polygon in the plane X1-X2 with holes, meshed by gmsh; edge groups side-1, side-2, ..., hole-1, ..."""

    generator: Literal["polygon"]
    corners: f.Outline
    holes: tuple[f.Outline, ...] = ()
    size: f.PositiveLength | None = None


class MeshFile(_Groups):
    """A mesh from a file, or of a drawing or a solid in one, with the groups that the file names."""

    file: f.FileName
    unit: f.LengthUnit | None = None
    size: f.PositiveLength | None = None
    mid_surface: StrictBool = False
    holes: f.Names = ()
    gap: f.PositiveLength | None = None
    second_order: StrictBool = False
    closed: StrictBool = False
    weld: f.PositiveLength | None = None
    cuts: f.Names = ()


Generated: TypeAlias = Rectangle | Annulus | Blocks | Cylinder | SpherePatch | Profile | Miura | Polygon
Mesh: TypeAlias = Generated | MeshFile


def generator_or_file(data: Any) -> Any:
    """Refuse a table that has both, or neither."""
    if isinstance(data, dict):
        if "file" in data and "generator" in data:
            raise key_error("file", "is given beside generator; give one or the other")
        if "file" not in data and "generator" not in data:
            generators = [get_args(kind.model_fields["generator"].annotation)[0] for kind in get_args(Generated)]
            raise key_error("generator", f"is missing, and mesh.file as well. {suggest('', generators)}")
    return data


def one_of_both(data: Any) -> str:
    """Which part of the union a table belongs to."""
    return "file" if isinstance(data, MeshFile) or (isinstance(data, dict) and "file" in data) else "generator"


TheMesh = Annotated[
    Annotated[Annotated[Generated, Field(discriminator="generator")], Tag("generator")]
    | Annotated[MeshFile, Tag("file")],
    Discriminator(one_of_both),
    BeforeValidator(generator_or_file),
]
