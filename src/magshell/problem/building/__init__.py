"""From checked data to a model and settings; what goes wrong is located in the file."""

from __future__ import annotations

import pathlib
from collections.abc import Mapping
from dataclasses import dataclass

from magshell.drawing import drawing
from magshell.evaluation.outputs import chosen
from magshell.linalg import make_solver
from magshell.magnetics import COUPLINGS
from magshell.mesh import Mesh
from magshell.model.elastic import ElasticSupport
from magshell.model.loads import LOADS, Load
from magshell.model.model import Model
from magshell.model.shell import Shell
from magshell.model.springs import SPRINGS
from magshell.model.stages import Stage
from magshell.model.support import Support
from magshell.model.supports import SUPPORTS
from magshell.problem import schema
from magshell.problem.building.field import build_field
from magshell.problem.building.located import at
from magshell.problem.building.material import EARLIER
from magshell.problem.building.mesh import build_mesh
from magshell.problem.building.shell import build_shell
from magshell.problem.schema import ProblemFile
from magshell.solver.settings import Settings


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
    text : str
        The file as it was read.
    folder : pathlib.Path
        Where the paths in it start.
    """

    source: str
    file: ProblemFile
    model: Model
    settings: Settings
    text: str
    folder: pathlib.Path

    @property
    def title(self) -> str:
        """As the file says it, or its name."""
        return self.file.title or self.source

    def __repr__(self) -> str:
        return f"Problem('{self.source}': {self.title})\n{self.model!r}"

    def _repr_html_(self) -> str:
        return str(drawing("problem_html")(self))


def build(file: ProblemFile, source: str, text: str = "", folder: pathlib.Path = pathlib.Path()) -> Problem:
    """Make the model that a problem file describes.

    Parameters
    ----------
    file : ProblemFile
    source : str
        Name of the file, for messages.
    text : str
        As it was read.
    folder : pathlib.Path
        Where the paths in it start.

    Raises
    ------
    InputError
        The parts do not fit together; located by file and key.
    """
    with at(source):
        mesh = build_mesh(file.mesh, folder)
        shell = build_shell(file, mesh, folder)
        field = build_field(file, folder)
        supports = _supports(file.supports, shell)
        springs = _springs(file.springs, shell)
        loads = _loads(file.loads, shell)
        _probes_exist(file.probes, mesh)
        with at("results.outputs"):
            chosen(file.results.outputs)
        model = Model(
            shell,
            supports=supports,
            field=field,
            coupling=COUPLINGS[file.field.coupling](),
            probes=file.probes,
            loads=loads,
            stages=_stages(file.stages),
            local_axis=file.results.local_axis,
            outputs=file.results.outputs,
            springs=springs,
        )
        settings = Settings(**file.solver.model_dump(exclude_none=True))
        make_solver(settings.linear_solver)
        return Problem(source, file, model, settings, text, folder)


def with_earlier_defaults(problem: Problem) -> Problem:
    """The problem as it was built when checkpoints had version 1, without regions; its text stays as it is."""
    material = problem.file.material
    if material is None:
        return problem
    given = {key: multiple for key, multiple in EARLIER.items() if getattr(material, key) is None}
    file = problem.file.model_copy(update={"material": material.model_copy(update=given)})
    return build(file, problem.source, problem.text, problem.folder)


def _stages(tables: tuple[schema.StageTable, ...]) -> list[Stage]:
    stages = []
    for number, table in enumerate(tables):
        with at(f"stages[{number}]"):
            stages.append(Stage(**{**table.model_dump(), "name": table.name or ""}))
    return stages


def _supports(tables: tuple[schema.SupportTable, ...], shell: Shell) -> list[Support]:
    supports: list[Support] = []
    for number, table in enumerate(tables):
        with at(f"supports[{number}].group"):
            shell.nodes_of(table.group)
        with at(f"supports[{number}]"):
            cls = SUPPORTS[table.kind]
            supports.append(cls(**{key: getattr(table, key) for key in cls.all_keys()}))
    return supports


def _springs(tables: tuple[schema.SpringTable, ...], shell: Shell) -> list[ElasticSupport]:
    springs: list[ElasticSupport] = []
    for number, table in enumerate(tables):
        with at(f"springs[{number}].group"):
            shell.nodes_of(table.group)
        cls = SPRINGS[table.kind]
        springs.append(cls(**{key: getattr(table, key) for key in cls.keys}))
    return springs


def _loads(tables: tuple[schema.LoadTable, ...], shell: Shell) -> list[Load]:
    loads: list[Load] = []
    for number, table in enumerate(tables):
        cls = LOADS[table.kind]
        loads.append(cls(**{key: getattr(table, key) for key in cls.keys}))
        with at(f"loads[{number}].group"):
            loads[-1].members(shell)
    return loads


def _probes_exist(probes: Mapping[str, tuple[float, float, float]], mesh: Mesh) -> None:
    for name, position in probes.items():
        with at(f"probes.{name}"):
            mesh.node_at(position)
