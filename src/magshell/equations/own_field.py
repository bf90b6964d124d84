r"""The field that the body's own remanence makes at the body.

Every level is a dipole m = M V, with the magnetisation M of its coupling law and the volume V of the level, in its
deformed position; rigid bodies with a magnetic moment are dipoles too. A level gets the field of all other elements
and of the rigid bodies that its element does not touch, B_own and ∇B_own. The energy

    W = -½ Σ m · B_own

has the factor ½, for each pair counts once. Forces and torques are those of B_own as of any other field: of a pair, one
half of what they do is the change of the other's field. The law of a level is asked for M by the force that it makes of
the gradient ∂B_i/∂x_j = δ_ij, which is M itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.equations.magnets import Magnets
from magshell.equations.term import FieldLost
from magshell.errors import InputError
from magshell.magnetics.dipole_sums import COMPONENTS, Groups, add_fields
from magshell.magnetics.law import GRADIENTS, Coupling, X, evaluate, is_conservative
from magshell.shell.body import Reference
from magshell.shell.deformed import evaluate as evaluate_points
from magshell.shell.deformed import level_stretch, of_couplings
from magshell.shell.elements import ElementType
from magshell.shell.positions import level_positions
from magshell.shell.samples import samples
from magshell.shell.section import LocalField
from magshell.shell.state import State
from magshell.wording import place

SYMMETRIC = np.array([0, 1, 2, 1, 3, 4, 2, 4, 5])
"""Of the nine ∂B_i/∂x_j, which of the six different ones each is."""
FEW, MANY = 1, 2
"""Cells along each side of an element."""


class Own(NamedTuple):
    """The body's own field.

    Attributes
    ----------
    flux_density, gradient : ndarray, shape (elements, p, k, 3) and (elements, p, k, 9)
        At the levels, T and T/m.
    at_magnets, slopes_at_magnets : ndarray, shape (n, 3) and (n, 3, 3)
        At the moments of rigid bodies.
    """

    flux_density: FloatArray
    gradient: FloatArray
    at_magnets: FloatArray
    slopes_at_magnets: FloatArray


class OwnField:
    """What the body's remanence makes at the body.

    Parameters
    ----------
    reference : Reference
    couplings : sequence of Coupling
        By the numbers that the levels have.
    element : ElementType
    nodes : ndarray, shape (elements, 8)
        Of the mesh.
    magnets : Magnets

    Raises
    ------
    InputError
        A coupling law exerts no force where the field varies, so that its magnetisation is not known.
    """

    def __init__(
        self,
        reference: Reference,
        couplings: Sequence[Coupling],
        element: ElementType,
        nodes: IntArray,
        magnets: Magnets,
    ) -> None:
        self._reference, self._couplings, self._nodes, self._magnets = reference, couplings, nodes, magnets
        few, many = (samples(element, reference.coordinates, cells) for cells in (FEW, MANY))
        self._few, self._many = few, many
        corners = reference.coordinates[:, :4]
        none = np.zeros(len(magnets))
        sizes = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=3).max(axis=(1, 2))
        point = reference.body.points
        normals = np.cross(point["A"][:, :, 0], point["A"][:, :, 1])
        _, weights = element.integration(reference.coordinates)
        areas = np.sum(weights * np.linalg.norm(normals, axis=2), axis=1)
        self._sizes, self._widths = np.concatenate([sizes, none]), np.concatenate([areas / sizes, none])
        for coupling in couplings:
            if not np.any(_magnetisation(coupling)):
                raise InputError(
                    f"self_field: the coupling law {type(coupling).__name__} exerts no force where the field varies, "
                    "so its magnetisation is not known; add the force to its rows X, as `pull` does"
                )
        self._last: tuple[State, Own, FloatArray] | None = None

    def at(self, state: State) -> Own:
        """The field in a state, at multiplier 1.

        Raises
        ------
        FieldLost
            Parts of the body come so near to each other that their field is not resolved.
        """
        return self._of(state)[1]

    def _of(self, state: State) -> tuple[State, Own, FloatArray]:
        """A state, its field and moments, kept for the next who asks; other threads may ask for other states."""
        last = self._last
        if last is None or last[0] is not state:
            moments = self.moments(state)
            last = self._last = state, self._summed(state, moments), moments
        return last

    def change(self, state: State, moved: State, size: float) -> Own:
        """How it differs in a state near by, over a size: ∇B at the levels and magnets that move, B where they were.

        What B changes by as they move, ∇B δx, is part of the tangent.
        """
        here, there = self.at(state), self._summed(moved, self.moments(moved))
        change = Own(*((new - old) / size for old, new in zip(here, there, strict=True)))
        levels = (level_positions(self._reference, moved) - level_positions(self._reference, state)) / size
        magnets = (self._magnets.positions(moved) - self._magnets.positions(state)) / size
        slopes = here.gradient.reshape(*levels.shape, 3)
        return change._replace(
            flux_density=change.flux_density - np.einsum("epkij,epkj->epki", slopes, levels),
            at_magnets=change.at_magnets - np.einsum("nij,nj->ni", here.slopes_at_magnets, magnets),
        )

    def energy(self, state: State) -> FloatArray:
        """-Σ m · B_own (elements,) of the levels whose law has an energy, J: twice the energy of their pairs."""
        made = self._reference.body.levels["coupling"]
        counts = np.array([is_conservative(coupling) for coupling in self._couplings])[made]
        _, own, moments = self._of(state)
        work = np.sum(moments * own.flux_density, axis=-1)
        return -np.sum(work * counts, axis=(1, 2))

    def moments(self, state: State) -> FloatArray:
        """Magnetic moments (elements, p, k, 3) of the levels, A m².

        Stretches that levels have of their own are those without a field.
        """
        reference = self._reference
        shape = reference.body.levels.shape
        slopes = np.zeros((*shape, GRADIENTS))
        slopes[..., [0, 4, 8]] = 1.0
        B = np.zeros((1, *shape[1:], 3))
        fields = evaluate_points(reference, state, level_stretch(reference, state, LocalField(B, None)))
        forces = of_couplings(reference, self._couplings, fields, LocalField(B, slopes))
        return np.asarray(-forces[..., X : X + 3] * reference.body.levels["volume"][..., None])

    def _summed(self, state: State, moments: FloatArray) -> Own:
        groups = self._groups(state, level_positions(self._reference, state), moments)
        at_few, at_many = (np.zeros((*x.shape[:2], COMPONENTS)) for x in (groups.few, groups.many))
        if np.isfinite(groups.centres).all():
            one, other = add_fields(groups, at_few, at_many)
            if one >= 0:
                raise self._too_near(groups, one, other)
        count = len(moments)
        summed, forces = np.zeros((*moments.shape[:3], COMPONENTS)), np.zeros_like(moments)
        sets = ((self._few, at_few, groups.few_moments), (self._many, at_many, groups.many_moments))
        for finer, field, m in sets:
            at = field[:count].reshape(count, -1, moments.shape[2], COMPONENTS)
            summed += np.einsum("eap,eakc->epkc", finer.moments, at)
            slopes = at[..., 3 + SYMMETRIC].reshape(*at.shape[:3], 3, 3)
            force = np.einsum("eaki,eakij->eakj", m[:count].reshape(*at.shape[:3], 3), slopes)
            forces += np.einsum("eap,eakj->epkj", finer.places, force)
        magnets = at_few[count:].mean(axis=1) + at_many[count:].mean(axis=1)
        return Own(
            summed[..., :3].copy(),
            _exerting(forces, moments, summed[..., 3 + SYMMETRIC]),
            magnets[:, :3].copy(),
            magnets[:, 3 + SYMMETRIC].reshape(-1, 3, 3),
        )

    def _groups(self, state: State, positions: FloatArray, moments: FloatArray) -> Groups:
        magnets, turned = self._magnets.positions(state)[:, None], self._magnets.turned(state)[:, None]
        found = []
        for finer in (self._few, self._many):
            count = finer.places.shape[1] * positions.shape[2]
            x = np.einsum("eap,epkx->eakx", finer.places, positions).reshape(len(positions), count, 3)
            m = np.einsum("eap,epkx->eakx", finer.moments, moments).reshape(len(positions), count, 3)
            found.append(np.concatenate([x, np.repeat(magnets, count, axis=1)]))
            found.append(np.concatenate([m, np.repeat(turned / count, count, axis=1)]))
        return Groups(
            few=found[0],
            many=found[2],
            few_moments=found[1],
            many_moments=found[3],
            centres=found[0].mean(axis=1),
            sizes=self._sizes,
            widths=self._widths,
            nodes=self._nodes,
            excluded=self._magnets.on_elements,
        )

    def _too_near(self, groups: Groups, one: int, other: int) -> FieldLost:
        elements = len(self._nodes)
        what = f"element {other}" if other < elements else "another rigid body"
        mine = "it" if one < elements else "a rigid body with a magnetic moment"
        return FieldLost(
            one if one < elements else None,
            f"{mine}, at {place(groups.centres[one])}, comes so near to {what} that their field on each other is not "
            "resolved; smaller elements resolve it, unless they pass through each other",
        )


def _exerting(forces: FloatArray, moments: FloatArray, slopes: FloatArray) -> FloatArray:
    """Slopes (..., 9) with which the moments get given forces; those that they have nearly do that.

    Where the moment varies in an element, the force on its finer dipoles is shared among the levels by the functions
    that put the dipoles between them: only then it is the derivative of the energy.
    """
    gradient = slopes.reshape(*moments.shape, 3)
    missing = forces - np.einsum("...i,...ij->...j", moments, gradient)
    square = np.sum(moments**2, axis=-1, keepdims=True)
    along = np.divide(moments, square, out=np.zeros_like(moments), where=square > 0.0)
    return np.asarray((gradient + along[..., :, None] * missing[..., None, :]).reshape(slopes.shape))


def _magnetisation(coupling: Coupling) -> FloatArray:
    """Of a law for m = n = (1, 0, 0) T."""
    along = np.array([[1.0, 0.0, 0.0]])
    gradient = np.zeros((1, GRADIENTS))
    gradient[0, [0, 4, 8]] = 1.0
    return -evaluate(coupling, along, along, np.zeros(3), gradient)[1][..., X : X + 3]
