"""From the shell and its regions to parts: together every element once, each with its layers as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple, Protocol

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError, suggest
from magshell.magnetics.remanence import Remanence
from magshell.magnetics.remanence.groups import only
from magshell.materials import completed
from magshell.mesh import Mesh
from magshell.model.checked import checked_material, positive
from magshell.model.region import NO_REMANENCE, OFFSETS, Group, Layer, Region
from magshell.model.thickness import Thickness
from magshell.shell.elements import ElementType

MOST_LEVELS = 16
REST = "shell"


class Part(NamedTuple):
    """Elements with the same properties, all defaults filled in.

    Attributes
    ----------
    name : str
        Of the groups of the region; "shell" for what is in no region.
    elements : ndarray, shape (n,)
    layers : tuple of Layer
        From the bottom to the top; one for a region without layers.
    layered : bool
        Whether it was given in layers, which stretch across the thickness each by itself.
    levels : int
        Gauss points through the thickness of each layer.
    at_points, at_nodes : ndarray, shape (n, p, layers) and (n, 8, layers)
        Thickness of each layer at the integration points and at the nodes of the elements, m.
    offset_at_points, offset_at_nodes : ndarray, shape (n, p) and (n, 8)
        Of the mesh from the mid-plane, along the normal, m.
    remanence : ndarray, shape (n, p, layers, 3)
        At the integration points, T.
    """

    name: str
    elements: IntArray
    layers: tuple[Layer, ...]
    layered: bool
    levels: int
    at_points: FloatArray
    at_nodes: FloatArray
    offset_at_points: FloatArray
    offset_at_nodes: FloatArray
    remanence: FloatArray


class Heights(NamedTuple):
    """The arrays of a `Part` that its thickness gives."""

    at_points: FloatArray
    at_nodes: FloatArray
    offset_at_points: FloatArray
    offset_at_nodes: FloatArray


class Draft(NamedTuple):
    """A part before its arrays are made; `where` names it in messages."""

    name: str
    where: str
    elements: IntArray
    layers: tuple[Layer, ...]
    layered: bool
    levels: int
    offset: str | float


class Made(Protocol):
    """What a shell must offer here."""

    @property
    def mesh(self) -> Mesh: ...
    @property
    def thickness(self) -> float | Thickness | None: ...
    @property
    def material(self) -> Any: ...
    @property
    def remanence(self) -> Remanence: ...
    @property
    def density(self) -> float | None: ...
    @property
    def layers(self) -> Sequence[Layer]: ...
    @property
    def offset(self) -> str | float: ...
    @property
    def levels(self) -> int: ...
    @property
    def regions(self) -> Sequence[Region]: ...
    @property
    def element(self) -> ElementType: ...
    @property
    def micro_rotation(self) -> bool: ...


def drafts_of(shell: Made) -> list[Draft]:
    """The parts of a shell without their arrays: first the elements in no region, if there are any.

    Raises
    ------
    InputError
        Regions that overlap or have no elements; something missing; values out of their range.
    """
    _check_layers("shell", shell.layers, shell.thickness, shell.material, None)
    if shell.layers and shell.remanence is not NO_REMANENCE:
        raise InputError("shell: remanence is given beside layers; each layer has its own")
    given = {"thickness": shell.thickness, "material": shell.material}
    missing = [] if shell.layers else [what for what, value in given.items() if value is None]
    found, owner = [], np.full(len(shell.mesh.elements), -1)
    names = [_name(number, region.group) for number, region in enumerate(shell.regions)]
    for number, region in enumerate(shell.regions):
        where = f"regions[{number}]"
        if isinstance(region.group, str) or names[number] != where:
            where += f" ('{names[number]}')"
        members = _members(shell.mesh, where, region.group)
        taken = members[owner[members] >= 0]
        if taken.size:
            raise InputError(
                f"{where}: element {taken[0]} is already in the region '{names[owner[taken[0]]]}'; "
                "an element has one region only"
            )
        owner[members] = number
        found.append(_draft(shell, region, names[number], where, members))
    left = np.flatnonzero(owner < 0)
    if left.size and missing:
        if not shell.regions or len(missing) == 1:
            raise InputError(f"shell: {missing[0]} is missing" + _of_regions(left, names))
        raise InputError(
            f"shell: element {left[0]} is in none of the regions ({', '.join(names)}); put it into one, or give the "
            f"shell a thickness and a material, for all that are in none ({left.size} elements)"
        )
    if left.size:
        found.insert(0, _draft(shell, None, REST, "shell", left))
    return found


def heights_of(shell: Made, drafts: Sequence[Draft]) -> list[Heights]:
    """Thickness of the layers of each draft, and where the mesh lies.

    Raises
    ------
    InputError
        Thickness that is not finite or not positive in an element.
    """
    coordinates = shell.mesh.points[shell.mesh.elements]
    varying = any(callable(layer.thickness) for draft in drafts for layer in draft.layers)
    count = shell.element.integration(coordinates)[1].shape[1]
    positions = _positions(shell) if varying else np.zeros((0, count, 3))
    sampled = [_Sampled(shell.mesh, at, drafts, lambda layer: layer.thickness) for at in (positions, coordinates)]
    found = []
    for draft in drafts:
        heights = [_heights(draft, one) for one in sampled]
        if varying:
            _check_heights(shell.mesh, draft, heights)
        found.append(Heights(*heights, *(_offset(draft.offset, height.sum(axis=-1)) for height in heights)))
    return found


def completed_drafts(drafts: Sequence[Draft], heights: Sequence[Heights], micro_rotation: bool) -> list[Draft]:
    """The drafts with what their materials leave to the thickness; of one that varies it is the mean.

    The mean is that of all elements whose layers have the same thickness, so that it does not matter how they are
    divided into regions.
    """
    of_make: dict[tuple[Any, ...], list[FloatArray]] = {}
    for draft, height in zip(drafts, heights, strict=True):
        of_make.setdefault(_make(draft), []).append(height.at_points.sum(axis=2).ravel())
    found = []
    for draft in drafts:
        known = [layer.thickness for layer in draft.layers if not callable(layer.thickness)]
        varies = len(known) < len(draft.layers)
        whole = float(np.sort(np.concatenate(of_make[_make(draft)])).mean()) if varies else sum(known)
        made = [replace(one, material=completed(one.material, whole, micro_rotation)) for one in draft.layers]
        found.append(draft._replace(layers=tuple(made)))
    return found


def _make(draft: Draft) -> tuple[Any, ...]:
    return tuple(layer.thickness for layer in draft.layers)


def parts_of(shell: Made, drafts: Sequence[Draft], heights: Sequence[Heights]) -> tuple[Part, ...]:
    """The drafts with all their arrays.

    Raises
    ------
    InputError
        Remanence that is not finite in an element.
    """
    sampled = _Sampled(shell.mesh, _positions(shell), drafts, lambda layer: layer.remanence)
    parts = []
    for draft, height in zip(drafts, heights, strict=True):
        remanence = np.zeros((*height.at_points.shape, 3))
        for number, layer in enumerate(draft.layers):
            if layer.remanence is not NO_REMANENCE:
                remanence[:, :, number] = sampled.of(layer.remanence, draft.elements)
        _check_remanence(draft, remanence)
        made = draft.name, draft.elements, draft.layers, draft.layered, draft.levels
        parts.append(Part(*made, *height, remanence))
    return tuple(parts)


def _positions(shell: Made) -> FloatArray:
    """Integration points (elements, p, 3), m."""
    coordinates = shell.mesh.points[shell.mesh.elements]
    points, _ = shell.element.integration(coordinates)
    functions = shell.element.functions(8, points, coordinates).values
    return np.asarray(np.einsum("epn,enx->epx", functions, coordinates))


def _heights(draft: Draft, sampled: _Sampled) -> FloatArray:
    """Thickness of each layer (n, places, layers)."""
    heights = np.empty((len(draft.elements), sampled.count, len(draft.layers)))
    for number, layer in enumerate(draft.layers):
        if callable(layer.thickness):
            heights[..., number] = sampled.of(layer.thickness, draft.elements)
        else:
            heights[..., number] = layer.thickness
    return heights


class _Sampled:
    """What callables of the layers give at places (elements, p, 3): each is asked once, for all that use it."""

    def __init__(self, mesh: Mesh, places: FloatArray, drafts: Sequence[Draft], what: Any) -> None:
        self._mesh, self._places, self._drafts, self._what = mesh, places, drafts, what
        self._known: dict[int, FloatArray] = {}
        self.count = places.shape[1]

    def of(self, sample: Any, elements: IntArray) -> FloatArray:
        """Values at the places of some elements."""
        if id(sample) not in self._known:
            users = [
                draft.elements for draft in self._drafts if any(self._what(layer) is sample for layer in draft.layers)
            ]
            members = np.concatenate(users)
            asked = self._places if len(members) == len(self._places) else only(members, self._places)
            self._known[id(sample)] = np.asarray(sample(self._mesh, asked), dtype=float)
        return self._known[id(sample)][elements]


def _of_regions(left: IntArray, names: Sequence[str]) -> str:
    return f"; element {left[0]} is in none of the regions ({', '.join(names)})" if names else ""


def _name(number: int, group: Group) -> str:
    if isinstance(group, str):
        return group
    if _are_names(group):
        names = [str(one) for one in group]
        return ", ".join(names) if len(names) < 4 else f"{names[0]}, {names[1]}, … {names[-1]}"
    return f"regions[{number}]"


def _are_names(group: Group) -> bool:
    """Whether it is a sequence of names."""
    return isinstance(group, Sequence) and bool(group) and all(isinstance(one, str) for one in group)


def _members(mesh: Mesh, where: str, group: Group) -> IntArray:
    try:
        if isinstance(group, str):
            return mesh.elements_of(group)
        if _are_names(group):
            return np.unique(np.concatenate([mesh.elements_of(str(one)) for one in group]))
    except InputError as error:
        raise InputError(f"{where}: {error}") from None
    numbers = np.asarray(group)
    if isinstance(group, Sequence) and not numbers.size:
        raise InputError(f"{where}: has no elements")
    if numbers.ndim != 1 or numbers.dtype.kind not in "iu":
        raise InputError(f"{where}: group is {group!r}; it must be an element group, several, or numbers of elements")
    if numbers.min() < 0 or numbers.max() >= len(mesh.elements):
        raise InputError(f"{where}: there is no element {numbers.max()}; the mesh has {len(mesh.elements)}")
    if len(np.unique(numbers)) != len(numbers):
        raise InputError(f"{where}: an element is listed twice")
    return np.sort(numbers).astype(np.int64)


def _draft(shell: Made, region: Region | None, name: str, where: str, members: IntArray) -> Draft:
    given = Region(group="") if region is None else region
    _check_layers(where, given.layers, given.thickness, given.material, given.remanence)
    density = shell.density if given.density is None else positive(f"{where}: density", given.density, "kg/m^3")
    layers = tuple(given.layers)
    if not layers and given.thickness is None and given.material is None and given.remanence is None:
        layers = tuple(shell.layers)
    layered = bool(layers)
    if not layers:
        thickness = shell.thickness if given.thickness is None else given.thickness
        material = shell.material if given.material is None else given.material
        for what, value in (("thickness", thickness), ("material", material)):
            if value is None:
                raise InputError(f"{where}: {what} is missing" + (", and the shell has layers" if shell.layers else ""))
        assert thickness is not None
        layers = (Layer(thickness, material, shell.remanence if given.remanence is None else given.remanence),)
    resolved = []
    for number, layer in enumerate(layers):
        at = f"{where}: layers[{number}]" if layered else where
        of_material = f"{at}: material" if layered or given.material is not None else "material"
        thickness = layer.thickness if callable(layer.thickness) else positive(f"{at}: thickness", layer.thickness, "m")
        own = density if layer.density is None else positive(f"{at}: density", layer.density, "kg/m^3")
        resolved.append(
            Layer(thickness, checked_material(of_material, layer.material, shell.micro_rotation), layer.remanence, own)
        )
    _check_size(where, resolved, shell.mesh.size)
    levels = _levels(where, shell.levels if given.levels is None else given.levels, len(resolved))
    offset = _checked_offset(where, shell.offset if given.offset is None else given.offset, shell.mesh.size)
    return Draft(name, where, members, tuple(resolved), layered, levels, offset)


def _check_layers(where: str, layers: Any, *others: Any) -> None:
    for name, value in zip(("thickness", "material", "remanence"), others, strict=True):
        if len(layers) and value is not None:
            raise InputError(f"{where}: {name} is given beside layers; each layer has its own")


def _check_size(where: str, layers: Sequence[Layer], size: float) -> None:
    thickness = sum(float(layer.thickness) for layer in layers if not callable(layer.thickness))
    if thickness > size:
        raise InputError(f"{where}: thickness is {thickness:g} m, larger than the body ({size:g} m); check the units")


def _levels(where: str, levels: Any, layers: int) -> int:
    least = 2 if layers == 1 else 1
    if isinstance(levels, bool) or not isinstance(levels, int | np.integer) or not least <= levels <= MOST_LEVELS:
        raise InputError(
            f"{where}: levels is {levels!r}; it must be a whole number from {least} to {MOST_LEVELS}"
            + (" (one level does not bend)" if levels == 1 else "")
        )
    return int(levels)


def _checked_offset(where: str, offset: Any, size: float) -> str | float:
    if isinstance(offset, str):
        if offset not in OFFSETS:
            raise InputError(f"{where}: offset is '{offset}'; or give a length. {suggest(offset, OFFSETS)}")
        return offset
    try:
        length = float(offset)
    except (TypeError, ValueError):
        raise InputError(f"{where}: offset is {offset!r}; it must be a length (m) or one of {OFFSETS}") from None
    if not abs(length) <= size:
        raise InputError(f"{where}: offset is {length:g} m, larger than the body ({size:g} m); check the units")
    return length


def _offset(offset: str | float, thickness: FloatArray) -> FloatArray:
    match offset:
        case "middle":
            return np.zeros(thickness.shape)
        case "top":
            return 0.5 * thickness
        case "bottom":
            return -0.5 * thickness
    return np.full(thickness.shape, float(offset))


def _check_heights(mesh: Mesh, draft: Draft, heights: Sequence[FloatArray]) -> None:
    """Thickness that varies is known only where it is asked for."""
    for height in heights:
        bad = ~(np.isfinite(height) & (height > 0.0))
        if bad.any():
            row, place, layer = (int(index) for index in np.argwhere(bad)[0])
            of_layer = f"layers[{layer}]: " if draft.layered else ""
            raise InputError(
                f"{draft.where}: {of_layer}thickness is {height[row, place, layer]:g} m in element "
                f"{draft.elements[row]}; it must be positive and finite"
            )
        too_thick = height.sum(axis=-1) > mesh.size
        if too_thick.any():
            row, place = (int(index) for index in np.argwhere(too_thick)[0])
            raise InputError(
                f"{draft.where}: thickness is {height[row, place].sum():g} m in element {draft.elements[row]}, larger "
                f"than the body ({mesh.size:g} m); check the units"
            )


def _check_remanence(draft: Draft, vectors: FloatArray) -> None:
    bad = np.atleast_2d(~np.isfinite(vectors).all(axis=(1, 3)))
    if bad.any():
        row, layer = (int(index) for index in np.argwhere(bad)[0])
        where = f"{draft.where}: layers[{layer}]: " if draft.layered else ""
        raise InputError(f"{where}remanence: it is not finite in element {draft.elements[row]}")
