"""Bodies of several parts for the tests of the numerics: laws, thickness, layers and offsets differ between them."""

from __future__ import annotations

import numpy as np
from battery import MATERIAL, REMANENCE, example, for_element, free_body

from magshell.magnetics import remanence
from magshell.materials import MicropolarMooneyRivlin, MicropolarStVenantKirchhoff
from magshell.model.region import Layer, Region
from magshell.shell.elements import QUADRATIC

SECOND, THIRD = MicropolarMooneyRivlin(2.5, 4.0, 0.6, 0.1, 0.4), example(MicropolarStVenantKirchhoff)
ACROSS = (-0.2, 0.5, 0.8)


def thirds(mesh):
    """Elements in three groups, in the order of the mesh; in a patch of four they meet at the middle."""
    return np.array_split(np.arange(len(mesh.elements)), 3)


def plain(mesh):
    """The second and the third part, of other laws, thickness and offset."""
    _, second, third = thirds(mesh)
    other = remanence.constant(ACROSS)
    return [Region(second, 0.21, SECOND, other, offset=0.03), Region(third, 0.09, THIRD, other, offset="top", levels=3)]


def layered(mesh):
    """The second part of two layers of other laws, the third of three that are magnetised in other directions."""
    _, second, third = thirds(mesh)
    base = example(MATERIAL)
    two = [Layer(0.05, SECOND, remanence.constant(ACROSS)), Layer(0.08, base)]
    three = [Layer(0.04, base, remanence.constant(REMANENCE)), Layer(0.06, THIRD), Layer(0.03, SECOND)]
    return [Region(second, layers=two, offset=-0.02), Region(third, layers=three, levels=1)]


PARTS = {"plain": plain, "layered": layered}


def jointed(mesh, parts, element=QUADRATIC, **options):
    """A body of parts that meet."""
    mesh = for_element(mesh, element)
    return free_body(mesh, element=element, regions=parts(mesh), **options)
