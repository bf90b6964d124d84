"""The field at the levels of the deformed shell."""

from __future__ import annotations

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.own_field import Own, OwnField
from magshell.equations.term import FieldLost
from magshell.magnetics.fields import Field, FieldUnknown, MagnetField, Values
from magshell.magnetics.fields.own import own_multiplier
from magshell.magnetics.fields.sources import OUTSIDE
from magshell.magnetics.law import GRADIENTS
from magshell.model.course import Loading
from magshell.shell.body import Reference
from magshell.shell.positions import level_positions
from magshell.shell.section import LocalField
from magshell.shell.state import State
from magshell.wording import place


class FieldAtLevels:
    """A field, as the levels of a shell see it.

    Parameters
    ----------
    field : Field
    reference : Reference
    own : OwnField, optional
        What the body itself makes, where the field has that as a part.
    """

    def __init__(self, field: Field, reference: Reference, own: OwnField | None = None) -> None:
        self.field, self._reference, self.own = field, reference, own

    def at(self, state: State, loading: Loading, second: bool = True) -> LocalField:
        """Flux density and, where it varies, its derivatives; second ones are zero where they are not asked for.

        Raises
        ------
        FieldLost
            The field is not known at a level, a level is inside a magnet, or elements are too near to each other for
            the body's own field.
        """
        if self.field.is_uniform:
            return self._uniform(loading.flux_density)
        points = level_positions(self._reference, state)
        flat = points.reshape(-1, 3)
        try:
            values = self.field.at(loading.drives, flat, second)
        except FieldUnknown as unknown:
            raise FieldLost(self._nearest(points, unknown), str(unknown)) from None
        self._check_outside(loading.drives, flat)
        return self._with_own(shaped(values, points.shape[:3]), state, own_multiplier(self.field, loading.drives))

    def own_at(self, state: State, loading: Loading) -> FloatArray:
        """The body's own part of the flux density (elements, p, k, 3), T."""
        multiplier = own_multiplier(self.field, loading.drives)
        if self.own is None or not multiplier:
            return np.zeros((*self._reference.body.levels.shape, 3))
        return multiplier * self.own.at(state).flux_density

    def rate(self, state: State, loading: Loading, rate: Loading) -> LocalField:
        """Derivative of flux density and gradient along a rate of the loading, at fixed points."""
        if self.field.is_uniform:
            return self._uniform(rate.flux_density)
        points = level_positions(self._reference, state)
        values = self.field.rate(loading.drives, rate.drives, points.reshape(-1, 3))
        return self._with_own(shaped(values, points.shape[:3]), state, own_multiplier(self.field, rate.drives))

    def _with_own(self, field: LocalField, state: State, multiplier: float) -> LocalField:
        """A field with a multiple of the body's own."""
        return with_own(field, self.own.at(state) if self.own is not None and multiplier else None, multiplier)

    def half_energy(self, state: State, loading: Loading) -> FloatArray:
        """Half the energy (elements,) in the body's own field, J, which counts twice in that of the kernels."""
        multiplier = own_multiplier(self.field, loading.drives)
        if self.own is None or not multiplier:
            return np.zeros(len(self._reference.body.elements))
        return 0.5 * multiplier * self.own.energy(state)

    def _uniform(self, flux_density: FloatArray) -> LocalField:
        shape = self._reference.body.levels.shape
        return LocalField(np.array(np.broadcast_to(flux_density, (1, *shape[1:], 3)), order="C"), None)

    def _check_outside(self, drives: FloatArray, points: FloatArray) -> None:
        """Refuse a shell that penetrates a magnet."""
        for part, own in self.field.parts(drives):
            if isinstance(part, MagnetField):
                inside = np.flatnonzero(part.containing(own, points) != OUTSIDE)
                if inside.size:
                    element = int(inside[0]) // int(np.prod(self._reference.body.levels.shape[1:]))
                    where = place(points[inside[0]])
                    raise FieldLost(element, f"it is inside a magnet of {part.name}, at {where}")

    def _nearest(self, points: FloatArray, unknown: FieldUnknown) -> int | None:
        """Element with the level that is nearest to where the field is not known."""
        if unknown.position is None:
            return None
        away = np.linalg.norm(points - unknown.position, axis=-1)
        return int(np.argmin(np.nan_to_num(away, nan=np.inf).reshape(len(away), -1).min(axis=1)))


def with_own(field: LocalField, own: Own | None, multiplier: float) -> LocalField:
    """A field that varies with a multiple of the body's own, if there is any.

    Its second derivatives are left out, as is all else that the tangent does not know of how it follows the body.
    """
    if own is None:
        return field
    assert field.slopes is not None
    slopes = field.slopes.copy()
    slopes[..., :9] += multiplier * own.gradient
    return LocalField(field.flux_density + multiplier * own.flux_density, slopes)


def shaped(values: Values, shape: tuple[int, ...]) -> LocalField:
    """Values at the levels (elements, p, k) of a shell, as kernels take them."""
    count = len(values.flux_density)
    slopes = np.zeros((count, GRADIENTS))
    slopes[:, :9] = values.gradient.reshape(count, 9)
    if values.second is not None:
        slopes[:, 9:] = values.second.reshape(count, 27)
    return LocalField(np.array(values.flux_density, order="C").reshape(*shape, 3), slopes.reshape(*shape, GRADIENTS))
