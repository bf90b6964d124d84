"""Write the tables and examples of `docs/problem-file.md` from the schema that reads problem files, and the table of
outputs of `docs/pictures.md` from the registry.

    python docs/make_reference.py            write
    python docs/make_reference.py --check    exit with 1 if a page is not what would be written

What a key means is said here, or by the load, support or material law itself; its kind, and its default, are those of
`magshell.problem.schema`.
"""

from __future__ import annotations

import argparse
import dataclasses
import pathlib
import sys
from collections.abc import Mapping
from typing import Annotated, Any, Literal, NamedTuple, get_args, get_origin, get_type_hints

import blocks
from pydantic import StrictBool
from pydantic_core import PydanticUndefined

import magshell as ms
from magshell import keys, units
from magshell.evaluation.outputs import OUTPUTS, Output
from magshell.evaluation.series import SERIES
from magshell.magnetics import COUPLINGS
from magshell.magnetics.fields import COILS, MAGNETS, Kind
from magshell.magnetics.remanence import REMANENCES
from magshell.materials import MATERIALS, MODULI, keys_of
from magshell.model.loads import LOADS
from magshell.model.parts import MOST_LEVELS
from magshell.model.repeated import REPEATED
from magshell.model.springs import SPRINGS
from magshell.model.supports import SUPPORTS
from magshell.problem import examples, fields, schema
from magshell.problem.schema.region import Thickness
from magshell.problem.schema.remanence import Folds
from magshell.shell.elements import ELEMENTS

PAGE = pathlib.Path(__file__).parent / "problem-file.md"
RESULTS = pathlib.Path(__file__).parent / "pictures.md"
FIELDS = pathlib.Path(__file__).parent / "fields.md"
REACTIONS = pathlib.Path(__file__).parent / "reactions.md"

KINDS = {
    fields.Length: "length",
    fields.NonNegativeLength: "length ≥ 0",
    fields.Positions: "list of lengths, rising",
    fields.Remanences: "remanence, or list of them",
    fields.Angle: "angle",
    fields.Angles: "angle, or list of them",
    fields.FileName: "file name",
    fields.LengthUnit: "unit of length",
    fields.RemanenceUnit: "unit of remanence",
    fields.PositiveLength: "length > 0",
    fields.Stiffness: "stiffness > 0",
    fields.LineStiffness: "stiffness per length > 0",
    fields.AreaStiffness: "stiffness per area > 0",
    fields.AngularStiffness: "torsional stiffness > 0",
    fields.HingeStiffness: "torsional stiffness per length > 0",
    fields.PositiveMass: "mass > 0",
    fields.NonNegativeStress: "stress ≥ 0",
    fields.PositiveStress: "stress > 0",
    fields.Stress: "stress",
    fields.CouplingModulus: "stress ≥ 0, or multiple of `mu`",
    fields.LengthScale: "length ≥ 0, or multiple of `h`",
    fields.FluxDensity: "flux density",
    fields.PositiveFluxDensity: "flux density > 0",
    fields.ForceVector: "three forces, not all 0",
    fields.MomentVector: "three moments, not all 0",
    fields.StressVector: "three stresses, not all 0",
    fields.AccelerationVector: "three accelerations, not all 0",
    fields.Pressure: "stress, not 0",
    fields.PositiveDensity: "density > 0",
    fields.History: "list of numbers",
    fields.Displacements: "list of three lengths each",
    fields.Polarisation: "three remanences, not all 0",
    fields.MagneticMoment: "three magnetic moments, not all 0",
    fields.Current: "current, not 0",
    fields.Currents: "list of lists of currents",
    fields.Sides: "three lengths > 0",
    fields.PlaneSides: "two lengths > 0",
    fields.Sector: "two angles",
    fields.Places: "three or more places, each three lengths",
    fields.GradientTensor: "three rows of three gradients",
    fields.FluxDensityUnit: "unit of flux density",
    fields.ProbeName: "name",
    fields.Rotation: "list of angles",
    fields.StageStops: "list of numbers in (0, 1], rising, or a whole number",
    fields.Number: "number",
    fields.PositiveNumber: "number > 0",
    fields.Count: "whole number ≥ 1",
    fields.Name: "name",
    fields.Names: "name, or list of names",
    fields.Divisions: "two whole numbers",
    fields.AngleRange: "two angles",
    fields.Position: "three lengths",
    fields.FluxVector: "three flux densities",
    fields.Remanence: "remanence",
    fields.PositiveRemanence: "remanence > 0",
    fields.RemanenceVector: "three remanences",
    fields.Direction: "three numbers, not all 0",
    fields.Outline: "list of corners, each two lengths",
    tuple[fields.Outline, ...]: "list of lists of corners",
    fields.Corners: "four corners, each two or three lengths",
    str: "text",
    StrictBool: "true or false",
    float: "a quantity",
    tuple[float, float, float]: "three of them",
    fields.Offset: '`"middle"`, `"top"`, `"bottom"` or a length',
    fields.Levels: f"whole number from 1 to {MOST_LEVELS}",
    fields.LengthRange: "two lengths",
    fields.Coordinate: "length, or two",
    fields.Radius: "length > 0, or two",
    schema.Sphere: "table",
    schema.Round: "table",
    Thickness: "length > 0, or a table",
    schema.MaterialTable: "table, see `[material]`",
    tuple[schema.RemanenceTable, ...]: "list of tables, see `[[remanence]]`",
    tuple[schema.LayerTable, ...]: "list of tables, see below",
    tuple[fields.PositiveLength, ...]: "list of lengths > 0",
    dict[fields.Name, schema.Elements]: "table of selections",
    schema.Block: "table",
    fields.NamePair: "two names",
    fields.LengthPair: "two lengths > 0",
    fields.Degrees: "angle",
    dict[fields.Name, fields.PlaneCorner]: "table of points, each two lengths",
    dict[fields.Name, schema.Wall]: "table of walls, see below",
    Folds: "list of folds, see below",
    fields.FieldStops: "list of flux densities > 0, rising, or a whole number",
    dict[fields.Name, schema.Selection]: "table of selections",
    dict[fields.Name, schema.Block]: "table of blocks",
}

GROUPS = {
    "element_groups": "More named elements, see *Selections*.",
    "edge_groups": "More named edges, see *Selections*.",
    "node_groups": "More named nodes, see *Selections*.",
}
SHAPES = {
    "sphere": "Inside of a sphere, see below.",
    "cylinder": "Inside of an endless cylinder, see below.",
    "polygon": "Corners of a polygon in the plane $X_1$–$X_2$: in it, above or below.",
}
HISTORY = {"history": keys.HISTORY.meaning}
MOTION = {
    "name": "For messages and columns.",
    "history": "Multiplier of the strength or current at the end of each stage.",
    "displacement": "At the end of each stage, from where it is before the first.",
    "rotation_axis": "About which it turns along the path.",
    "rotation": "Angle by which it is turned at the end of each stage.",
    "rotation_centre": "A point of the axis, which moves with the displacement.",
}

TABLES: dict[str, tuple[type[schema.Table], dict[str, str]]] = {
    "rectangle": (
        schema.Rectangle,
        {
            "generator": "Which generator.",
            "length": "Extent along $X_1$.",
            "width": "Extent along $X_2$.",
            "elements": "Elements along $X_1$ and $X_2$.",
            **GROUPS,
        },
    ),
    "annulus": (
        schema.Annulus,
        {
            "generator": "Which generator.",
            "inner_radius": "Of the inner edge.",
            "outer_radius": "Of the outer edge.",
            "elements": "Elements from the inner to the outer edge, and around.",
            "angle": "First and last angle, from $+X_1$ towards $+X_2$; a span of 360° is a whole ring.",
            "slit": "Whether a whole ring is cut open at its first angle.",
            **GROUPS,
        },
    ),
    "blocks": (
        schema.Blocks,
        {
            "generator": "Which generator.",
            "elements": "Elements of every block that does not say its own.",
            "blocks": "The blocks, by name; each is an element group.",
            **GROUPS,
        },
    ),
    "block": (
        schema.Block,
        {
            "corners": "Counter-clockwise seen against the normal.",
            "elements": "Elements along the side from corner 1 to 2, and along that from corner 2 to 3.",
        },
    ),
    "cylinder": (
        schema.Cylinder,
        {
            "generator": "Which generator.",
            "radius": "Of the mid-surface.",
            "length": "From the origin along the axis.",
            "elements": "Elements around and along.",
            "angle": "First and last angle, right-handed about the axis; a span of 360° is a whole tube.",
            "axis": "Direction of the axis.",
            "zero": "Direction of angle 0.",
            **GROUPS,
        },
    ),
    "sphere-patch": (
        schema.SpherePatch,
        {
            "generator": "Which generator.",
            "radius": "Of the mid-surface.",
            "polar": "First and last polar angle, from $+X_3$.",
            "azimuth": "First and last azimuth, from $+X_1$ towards $+X_2$.",
            "elements": "Elements along the meridian and around.",
            **GROUPS,
        },
    ),
    "mesh-profile": (
        schema.Profile,
        {
            "generator": "Which generator.",
            "points": "Points of the cross-section, by name; each is an edge group.",
            "walls": "The walls between them, by name; each is an element group.",
            "length": "From the origin along the axis.",
            "elements": "Elements across each wall that does not say its own, and along the axis.",
            "axis": "Direction of the extrusion.",
            "first": "Direction of the first coordinate of the points; the second is axis × first.",
            **GROUPS,
        },
    ),
    "wall": (
        schema.Wall,
        {"between": "The points that it joins.", "elements": "Elements across it."},
    ),
    "miura": (
        schema.Miura,
        {
            "generator": "Which generator.",
            "sides": "Sides of a panel: $b$ in the zigzag lines, which run along $X_1$, and $a$ in the lines along "
            "$X_2$.",
            "sector": "Acute angle $\\gamma$ of a panel, below 90°.",
            "fold": "Angle $\\theta$ between the panels and the plane $X_1$–$X_2$: 0 is flat, 90° folded together.",
            "cells": "Cells along $X_1$ and $X_2$, of two by two panels each.",
            "elements": "Elements of each panel along these.",
            **GROUPS,
        },
    ),
    "polygon": (
        schema.Polygon,
        {
            "generator": "Which generator.",
            "corners": "Pairs $X_1$, $X_2$, in the order of a walk around it.",
            "holes": "Polygons that are cut out.",
            "size": "Side of an element.",
            **GROUPS,
        },
    ),
    "mesh-file": (
        schema.MeshFile,
        {
            "file": "A mesh, a drawing or a geometry, from the folder of the problem file.",
            "unit": "Of the lengths in the file. Files of `magshell mesh`, STEP, IGES, SVG and most DXF files say it "
            "themselves, of others it is required; for a drawing it overrides what that says.",
            "size": "Side of an element, of what gmsh meshes.",
            "mid_surface": "Whether the file holds a solid of constant thickness whose mid-surface is meant: a body, "
            "solid elements, or a closed skin as in an STL file.",
            "holes": "Layers of a drawing whose outlines are holes, whatever they lie in.",
            "gap": "Ends of a drawing's lines that are closer are joined.",
            "second_order": "Whether elements of first order get mid-side nodes, on the surface that they stand for.",
            "closed": "Whether a closed surface with sharp edges or parallel faces is meant, such as a box; else it is "
            "refused as the skin of a solid.",
            "weld": "Nodes of a mesh that are no further apart become one, as at the open seam of a tube.",
            "cuts": "Edge groups along which the surface is cut: nodes that lie on each other there stay apart, others "
            "are doubled.",
            **GROUPS,
        },
    ),
    "selection": (
        schema.Selection,
        {
            **{f"x{i}": f"Coordinate $X_{i}$, or the least and the greatest; left out, it is free." for i in (1, 2, 3)},
            **SHAPES,
            "groups": "Of which edges, or nodes, are chosen; left out: all boundary edges, all nodes.",
        },
    ),
    "elements-selection": (
        schema.Elements,
        {
            **{f"x{i}": f"Least and greatest coordinate $X_{i}$; left out, it is free." for i in (1, 2, 3)},
            **SHAPES,
            "groups": "Element groups to choose from; left out, all elements.",
        },
    ),
    "sphere": (
        schema.Sphere,
        {"centre": "Of the sphere.", "radius": "Largest distance from the centre, or the least and the largest."},
    ),
    "round": (
        schema.Round,
        {
            "through": "A point of the axis.",
            "axis": "Its direction.",
            "radius": "Largest distance from the axis, or the least and the largest.",
        },
    ),
    "shell": (
        schema.ShellTable,
        {
            "thickness": "$h$.",
            "density": "$\\rho$, mass per undeformed volume; gravity needs it.",
            "layers": "From the bottom to the top, in place of `thickness`, `[material]` and `[[remanence]]`.",
            "offset": "Where the mesh lies: in the mid-plane, at the top or the bottom face, or this far above the "
            "mid-plane.",
            "levels": "Gauss points through the thickness, of each layer; one layer needs two.",
            "element": "Quadratic in $u$, director and micro-rotation; or the paper's, with 6, 0 or 39 enhanced "
            "parameters.",
            "thickness_stretch": "Stretch that varies linearly across the thickness: an unknown $\\varphi$, none "
            "(locks in bending; not with layers), or eliminated at each point.",
            "micro_rotation": "Without it: the classical shell of seven parameters, whose `coupling_modulus` and "
            "`length_scale` are 0 (also as multiples), and whose coupling is `deformation-gradient`; no layers.",
        },
    ),
    "region": (
        schema.RegionTable,
        {
            "group": "Element groups.",
            "thickness": "$h$.",
            "material": "Its law.",
            "remanence": "Its remanence; `[]`: none.",
            "density": "$\\rho$; of layers that do not say their own.",
            "layers": "From the bottom to the top, in place of thickness, material and remanence.",
            "offset": "Where the mesh lies in it.",
            "levels": "Gauss points through the thickness of each layer.",
        },
    ),
    "layer": (
        schema.LayerTable,
        {
            "thickness": "Of the layer.",
            "material": "Its law.",
            "remanence": "Its remanence.",
            "density": "Mass per undeformed volume.",
        },
    ),
    "thickness-profile": (
        schema.ThicknessProfile,
        {
            "along": "Direction of the coordinate $s$, which is 0 at the origin.",
            "positions": "Values of $s$, rising.",
            "values": "Thickness there; linear between, constant beyond.",
        },
    ),
    "thickness-file": (
        schema.ThicknessFile,
        {
            "file": "CSV with the column `thickness` and, if its rows are places, `x1,x2,x3`; without them one row per "
            "node or per element.",
            "thickness_unit": "Unit of the thickness.",
            "length_unit": "Unit of the places.",
            "stepped": "Whether an element has the value of the place nearest to its centre; else each node has that "
            "of the place nearest to it, and between nodes it is interpolated.",
            "tolerance": "Largest distance to the place; left out: half an element's longest diagonal.",
        },
    ),
    "fold": (
        schema.FoldTable,
        {
            "through": "A point of the fold line.",
            "along": "In the flat part, normal to the line: into the piece that moves.",
            "towards": "Normal of the flat part: into which that piece moves.",
            "angle": "By which it turns.",
            "radius": "Of the bend; 0 for a sharp fold.",
        },
    ),
    "field": (
        schema.FieldTable,
        {
            "flux_density": "At multiplier 1 and angle 0; or instead",
            "magnitude": "its magnitude, and",
            "direction": "its direction.",
            **HISTORY,
            "rotation_axis": "About which the field turns.",
            "rotation": "Angle by which it is turned at the end of each stage.",
            "stops": "Magnitudes that the path must hit wherever it passes them; the end is always hit. "
            "`stops = 20`: 20, evenly spaced.",
            "coupling": "The law that couples field and shell, see the [theory page](theory.md#5-magnetic-coupling).",
            "gradient": "A constant gradient; this and the next are described on the page [Fields](fields.md).",
            "sampled": "A grid, from a file.",
            "coils": "Coils by their calibration.",
            "spline_spacing": "Interpolates the field of magnets and coils, see [Splines](fields.md#splines).",
            "self_field": "Whether [the body's own field](fields.md#the-bodys-own-field) acts on it.",
        },
    ),
    "source": (
        schema.SourceTable,
        {
            "shape": "Which magnet or coil.",
            "position": "Of its middle before the first stage.",
            "orientation_axis": "About which it is turned before the first stage.",
            "orientation": "By how much.",
            **MOTION,
        },
    ),
    "field-gradient": (
        schema.GradientTable,
        {
            "tensor": "∂B_i/∂x_j: symmetric, its diagonal adding up to 0.",
            "centre": "Where it adds nothing to the uniform part.",
            **MOTION,
        },
    ),
    "field-sampled": (
        schema.SampledTable,
        {
            "file": "CSV, `.vti`, `.vtr`, `.vtk`, `.npz` or `.npy`.",
            "flux_density_unit": 'Unit of its vectors, such as `"mT"`.',
            "length_unit": "Unit of its positions.",
            **MOTION,
        },
    ),
    "field-coils": (
        schema.CoilSystemTable,
        {
            "name": MOTION["name"],
            "calibration": "CSV without headings, a column for each coil: T/A for B1, B2, B3, and T/m/A for ∂B1/∂x1, "
            "∂B1/∂x2, ∂B1/∂x3, ∂B2/∂x2, ∂B2/∂x3; or the first three rows only.",
            "currents": "At the end of each stage, one for each coil.",
            "centre": "Of the calibration.",
        },
    ),
    "rigid": (
        schema.RigidTable,
        {
            "group": "Group of nodes, edges or elements; no node belongs to two bodies.",
            "name": "By which supports, loads and springs name it, and its columns of the history.",
            "point": "Reference point: the body's displacement is that of this point, and forces act on it.",
            "moment": "Magnetic dipole moment in the undeformed shell; it turns with the body.",
            "mass": "At the reference point; gravity acts on it.",
        },
    ),
    "hinge": (
        schema.HingeTable,
        {
            "group": "Group of edges, each shared by two or more elements.",
            "stiffness": "Of a torsion spring, per length of the edge; it resists a change of the angle.",
        },
    ),
    "stage": (
        schema.StageTable,
        {
            "name": "For messages and files.",
            "control": "What is given: the load factor, the length of the path from step to step, or the displacement "
            "of a probe.",
            "stops": "Load factors of the stage that the path must hit; 1 is always hit. `stops = 20`: 20, evenly "
            "spaced.",
            "probe": "Name of a probe,",
            "component": "the component of its displacement, and",
            "target": "the value at which the stage ends: needed under displacement control; with arc length in place "
            "of load factor 1.",
            "branch": "Start at this critical point of the path so far (from 1), along its mode.",
            "side": "Which way along the mode.",
        },
    ),
    "results": (
        schema.ResultsTable,
        {
            "local_axis": "Its projection on the undeformed surface is the first local axis of tensors and resultants, "
            "see [Strain and stress](stress.md#axes).",
            "outputs": "Names of [outputs](pictures.md#what-can-be-shown) that `steps/*.vtu` and the page hold beside "
            "the usual ones; `stress` stands for `stress_top`, `stress_middle` and `stress_bottom`.",
        },
    ),
    "solver": (
        schema.SolverTable,
        {
            "tolerance": "Largest residual of each kind of unknown over the elements' forces of that kind.",
            "max_iterations": "Linear solves after which a step is cut.",
            "target_iterations": "Linear solves per step that the step size aims at.",
            "first_step": "First increment of the load factor in a stage.",
            "smallest_step": "A step shorter than this, in displacements over the body's size, ends the solve.",
            "largest_step": "No increment of the load factor exceeds this.",
            "linear_solver": "`multifrontal`, `superlu`, or `pardiso` where the extra is installed.",
        },
    ),
    "file": (
        schema.ProblemFile,
        {
            "title": "One line, shown by `magshell examples` and at the start of a run.",
            "description": "For the reader of the file.",
            "mesh": "The mid-surface.",
            "shell": "What the surface is made into; with it, as with the next, elements that are in no region.",
            "material": "The material law and its parameters.",
            "regions": "Elements of another thickness, material, density or remanence.",
            "remanence": "The remanent flux density; elements without one have none.",
            "field": "The external field.",
            "magnets": "Magnets, see [Fields](fields.md).",
            "coils": "Coils, see [Fields](fields.md).",
            "loads": "Mechanical loads.",
            "supports": "What holds the shell.",
            "springs": "Elastic supports.",
            "rigid": "Groups that move as rigid bodies.",
            "hinges": "Edges along which sheets may turn against each other.",
            "repeated": "Motions that take the shell to its neighbours in a structure of many alike.",
            "stages": "Parts of the load path, in sequence; left out: one, or as many as the longest history has.",
            "probes": "Nodes to follow: a name and the reference position.",
            "results": "Axes of tensors, and what files hold beside the usual.",
            "solver": "How the path is followed.",
        },
    ),
}


class Described(NamedTuple):
    """A thing that describes its keys itself."""

    table: type[schema.Table]
    keys: Mapping[str, keys.Key]
    which: dict[str, str]


ENTRY = {"kind": "Which field.", "group": "Element groups it holds for; may be left out of a single entry."}
LAW = {"law": "The material law; `micropolar-` may be left out."}
DESCRIBED = {
    **{
        name.removeprefix("micropolar-"): Described(table, {**MODULI, **keys_of(MATERIALS[name])}, LAW)
        for name, table in schema.material_tables().items()
    },
    **{
        "remanence-file" if name == "file" else name: Described(table, REMANENCES[name].keys, ENTRY)
        for name, table in schema.remanence_tables().items()
    },
    **{
        name: Described(table, LOADS[name].keys, {"kind": "Which load."})
        for name, table in schema.load_tables().items()
    },
    **{
        name: Described(table, SUPPORTS[name].all_keys(), {"kind": "Which support."})
        for name, table in schema.support_tables().items()
    },
    **{
        name: Described(table, SPRINGS[name].keys, {"kind": "Which springs."})
        for name, table in schema.spring_tables().items()
    },
    **{
        name: Described(table, REPEATED[name].keys, {"kind": "Which repetition."})
        for name, table in schema.repeated_tables().items()
    },
}
TABLES |= {
    name: (one.table, {**one.which, **{key: about.meaning for key, about in one.keys.items()}})
    for name, one in DESCRIBED.items()
}

TOP = {
    "mesh": "table",
    "shell": "table",
    "material": "table",
    "field": "table",
    "solver": "table",
    "regions": "list of tables",
    "remanence": "list of tables",
    "magnets": "list of tables",
    "coils": "list of tables",
    "loads": "list of tables",
    "supports": "list of tables, at least one",
    "springs": "list of tables",
    "rigid": "list of tables",
    "hinges": "list of tables",
    "repeated": "list of tables",
    "stages": "list of tables",
    "probes": "table of positions",
}
OTHERWISE = {
    ("blocks", "elements"): "each block its own",
    ("wall", "elements"): "that of `mesh`",
    ("block", "elements"): "those of `mesh`",
    ("mesh-file", "unit"): "that which the file says",
    ("mesh-file", "size"): "about 800 elements",
    ("mesh-file", "gap"): "1e-4 of the size of the drawing",
    ("polygon", "size"): "about 800 elements",
    ("field", "flux_density"): "magnitude and direction, or another field",
    ("field", "history"): keys.HISTORY.otherwise,
    **{(name, "history"): keys.HISTORY.otherwise for name in ("source", "field-gradient", "field-sampled")},
    **{(name, key): a.otherwise for name, one in DESCRIBED.items() for key, a in one.keys.items() if a.otherwise},
    ("file", "field"): "none",
    ("file", "supports"): "**required**, unless springs hold the shell",
    **{(name, "rotation_centre"): "its middle" for name in ("source", "field-gradient", "field-sampled")},
    **{("file", key): "**required**, unless layers or regions hold all" for key in ("shell", "material")},
    ("shell", "thickness"): "**required**, unless layers or regions hold all",
    **{
        ("region", key): "that of the shell"
        for key in ("thickness", "material", "remanence", "density", "offset", "levels")
    },
    ("layer", "density"): "that of the region",
    ("rigid", "name"): "the group",
    ("rigid", "point"): "the centroid of the group's nodes",
    ("hinge", "stiffness"): "it turns freely",
    ("file", "results"): "see below",
    ("file", "solver"): "see below",
}
OF_FIELDS = ("source", "field-gradient", "field-sampled", "field-coils")
EXAMPLES = {
    "example-rectangle": "strip-10",
    "example-annulus": "slit-annulus",
    "example-blocks": "thin-cross",
    "example-cylinder": "pump",
    "example-sphere-patch": "gripper",
}


def main() -> int:
    """Write or check the pages."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; exit with 1 if a page is stale")
    check = parser.parse_args().check
    status = 0
    for page, made in pages().items():
        text = page.read_text(encoding="utf-8")
        fresh = blocks.filled(text, made, "docs/make_reference.py")
        if check and fresh != text:
            print(f"{page.name} is stale: run python docs/make_reference.py")
            status = 1
        if not check:
            page.write_text(fresh, encoding="utf-8")
    return status


def pages() -> dict[pathlib.Path, dict[str, str]]:
    """The blocks of every page."""
    made = {name: table(name) for name in TABLES if name not in OF_FIELDS}
    made |= {name: f"```toml\n{examples.text(problem)}```" for name, problem in EXAMPLES.items()}
    made["units"] = units_table()
    of_fields = {name: table(name) for name in OF_FIELDS} | {"magnets": shapes(MAGNETS), "coils": shapes(COILS)}
    return {PAGE: made, FIELDS: of_fields, RESULTS: {"outputs": outputs_table()}, REACTIONS: {"series": series_table()}}


def outputs_table() -> str:
    """What a result holds."""
    rows = ["| Name | Symbol | Unit | Of each | In files | What it is |", "|---|---|---|---|---|---|"]
    where = {"point": "node", "sheet": "node and sheet", "patch": "node and patch", "cell": "element"}
    families: dict[str, list[Output]] = {}
    for output in OUTPUTS.values():
        families.setdefault(output.name.removesuffix(f"_{output.face}"), []).append(output)
    for output, *others in families.values():
        symbols = [f"`{output.symbol}`"] if output.has_length or output.components == 1 else []
        if output.components > 1:
            numbers = range(1, output.components + 1)
            symbols += [f"`{output.of_component(output.symbol, number)}`" for number in numbers]
        names = ", ".join(f"`{one.name}`" for one in (output, *others))
        usual = [one.face for one in (output, *others) if one.usual]
        files = "yes" if usual == [""] else " and ".join(usual) or "on request"
        sentence = output.sentence.split(";")[0].rstrip(".") + "." if others else output.sentence
        columns = (names, ", ".join(symbols), output.unit or "1", where[output.where], files, sentence)
        rows.append(f"| {' | '.join(columns)} |")
    return "\n".join(rows)


def series_table() -> str:
    """What the history holds after field, probes and what only the path knows."""
    rows = ["| Series | Unit | What it is |", "|---|---|---|"]
    rows += [f"| {series.name} | {series.unit or '1'} | {series.sentence} |" for series in SERIES.values()]
    return "\n".join(rows)


def shapes(kinds: Mapping[str, Kind]) -> str:
    """Keys of magnets or coils."""
    rows = ["| Shape | Key | Value | Default | Meaning |", "|---|---|---|---|---|"]
    for shape, kind in kinds.items():
        otherwise = keys.defaults(kind.make)
        for number, (key, about) in enumerate(kind.keys.items()):
            first = f'`"{shape}"`' if number == 0 else ""
            left_out = about.otherwise or ("**required**" if key not in otherwise else written(otherwise[key]))
            rows.append(
                f"| {first} | `{key}` | {kind_of(getattr(fields, about.kind))} | {left_out} | {about.meaning} |"
            )
    return "\n".join(rows)


def table(name: str) -> str:
    """Keys of a table of the schema."""
    cls, meanings = TABLES[name]
    if set(meanings) != set(cls.model_fields):
        raise SystemExit(f"{name}: described are {sorted(meanings)}, the schema has {sorted(cls.model_fields)}")
    hints = get_type_hints(cls, include_extras=True)
    rows = ["| Key | Value | Default | Meaning |", "|---|---|---|---|"]
    for key, meaning in meanings.items():
        kind = TOP[key] if name == "file" and key in TOP else kind_of(hints[key])
        rows.append(f"| `{key}` | {kind} | {default(name, cls, key)} | {meaning} |")
    return "\n".join(rows)


def kind_of(hint: Any) -> str:
    """In words, what may stand to the right of the equals sign."""
    if hint == fields.Element:
        hint = Literal[tuple(ELEMENTS)]
    if hint == fields.Coupling:
        hint = Literal[tuple(COUPLINGS)]
    if isinstance(hint, type) and issubclass(hint, schema.Table):
        return "table"
    if get_origin(hint) is Literal:
        return " or ".join(f'`"{choice}"`' if isinstance(choice, str) else f"`{choice}`" for choice in get_args(hint))
    for known, words in KINDS.items():
        if hint == known:
            return words
    if get_origin(hint) is Annotated:
        return kind_of(get_args(hint)[0])
    parts = [part for part in get_args(hint) if part is not type(None)]
    return ", or ".join(kind_of(part) for part in parts)


def default(name: str, cls: type[schema.Table], key: str) -> str:
    """What holds where the key is left out."""
    if (name, key) in OTHERWISE:
        return OTHERWISE[name, key]
    if cls is schema.SolverTable:
        settings = {field.name: field.default for field in dataclasses.fields(ms.Settings)}
        return written(settings[key])
    value = cls.model_fields[key].default
    if value is PydanticUndefined:
        return "**required**"
    if key == "angle":
        return f'`["{value[0]:g} deg", "{value[1]:g} deg"]`'
    return "none" if value in (None, "", (), {}) else written(value)


def written(value: Any) -> str:
    """A default as it would stand in the file."""
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    if isinstance(value, str):
        return f'`"{value}"`'
    if isinstance(value, tuple):
        return f"`[{', '.join(f'{each:g}' for each in value)}]`"
    return f"`{value:g}`"


def units_table() -> str:
    """Kinds of quantity and the units they may be written in."""
    rows = ["| Quantity | Units, SI first |", "|---|---|"]
    rows += [f"| {kind.name} | {', '.join(f'`{unit}`' for unit in kind.units)} |" for kind in units.QUANTITIES]
    return "\n".join(rows)


if __name__ == "__main__":
    sys.exit(main())
