"""A problem in words: every number that was understood, the dimensionless ones that follow, and doubts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.evaluation.outputs import chosen
from magshell.magnetics.fields import UniformField
from magshell.materials import own_keys
from magshell.mesh.files import FileMesh
from magshell.mesh.quality import worst
from magshell.model import symmetry
from magshell.model.doubts.figures import Figures, Whole, figures_of
from magshell.model.doubts.loads import strength
from magshell.model.doubts.mesh_error import in_words
from magshell.model.elastic import ElasticSupport
from magshell.model.repeated import Periodic
from magshell.model.rigid import direction
from magshell.model.support import Support
from magshell.model.supports import SymmetryPlane
from magshell.model.words import offset_of, span
from magshell.problem import (
    body_report,
    fields,
    junction_report,
    load_report,
    region_report,
    remanence_report,
    schema,
    source_report,
    symmetry_report,
)
from magshell.problem.building import Problem
from magshell.problem.building.material import by_default
from magshell.problem.fields import dimension_of
from magshell.units import DENSITY, FLUX_DENSITY, LENGTH, MASS, NUMBER, STRESS, show
from magshell.wording import counted, quantity


@dataclass(frozen=True)
class Report:
    """What `magshell check` prints.

    Attributes
    ----------
    sections : dict of str to list of (str, str)
        Label and text of every line, by section.
    warnings : list of str
        Likely slips.
    notes : list of str
        Further remarks.
    """

    sections: dict[str, list[tuple[str, str]]]
    warnings: list[str]
    notes: list[str]


def describe(problem: Problem) -> Report:
    """Describe a problem that has passed all checks."""
    figures = figures_of(problem.model)
    strong = strength(problem.model, figures)
    several = region_report.has_several(problem)
    return Report(
        sections={
            "Problem": [("title", problem.title), ("file", problem.source)],
            "Mesh": list(_mesh(problem, figures.extent)),
            "Shell": list(_shell(problem, figures)),
            **({"Regions": list(region_report.lines(problem))} if several else {}),
            **({} if several else {"Material": list(_material(problem, figures.parts[0]))}),
            "Remanence": list(_remanence(problem, figures)),
            "Field": [*_field(problem, figures), *source_report.lines(problem.file), *source_report.own(problem.model)],
            **({"Loads": list(load_report.lines(problem, strong))} if problem.file.loads else {}),
            **({"Supports": list(_supports(problem, figures))} if problem.model.supports else {}),
            **({"Springs": list(_springs(problem, figures))} if problem.model.springs else {}),
            **({"Rigid bodies": list(body_report.lines(problem.model))} if problem.model.shell.rigid else {}),
            **({"Repeated": list(_repeated(problem))} if problem.model.shell.repeated else {}),
            **({"Stages": list(_stages(problem))} if len(problem.model.stages) > 1 or problem.file.stages else {}),
            "Probes": list(_probes(problem, figures.extent)),
            **({"Results": list(_results(problem))} if problem.file.results.model_fields_set else {}),
        },
        warnings=list(_doubts(problem, figures)),
        notes=[note] if (note := by_default(problem.file)) is not None else [],
    )


def problem_html(problem: Problem) -> str:
    """The model in a notebook, with the doubts about it."""
    from magshell.output.notebook import model_html

    return model_html(problem.model, problem.title, describe(problem).warnings)


def _repeated(problem: Problem) -> Iterator[tuple[str, str]]:
    mesh = problem.model.shell.mesh
    for one in problem.model.shell.repeated:
        period = ""
        if isinstance(one, Periodic):
            length = show(float(np.linalg.norm(one.period(mesh))), LENGTH)
            period = f" at {length}, jump of the displacement '{one.name}'"
        yield one.kind, f"{one.group} to {one.image}, {one.words}{period}, {counted(len(one.nodes(mesh)[0]), 'pair')}"


def _mesh(problem: Problem, extent: float) -> Iterator[tuple[str, str]]:
    mesh = problem.model.shell.mesh
    carried = problem.model.rows.carried
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
        f"{int((carried & ~problem.model.constraints.fixed).sum())}, and {int(carried.sum())} before supports",
    )
    if len(mesh.parts) > 1:
        yield "separate parts", str(len(mesh.parts))
    yield from junction_report.lines(mesh, problem.model.shell.hinges)
    if (joined := problem.model.rows.joined).size:
        yield "joint nodes", f"{len(joined)}, where one rotation carries the directors of all sheets"
    for axis in range(3):
        span = [_coordinate(each[axis], extent) for each in (least, greatest)]
        yield f"X{axis + 1}", " to ".join(span)
    yield "worst corner", _worst(quality["scaled_jacobian"], "scaled Jacobian, 1 is best")
    yield "worst aspect ratio", _worst(quality["aspect_ratio"], "longest over shortest side")
    yield "expected error", in_words(problem.model.expected_error)
    yield "groups", ", ".join(mesh.groups) or "none"


def _worst(measure: tuple[int, float], meaning: str) -> str:
    return f"{measure[1]:.3g} ({meaning}) in element {measure[0]}"


def _shell(problem: Problem, figures: Whole) -> Iterator[tuple[str, str]]:
    shell = problem.model.shell
    least, greatest = figures.thinnest, figures.thickest
    uniform = greatest - least <= 1e-9 * greatest
    offset = offset_of(shell.parts[0]) if len(shell.parts) == 1 else ""
    yield "thickness h", span(np.array([least, greatest])) + offset
    densities = {layer.density for part in shell.parts for layer in part.layers}
    if len(densities) == 1 and (density := densities.copy().pop()) is not None:
        yield "density rho", show(density, DENSITY)
    if None not in densities:
        mass = problem.model.mass
        centroid = ", ".join(_coordinate(x, figures.extent) for x in mass.centroid)
        yield "mass", f"{show(mass.total, MASS)}, centroid at ({centroid})"
    thin = "" if uniform else " where it is thinnest"
    slenderness = figures.extent / least
    yield "L/h", f"{slenderness:.4g}{thin} with the largest extent L = {show(figures.extent, LENGTH)}"
    curved = [part for part in figures.parts if math.isfinite(part.radius)]
    if curved:
        worst = min(curved, key=lambda part: part.radius / part.thickest)
        radius = f"with the least radius of curvature R = {show(worst.radius, LENGTH)}"
        yield "R/h", f"{worst.radius / worst.thickest:.4g} {radius}"


def _material(problem: Problem, figures: Figures) -> Iterator[tuple[str, str]]:
    material = problem.model.shell.parts[0].layers[0].material
    yield "law", region_report.law_of(material) if problem.file.material is None else problem.file.material.law
    yield "shear modulus mu", show(material.shear_modulus, STRESS)
    yield "Lamé constant lambda", show(material.lame_lambda, STRESS)
    for key, described in own_keys(type(material)).items():
        dimension, value = dimension_of(getattr(fields, described.kind)), getattr(material, key)
        yield key.replace("_", " "), f"{value:g}" if dimension is NUMBER else show(value, dimension)
    yield "E, nu", f"{show(figures.youngs_modulus, STRESS)}, {figures.poissons_ratio:.4g}"
    ratio = material.coupling_modulus / material.shear_modulus
    yield "coupling modulus eta", f"{show(material.coupling_modulus, STRESS)} = {ratio:.4g} mu"
    ratio = material.length_scale / figures.thinnest
    yield "length scale l", f"{show(material.length_scale, LENGTH)} = {ratio:.4g} h"


def _remanence(problem: Problem, figures: Whole) -> Iterator[tuple[str, str]]:
    mesh, magnitude = problem.model.shell.mesh, figures.remanence
    shared = region_report.shared(problem)
    for entry in problem.file.remanence:
        for group in entry.group or ():
            members = np.intersect1d(mesh.elements_of(group), shared)
            yield group, f"{_span(magnitude, members)}, {remanence_report.sense(entry)}"
        if entry.group is None:
            where = "everywhere" if len(shared) == len(magnitude) else "elsewhere"
            yield where, f"{_span(magnitude, shared)}, {remanence_report.sense(entry)}"
    yield from region_report.remanences(problem)
    bare = int((magnitude == 0.0).sum())
    if bare:
        yield "none in", f"{bare} of {len(magnitude)} elements"


def _span(magnitude: FloatArray, elements: IntArray) -> str:
    if not elements.size:
        return "no element"
    least, greatest = magnitude[elements].min(), magnitude[elements].max()
    if greatest - least <= 1e-9 * greatest:
        return show(greatest, FLUX_DENSITY)
    return f"{show(least, FLUX_DENSITY)} to {show(greatest, FLUX_DENSITY)}"


def _field(problem: Problem, figures: Whole) -> Iterator[tuple[str, str]]:
    table = problem.file.field
    if figures.field == 0.0:
        yield "flux density B", "none"
        if problem.model.fields_act:
            yield "coupling law", table.coupling
        return
    if any(table.vector):
        yield "flux density B", quantity(table.vector, FLUX_DENSITY)
    if problem.model.field.is_uniform:
        yield "|B|", show(figures.field, FLUX_DENSITY)
    else:
        yield from source_report.at_shell(problem.model)
    yield "coupling law", table.coupling
    field = problem.model.field
    stops = np.asarray(field.stops, dtype=float).tolist() if isinstance(field, UniformField) else []
    if isinstance(table.stops, int) and stops:
        yield "stops", f"{counted(len(stops), 'stop')}, {show(stops[0], FLUX_DENSITY)} apart"
    elif stops:
        yield "stops", ", ".join(show(stop, FLUX_DENSITY) for stop in stops)
    yield "10³ |B| |Brem| / (mu mu0)", f"{figures.magnetic_load:.4g}"
    yield "12 |B| |Brem| / (mu0 E) (L/h)²", f"{figures.bending_load:.4g}"


def _supports(problem: Problem, figures: Whole) -> Iterator[tuple[str, str]]:
    planes = iter(symmetry.planes(problem.model))
    for support in problem.model.supports:
        nodes = counted(len(problem.model.shell.nodes_of(support.group)), "node")
        mirrored = isinstance(support, SymmetryPlane)
        half = symmetry_report.other_half(problem, next(planes)) if mirrored else ""
        yield support.group, f"{support.words}, {nodes}{_reaction(support, figures.extent)}{half}"
    for turn in problem.model.turns:
        axes = " and ".join(direction(axis) for axis in turn.axes)
        yield "held by the field", f"rotation about {axes}; the path begins where the body has turned into the field"


def _springs(problem: Problem, figures: Whole) -> Iterator[tuple[str, str]]:
    for spring in problem.model.springs:
        yield spring.group, f"{spring.words(problem.model.shell)}{_reaction(spring, figures.extent)}"


def _reaction(support: Support | ElasticSupport, extent: float) -> str:
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
        if problem.model.field_magnitude:
            field = ", ".join(show(component, FLUX_DENSITY) for component in end.flux_density)
            parts.append(f"field ({field})" if problem.model.field.is_uniform else f"field at the centre ({field})")
            if not problem.model.field.is_uniform and (driven := source_report.driven(problem.model, number)):
                parts.append(driven)
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


def _results(problem: Problem) -> Iterator[tuple[str, str]]:
    table = problem.file.results
    yield "local axis", f"({', '.join(f'{number:g}' for number in table.local_axis)}), projected on the surface"
    more = [output.name for output in chosen(table.outputs) if not output.usual or output.name in table.outputs]
    yield "outputs beside the usual", ", ".join(more) or "none"


def _coordinate(value: float, extent: float) -> str:
    """A coordinate, without the round-off of one that is meant to be 0."""
    return show(value if abs(value) > 1e-9 * extent else 0.0, LENGTH)


def _doubts(problem: Problem, figures: Whole) -> Iterator[str]:
    """Likely slips of the model, and those that only its file shows."""
    yield from problem.model.doubts()
    yield from _other_thickness(problem, figures)
    yield from region_report.doubts(problem)
    yield from symmetry_report.doubts(problem)


def _other_thickness(problem: Problem, figures: Whole) -> Iterator[str]:
    """A warning if the solid that the mesh was made of is not as thick as the shell."""
    mesh = problem.model.shell.mesh
    if not isinstance(mesh, FileMesh) or mesh.origin.thickness is None:
        return
    solid = mesh.origin.thickness
    if max(figures.thickest - solid, solid - figures.thinnest) > 0.01 * solid:
        yield (
            f"the solid in {mesh.origin.file} is {show(solid, LENGTH)} thick, the shell "
            f"{show(figures.thinnest, LENGTH)}: check shell.thickness"
        )
