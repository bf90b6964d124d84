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
from magshell.shell.level import Laws
from magshell.shell.loaded import loaded
from magshell.shell.loops import Body
from magshell.shell.point import LEVEL, POINT
from magshell.shell.ties import STRETCHED, TURNED, Ties


class Surface(NamedTuple):
    """The mid-surface, node by node of the elements.

    Attributes
    ----------
    elements : ndarray, shape (elements, 8)
        Rows of the nodal arrays.
    ties : Ties
    points, normals : ndarray, shape (elements, 8, 3)
        m; unit normals at the nodes.
    element : ElementType
    micro_rotation : bool
        Without it no node carries a quaternion.
    """

    elements: IntArray
    ties: Ties
    points: FloatArray
    normals: FloatArray
    element: ElementType
    micro_rotation: bool


class Make(NamedTuple):
    """What each element is made of.

    Attributes
    ----------
    thickness : ndarray, shape (elements,)
        Mean, m.
    sections : Sections
    levels : ndarray, shape (elements,)
        How many each element has.
    by_level : ndarray of bool, shape (elements,)
        Whether each level has a stretch of its own, in place of φ.
    warping : ndarray, shape (elements, points, levels)
        By how much the transverse shear of a level exceeds the director's, as a share of it.
    remanence : ndarray, shape (elements, points, levels, 3)
        T.
    materials, couplings : sequence of Material, sequence of Coupling
    material_of, coupling_of : ndarray, shape (elements, levels)
        Which of them holds at a level.
    """

    thickness: FloatArray
    sections: Sections
    levels: IntArray
    by_level: AnyArray
    warping: FloatArray
    remanence: FloatArray
    materials: Sequence[Any]
    material_of: IntArray
    couplings: Sequence[Any]
    coupling_of: IntArray


class Reference(NamedTuple):
    """The undeformed shell: what the kernels read, and views of it by name; positions (elements, 8, 3) of the nodes."""

    body: Body
    geometry: SectionGeometry
    shape: Interpolation
    remanence: FloatArray
    coordinates: FloatArray


def reference_of(surface: Surface, make: Make) -> Reference:
    """The arrays of a shell."""
    element = surface.element
    shape = interpolation(surface.points, surface.normals, element, surface.micro_rotation)
    _, weights = element.integration(surface.points)
    geometry = section_geometry(surface.points, surface.normals, shape, weights, make.sections)
    kind = surface.ties.kind
    s = element.rest_nodes if np.any((kind == STRETCHED) | (kind == TURNED)) else 0
    layout = layout_of(8, element.rest_nodes, element.stretch_nodes, shape.rotation.shape[-1], element.vectors, s)
    levels = np.zeros(geometry.volume.shape, dtype=LEVEL)
    levels["z"], levels["volume"], levels["G"] = geometry.z, geometry.volume, geometry.G
    levels["height"], levels["warping"] = make.sections.heights, make.warping
    levels["remanence"] = make.remanence
    levels["material"], levels["coupling"] = make.material_of[:, None], make.coupling_of[:, None]
    position = loaded(element, element.integration(surface.points)[0], surface.points).values
    points = _points(geometry, shape, position, of_elements(make, "couple_modulus"))
    points["levels"], points["by_level"] = make.levels[:, None], make.by_level[:, None]
    heights = make.sections.heights.mean(axis=1)
    shear_modulus = np.average(of_elements(make, "shear_modulus"), axis=1, weights=heights)
    held = hold(surface.points, element, make.thickness, shear_modulus)
    laws = Laws(*material_laws.addresses(make.materials), *coupling_laws.addresses(make.couplings))
    body = Body(
        elements=np.ascontiguousarray(surface.elements),
        normals=np.ascontiguousarray(surface.normals),
        by_level=np.ascontiguousarray(make.by_level) if make.by_level.any() else None,
        ties=surface.ties,
        layout=layout,
        points=points,
        levels=levels,
        enhancement=shape.enhancement,
        laws=laws,
        hold=held,
    )
    views = SectionGeometry(points["A"], points["D"], points["dD"], levels["z"], levels["G"], levels["volume"])
    functions = Interpolation(
        points["u"],
        points["director"][..., : layout.w],
        points["phi"][..., : layout.phi],
        points["rotation"][..., : layout.q],
        shape.enhancement,
    )
    return Reference(body, views, functions, levels["remanence"], surface.points)


def of_elements(make: Make, name: str) -> FloatArray:
    """A parameter of the materials at the levels of each element (elements, levels)."""
    return np.array([getattr(material, name) for material in make.materials])[make.material_of]


def _points(
    geometry: SectionGeometry, shape: Interpolation, position: FloatArray, couple_modulus: FloatArray
) -> AnyArray:
    points = np.zeros(geometry.A.shape[:2], dtype=POINT)
    points["A"], points["D"], points["dD"] = geometry.A, geometry.D, geometry.dD
    legs = geometry.G[..., :2, :]
    points["couple_metric"] = np.einsum("ek,epk,epkax,epkbx->epab", couple_modulus, geometry.volume, legs, legs)
    points["u"], points["position"] = shape.u, position
    points["director"][..., : shape.director.shape[-1]] = shape.director
    points["phi"][..., : shape.phi.shape[-1]] = shape.phi
    points["rotation"][..., : shape.rotation.shape[-1]] = shape.rotation
    return points
