"""From the undeformed shell to the arrays that the kernels read."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.magnetics import law as coupling_laws
from magshell.materials import law as material_laws
from magshell.shell.bubble import hold
from magshell.shell.element import layout_of
from magshell.shell.elements import ElementType
from magshell.shell.geometry import Interpolation, SectionGeometry, Sections, interpolation, section_geometry
from magshell.shell.loops import Body
from magshell.shell.point import LEVEL, POINT
from magshell.shell.section import Laws


class Surface(NamedTuple):
    """The mid-surface, node by node of the elements.

    Attributes
    ----------
    elements : ndarray, shape (elements, 8)
    points, normals : ndarray, shape (elements, 8, 3)
        m; unit normals at the nodes.
    element : ElementType
    micro_rotation : bool
        Without it no node carries a quaternion.
    """

    elements: IntArray
    points: FloatArray
    normals: FloatArray
    element: ElementType
    micro_rotation: bool


class Make(NamedTuple):
    """What each element is made of.

    Attributes
    ----------
    thickness : ndarray, shape (elements,)
        m.
    sections : Sections
    remanence : ndarray, shape (elements, points, levels, 3)
        T.
    materials, couplings : sequence of Material, sequence of Coupling
    material_of, coupling_of : ndarray, shape (elements, levels)
        Which of them holds at a level.
    plane_stress : bool
        Whether φ is eliminated at each point.
    """

    thickness: FloatArray
    sections: Sections
    remanence: FloatArray
    materials: Sequence[Any]
    material_of: IntArray
    couplings: Sequence[Any]
    coupling_of: IntArray
    plane_stress: bool


class Reference(NamedTuple):
    """The undeformed shell: what the kernels read, and views of it by name."""

    body: Body
    geometry: SectionGeometry
    shape: Interpolation
    remanence: FloatArray


def reference_of(surface: Surface, make: Make) -> Reference:
    """The arrays of a shell."""
    element = surface.element
    shape = interpolation(surface.points, surface.normals, element, surface.micro_rotation)
    _, weights = element.integration(surface.points)
    geometry = section_geometry(surface.points, surface.normals, shape, weights, make.sections)
    layout = layout_of(8, element.rest_nodes, element.stretch_nodes, shape.rotation.shape[-1], element.vectors)
    levels = np.zeros(geometry.volume.shape, dtype=LEVEL)
    levels["z"], levels["volume"], levels["G"] = geometry.z, geometry.volume, geometry.G
    levels["remanence"] = make.remanence
    levels["material"], levels["coupling"] = make.material_of[:, None], make.coupling_of[:, None]
    points = _points(geometry, shape, of_elements(make, "couple_modulus"))
    held = hold(surface.points, element, make.thickness, of_elements(make, "shear_modulus").mean(axis=1))
    laws = Laws(*material_laws.addresses(make.materials), *coupling_laws.addresses(make.couplings))
    body = Body(
        elements=np.ascontiguousarray(surface.elements),
        layout=layout,
        points=points,
        levels=levels,
        enhancement=shape.enhancement,
        laws=laws,
        hold=held,
        plane_stress=make.plane_stress,
    )
    views = SectionGeometry(points["A"], points["D"], points["dD"], levels["z"], levels["G"], levels["volume"])
    functions = Interpolation(
        points["u"],
        points["director"][..., : layout.w],
        points["phi"][..., : layout.phi],
        points["rotation"][..., : layout.q],
        shape.enhancement,
    )
    return Reference(body, views, functions, levels["remanence"])


def of_elements(make: Make, name: str) -> FloatArray:
    """A parameter of the materials at the levels of each element (elements, levels)."""
    return np.array([getattr(material, name) for material in make.materials])[make.material_of]


def _points(geometry: SectionGeometry, shape: Interpolation, couple_modulus: FloatArray) -> AnyArray:
    points = np.zeros(geometry.A.shape[:2], dtype=POINT)
    points["A"], points["D"], points["dD"] = geometry.A, geometry.D, geometry.dD
    legs = geometry.G[..., :2, :]
    points["couple_metric"] = np.einsum("ek,epk,epkax,epkbx->epab", couple_modulus, geometry.volume, legs, legs)
    points["u"] = shape.u
    points["director"][..., : shape.director.shape[-1]] = shape.director
    points["phi"][..., : shape.phi.shape[-1]] = shape.phi
    points["rotation"][..., : shape.rotation.shape[-1]] = shape.rotation
    return points
