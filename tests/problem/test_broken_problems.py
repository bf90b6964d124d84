"""Every way to get a problem file wrong that we could think of, and what the user is told.

Each entry changes one thing in a problem that works. The command must end with status 2, say it in one line
that names file and key, show no traceback and leave no results behind.
"""

# ruff: noqa: E501 (a table reads best with one entry a line)

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest
from problem_files import BLOCKS, LOADED, MIURA, PROFILE, PUMP, STRIP, changed

from magshell.cli import main
from problem.loaded import EVERY_LOAD

CLAMP = '[[supports]]\nkind = "clamp"\ngroup = "left"\n'
REMANENCE = '[[remanence]]\nkind = "constant"\nvector = ["143 mT", 0, 0]\n'


class Broken(NamedTuple):
    """One change to a problem that works, where it must be reported, and words of the report."""

    name: str
    old: str
    new: str
    where: str
    words: tuple[str, ...]
    base: str = STRIP


BROKEN = [
    # keys
    Broken("misspelt key", "thickness", "thicknes", "shell.thicknes", ("unknown key", "'thickness'")),
    Broken("misspelt table", "[shell]", "[shel]", "shel", ("unknown key", "'shell'")),
    Broken("missing table", '[shell]\nthickness = "1 mm"', "", "shell", ("missing",)),
    Broken("missing key", 'width = "5 mm"', "", "mesh.width", ("missing",)),
    Broken("key of another generator", 'width = "5 mm"', 'width = "5 mm"\nradius = "5 mm"', "mesh.radius", ("unknown key",)),
    Broken("unknown key in a list", 'group = "left"', 'group = "left"\nside = 1', "supports[0].side", ("unknown key", "group")),
    # kinds
    Broken("unknown generator", '"rectangle"', '"rectangel"', "mesh.generator", ("'rectangel'", "'rectangle'")),
    Broken("no generator", 'generator = "rectangle"', "", "mesh.generator", ("missing", "sphere-patch")),
    Broken("generator of another type", '"rectangle"', "3", "mesh.generator", ("'3'", "rectangle")),
    Broken("unknown law", '"micropolar-neo-hookean"', '"neo-hook"', "material.law", ("'neo-hookean'", "micropolar-neo-hookean")),
    Broken("unknown support", '"clamp"', '"clamped"', "supports[0].kind", ("'clamped'", "'clamp'")),
    Broken("unknown remanence", '"constant"', '"spiral"', "remanence[0].kind", ("'spiral'", "meridional")),
    Broken("unknown coupling", "stops", 'coupling = "cuople"\nstops', "field.coupling", ("'cuople'", "'couple'")),
    # units
    Broken("wrong unit", '"1 mm"\n\n[mat', '"0.9 kPa"\n\n[mat', "shell.thickness", ("0.9 kPa", "stress", "length", "mm")),
    Broken("missing unit", '"303 kPa"', "303", "material.shear_modulus", ("303", "no unit", "kPa")),
    Broken("missing unit in a list", '"143 mT"', "143", "remanence[0].vector[0]", ("no unit", "mT")),
    Broken("misspelt unit", '"303 kPa"', '"303 Kpa"', "material.shear_modulus", ("'Kpa'", "'kPa'")),
    Broken("no number", '"303 kPa"', '"soft"', "material.shear_modulus", ("'soft'", "number")),
    Broken("stop in mm", '"1 mT", "2 mT"', '"1 mm", "2 mT"', "field.stops[0]", ("length", "flux density")),
    Broken("no stops at all", 'stops = ["1 mT", "2 mT"]', "stops = 0", "field.stops", ("'0' is not a whole number from 1",)),
    Broken("number of stops in mT", 'stops = ["1 mT", "2 mT"]', 'stops = "2 mT"', "field.stops", ("'2 mT' is not a whole number from 1",)),
    # the field
    Broken("field without direction", 'flux_density = [0, 0, "2 mT"]', 'magnitude = "2 mT"', "field.direction", ("is missing beside magnitude",)),
    Broken("field twice", "stops", 'magnitude = "2 mT"\ndirection = [0, 0, 1]\nstops', "field.flux_density", ("beside magnitude",)),
    Broken("field of nothing", 'flux_density = [0, 0, "2 mT"]\nstops = ["1 mT", "2 mT"]', 'coupling = "couple"', "field.flux_density", ("is missing; give it, or magnitude and direction",)),
    Broken("stop beyond the magnitude", 'flux_density = [0, 0, "2 mT"]', 'magnitude = "1.5 mT"\ndirection = [0, 1, 1]', "field.stops[1]", ("beyond",)),
    # values
    Broken("negative thickness", '"1 mm"\n\n[mat', '"-1 mm"\n\n[mat', "shell.thickness", ("-1 mm", "not positive")),
    Broken("zero thickness", '"1 mm"\n\n[mat', "0\n\n[mat", "shell.thickness", ("not positive",)),
    Broken("NaN", '"303 kPa"', "nan", "material.shear_modulus", ("nan", "not a finite number")),
    Broken("NaN with unit", '"2 mT"]\nst', '"nan mT"]\nst', "field.flux_density[2]", ("not a finite number",)),
    Broken("infinite", '"20 mm"\nw', '"inf mm"\nw', "mesh.length", ("not a finite number",)),
    Broken("infinite TOML number", '"20 mm"\nw', "inf\nw", "mesh.length", ("not a finite number",)),
    Broken("overflow", '"20 mm"\nw', '"1e999 mm"\nw', "mesh.length", ("not a finite number",)),
    Broken("beyond sense", '"20 mm"\nw', '"1e30 mm"\nw', "mesh.length", ("beyond any length",)),
    Broken("one modulus", 'lame_lambda = "7300 kPa"\n', "", "material", ("shear_modulus is given alone", "youngs_modulus, poissons_ratio or bulk_modulus")),
    Broken("no modulus", 'shear_modulus = "303 kPa"\nlame_lambda = "7300 kPa"\n', "", "material", ("shear_modulus is missing", "youngs_modulus and poissons_ratio")),
    Broken("three moduli", 'lame_lambda = "7300 kPa"\n', 'lame_lambda = "7300 kPa"\nbulk_modulus = "7502 kPa"\n', "material", ("shear_modulus, lame_lambda and bulk_modulus are given", "leave out the rest")),
    Broken("incompressible", 'lame_lambda = "7300 kPa"\n', "poissons_ratio = 0.5\n", "material", ("poissons_ratio is 0.5", "below 0.5")),
    Broken("moduli apart", 'lame_lambda = "7300 kPa"\n', 'youngs_modulus = "1 MPa"\n', "material", ("shear_modulus = 303000 and youngs_modulus = 1e+06 do not go together", "at least 606000 and below 909000")),
    Broken("multiple of another modulus", '"0.1 mu"', '"0.1 lambda"', "material.coupling_modulus", ("'0.1 lambda'", "multiple of the shear modulus", '"1 mu"')),
    Broken("negative length scale", '"0.1 h"', '"-1 mm"', "material.length_scale", ("negative", '"1 h"')),
    Broken("field in kA/m", '[0, 0, "2 mT"]', '[0, 0, "2 kA/m"]', "field.flux_density[2]", ("'2 kA/m'", "field strength", "mT")),
    Broken("remanence in Oe", '"143 mT"', '"1430 Oe"', "remanence[0].vector[0]", ("oersted", "unit of the field strength H", "kA/m or emu/cm^3")),
    Broken("negative modulus", '"7300 kPa"', '"-300 kPa"', "material.lame_lambda", ("negative",)),
    Broken("share above one", 'law = "micropolar-neo-hookean"', 'law = "micropolar-mooney-rivlin"\nsecond_invariant_share = 1.5', "material", ("second_invariant_share",)),
    Broken("boolean for a length", '"20 mm"\nw', "true\nw", "mesh.length", ("True", "length")),
    Broken("text for a table", '[shell]\nthickness = "1 mm"', "", "shell", ("table",), "shell = 3\n" + STRIP),
    Broken("table for a list", "[[supports]]", "[supports]", "supports", ("[[supports]]",)),
    Broken("zero elements", "[4, 1]", "[0, 1]", "mesh.elements[0]", ("0", "whole number")),
    Broken("fractional elements", "[4, 1]", "[4.5, 1]", "mesh.elements[0]", ("4.5", "whole number")),
    Broken("elements as text", "[4, 1]", '["4", 1]', "mesh.elements[0]", ("'4'", "whole number")),
    Broken("too many elements", "[4, 1]", "[9000, 9000]", "mesh", ("81000000 elements",)),
    Broken("one number of elements", "[4, 1]", "[4]", "mesh.elements", ("1 entries", "expected 2")),
    Broken("elements not a list", "[4, 1]", "4", "mesh.elements", ("not a list",)),
    Broken("vector of four", '["143 mT", 0, 0]', '["143 mT", 0, 0, 0]', "remanence[0].vector", ("4 entries", "expected 3")),
    Broken("position of two", '["20 mm", 0, 0]', '["20 mm", 0]', "probes.tip", ("2 entries", "expected 3")),
    Broken("title as a number", "[mesh]", "title = 3\n[mesh]", "title", ("not text",)),
    Broken("probe name with a comma", "tip =", '"ti,p" =', "probes.ti,p", ("name",)),
    # load
    Broken("nothing loads", '"2 mT"]\nstops = ["1 mT", "2 mT"]', "0]", "field", ("flux_density", "zero", "nothing loads")),
    Broken("stop beyond the field", '"1 mT", "2 mT"', '"1 mT", "3 mT"', "field.stops[1]", ("beyond the largest field",)),
    Broken("stops unordered", '"1 mT", "2 mT"', '"2 mT", "1 mT"', "field.stops[1]", ("rise",)),
    Broken("stop at zero", '"1 mT", "2 mT"', '0, "2 mT"', "field.stops[0]", ("not positive",)),
    Broken("remanence twice", 'vector = ["143 mT", 0, 0]', 'vector = ["143 mT", 0, 0]\nmagnitude = "1 mT"', "remanence[0].vector", ("one or the other",)),
    Broken("magnitude without direction", 'vector = ["143 mT", 0, 0]', 'magnitude = "1 mT"', "remanence[0].direction", ("missing",)),
    Broken("zero direction", 'vector = ["143 mT", 0, 0]', 'magnitude = "1 mT"\ndirection = [0, 0, 0]', "remanence[0].direction", ("zero vector",)),
    Broken("remanence of no group", REMANENCE, REMANENCE + 'group = "arm"\n', "remanence[0].group", ("'arm'",)),
    Broken("remanence on an edge", REMANENCE, REMANENCE + 'group = "left"\n', "remanence[0].group", ("group of edges",)),
    Broken("empty list of groups", REMANENCE, REMANENCE + "group = []\n", "remanence[0].group", ("empty list",)),
    Broken("two remanences, one without group", REMANENCE, REMANENCE + 'group = "one"\n' + REMANENCE, "remanence[1].group", ("missing", "one, two"), BLOCKS),
    Broken("two remanences in one element", REMANENCE, (REMANENCE + 'group = "one"\n') * 2, "remanence[1].group", ("already", "'one'"), BLOCKS),
    Broken("unknown load", '"force"', '"forse"', "loads[0].kind", ("'forse'", "'force'"), LOADED),
    Broken("no kind of load", 'kind = "force"', "", "loads[0].kind", ("missing", "moment"), LOADED),
    Broken("load on no group", '"far"\ntotal', '"fra"\ntotal', "loads[0].group", ("'fra'", "'far'"), LOADED),
    Broken("load without total", 'total = [0, 0, "2 mN"]', "", "loads[0].total", ("missing",), LOADED),
    Broken("load of zero", '"2 mN"', "0", "loads[0].total", ("zero",), LOADED),
    Broken("load of two components", '[0, 0, "2 mN"]', '[0, "2 mN"]', "loads[0].total", ("2 entries", "expected 3"), LOADED),
    Broken("load not finite", '"2 mN"', '"inf mN"', "loads[0].total[2]", ("not a finite number",), LOADED),
    Broken("load without unit", '"2 mN"', "2", "loads[0].total[2]", ("no unit", "N"), LOADED),
    Broken("force in N m", '"2 mN"', '"2 N m"', "loads[0].total[2]", ("moment", "force"), LOADED),
    Broken("moment in N", '"0.01 N mm"', '"0.01 N"', "loads[1].total[1]", ("force", "moment"), LOADED),
    Broken("moment in Nm", '"0.01 N mm"', '"0.01 Nm"', "loads[1].total[1]", ("'Nm'", "'N m'"), LOADED),
    Broken("misspelt key of a load", "total = [0, 0,", "value = [0, 0,", "loads[0].value", ("unknown key", "total"), LOADED),
    Broken("table for a list of loads", "[[loads]]\nkind = \"force\"", "[loads]\nkind = \"force\"", "", ("TOML", "twice"), LOADED),
    Broken("unknown kind among more loads", '"traction"\n', '"tracktion"\n', "loads[2].kind", ("'tracktion'", "'traction'"), EVERY_LOAD),
    Broken("traction on an edge", '"two"\ntraction', '"left"\ntraction', "loads[2].group", ("group of edges",), EVERY_LOAD),
    Broken("traction as a force", '"5 Pa"', '"5 N"', "loads[2].traction[2]", ("force", "stress"), EVERY_LOAD),
    Broken("traction of zero", '"5 Pa"', "0", "loads[2].traction", ("zero",), EVERY_LOAD),
    Broken("follower of a traction", '"two"\ntraction', '"two"\nfollower = true\ntraction', "loads[2].follower", ("unknown key",), EVERY_LOAD),
    Broken("pressure of no group", '"one"\npressure', '"oen"\npressure', "loads[3].group", ("'oen'", "'one'"), EVERY_LOAD),
    Broken("pressure as a vector", '"-8 Pa"', '[0, 0, "-8 Pa"]', "loads[3].pressure", ("stress",), EVERY_LOAD),
    Broken("pressure of zero", '"-8 Pa"', "0", "loads[3].pressure", ("zero", "leave the table out"), EVERY_LOAD),
    Broken("gravity without unit", '"-9.81 m/s^2"', "-9.81", "loads[4].acceleration[2]", ("no unit", "m/s^2"), EVERY_LOAD),
    Broken("gravity in m/s2", '"-9.81 m/s^2"', '"-9.81 m/s2"', "loads[4].acceleration[2]", ("'m/s2'", "'m/s^2'"), EVERY_LOAD),
    Broken("gravity of no group", '"two"\nhistory = [1, 1]', '"tow"\nhistory = [1, 1]', "loads[4].group", ("'tow'", "'two'"), EVERY_LOAD),
    Broken("gravity without density", 'density = "1.2 g/cm^3"', "", "shell", ("density is missing", "gravity needs it"), EVERY_LOAD),
    Broken("density of zero", '"1.2 g/cm^3"', "0", "shell.density", ("not positive",), EVERY_LOAD),
    Broken("density in Pa", '"1.2 g/cm^3"', '"1.1 Pa"', "shell.density", ("stress", "density"), EVERY_LOAD),
    Broken("follower as text", "follower = true\nhistory = [0, 1]", 'follower = "yes"\nhistory = [0, 1]', "loads[0].follower", ("'yes'", "true nor false"), EVERY_LOAD),
    Broken("follower without micro-rotation", 'density = "1.2 g/cm^3"', 'density = "1.2 g/cm^3"\nmicro_rotation = false', "loads", ("force on 'far'", "turns with the micro-rotation", "leave follower out"), EVERY_LOAD),
    Broken("history as a number", "history = [1, 1]", "history = 1", "loads[4].history", ("not a list", "each stage"), EVERY_LOAD),
    Broken("history of nothing", "history = [1, 1]", "history = []", "loads[4].history", ("empty", "each stage"), EVERY_LOAD),
    Broken("history with a unit", "history = [1, 1]", 'history = [1, "1 N"]', "loads[4].history[1]", ("'N'", "number"), EVERY_LOAD),
    Broken("history not finite", "history = [1, 1]", "history = [1, nan]", "loads[4].history[1]", ("not a finite number",), EVERY_LOAD),
    Broken("histories of different lengths", "history = [1, 1]", "history = [1, 1, 1]", "loads", ("force on 'far'", "2 entries", "3 stages"), EVERY_LOAD),
    Broken("neither field nor load", STRIP[STRIP.index("[field]") : STRIP.index("[[supports]]")], "", "field", ("zero", "nor is there a load", "nothing loads")),
    # supports and probes
    Broken("missing group", '"left"', '"lefft"', "supports[0].group", ("'lefft'", "'left'")),
    Broken("name of a mesh file", '"left"', '"arm (left)/1+2"', "supports[0].group", ("'arm (left)/1+2' is not a name", "a mesh file calls so is 'arm _left__1+2' here")),
    Broken("empty group name", '"left"', '""', "supports[0].group", ("name",)),
    Broken("no supports table", CLAMP, "", "supports", ("missing",)),
    Broken("no supports", CLAMP, "", "supports", ("empty",), "supports = []\n" + STRIP),
    Broken("support that lets it slide", '"clamp"', '"symmetry"\nnormal = [1, 0, 0]', "supports", ("translation along",)),
    Broken("symmetry without normal", '"clamp"', '"symmetry"', "supports[0].normal", ("missing",)),
    Broken("prescribed value in the wrong unit", '"clamp"', '"prescribe"\nfield = "u"\ncomponent = 3\nvalue = "1 deg"', "supports[0].value", ("angle", "length")),
    Broken("prescribed value of two components", '"clamp"', '"prescribe"\nfield = "u"\nvalue = ["1 mm", 0]', "supports[0].value", ("2 entries", "expected one value, or three")),
    Broken("contradicting supports", CLAMP, CLAMP + '[[supports]]\nkind = "prescribe"\ngroup = "left"\nfield = "u"\nvalue = "1 mm"\n', "", ("supports: they contradict each other", "'left'")),
    Broken("no remanence", '"143 mT"', "0", "remanence", ("zero everywhere",)),
    Broken("component 4", '"clamp"', '"prescribe"\nfield = "u"\ncomponent = 4', "supports[0].component", ("4", "1, 2 or 3")),
    Broken("component of phi", '"clamp"', '"prescribe"\nfield = "phi"\ncomponent = 1', "supports[0].component", ("phi",)),
    Broken("unknown field", '"clamp"', '"prescribe"\nfield = "v"', "supports[0].field", ("'v'", "'u'")),
    Broken("probe not on the mesh", '["20 mm", 0, 0]', '["21 mm", 0, 0]', "probes.tip", ("nearest",)),
    Broken("edge group where nothing is", 'x1 = "20 mm" }', 'x1 = "21 mm" }', "mesh.edge_groups.far", ("no boundary edge",)),
    Broken("edge group without coordinate", '{ x1 = "20 mm" }', "{}", "mesh.edge_groups.far", ("x1, x2, x3",)),
    Broken("edge group with a name that is taken", "far =", "left =", "mesh.edge_groups.left", ("left",)),
    # meshes
    Broken("inverted block", '[[0, 0], ["10 mm", 0], ["10 mm", "5 mm"], [0, "5 mm"]]', '[[0, 0], [0, "5 mm"], ["10 mm", "5 mm"], ["10 mm", 0]]', "mesh", ("'one'", "clockwise"), BLOCKS),
    Broken("twisted block", '[[0, 0], ["10 mm", 0], ["10 mm", "5 mm"], [0, "5 mm"]]', '[[0, 0], ["10 mm", "5 mm"], ["10 mm", 0], [0, "5 mm"]]', "mesh", ("'one'",), BLOCKS),
    Broken("three corners", ', [0, "5 mm"]]', "]", "mesh.blocks.one.corners", ("3 entries", "expected 4"), BLOCKS),
    Broken("corner of one coordinate", '[0, "5 mm"]]', "[0]]", "mesh.blocks.one.corners[3]", ("1 entries", "expected 2 or 3"), BLOCKS),
    Broken("block without elements", "elements = [2, 1]", "", "mesh.blocks.one.elements", ("missing",), BLOCKS),
    Broken("divisions that do not match", "[mesh.blocks.two]", "[mesh.blocks.two]\nelements = [2, 3]", "mesh", ("'one'", "'two'", "1", "3"), BLOCKS),
    Broken("no blocks", BLOCKS[BLOCKS.index("[mesh.blocks.one]") : BLOCKS.index("[mesh.edge_groups]")], "[mesh.blocks]\n", "mesh.blocks", ("empty",), BLOCKS),
    Broken("disconnected block without support", '["10 mm", 0], ["20 mm", 0], ["20 mm", "5 mm"], ["10 mm", "5 mm"]', '["11 mm", 0], ["20 mm", 0], ["20 mm", "5 mm"], ["11 mm", "5 mm"]', "supports", ("part",), BLOCKS),
    Broken("wall to no point", '["low", "knee"]', '["low", "kne"]', "mesh", ("'post'", "'kne'", "'knee'"), PROFILE),
    Broken("wall between three points", '["low", "knee"]', '["low", "knee", "high"]', "mesh.walls.post.between", ("3 entries", "expected 2"), PROFILE),
    Broken("wall to a number", '["low", "knee"]', '["low", 3]', "mesh.walls.post.between[1]", ("'3'", "name"), PROFILE),
    Broken("point in space", 'knee = ["20 mm", 0]', 'knee = ["20 mm", 0, 0]', "mesh.points.knee", ("3 entries", "expected 2"), PROFILE),
    Broken("point within a wall", 'high = ["20 mm", "8 mm"]', 'high = ["10 mm", 0]', "mesh", ("'high'", "within wall 'post'"), PROFILE),
    Broken("no walls", PROFILE[PROFILE.index("post = {") : PROFILE.index("[shell]")], "", "mesh.walls", ("empty",), PROFILE),
    Broken("too many walls", "elements = 4", "elements = 9999999", "mesh.walls.post.elements", ("whole number",), PROFILE),
    Broken("sector of 90 degrees", '"60 deg"', '"90 deg"', "mesh", ("sector = 90", "between 0 and 90"), MIURA),
    Broken("sector without a unit", '"60 deg"', "60", "mesh.sector", ("angle", "unit"), MIURA),
    Broken("panels folded together", '"30 deg"', '"89.99 deg"', "mesh", ("lie on each other",), MIURA),
    Broken("one side", '["10 mm", "8 mm"]', '["10 mm"]', "mesh.sides", ("1 entries", "expected 2"), MIURA),
    Broken("too many cells", "cells = [1, 1]", "cells = [9000, 9000]", "mesh", ("elements",), MIURA),
    Broken("angle that goes back", '["0 deg", "90 deg"]', '["90 deg", "0 deg"]', "mesh", ("angle",), PUMP),
    Broken("angle in mm", '"90 deg"', '"90 mm"', "mesh.angle[1]", ("length", "angle"), PUMP),
    Broken("axis of zero length", "angle =", "axis = [0, 0, 0]\nangle =", "mesh.axis", ("zero vector",), PUMP),
    # results
    Broken("unknown output", "[probes]", '[results]\noutputs = ["stress", "strss"]\n[probes]', "results.outputs", ("'strss'", "Did you mean 'stress'")),
    Broken("axis without direction", "[probes]", "[results]\nlocal_axis = [0, 0, 0]\n[probes]", "results.local_axis", ("zero vector",)),
    # solver
    Broken("unknown linear solver", "[probes]", '[solver]\nlinear_solver = "superlou"\n[probes]', "solver", ("'superlou'", "'superlu'")),
    Broken("negative tolerance", "[probes]", "[solver]\ntolerance = -1e-9\n[probes]", "solver.tolerance", ("not positive",)),
    Broken("coarse tolerance", "[probes]", "[solver]\ntolerance = 0.5\n[probes]", "solver", ("tolerance", "1e-2")),
    Broken("steps out of order", "[probes]", "[solver]\nfirst_step = 0.1\nlargest_step = 0.01\n[probes]", "solver", ("first_step", "largest_step")),
    # TOML
    Broken("key twice", 'width = "5 mm"', 'width = "5 mm"\nwidth = "6 mm"', "", ("not valid TOML", "twice", "line 6")),
    Broken("table twice", "[field]", "[shell]\n[field]", "", ("not valid TOML", "twice", "line")),
    Broken("quote not closed", '"303 kPa"', '"303 kPa', "", ("not valid TOML", "line 16")),
    Broken("unit outside the quotes", '"303 kPa"', "303 kPa", "", ("not valid TOML", "line 16", 'in quotes: shear_modulus = "303 kPa"')),
    Broken("comma and no quotes", 'thickness = "1 mm"', "thickness = 0,8 mm", "", ("line 12", 'in quotes: thickness = "0.8 mm"')),
    Broken("name without quotes", '"clamp"', "clamp  # here", "", ("not valid TOML", 'in quotes: kind = "clamp"')),
    Broken("unit outside the quotes in a list", '"143 mT"', "143 mT", "", ("not valid TOML", "in quotes, also in a list")),
    # what is called otherwise, stands elsewhere or does not exist
    Broken("two materials", "[material]", "[[material]]", "material", ("one [material] only", "further materials belong to [[regions]]")),
    Broken("list of meshes", "[mesh]", "[[mesh]]", "mesh", ("one [mesh] only",), STRIP.replace("[mesh.edge_groups]\nfar = { x1 = \"20 mm\" }\n", "")),
    Broken("shell as text", '[shell]\nthickness = "1 mm"\n', "", "shell", ("not a table", "write [shell]"), 'shell = "1 mm"\n' + STRIP),
    Broken("list of fields", "[field]", "[[field]]", "field", ("one [field] only",)),
    Broken("list of probes", "[probes]", "[[probes]]", "probes", ("one [probes] only", "tip = [")),
    Broken("magnetisation", "[probes]", "[[magnetisation]]\n[probes]", "magnetisation", ("Did you mean 'remanence'",)),
    Broken("magnet", "[probes]", "[[magnet]]\n[probes]", "magnet", ("Did you mean 'magnets'",)),
    Broken("contact", "[probes]", "[contact]\n[probes]", "contact", ("there is no contact",)),
    Broken("density of the material", "shear_modulus", "density", "material.density", ("belongs to [shell]",)),
    Broken("fixed", '"clamp"', '"fixed"', "supports[0].kind", ("'fixed'", "Did you mean 'clamp'")),
    Broken("pinned", '"clamp"', '"pinned"', "supports[0].kind", ("Did you mean 'simple'",)),
    Broken("type of a support", 'kind = "clamp"', 'type = "clamp"', "supports[0].kind", ("is missing", "'type' in its place")),
    Broken("element type", "[shell]", '[shell]\nelement = "quad"', "shell.element", ("did you mean 'quadratic'",)),
    Broken("decimal comma", '"1 mm"\n\n[material]', '"0,8 mm"\n\n[material]', "shell.thickness", ("decimal comma", '"0.8 mm"')),
    Broken("bare number", '"1 mm"\n\n[material]', "30\n\n[material]", "shell.thickness", ("no unit", '"30 mm"')),
]  # fmt: skip


@pytest.mark.parametrize("case", BROKEN, ids=[case.name.replace(" ", "-") for case in BROKEN])
@pytest.mark.parametrize("command", ["check", "run"])
def test_says_what_is_wrong_and_where(
    case: Broken, command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "broken.toml").write_text(changed(case.base, (case.old, case.new)))
    out = ["--out", str(tmp_path / "out")] if command == "run" else []
    status = main([command, str(tmp_path / "broken.toml"), *out])
    shown = capsys.readouterr()
    lines = shown.err.splitlines()
    place = f"error: broken.toml: {case.where}: " if case.where else "error: broken.toml: "
    assert status == 2, shown.err
    assert len(lines) == 1, shown.err
    assert lines[0].startswith(place), f"{lines[0]!r} does not start with {place!r}"
    for word in case.words:
        assert word in lines[0], f"{word!r} is not in {lines[0]!r}"
    assert "Traceback" not in shown.err + shown.out
    assert not (tmp_path / "out").exists()


def refused(capsys: pytest.CaptureFixture[str], problem: Path | str, out: Path) -> str:
    """What the command says about a problem that it refuses without leaving anything behind."""
    status = main(["run", str(problem), "--out", str(out)])
    shown = capsys.readouterr().err
    assert status == 2, shown
    assert not out.exists()
    assert "Traceback" not in shown
    assert len(shown.splitlines()) == 1, shown
    return shown


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "empty"),
        (b"  \n\t\n", "empty"),
        (b"\x7fELF\x02\x01\x00", "not valid TOML"),
        (b"\x89PNG\r\n\x1a\n\x00", "not a text file in UTF-8 (byte 0 is 0x89)"),
        (STRIP.encode("utf-16"), "not a text file"),
        (b"a = " + b"[" * 100_000, "nested too deeply"),
        (b"a = 1" + b"0" * 5_000, "not valid TOML"),
        (b"\x00", "not valid TOML"),
    ],
    ids=["empty", "blank", "binary", "picture", "utf-16", "deep", "huge-integer", "nul"],
)
def test_what_is_no_problem_file(
    content: bytes, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "broken.toml"
    file.write_bytes(content)
    shown = refused(capsys, file, tmp_path / "out")
    assert shown.startswith("error: broken.toml: ")
    assert words in shown


def test_missing_file_names_the_nearest(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "my-arm.toml").write_text(STRIP)
    assert "Did you mean 'my-arm.toml'" in refused(capsys, tmp_path / "myarm.toml", tmp_path / "out")
    assert "Did you mean 'gripper'" in refused(capsys, "griper", tmp_path / "out")


def test_folder_is_no_problem(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert "is a folder" in refused(capsys, tmp_path, tmp_path / "out")


def test_byte_order_mark_and_windows_line_ends_are_read(tmp_path: Path) -> None:
    file = tmp_path / "windows.toml"
    file.write_bytes(b"\xef\xbb\xbf" + STRIP.replace("\n", "\r\n").encode())
    assert main(["check", str(file)]) == 0


def test_every_error_has_its_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "broken.toml"
    file.write_text(changed(STRIP, ('"5 mm"', '"5 kPa"'), ("[4, 1]", "[0, 1]"), ('"clamp"', '"clip"')))
    assert main(["check", str(file)]) == 2
    keys = [line.split(": ")[2] for line in capsys.readouterr().err.splitlines()]
    assert keys == ["mesh.width", "mesh.elements[0]", "supports[0].kind"]
