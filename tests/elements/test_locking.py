"""Thin and nearly incompressible shells in coarse, distorted meshes: neither shear, membrane nor volumetric locking.

With locking a deflection falls short by a factor that grows with (L/h)² or with lambda / mu, up to a thousand here.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import magshell as ms
from elements.linear import MU, SMALL, respond, rubber
from elements.meshes import moved
from magshell.mesh import split

LENGTH, HALF_WIDTH = 1.0, 0.125
each_thickness = pytest.mark.parametrize("slenderness", [10, 100, 1000])


@cache
def strip(
    elements: tuple[int, int], slenderness: float, nu: float, distortion: float = 0.0, triangles: str | None = None
) -> float:
    """Work of a small transverse end force on half a cantilever whose section may bend across the width as well."""
    thickness = LENGTH / slenderness
    mesh = ms.mesh.rectangle(LENGTH, HALF_WIDTH, elements)
    mesh = moved(mesh, distortion) if distortion else mesh
    mesh = (split(mesh, triangles) if triangles else mesh).select_nodes("origin", x1=0, x2=0)
    shell = ms.Shell(mesh, thickness, rubber(nu, thickness))
    supports = [
        ms.SymmetryPlane("left", (1, 0, 0)),
        ms.SymmetryPlane("bottom", (0, 1, 0)),
        ms.Prescribe("origin", "u", 3),
    ]
    return respond(ms.Model(shell, supports, loads=[ms.Force("right", (0, 0, SMALL * thickness**3))])).work


@each_thickness
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999])
@pytest.mark.parametrize("triangles", [None, "rising", "alternating", "crossed"])
@pytest.mark.parametrize("mesh", ["regular", "distorted"])
def test_strip_bent_by_an_end_force(slenderness: float, nu: float, mesh: str, triangles: str | None) -> None:
    """The moment is linear along the strip. n elements that held its mean only would lose 1/4n² of the work.

    An element with linear moments loses less than that on a regular mesh. On a distorted one it may lose as much;
    triangles that are distorted, incompressible and very thin lose up to three times as much.
    """
    elements, distortion = ((8, 1), 0.0) if mesh == "regular" else ((8, 2), 0.25)
    allowed = 0.25 / 8**2 * (0.25 if mesh == "regular" else 3.0 if triangles and nu == 0.4999 else 1.0)
    off = strip(elements, slenderness, nu, distortion, triangles) / strip((32, 4), slenderness, nu) - 1.0
    print(f"{off:.1e}")
    assert abs(off) < allowed, f"work of the force off by {off:.1e}, allowed {allowed:.1e}"


@each_thickness
def test_clamp_that_holds_the_width_of_a_nearly_incompressible_strip(slenderness: float) -> None:
    """The clamp keeps the section from bending across the width, in a layer of about the width.

    How much that takes from the deflection of a beam is known from the fine mesh. Elements of half the layer's width
    find at least three quarters of it.
    """
    nu, thickness = 0.4999, LENGTH / slenderness

    def work(elements: tuple[int, int], distortion: float) -> float:
        mesh = ms.mesh.rectangle(LENGTH, 2 * HALF_WIDTH, elements)
        shell = ms.Shell(moved(mesh, distortion), thickness, rubber(nu, thickness))
        load = ms.Force("right", (0, 0, SMALL * thickness**3))
        return respond(ms.Model(shell, [ms.Clamp("left")], loads=[load])).work

    fine = work((32, 8), 0.0)
    layer = 0.5 * strip((32, 4), slenderness, nu) / fine - 1.0
    assert layer > 0.02, f"the clamp takes {layer:.1%}"
    for distortion in (0.0, 0.25):
        off = work((8, 2), distortion) / fine - 1.0
        print(f"layer {layer:.1e}, off {off:.1e}")
        assert abs(off) < 0.25 * layer, f"distortion {distortion}: off by {off:.1e}; the clamp takes {layer:.1e}"


@pytest.mark.parametrize("elements", [4, 8, 16])
@pytest.mark.parametrize("slenderness", [100, 1000])
def test_quarter_ring_bent_by_an_end_force(elements: int, slenderness: float) -> None:
    """Without extension: W = P²R³/2EI ∫ (1 - cos φ)² dφ, whatever the thickness.

    An element over the angle θ tells an arc from its chord no better than θ²/24 of the length, twice that in work.
    """
    thickness, width = 1.0 / slenderness, 0.1
    mesh = ms.mesh.cylinder(1.0, width, (elements, 1), angle=(0, 90), axis=(0, 1, 0), zero=(1, 0, 0))
    shell = ms.Shell(mesh, thickness, rubber(0.0, thickness))
    force = SMALL * thickness**3
    model = ms.Model(shell, [ms.Clamp("angle-start")], loads=[ms.Force("angle-stop", (force, 0, 0))])
    couple_stress = MU * shell.material.length_scale**2 * thickness * width
    stiffness = 2.0 * MU * width * thickness**3 / 12.0 + couple_stress
    off = respond(model).work / (0.5 * force**2 / stiffness * (0.75 * np.pi - 2.0)) - 1.0
    allowed = (0.5 * np.pi / elements) ** 2 / 12.0
    print(f"{off:.1e}, allowed {allowed:.1e}")
    assert abs(off) < allowed, f"off by {off:.1e}, allowed {allowed:.1e}"
