"""The shell of a problem: its regions and layers."""

from __future__ import annotations

import pathlib
from collections.abc import Sequence
from typing import Any

from magshell.magnetics.remanence import Remanence
from magshell.mesh import Mesh
from magshell.model import thickness as thicknesses
from magshell.model.hinge import Hinge
from magshell.model.region import NO_REMANENCE, Layer, Region
from magshell.model.repeated import REPEATED, Repeated
from magshell.model.rigid_body import RigidBody
from magshell.model.shell import Shell
from magshell.model.thickness import Thickness
from magshell.problem import schema
from magshell.problem.building.located import at
from magshell.problem.building.material import build_material
from magshell.problem.building.remanence import build_remanence
from magshell.problem.schema import ProblemFile, ThicknessFile, ThicknessProfile

Given = float | ThicknessFile | ThicknessProfile | None


def build_shell(file: ProblemFile, mesh: Mesh, folder: pathlib.Path) -> Shell:
    """The shell that a file describes."""
    table, builder = file.shell, _Builder(mesh, folder)
    with at("shell.thickness"):
        thickness = builder.thickness(table.thickness)
    regions = [builder.region(number, one) for number, one in enumerate(file.regions)]
    given: dict[str, Any] = {"remanence": build_remanence(file.remanence, mesh, folder)} if file.remanence else {}
    return Shell(
        mesh=mesh,
        thickness=thickness,
        material=None if file.material is None else build_material(file.material),
        element=table.element,
        thickness_stretch=table.thickness_stretch,
        micro_rotation=table.micro_rotation,
        density=table.density,
        regions=regions,
        layers=builder.layers("shell", table.layers),
        offset=table.offset,
        levels=table.levels,
        hinges=[builder.hinge(number, one) for number, one in enumerate(file.hinges)],
        rigid=[builder.rigid(number, one) for number, one in enumerate(file.rigid)],
        repeated=[builder.repeated(number, one) for number, one in enumerate(file.repeated)],
        **given,
    )


class _Builder:
    """Makes parts of a shell of their tables."""

    def __init__(self, mesh: Mesh, folder: pathlib.Path) -> None:
        self._mesh, self._folder = mesh, folder

    def region(self, number: int, table: schema.RegionTable) -> Region:
        """An entry of `regions`."""
        where = f"regions[{number}]"
        for group in table.group:
            with at(f"{where}.group"):
                self._mesh.elements_of(group)
        with at(f"{where}.thickness"):
            thickness = self.thickness(table.thickness)
        entries = table.remanence
        return Region(
            group=table.group if len(table.group) > 1 else table.group[0],
            thickness=thickness,
            material=None if table.material is None else build_material(table.material),
            remanence=None if entries is None else self._remanence(where, entries),
            density=table.density,
            layers=self.layers(where, table.layers),
            offset=table.offset,
            levels=table.levels,
        )

    def rigid(self, number: int, table: schema.RigidTable) -> RigidBody:
        """An entry of `rigid`."""
        with at(f"rigid[{number}].group"):
            self._mesh.nodes_of(table.group)
        given = {key: value for key, value in table.model_dump().items() if value is not None}
        with at(f"rigid[{number}]"):
            return RigidBody(**given)

    def hinge(self, number: int, table: schema.HingeTable) -> Hinge:
        """An entry of `hinges`."""
        hinge = Hinge(table.group, table.stiffness or 0.0)
        with at(f"hinges[{number}].group"):
            hinge.edges(self._mesh)
        return hinge

    def repeated(self, number: int, table: schema.RepeatedTable) -> Repeated:
        """An entry of `repeated`."""
        cls = REPEATED[table.kind]
        for key in ("group", "image"):
            with at(f"repeated[{number}].{key}"):
                self._mesh.nodes_of(getattr(table, key))
        with at(f"repeated[{number}]"):
            made = cls(**{key: getattr(table, key) for key in cls.keys if getattr(table, key) is not None})
            made.nodes(self._mesh)
            return made

    def layers(self, where: str, tables: Sequence[schema.LayerTable]) -> list[Layer]:
        """The entries of `layers`."""
        found = []
        for number, table in enumerate(tables):
            place = f"{where}.layers[{number}]"
            with at(f"{place}.thickness"):
                thickness = self.thickness(table.thickness)
            assert thickness is not None
            found.append(
                Layer(thickness, build_material(table.material), self._remanence(place, table.remanence), table.density)
            )
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

    def _remanence(self, where: str, entries: tuple[schema.RemanenceTable, ...]) -> Remanence:
        return build_remanence(entries, self._mesh, self._folder, f"{where}.remanence") if entries else NO_REMANENCE
