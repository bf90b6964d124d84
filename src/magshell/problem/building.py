"""From checked data to a model and settings; what goes wrong is located in the file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from magshell import magnetics, materials
from magshell.errors import InputError
from magshell.linalg import make_solver
from magshell.loads import Force, Gravity, Load, Moment, Pressure, Traction
from magshell.magnetics import UniformField, remanence
from magshell.magnetics.remanence import Remanence
from magshell.materials import Material
from magshell.mesh import Mesh, annulus, blocks, cylinder, rectangle, sphere_patch
from magshell.model import Model, Shell
from magshell.problem import schema
from magshell.problem.schema import ProblemFile
from magshell.solver.settings import Settings
from magshell.stages import Stage
from magshell.supports import Clamp, Prescribe, SimpleSupport, Support, SymmetryPlane

MOST_ELEMENTS = 1_000_000

COUPLINGS = {
    "couple": magnetics.MicropolarCouple(),
    "micro-rotation": magnetics.MicroRotationEnergy(),
    "deformation-gradient": magnetics.DeformationGradientEnergy(),
}


@dataclass(frozen=True, eq=False)
class Problem:
    """A problem ready to solve.

    Attributes
    ----------
    source : str
        Name of the file.
    file : ProblemFile
        Its content in SI.
    model : Model
    settings : Settings
    """

    source: str
    file: ProblemFile
    model: Model
    settings: Settings

    @property
    def title(self) -> str:
        return self.file.title or self.source


def build(file: ProblemFile, source: str) -> Problem:
    """Make the model that a problem file describes.

    Parameters
    ----------
    file : ProblemFile
    source : str
        Name of the file, for messages.

    Raises
    ------
    InputError
        What the parts are wrong about together, with file and key.
    """
    with _at(source):
        mesh = _mesh(file.mesh)
        shell = Shell(
            mesh=mesh,
            thickness=file.shell.thickness,
            material=_material(file.material, file.shell),
            remanence=_remanence(file.remanence, mesh),
            element=file.shell.element,
            thickness_stretch=file.shell.thickness_stretch,
            micro_rotation=file.shell.micro_rotation,
            density=file.shell.density,
        )
        field = _field(file.field)
        supports = _supports(file.supports, mesh)
        loads = _loads(file.loads, mesh)
        _probes_exist(file.probes, mesh)
        model = Model(
            shell,
            supports=supports,
            field=field,
            coupling=COUPLINGS[file.field.coupling],
            probes=file.probes,
            loads=loads,
            stages=_stages(file.stages),
        )
        settings = Settings(**file.solver.model_dump(exclude_none=True))
        make_solver(settings.linear_solver)
        return Problem(source, file, model, settings)


@contextmanager
def _at(where: str) -> Iterator[None]:
    """Prefix every input error of the block with its place."""
    try:
        yield
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _mesh(table: schema.Mesh) -> Mesh:
    with _at("mesh"):
        mesh = _generated(table)
    for name, selection in table.edge_groups.items():
        with _at(f"mesh.edge_groups.{name}"):
            mesh = mesh.select_edges(name, selection.x1, selection.x2, selection.x3)
    for name, selection in table.node_groups.items():
        with _at(f"mesh.node_groups.{name}"):
            mesh = mesh.select_nodes(name, selection.x1, selection.x2, selection.x3)
    return mesh


def _generated(table: schema.Mesh) -> Mesh:
    match table:
        case schema.Rectangle():
            _bounded(table.elements)
            return rectangle(table.length, table.width, table.elements)
        case schema.Annulus():
            _bounded(table.elements)
            return annulus(table.inner_radius, table.outer_radius, table.elements, table.angle, table.slit)
        case schema.Cylinder():
            _bounded(table.elements)
            return cylinder(table.radius, table.length, table.elements, table.angle, table.axis, table.zero)
        case schema.SpherePatch():
            _bounded(table.elements)
            return sphere_patch(table.radius, table.polar, table.azimuth, table.elements)
        case schema.Blocks():
            divisions = {name: table.divisions(name) for name in table.blocks}
            _bounded(*divisions.values())
            spatial = any(len(corner) == 3 for block in table.blocks.values() for corner in block.corners)
            corners = {
                name: np.array([[*corner, 0.0][: 3 if spatial else 2] for corner in block.corners])
                for name, block in table.blocks.items()
            }
            return blocks(corners, divisions)


def _bounded(*divisions: tuple[int, int]) -> None:
    elements = sum(n * m for n, m in divisions)
    if elements > MOST_ELEMENTS:
        raise InputError(f"elements: asks for {elements} elements; at most {MOST_ELEMENTS} can be solved")


def _material(table: schema.Material, shell: schema.ShellTable) -> Material:
    eta, length = table.coupling_modulus, table.length_scale
    usual = (table.shear_modulus / 10.0, shell.thickness / 10.0) if shell.micro_rotation else (0.0, 0.0)
    parameters = {
        "shear_modulus": table.shear_modulus,
        "lame_lambda": table.lame_lambda,
        "coupling_modulus": usual[0] if eta is None else eta,
        "length_scale": usual[1] if length is None else length,
    }
    if isinstance(table, schema.MooneyRivlin):
        return materials.MicropolarMooneyRivlin(**parameters, second_invariant_share=table.second_invariant_share)
    if isinstance(table, schema.StVenantKirchhoff):
        return materials.MicropolarStVenantKirchhoff(**parameters)
    return materials.MicropolarNeoHookean(**parameters)


def _remanence(entries: tuple[schema.Remanence, ...], mesh: Mesh) -> Remanence:
    if len(entries) == 1 and entries[0].group is None:
        return _one_remanence(entries[0])
    grouped: dict[str, Remanence] = {}
    owner: dict[int, str] = {}
    for number, entry in enumerate(entries):
        with _at(f"remanence[{number}].group"):
            if entry.group is None:
                raise InputError(f"is missing; with several entries each says its element groups {_listed(mesh)}")
            for group in entry.group:
                for element in mesh.elements_of(group).tolist():
                    if element in owner:
                        raise InputError(
                            f"element {element} of '{group}' already has the remanence of '{owner[element]}'"
                        )
                    owner[element] = group
                grouped[group] = _one_remanence(entry)
    return remanence.by_group(grouped)


def _one_remanence(entry: schema.Remanence) -> Remanence:
    match entry:
        case schema.ConstantRemanence():
            if entry.vector is not None:
                return remanence.constant(entry.vector)
            direction = np.array(entry.direction)
            return remanence.constant((entry.magnitude or 0.0) * direction / np.linalg.norm(direction))
        case schema.MeridionalRemanence():
            return remanence.meridional(entry.magnitude, entry.axis, entry.mirrored)
        case schema.CircumferentialRemanence():
            return remanence.circumferential(entry.magnitude, entry.axis, entry.towards)


def _field(table: schema.FieldTable) -> UniformField:
    return UniformField(table.flux_density, table.stops, table.history, table.rotation_axis, table.rotation)


def _stages(tables: tuple[schema.StageTable, ...]) -> list[Stage]:
    stages = []
    for number, table in enumerate(tables):
        with _at(f"stages[{number}]"):
            stages.append(Stage(**{**table.model_dump(), "name": table.name or ""}))
    return stages


def _supports(tables: tuple[schema.Support, ...], mesh: Mesh) -> list[Support]:
    supports: list[Support] = []
    for number, table in enumerate(tables):
        with _at(f"supports[{number}].group"):
            mesh.nodes_of(table.group)
        with _at(f"supports[{number}]"):
            supports.append(_support(table))
    return supports


def _support(table: schema.Support) -> Support:
    match table:
        case schema.ClampTable():
            return Clamp(table.group)
        case schema.SimpleTable():
            return SimpleSupport(table.group)
        case schema.SymmetryTable():
            return SymmetryPlane(table.group, table.normal)
        case schema.PrescribeTable():
            return Prescribe(table.group, table.field, table.component, table.value, table.history)


def _loads(tables: tuple[schema.Load, ...], mesh: Mesh) -> list[Load]:
    loads: list[Load] = []
    for number, table in enumerate(tables):
        with _at(f"loads[{number}].group"):
            _loaded_group(table, mesh)
        loads.append(_load(table))
    return loads


def _loaded_group(table: schema.Load, mesh: Mesh) -> None:
    if isinstance(table, schema.ForceTable | schema.MomentTable):
        mesh.nodes_of(table.group)
    elif table.group is not None:
        mesh.elements_of(table.group)


def _load(table: schema.Load) -> Load:
    match table:
        case schema.ForceTable():
            return Force(table.group, table.total, table.follower, table.history)
        case schema.MomentTable():
            return Moment(table.group, table.total, table.follower, table.history)
        case schema.TractionTable():
            return Traction(table.group, table.traction, table.history)
        case schema.PressureTable():
            return Pressure(table.group, table.pressure, table.history)
        case schema.GravityTable():
            return Gravity(table.acceleration, table.group, table.history)


def _probes_exist(probes: Mapping[str, tuple[float, float, float]], mesh: Mesh) -> None:
    for name, position in probes.items():
        with _at(f"probes.{name}"):
            mesh.node_at(position)


def _listed(mesh: Mesh) -> str:
    return f"({', '.join(mesh.element_groups)})" if mesh.element_groups else "(this mesh has none)"
