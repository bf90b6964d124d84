"""A problem in words: every number that was understood, the dimensionless ones that follow, and doubts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.materials import own_keys
from magshell.mesh import Mesh
from magshell.mesh.files import FileMesh
from magshell.mesh.geometry import centres, unit
from magshell.mesh.quality import worst
from magshell.model import symmetry
from magshell.model.supports import Support, SymmetryPlane
from magshell.problem import fields, load_report, remanence_report, schema, symmetry_report, triangle_report
from magshell.problem.building import Problem
from magshell.problem.fields import dimension_of
from magshell.problem.load_report import Strength
from magshell.shell.unknowns import width
from magshell.units import DENSITY, FLUX_DENSITY, LENGTH, MASS, NUMBER, STRESS, show
from magshell.wording import counted, quantity

VACUUM_PERMEABILITY = 4e-7 * math.pi


@dataclass(frozen=True)
class Report:
    """What `magshell check` tells.

    Attributes
    ----------
    sections : dict of str to list of (str, str)
        Label and text of every line, by section.
    warnings : list of str
        What smells of a slip.
    """

    sections: dict[str, list[tuple[str, str]]]
    warnings: list[str]


@dataclass(frozen=True)
class _Figures:
    """The magnitudes that the report and its doubts are about, SI."""

    extent: float
    thickness: float
    radius: float
    shear_modulus: float
    youngs_modulus: float
    poissons_ratio: float
    field: float
    remanence: FloatArray
    couple: float

    @property
    def strongest(self) -> float:
        return float(self.remanence.max())

    @property
    def slenderness(self) -> float:
        return self.extent / self.thickness

    @property
    def magnetic_load(self) -> float:
        """10³ |B| |Brem| / (mu mu0), the abscissa of the source's figures."""
        return 1e3 * self.field * self.strongest / (self.shear_modulus * VACUUM_PERMEABILITY)

    @property
    def bending_load(self) -> float:
        """12 |Brem| |B| / (mu0 E) (L/h)²: an elastic line of this length bends visibly from about 0.1."""
        stress = self.field * self.strongest / VACUUM_PERMEABILITY
        return 12.0 * stress / self.youngs_modulus * self.slenderness**2


def describe(problem: Problem) -> Report:
    """Describe a problem that has passed all checks."""
    figures = _figures(problem)
    strong = load_report.strength(problem, figures.extent, figures.youngs_modulus)
    return Report(
        sections={
            "Problem": [("title", problem.title), ("file", problem.source)],
            "Mesh": list(_mesh(problem, figures.extent)),
            "Shell": list(_shell(problem, figures)),
            "Material": list(_material(problem, figures)),
            "Remanence": list(_remanence(problem, figures)),
            "Field": list(_field(problem, figures)),
            **({"Loads": list(load_report.lines(problem, strong))} if problem.file.loads else {}),
            "Supports": list(_supports(problem, figures)),
            **({"Stages": list(_stages(problem))} if len(problem.model.stages) > 1 or problem.file.stages else {}),
            "Probes": list(_probes(problem, figures.extent)),
        },
        warnings=list(_doubts(problem, figures, strong)),
    )


def problem_html(problem: Problem) -> str:
    """The model in a notebook, with the doubts about it."""
    from magshell.output.notebook import model_html

    return model_html(problem.model, problem.title, describe(problem).warnings)


def _figures(problem: Problem) -> _Figures:
    shell, flux = problem.model.shell, np.array(problem.file.field.flux_density)
    mesh, material = shell.mesh, shell.material
    mu, lam = material.shear_modulus, material.lame_lambda
    vectors = shell.remanence(mesh, centres(mesh.points, mesh.elements)[:, None])[:, 0]
    return _Figures(
        extent=float(np.ptp(mesh.points, axis=0).max()),
        thickness=shell.thickness,
        radius=_smallest_radius(mesh),
        shear_modulus=mu,
        youngs_modulus=mu * (3.0 * lam + 2.0 * mu) / (lam + mu),
        poissons_ratio=0.5 * lam / (lam + mu),
        field=float(np.linalg.norm(flux)),
        remanence=np.linalg.norm(vectors, axis=1),
        couple=float(np.linalg.norm(np.cross(vectors, flux), axis=1).max()),
    )


def _smallest_radius(mesh: Mesh) -> float:
    """Least radius of curvature out of the surface, from the rise of the mid-side nodes; inf where flat."""
    x = mesh.points[mesh.elements]
    start, end, middle = x[:, :4], np.roll(x[:, :4], -1, axis=1), x[:, 4:]
    inward = 4.0 * centres(mesh.points, mesh.elements)[:, None] - 3.0 * middle - np.roll(middle, 2, axis=1)
    normal = unit(np.cross(end - start, inward))
    rise = np.abs(((middle - 0.5 * (start + end)) * normal).sum(axis=2))
    chord = np.linalg.norm(end - start, axis=2)
    curved = rise > 1e-9 * chord
    if not curved.any():
        return math.inf
    return float((0.125 * chord[curved] ** 2 / rise[curved] + 0.5 * rise[curved]).min())


def _mesh(problem: Problem, extent: float) -> Iterator[tuple[str, str]]:
    mesh = problem.model.shell.mesh
    carriers = problem.model.shell.carriers
    unknowns = sum(width(field) * int(nodes.sum()) for field, nodes in carriers.items())
    least, greatest = mesh.points.min(axis=0), mesh.points.max(axis=0)
    quality = worst(mesh)
    if isinstance(mesh, FileMesh):
        yield "file", f"{mesh.origin.file}, lengths in {mesh.origin.unit}"
        yield from (("changed", change) for change in mesh.origin.changes)
    elif not isinstance(problem.file.mesh, schema.MeshFile):
        yield "generator", problem.file.mesh.generator
    shapes = f" ({mesh.counts})" if mesh.triangles.any() else ""
    yield "elements, nodes", f"{len(mesh.elements)}{shapes}, {len(mesh.points)}"
    yield (
        "unknowns",
        f"{unknowns - int(problem.model.constraints.fixed.sum())}, and {unknowns} before supports",
    )
    if len(mesh.parts) > 1:
        yield "separate parts", str(len(mesh.parts))
    for axis in range(3):
        span = [_coordinate(each[axis], extent) for each in (least, greatest)]
        yield f"X{axis + 1}", " to ".join(span)
    yield "worst corner", _worst(quality["scaled_jacobian"], "scaled Jacobian, 1 is best")
    yield "worst aspect ratio", _worst(quality["aspect_ratio"], "longest over shortest side")
    yield "groups", ", ".join(mesh.groups) or "none"


def _worst(measure: tuple[int, float], meaning: str) -> str:
    return f"{measure[1]:.3g} ({meaning}) in element {measure[0]}"


def _shell(problem: Problem, figures: _Figures) -> Iterator[tuple[str, str]]:
    yield "thickness h", show(figures.thickness, LENGTH)
    if problem.model.shell.density is not None:
        yield "density rho", show(problem.model.shell.density, DENSITY)
        mass = problem.model.mass
        centroid = ", ".join(_coordinate(x, figures.extent) for x in mass.centroid)
        yield "mass", f"{show(mass.total, MASS)}, centroid at ({centroid})"
    yield "L/h", f"{figures.slenderness:.4g} with the largest extent L = {show(figures.extent, LENGTH)}"
    if math.isfinite(figures.radius):
        least = f"with the least radius of curvature R = {show(figures.radius, LENGTH)}"
        yield "R/h", f"{figures.radius / figures.thickness:.4g} {least}"


def _material(problem: Problem, figures: _Figures) -> Iterator[tuple[str, str]]:
    material = problem.model.shell.material
    yield "law", problem.file.material.law
    yield "shear modulus mu", show(material.shear_modulus, STRESS)
    yield "Lamé constant lambda", show(material.lame_lambda, STRESS)
    for key, described in own_keys(type(material)).items():
        dimension, value = dimension_of(getattr(fields, described.kind)), getattr(material, key)
        yield key.replace("_", " "), f"{value:g}" if dimension is NUMBER else show(value, dimension)
    yield "E, nu", f"{show(figures.youngs_modulus, STRESS)}, {figures.poissons_ratio:.4g}"
    ratio = material.coupling_modulus / material.shear_modulus
    yield "coupling modulus eta", f"{show(material.coupling_modulus, STRESS)} = {ratio:.4g} mu"
    ratio = material.length_scale / figures.thickness
    yield "length scale l", f"{show(material.length_scale, LENGTH)} = {ratio:.4g} h"


def _remanence(problem: Problem, figures: _Figures) -> Iterator[tuple[str, str]]:
    mesh, magnitude = problem.model.shell.mesh, figures.remanence
    for entry in problem.file.remanence:
        for group in entry.group or ():
            yield group, f"{_span(magnitude, mesh.elements_of(group))}, {remanence_report.sense(entry)}"
        if entry.group is None:
            yield "everywhere", f"{_span(magnitude, np.arange(len(magnitude)))}, {remanence_report.sense(entry)}"
    bare = int((magnitude == 0.0).sum())
    if bare:
        yield "none in", f"{bare} of {len(magnitude)} elements"


def _span(magnitude: FloatArray, elements: IntArray) -> str:
    least, greatest = magnitude[elements].min(), magnitude[elements].max()
    if greatest - least <= 1e-9 * greatest:
        return show(greatest, FLUX_DENSITY)
    return f"{show(least, FLUX_DENSITY)} to {show(greatest, FLUX_DENSITY)}"


def _field(problem: Problem, figures: _Figures) -> Iterator[tuple[str, str]]:
    table = problem.file.field
    if figures.field == 0.0:
        yield "flux density B", "none"
        return
    yield "flux density B", quantity(table.flux_density, FLUX_DENSITY)
    yield "|B|", show(figures.field, FLUX_DENSITY)
    yield "coupling law", table.coupling
    if table.stops:
        yield "stops", ", ".join(show(stop, FLUX_DENSITY) for stop in table.stops)
    yield "10³ |B| |Brem| / (mu mu0)", f"{figures.magnetic_load:.4g}"
    yield "12 |B| |Brem| / (mu0 E) (L/h)²", f"{figures.bending_load:.4g}"


def _supports(problem: Problem, figures: _Figures) -> Iterator[tuple[str, str]]:
    planes = iter(symmetry.planes(problem.model))
    for support in problem.model.supports:
        nodes = counted(len(problem.model.shell.mesh.nodes_of(support.group)), "node")
        mirrored = isinstance(support, SymmetryPlane)
        half = symmetry_report.other_half(problem, next(planes)) if mirrored else ""
        yield support.group, f"{support.words}, {nodes}{_reaction(support, figures.extent)}{half}"


def _reaction(support: Support, extent: float) -> str:
    """Name and point of a support's reaction, where they are given."""
    text = "" if support.name is None else f", reaction '{support.name}'"
    if support.point is None:
        return text
    point = ", ".join(_coordinate(x, extent) for x in np.asarray(support.point, dtype=float))
    return f"{text or ', reaction'} about ({point})"


def _stages(problem: Problem) -> Iterator[tuple[str, str]]:
    for number, stage in enumerate(problem.model.stages):
        end = problem.model.course(number).at(1.0)
        parts = [f"{stage.control} control"]
        if problem.model.field.magnitude:
            field = ", ".join(show(component, FLUX_DENSITY) for component in end.flux_density)
            parts.append(f"field ({field})")
        for load, multiplier in zip(problem.model.loads, end.loads, strict=True):
            parts.append(f"{load.kind} × {multiplier:.4g}")
        if stage.target is not None:
            parts.append(f"until u{stage.component} of {stage.probe} is {show(stage.target, LENGTH)}")
        if stage.branch is not None:
            parts.append(f"from critical point {stage.branch}, side {stage.side:+d}")
        yield f"{number + 1} {stage.name}".strip(), ", ".join(parts)


def _probes(problem: Problem, extent: float) -> Iterator[tuple[str, str]]:
    points = problem.model.shell.mesh.points
    for name, node in problem.model.probe_nodes.items():
        yield name, f"node {node} at ({', '.join(_coordinate(x, extent) for x in points[node])})"


def _coordinate(value: float, extent: float) -> str:
    """A coordinate, without the round-off of one that is meant to be 0."""
    return show(value if abs(value) > 1e-9 * extent else 0.0, LENGTH)


def _doubts(problem: Problem, figures: _Figures, strong: Strength) -> Iterator[str]:
    """Magnitudes that no experiment has, most often a slip of units."""
    modulus = show(figures.shear_modulus, STRESS)
    if figures.slenderness < 5.0:
        yield f"L/h is {figures.slenderness:.3g}: too thick for a shell; check shell.thickness and the mesh"
    if figures.slenderness > 1e4:
        yield f"L/h is {figures.slenderness:.3g}: thinner than any film; check shell.thickness and the mesh"
    if figures.radius < 2.0 * figures.thickness:
        yield f"R/h is {figures.radius / figures.thickness:.3g}: curved too tightly for its thickness"
    if figures.field > 5.0:
        field = show(figures.field, FLUX_DENSITY)
        yield f"the field is {field}: beyond most laboratories; check field.flux_density"
    if figures.strongest > 1.5:
        yield f"the remanence is {show(figures.strongest, FLUX_DENSITY)}: more than any magnet keeps"
    if figures.shear_modulus < 1e3:
        yield f"the shear modulus is {modulus}: softer than a gel; check material.shear_modulus"
    if figures.shear_modulus > 1e10:
        yield f"the shear modulus is {modulus}: stiffer than magnesium; check material.shear_modulus"
    if figures.poissons_ratio > 0.4999:
        yield f"Poisson's ratio is {figures.poissons_ratio:.6g}: nearly incompressible, slow to converge"
    if figures.field and not figures.strongest:
        yield "there is a field but no remanence: the field does nothing"
    elif figures.field and figures.couple < 1e-9 * figures.field * figures.strongest:
        yield "the field is parallel to the remanence everywhere: the undeformed shape feels no couple"
    elif figures.field and figures.bending_load < 1e-3:
        yield f"the bending load is {figures.bending_load:.2g}: the shell will hardly move; check the units"
    elif figures.bending_load > 1e5:
        yield f"the bending load is {figures.bending_load:.2g}: far beyond any experiment; check the units"
    yield from remanence_report.doubts(problem)
    yield from load_report.doubts(problem, strong)
    yield from symmetry_report.doubts(problem)
    if problem.model.constraints.fixed[:, :3].all():
        yield "the supports hold every node: the displacement is given everywhere, nothing is left to move"
    yield from triangle_report.doubts(problem.model.shell.mesh, figures.thickness, figures.radius)
    worst_corner = worst(problem.model.shell.mesh)["scaled_jacobian"]
    if worst_corner.value < 0.2:
        yield f"element {worst_corner.element} is badly shaped (scaled Jacobian {worst_corner.value:.2g})"
    if not problem.file.probes:
        yield "there are no probes: the history will hold the load only"
