"""The shell of a problem: its regions and layers."""

from __future__ import annotations

import pathlib
from collections.abc import Sequence

from magshell.errors import InputError
from magshell.magnetics.remanence import Remanence
from magshell.materials import MATERIALS, Material, keys_of
from magshell.mesh import Mesh
from magshell.model import thickness as thicknesses
from magshell.model.region import NO_REMANENCE, Layer, Region
from magshell.model.shell import Shell
from magshell.model.thickness import Thickness
from magshell.problem import schema
from magshell.problem.building.located import at
from magshell.problem.building.remanence import build_remanence
from magshell.problem.schema import ProblemFile, ThicknessFile, ThicknessProfile

Given = float | ThicknessFile | ThicknessProfile | None


def build_shell(file: ProblemFile, mesh: Mesh, folder: pathlib.Path) -> Shell:
    """The shell that a file describes."""
    table, builder = file.shell, _Builder(mesh, folder, file.shell.micro_rotation)
    with at("shell.thickness"):
        thickness = builder.thickness(table.thickness)
    regions = [builder.region(number, one, table) for number, one in enumerate(file.regions)]
    given = {"remanence": build_remanence(file.remanence, mesh, folder)} if file.remanence else {}
    return Shell(
        mesh=mesh,
        thickness=thickness,
        material=builder.material(file.material, "material", table.thickness),
        element=table.element,
        thickness_stretch=table.thickness_stretch,
        micro_rotation=table.micro_rotation,
        density=table.density,
        regions=regions,
        layers=builder.layers("shell", table.layers),
        offset=table.offset,
        levels=table.levels,
        **given,
    )


class _Builder:
    """Makes parts of a shell of their tables."""

    def __init__(self, mesh: Mesh, folder: pathlib.Path, micro_rotation: bool) -> None:
        self._mesh, self._folder, self._micro_rotation = mesh, folder, micro_rotation

    def region(self, number: int, table: schema.RegionTable, shell: schema.ShellTable) -> Region:
        """An entry of `regions`."""
        where = f"regions[{number}]"
        for group in table.group:
            with at(f"{where}.group"):
                self._mesh.elements_of(group)
        with at(f"{where}.thickness"):
            thickness = self.thickness(table.thickness)
        entries = table.remanence
        own = shell.thickness if table.thickness is None else table.thickness
        return Region(
            group=table.group if len(table.group) > 1 else table.group[0],
            thickness=thickness,
            material=self.material(table.material, f"{where}.material", own),
            remanence=None if entries is None else self._remanence(where, entries),
            density=table.density,
            layers=self.layers(where, table.layers),
            offset=table.offset,
            levels=table.levels,
        )

    def layers(self, where: str, tables: Sequence[schema.LayerTable]) -> list[Layer]:
        """The entries of `layers`."""
        known = [table.thickness for table in tables if isinstance(table.thickness, float)]
        whole = sum(known) if len(known) == len(tables) else None
        found = []
        for number, table in enumerate(tables):
            place = f"{where}.layers[{number}]"
            with at(f"{place}.thickness"):
                thickness = self.thickness(table.thickness)
            assert thickness is not None
            material = self.material(table.material, f"{place}.material", whole)
            found.append(Layer(thickness, material, self._remanence(place, table.remanence), table.density))
        return found

    def thickness(self, given: Given) -> float | Thickness | None:
        """A length, or what a table says."""
        match given:
            case ThicknessProfile():
                return thicknesses.profile(given.along, given.positions, given.values)
            case ThicknessFile():
                file = self._folder / given.file
                return thicknesses.from_file(
                    file, given.thickness_unit, given.length_unit, given.stepped, given.tolerance
                )
        return given

    def material(self, table: schema.MaterialTable | None, where: str, thickness: Given) -> Material | None:
        """The law with its parameters."""
        if table is None:
            return None
        law = MATERIALS[table.law]
        parameters = {key: getattr(table, key) for key in keys_of(law)}
        if parameters["coupling_modulus"] is None:
            parameters["coupling_modulus"] = table.shear_modulus / 10.0 if self._micro_rotation else 0.0
        if parameters["length_scale"] is None and not self._micro_rotation:
            parameters["length_scale"] = 0.0
        elif parameters["length_scale"] is None:
            if not isinstance(thickness, float):
                raise InputError(f"{where}.length_scale: is missing; it is h/10 only where there is one thickness h")
            parameters["length_scale"] = thickness / 10.0
        return law(**parameters)

    def _remanence(self, where: str, entries: tuple[schema.RemanenceTable, ...]) -> Remanence:
        return build_remanence(entries, self._mesh, self._folder, f"{where}.remanence") if entries else NO_REMANENCE
