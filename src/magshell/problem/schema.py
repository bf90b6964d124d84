"""The problem file as data: which tables and keys there are, and what each may hold.

After reading, every quantity is in SI (angles of the mesh generators in degrees). What a single table cannot
know, such as whether a group exists, is checked in `magshell.problem.building`.
"""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal, TypeAlias

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StrictBool,
    ValidationInfo,
    field_validator,
    model_validator,
)
from pydantic_core import PydanticCustomError

from magshell.errors import InputError, suggest
from magshell.problem import fields as f


def key_error(key: str, message: str) -> PydanticCustomError:
    """An error of a table that belongs to one of its keys."""
    return PydanticCustomError("key_error", "{message}", {"key": key, "message": message})


class Table(BaseModel):
    """A table of the file; a key that it does not know is an error that names the nearest it does know."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    @model_validator(mode="before")
    @classmethod
    def _only_known_keys(cls, data: Any) -> Any:
        if not isinstance(data, dict):
            raise InputError("is not a table of keys and values")
        for key in data:
            if key not in cls.model_fields:
                raise key_error(key, f"is an unknown key. {suggest(key, cls.model_fields)}")
        return data


class Selection(Table):
    """Everything on the boundary (edges) or in the mesh (nodes) that has these coordinates."""

    x1: f.Length | None = None
    x2: f.Length | None = None
    x3: f.Length | None = None

    @model_validator(mode="after")
    def _selects_something(self) -> Selection:
        if self.x1 is None and self.x2 is None and self.x3 is None:
            raise InputError("selects nothing; give at least one of x1, x2, x3")
        return self


class _Groups(Table):
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


class ShellTable(Table):
    """What the surface is made into."""

    thickness: f.PositiveLength
    density: f.PositiveDensity | None = None
    element: Literal["quadratic", "paper", "paper-unenhanced", "paper-39"] = "quadratic"
    thickness_stretch: Literal["linear", "none", "plane-stress"] = "linear"
    micro_rotation: StrictBool = True


class _Material(Table):
    shear_modulus: f.PositiveStress
    lame_lambda: f.NonNegativeStress
    coupling_modulus: f.NonNegativeStress | None = None
    length_scale: f.PositiveLength | None = None


class NeoHookean(_Material):
    """Micropolar neo-Hookean material."""

    law: Literal["micropolar-neo-hookean"]


class MooneyRivlin(_Material):
    """Micropolar Mooney–Rivlin material."""

    law: Literal["micropolar-mooney-rivlin"]
    second_invariant_share: f.Number = 0.25


class StVenantKirchhoff(_Material):
    """Micropolar St Venant–Kirchhoff material."""

    law: Literal["micropolar-st-venant-kirchhoff"]


class _Remanence(Table):
    group: f.Names | None = None


class ConstantRemanence(_Remanence):
    """The same vector everywhere, given as it is or as a magnitude along a direction."""

    kind: Literal["constant"]
    vector: f.FluxVector | None = None
    magnitude: f.PositiveFluxDensity | None = None
    direction: f.Direction | None = None

    @model_validator(mode="after")
    def _is_given_once(self) -> ConstantRemanence:
        polar = (self.magnitude is not None, self.direction is not None)
        if self.vector is None and polar == (False, False):
            raise key_error("vector", "is missing; give it, or magnitude and direction")
        if self.vector is not None and any(polar):
            raise key_error("vector", "is given beside magnitude or direction; give one or the other")
        if self.vector is None and not all(polar):
            present, missing = ("magnitude", "direction") if polar[0] else ("direction", "magnitude")
            raise key_error(missing, f"is missing beside {present}")
        return self


class MeridionalRemanence(_Remanence):
    """Along the meridians of a sphere, away from the pole on the +axis side, mirrored at the equator."""

    kind: Literal["meridional"]
    magnitude: f.PositiveFluxDensity
    axis: f.Direction = (0.0, 0.0, 1.0)
    mirrored: StrictBool = True


class CircumferentialRemanence(_Remanence):
    """Around an axis; with `towards`, in the sense that has a positive component along it."""

    kind: Literal["circumferential"]
    magnitude: f.PositiveFluxDensity
    axis: f.Direction = (0.0, 0.0, 1.0)
    towards: f.Direction | None = None


class FieldTable(Table):
    """The external field."""

    flux_density: f.FluxVector
    history: f.History | None = None
    rotation_axis: f.Direction | None = None
    rotation: f.Rotation | None = None
    stops: tuple[f.PositiveFluxDensity, ...] = ()
    coupling: Literal["couple", "micro-rotation", "deformation-gradient"] = "couple"

    @model_validator(mode="after")
    def _axis_and_angles_go_together(self) -> FieldTable:
        if self.rotation is not None and self.rotation_axis is None:
            raise key_error("rotation_axis", "is missing beside rotation")
        if self.rotation is None and self.rotation_axis is not None:
            raise key_error("rotation", "is missing beside rotation_axis")
        return self

    @model_validator(mode="after")
    def _stops_lie_on_the_way(self) -> FieldTable:
        end = sum(component**2 for component in self.flux_density) ** 0.5 * max(map(abs, self.history or (1.0,)))
        for number, stop in enumerate(self.stops):
            if stop > end * (1.0 + 1e-12):
                raise key_error(f"stops[{number}]", f"{stop:g} T lies beyond the largest field of the path, {end:g} T")
            if number and stop <= self.stops[number - 1]:
                raise key_error(f"stops[{number}]", "does not exceed the one before; stops must rise")
        return self


class _Support(Table):
    group: f.Name


class ClampTable(_Support):
    """No displacement, no rotation; the thickness stretch stays free."""

    kind: Literal["clamp"]


class SimpleTable(_Support):
    """No displacement."""

    kind: Literal["simple"]


class SymmetryTable(_Support):
    """Mirror plane with this normal."""

    kind: Literal["symmetry"]
    normal: f.Direction


class PrescribeTable(_Support):
    """A nodal field, or one component of it, that reaches `value`."""

    kind: Literal["prescribe"]
    field: Literal["u", "w", "phi", "omega"]
    component: Literal[1, 2, 3] | None = None
    value: float | tuple[float, float, float] = 0.0
    history: f.History | None = None

    @field_validator("value", mode="before")
    @classmethod
    def _has_the_unit_of_the_field(cls, value: object, info: ValidationInfo) -> object:
        if "field" not in info.data:
            return 0.0
        one = info.data["field"] == "phi" or info.data.get("component") is not None
        return f.prescribed_value(value, info.data["field"], one)

    @model_validator(mode="after")
    def _phi_is_a_scalar(self) -> PrescribeTable:
        if self.field == "phi" and self.component is not None:
            raise key_error("component", "makes no sense with the field phi, which has only one; leave it out")
        return self


class _Load(Table):
    history: f.History | None = None


class ForceTable(_Load):
    """A force, dead or turning with the micro-rotation."""

    kind: Literal["force"]
    group: f.Name
    total: f.ForceVector
    follower: StrictBool = False


class MomentTable(_Load):
    """A moment on the micro-rotation, dead or turning with it, or on the director."""

    kind: Literal["moment"]
    group: f.Name
    total: f.MomentVector
    follower: StrictBool = False


class TractionTable(_Load):
    """A dead force per undeformed area."""

    kind: Literal["traction"]
    group: f.Name
    traction: f.StressVector


class PressureTable(_Load):
    """A pressure along the deformed normal."""

    kind: Literal["pressure"]
    group: f.Name
    pressure: f.Pressure


class GravityTable(_Load):
    """Weight."""

    kind: Literal["gravity"]
    acceleration: f.AccelerationVector
    group: f.Name | None = None


class StageTable(Table):
    """A part of the load path."""

    name: f.Name | None = None
    control: Literal["load", "arc-length", "displacement"] = "load"
    stops: tuple[f.PositiveNumber, ...] = ()
    probe: f.ProbeName | None = None
    component: Literal[1, 2, 3] | None = None
    target: f.Length | None = None
    branch: f.Count | None = None
    side: Literal[1, -1] = 1


class SolverTable(Table):
    """How the path is followed; what is left out has the default of `magshell.Settings`."""

    tolerance: f.PositiveNumber | None = None
    max_iterations: f.Count | None = None
    target_iterations: f.Count | None = None
    first_step: f.PositiveNumber | None = None
    smallest_step: f.PositiveNumber | None = None
    largest_step: f.PositiveNumber | None = None
    linear_solver: f.Name | None = None


Mesh: TypeAlias = Rectangle | Annulus | Blocks | Cylinder | SpherePatch
Material: TypeAlias = NeoHookean | MooneyRivlin | StVenantKirchhoff
Remanence: TypeAlias = ConstantRemanence | MeridionalRemanence | CircumferentialRemanence
Support: TypeAlias = ClampTable | SimpleTable | SymmetryTable | PrescribeTable
Load: TypeAlias = ForceTable | MomentTable | TractionTable | PressureTable | GravityTable


class ProblemFile(Table):
    """The whole file."""

    # Key that chooses among the kinds of a table, and where in the path of an error pydantic puts the choice.
    chosen_by: ClassVar[dict[str, tuple[str, int]]] = {
        "mesh": ("generator", 1),
        "material": ("law", 1),
        "remanence": ("kind", 2),
        "supports": ("kind", 2),
        "loads": ("kind", 2),
    }

    title: str = ""
    description: str = ""
    mesh: Annotated[Mesh, Field(discriminator="generator")]
    shell: ShellTable
    material: Annotated[Material, Field(discriminator="law")]
    remanence: tuple[Annotated[Remanence, Field(discriminator="kind")], ...] = ()
    field: FieldTable = FieldTable(flux_density=(0.0, 0.0, 0.0))
    loads: tuple[Annotated[Load, Field(discriminator="kind")], ...] = ()
    supports: Annotated[tuple[Annotated[Support, Field(discriminator="kind")], ...], BeforeValidator(f.not_empty)]
    stages: tuple[StageTable, ...] = ()
    probes: dict[f.ProbeName, f.Position] = {}
    solver: SolverTable = SolverTable()
