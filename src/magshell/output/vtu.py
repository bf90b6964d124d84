"""VTU files, one per converged step, and the PVD file that strings them together for ParaView."""

from __future__ import annotations

import glob
import os
import pathlib
from collections.abc import Collection, Iterable
from itertools import pairwise
from typing import TYPE_CHECKING, Any
from xml.sax.saxutils import quoteattr

import numpy as np

from magshell.evaluation.converged import converged
from magshell.evaluation.outputs import Output, chosen
from magshell.evaluation.patches import patches_of
from magshell.files import naming, refuse_somebodys, with_suffix, write_atomically
from magshell.magnetics.fields.own import has_own
from magshell.model.words import name_of
from magshell.shell.triangle import REPEATED, SLOTS
from magshell.solver.events import Observer

if TYPE_CHECKING:
    from magshell.equations.discretisation import Discretisation
    from magshell.mesh import Mesh
    from magshell.solver.buckling import BucklingMode
    from magshell.solver.critical import CriticalPoint
    from magshell.solver.path import Path
    from magshell.solver.settings import Settings
    from magshell.solver.step import Step

VTK_QUADRATIC_QUAD = 23
VTK_QUADRATIC_TRIANGLE = 22
END = b"</VTKFile>\n"
IN_FIELDS_THAT_VARY = ("flux_density", "magnetic_force_density")
WITH_OWN_FIELD = ("self_flux_density",)


class VtuWriter(Observer):
    """Write every converged step as a file of quadratic quads and triangles, which ParaView draws curved.

    Points are reference positions (m): in ParaView, *Warp By Vector* with `displacement` shows the deformed
    shape. Point and cell arrays are the usual ones of `magshell.evaluation.outputs` and those that the model asks for,
    and in a field that varies its flux density and force density;
    their units and meaning are in the field data `outputs`, `units` and `meanings` (bytes of UTF-8, a line each),
    beside `load_factor`, `step`, `flux_density` and `flux_density_magnitude` (T). The cell array `region` numbers the
    regions in the field data `region_names`. The time in the PVD file is the load factor plus the number of the
    stages before, or, on a path that turns back, the number of the step.

    Parameters
    ----------
    directory : path
        Folder of the PVD file.
    name : str
        The PVD file is `NAME.pvd`.
    folder : str
        Folder of the VTU files, `step-0000.vtu` and so on, inside the directory. Step files that an earlier
        run left there are removed when the solve starts.

    Raises
    ------
    OSError
        The disk refuses; the message names the file.
    """

    def __init__(self, directory: str | os.PathLike[str], name: str = "shell", folder: str = "steps") -> None:
        self.file = pathlib.Path(directory) / f"{name}.pvd"
        self._folder = folder

    def started(self, discretisation: Discretisation, settings: Settings | None = None) -> None:
        """Begin a new series."""
        self._discretisation = discretisation
        self._written: list[tuple[float, str]] = []
        with naming(self.file):
            self.file.unlink(missing_ok=True)
        self._keep_only(())

    def resumed(self, path: Path) -> None:
        """The steps so far; files of theirs that are there and whole are left as they are."""
        self._discretisation = path.discretisation
        self._written = [(step.stage + step.load_factor, self._name(step)) for step in path.steps]
        self._keep_only({name for _, name in self._written})
        for step in path.steps:
            if not _is_whole(self.file.parent / self._name(step)):
                self._write(step)
        write_atomically(self.file, _pvd(self._written))

    def converged(self, step: Step) -> None:
        """Write the step, then the series with it."""
        self._write(step)
        self._written.append((step.stage + step.load_factor, self._name(step)))
        write_atomically(self.file, _pvd(self._written))

    def _name(self, step: Step) -> str:
        return f"{self._folder}/step-{step.number:04d}.vtu"

    def _write(self, step: Step) -> None:
        write_atomically(self.file.parent / self._name(step), vtu(grid(self._discretisation, step)))

    def _keep_only(self, names: Collection[str]) -> None:
        """Remove the other step files of the folder."""
        folder = self.file.parent / self._folder
        with naming(folder):
            for old in folder.glob("step-[0-9][0-9][0-9][0-9]*.vtu"):
                if f"{self._folder}/{old.name}" not in names:
                    old.unlink(missing_ok=True)


def _is_whole(file: pathlib.Path) -> bool:
    """Whether a VTU file is there to its end (one that a disk lost on a power failure is not)."""
    try:
        with open(file, "rb") as opened:
            opened.seek(-min(len(END), file.stat().st_size), os.SEEK_END)
            return opened.read() == END
    except OSError:
        return False


def save_series(path: Path, file: str | os.PathLike[str]) -> None:
    """Write a whole path: `NAME.pvd` with its step files in the folder `NAME` beside it.

    Parameters
    ----------
    path : Path
    file : path
        The PVD file; without a suffix it gets `.pvd`.

    Raises
    ------
    InputError
        A name that says another format; steps of something else in the folder beside it.
    OSError
        The disk refuses; the message names the file.
    """
    target = pathlib.Path(file)
    target = with_suffix(target if target.suffix else target.with_name(f"{target.name}.pvd"), ".pvd")
    made = b'type="Collection"' in target.read_bytes()[:200] if target.is_file() else False
    refuse_somebodys(target.parent, made, (target.name, f"{glob.escape(target.stem)}/step-*.vtu"))
    writer = VtuWriter(target.parent, name=target.stem, folder=target.stem)
    writer.started(path.discretisation)
    for step in path.steps:
        writer.converged(step)


def grid(discretisation: Discretisation, step: Step | CriticalPoint | BucklingMode) -> Any:
    """One step as a `pyvista.UnstructuredGrid`.

    Parameters
    ----------
    discretisation : Discretisation
    step : Step, CriticalPoint or BucklingMode

    Returns
    -------
    pyvista.UnstructuredGrid
        Reference positions with the outputs. On a border across which stresses jump (`Patches`) the points are there
        once for each side: first come the nodes of the mesh, then the further ones; `node` tells which they are.
    """
    import pyvista

    mesh, patches = discretisation.mesh, patches_of(discretisation.model.shell)
    varies = () if discretisation.model.field.is_uniform else IN_FIELDS_THAT_VARY
    own = WITH_OWN_FIELD if has_own(discretisation.model.field) else ()
    outputs = chosen([*discretisation.model.outputs, *varies, *own])
    cells = np.insert(patches.elements, 0, np.where(mesh.triangles, len(SLOTS), 8), axis=1)
    kept = np.ones(cells.shape, dtype=bool)
    kept[np.ix_(mesh.triangles, 1 + REPEATED)] = False
    types = np.where(mesh.triangles, VTK_QUADRATIC_TRIANGLE, VTK_QUADRATIC_QUAD).astype(np.uint8)
    result = pyvista.UnstructuredGrid(cells[kept], types, mesh.points[patches.nodes])
    reached = converged(discretisation, step)
    for output in outputs:
        data = result.cell_data if output.where == "cell" else result.point_data
        values = np.array(output.evaluate(reached))
        data.set_array(values[patches.nodes] if output.where == "point" else values, output.name)
    result.point_data.set_array(patches.nodes, "node")
    annotate(result, mesh, step, outputs)
    shell = discretisation.model.shell
    if not shell.plain:
        result.cell_data.set_array(shell.part_of, "region")
        _add_texts(result, "region_names", [name_of(part) for part in shell.parts])
    result.point_data.active_vectors_name = "displacement"
    return result


def annotate(result: Any, mesh: Mesh, step: Step | CriticalPoint | BucklingMode, outputs: Iterable[Output]) -> None:
    """Add field data: where on the path a grid is, and what its arrays are."""
    outputs = tuple(outputs)
    flux_density = step.flux_density
    result.field_data.update(
        {
            "load_factor": np.array([step.load_factor]),
            "step": np.array([step.number]),
            "stage": np.array([step.stage + 1]),
            "flux_density": flux_density[np.newaxis],
            "flux_density_magnitude": np.array([np.linalg.norm(flux_density)]),
        }
    )
    _add_texts(result, "outputs", [output.name for output in outputs])
    _add_texts(result, "units", [output.unit for output in outputs])
    _add_texts(result, "meanings", [output.sentence for output in outputs])
    _add_texts(result, "element_group_names", mesh.element_groups)


def _add_texts(grid: Any, name: str, texts: Iterable[str]) -> None:
    """Field data of texts, as the bytes of their lines: meshio reads no file with an array of texts."""
    grid.field_data[name] = np.frombuffer("\n".join(texts).encode() or b"\n", dtype=np.uint8)


def vtu(grid: Any) -> bytes:
    """The file's content, compressed; made in memory because VTK only prints what a disk refuses."""
    from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridWriter

    writer = vtkXMLUnstructuredGridWriter()
    writer.SetInputData(grid)
    writer.SetDataModeToBinary()
    writer.SetCompressorTypeToZLib()
    writer.WriteToOutputStringOn()
    writer.Write()
    return str(writer.GetOutputString()).encode()


def _pvd(written: list[tuple[float, str]]) -> bytes:
    times = [time for time, _ in written]
    if any(later <= earlier for earlier, later in pairwise(times)):
        times = [float(number) for number in range(len(times))]
    lines = [
        f'    <DataSet timestep="{time!r}" part="0" file={quoteattr(name)}/>'
        for time, (_, name) in zip(times, written, strict=True)
    ]
    return "\n".join(
        [
            '<?xml version="1.0"?>',
            '<VTKFile type="Collection" version="0.1">',
            "  <Collection>",
            *lines,
            "  </Collection>",
            "</VTKFile>",
            "",
        ]
    ).encode()
