"""The shell: mid-surface, what it is made of, element type; validated once."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from magshell.arguments import instance, on_groups, sampling, several
from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.magnetics.remanence import Remanence
from magshell.materials import completed
from magshell.mesh import Mesh
from magshell.model.checked import checked_material, positive
from magshell.model.hinge import Hinge
from magshell.model.images import Images, images_of
from magshell.model.overall import overall_remanence
from magshell.model.parts import Draft, Heights, Part, completed_drafts, drafts_of, heights_of, parts_of
from magshell.model.places import check_name
from magshell.model.region import NO_REMANENCE, Layer, Region
from magshell.model.repeated import Periodic, Repeated
from magshell.model.rigid_body import RigidBody
from magshell.model.thickness import Thickness
from magshell.shell.elements import ELEMENTS, QUADRATIC
from magshell.shell.elements.definition import ElementType

STRETCHES = ("linear", "none", "plane-stress")


@dataclasses.dataclass(frozen=True, eq=False)
class Shell:
    """A shell: thickness, material, remanence and density hold for the elements that are in no region.

    Parameters
    ----------
    mesh : Mesh
        Mid-surface, unless there is an offset.
    thickness : float or Thickness, optional
        m; see `magshell.thickness` for one that varies. Needed unless there are layers, or regions hold all elements.
    material : Material, optional
        A law with its parameters, for instance `MicropolarNeoHookean`. Where they are left out, the coupling modulus
        is the shear modulus and the length scale a hundredth of the thickness (of each region that is of the
        material; of a thickness that varies, its mean); without micro-rotation both are 0.
    remanence : Remanence, optional
        Remanent flux density of the undeformed material, see `magshell.remanence`; by default none.
    element : ElementType or str, optional
        Element type or its name, see `magshell.shell.elements`.
    thickness_stretch : {"linear", "none", "plane-stress"}, optional
        Stretch of the thickness that varies linearly across it: an unknown φ, absent (this locks in bending), or
        eliminated at each point so that P33 has no moment.
    density : float, optional
        Mass per undeformed volume, kg/m³; gravity needs it.
    micro_rotation : bool, optional
        False: the classical shell of seven parameters (u, w, φ). The materials' coupling_modulus and length_scale must
        then be 0, only `DeformationGradientEnergy` can couple a field to it, and there are no layers.
    regions : sequence of Region, optional
        Elements with other properties.
    layers : sequence of Layer, optional
        From the bottom (the side that the normal points away from) to the top, in place of thickness, material and
        remanence.
    offset : {"middle", "top", "bottom"} or float, optional
        Where the mesh lies: in the mid-plane, at the top or the bottom face, or this far above the mid-plane along the
        normal, m.
    levels : int, optional
        Gauss points through the thickness of each layer.
    hinges : sequence of Hinge, optional
        Edges along which the shell may turn freely, or against a spring.
    rigid : sequence of RigidBody, optional
        Groups that move as rigid bodies.
    repeated : sequence of Cyclic or Periodic, optional
        Motions that take the shell to its neighbours in a structure of many alike.

    Raises
    ------
    InputError
        Values out of their range; regions that overlap, or elements in none; a curved mesh that is too thick for its
        radius of curvature.
    """

    mesh: Mesh
    thickness: float | Thickness | None = None
    material: Any = None
    remanence: Remanence = NO_REMANENCE
    element: Any = QUADRATIC
    thickness_stretch: str = "linear"
    micro_rotation: bool = True
    density: float | None = None
    regions: Sequence[Region] = ()
    layers: Sequence[Layer] = ()
    offset: str | float = "middle"
    levels: int = 2
    hinges: Sequence[Hinge] = ()
    rigid: Sequence[RigidBody] = ()
    repeated: Sequence[Repeated] = ()
    _drafts: list[Draft] = dataclasses.field(init=False, repr=False)
    _heights: list[Heights] = dataclasses.field(init=False, repr=False)

    def __post_init__(self) -> None:
        put = object.__setattr__
        instance("shell: mesh", self.mesh, Mesh, "a Mesh: one of ms.mesh.rectangle(…) and the like, or ms.mesh.read(…)")
        put(self, "regions", several("shell: regions", self.regions, Region, "a Region"))
        put(self, "layers", several("shell: layers", self.layers, Layer, "a Layer"))
        put(self, "hinges", on_groups("shell: hinges", self.hinges, Hinge, "a Hinge"))
        put(self, "rigid", on_groups("shell: rigid", self.rigid, RigidBody, "a RigidBody"))
        put(self, "repeated", on_groups("shell: repeated", self.repeated, Repeated, "a Cyclic or Periodic"))
        instance("shell: micro_rotation", self.micro_rotation, (bool, np.bool_), "True or False")
        self._check_functions("shell", self)
        for number, region in enumerate(self.regions):
            self._check_functions(f"regions[{number}]", region)
        for number, layer in enumerate(self.layers):
            self._check_functions(f"layers[{number}]", layer)
        if self.density is not None:
            put(self, "density", positive("shell: density", self.density, "kg/m^3"))
        if self.thickness is not None and not callable(self.thickness):
            put(self, "thickness", positive("shell: thickness", self.thickness, "m"))
        if self.material is not None:
            material = checked_material("material", self.material, self.micro_rotation)
            if isinstance(self.thickness, float):
                material = completed(material, self.thickness, self.micro_rotation)
            put(self, "material", material)
        put(self, "_drafts", drafts_of(self))
        if isinstance(self.element, str):
            if self.element not in ELEMENTS:
                raise InputError(f"shell: element is '{self.element}'. {suggest(self.element, ELEMENTS)}")
            put(self, "element", ELEMENTS[self.element])
        instance("shell: element", self.element, ElementType, f"one of {', '.join(map(repr, ELEMENTS))}")
        if self.mesh.triangles.any():
            if self.element.with_triangles is None:
                able = " or ".join(f"'{name}'" for name, element in ELEMENTS.items() if element.with_triangles)
                raise InputError(
                    f"shell: element is '{self.element.name}', which has no triangles, and element "
                    f"{int(np.argmax(self.mesh.triangles))} of the mesh is one; use {able}"
                )
            put(self, "element", self.element.with_triangles)
        if self.thickness_stretch not in STRETCHES:
            raise InputError(
                f"shell: thickness_stretch is '{self.thickness_stretch}'. {suggest(self.thickness_stretch, STRETCHES)}"
            )
        for draft in self._drafts:
            if draft.layered:
                self._check_theory_of_layers(draft.where)
        put(self, "_heights", heights_of(self, self._drafts))
        put(self, "_drafts", completed_drafts(self._drafts, self._heights, self.micro_rotation))

    def _check_functions(self, where: str, made: Shell | Region | Layer) -> None:
        """Refuse remanence and thickness that are no functions of mesh and points."""
        if made.remanence is not None or not isinstance(made, Region):
            sampling(f"{where}: remanence", made.remanence, "ms.remanence", "a remanence (T)")
        if callable(made.thickness):
            sampling(f"{where}: thickness", made.thickness, "ms.thickness", "a thickness (m)")
        layers = several(f"{where}: layers", made.layers, Layer, "a Layer") if isinstance(made, Region) else ()
        for number, layer in enumerate(layers):
            self._check_functions(f"{where}: layers[{number}]", layer)

    def _check_theory_of_layers(self, where: str) -> None:
        if not self.micro_rotation:
            raise InputError(
                f"{where}: micro_rotation is False beside layers, whose transverse shear is measured from the "
                "micro-rotation; leave it out"
            )
        if self.thickness_stretch == "none":
            raise InputError(
                f"{where}: thickness_stretch is 'none' beside layers, which always stretch, each by itself; "
                "leave it out"
            )

    def __repr__(self) -> str:
        made = [] if self.thickness is None else [f"thickness {in_words(self.thickness)}"]
        made += [] if self.material is None else [repr(self.material)]
        made += [f"{len(self.layers)} layers"] if self.layers else []
        made += [f"{len(self.regions)} regions"] if self.regions else []
        return f"Shell({self.mesh!r}, {', '.join(made)}, element '{self.element.name}')"

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Parts of equal properties, the elements in no region first: together they hold every element once.

        Raises
        ------
        InputError
            The remanence is not finite in an element.
        """
        return parts_of(self, self._drafts, self._heights)

    @property
    def plain(self) -> bool:
        """Whether it is of one thickness and material, with the mesh in the middle of it."""
        first = self._drafts[0]
        varies = callable(first.layers[0].thickness)
        return len(self._drafts) == 1 and not (first.layered or varies or first.offset not in ("middle", 0.0))

    @cached_property
    def magnetised(self) -> bool:
        """Whether any layer has remanence, also where that of the layers has no mean."""
        return any(bool(part.remanence.any()) for part in self.parts)

    @property
    def greatest_thickness(self) -> float:
        """m."""
        return max(float(one.at_nodes.sum(axis=-1).max()) for one in self._heights)

    @cached_property
    def faces_at_nodes(self) -> FloatArray:
        """Heights of the bottom and the top face over the mesh at the nodes of the elements, (elements, 8, 2), m."""
        faces = np.empty((*self.mesh.elements.shape, 2))
        for draft, height in zip(self._drafts, self._heights, strict=True):
            half = 0.5 * height.at_nodes.sum(axis=-1)
            faces[draft.elements, :, 0], faces[draft.elements, :, 1] = -half, half
            faces[draft.elements] -= height.offset_at_nodes[..., None]
        return faces

    @cached_property
    def images(self) -> Images:
        """Nodes that are images of others.

        Raises
        ------
        InputError
            A repetition does not fit the mesh.
        """
        return images_of(self.mesh, self.repeated)

    @property
    def periodic(self) -> tuple[Periodic, ...]:
        """Those of the repetitions that have a jump of the displacement."""
        return tuple(one for one in self.repeated if isinstance(one, Periodic))

    def body_row(self, name: str | None) -> int | None:
        """Row of the nodal arrays of the rigid body of this name; None: there is none."""
        names = [body.name for body in self.rigid]
        return len(self.mesh.points) + names.index(name) if name in names else None

    def jump_row(self, name: str | None) -> int | None:
        """Row of the nodal arrays of the jump of this name; None: there is none."""
        names = [one.name for one in self.periodic]
        return len(self.mesh.points) + len(self.rigid) + names.index(name) if name in names else None

    def nodes_of(self, name: str) -> IntArray:
        """Nodes of a group, those that belong to a rigid body, or those beyond a jump.

        Raises
        ------
        InputError
            There is none of this name.
        """
        groups = {body.name: body.group for body in self.rigid} | {one.name: one.image for one in self.periodic}
        check_name(name, self.mesh, self.rigid, self.periodic)
        return self.mesh.nodes_of(groups.get(name, name))

    def mean_of(self, parameter: str) -> FloatArray:
        """A parameter of the material of each element (elements,), its mean over the layers."""
        mean = np.empty(len(self.mesh.elements))
        for draft, height in zip(self._drafts, self._heights, strict=True):
            values = np.array([getattr(layer.material, parameter) for layer in draft.layers])
            shares = height.at_points.mean(axis=1)
            mean[draft.elements] = values[0] if len(values) == 1 else shares @ values / shares.sum(axis=1)
        return mean

    @cached_property
    def overall_remanence(self) -> Remanence:
        """Remanence of all parts together; of layers the mean over the thickness."""
        return overall_remanence(self.remanence, self._drafts)

    @cached_property
    def part_of(self) -> AnyArray:
        """Number of the part (elements,) of each element."""
        numbers = np.empty(len(self.mesh.elements), dtype=np.int64)
        for number, draft in enumerate(self._drafts):
            numbers[draft.elements] = number
        return numbers

    @cached_property
    def remanence_at_points(self) -> FloatArray:
        """Remanence at the integration points, its mean over the thickness, (elements, points, 3), T.

        Raises
        ------
        InputError
            It is not finite in an element.
        """
        mean = np.empty((len(self.mesh.elements), self.parts[0].remanence.shape[1], 3))
        for part in self.parts:
            if len(part.layers) == 1:
                mean[part.elements] = part.remanence[:, :, 0]
            else:
                shares = part.at_points / part.at_points.sum(axis=2, keepdims=True)
                mean[part.elements] = np.einsum("epl,eplx->epx", shares, part.remanence)
        return mean

    @property
    def carriers(self) -> dict[str, AnyArray]:
        """Which nodes carry the fields u, w, phi and omega: boolean arrays (nodes,)."""
        count = len(self.mesh.points)
        carriers: dict[str, AnyArray] = self.element.carriers(self.mesh.elements, count)
        if self.thickness_stretch != "linear":
            carriers["phi"] = np.zeros(count, dtype=bool)
        if not self.micro_rotation:
            carriers["omega"] = np.zeros(count, dtype=bool)
        return carriers


def in_words(thickness: float | Thickness) -> str:
    """A number in m, or that it varies."""
    return "varies" if callable(thickness) else f"{thickness:g} m"
