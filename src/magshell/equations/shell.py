"""The shell as a term of the equations: its elements, with their own parameters condensed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.equations.frames import to_frames, to_global
from magshell.equations.insertion import Insertion, destination, summed
from magshell.equations.instant import STATIC, Increment, Instant, Prediction, Weights
from magshell.equations.local_field import FieldAtLevels, with_own
from magshell.equations.numbering import Numbering
from magshell.equations.own_field import Own
from magshell.equations.scatter import Destination, Elements, add_matrices, turn_matrices
from magshell.equations.term import Contribution, InvertedElement
from magshell.magnetics.law import GRADIENTS
from magshell.model.constraints import Constraints
from magshell.model.course import Loading
from magshell.model.model import NO_FIELD
from magshell.shell import loops
from magshell.shell.body import Reference
from magshell.shell.element import padded
from magshell.shell.geometry import unit_forces
from magshell.shell.point import MAGNETIC
from magshell.shell.section import LocalField, Request
from magshell.shell.unknowns import COLUMNS, COMPONENTS

ROUND_OFF = 8.0 * np.finfo(float).eps
# Elements whose matrices are made before they are inserted: they stay in the processor's cache.
BATCH = 32
# Steps and weights of differences: exact for what is linear, and of fourth order.
FORWARD = ((1.0, 1.0), (0.0, -1.0))
CENTRAL = tuple((k / 64.0, 64.0 * weight / 12.0) for k, weight in ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0)))


class ShellTerm:
    """Elastic and magnetic forces of a shell.

    Parameters
    ----------
    reference : Reference
    nodes : int
        Of the mesh.
    stiffest : ndarray, shape (elements, levels)
        Largest modulus of the material, Pa.
    field : FieldAtLevels, optional
        By default none.
    """

    def __init__(
        self, reference: Reference, nodes: int, stiffest: FloatArray, field: FieldAtLevels | None = None
    ) -> None:
        self.body, self._nodes = reference.body, nodes
        self.field = FieldAtLevels(NO_FIELD, reference) if field is None else field
        layout, count = self.body.layout, len(self.body.elements)
        carrying = [layout.u] * 3 + [layout.w] * 3 + [layout.phi] + [layout.q] * 3 + [layout.s]
        node = np.concatenate([np.arange(number) for number in carrying])
        self.elements = Elements(self.body.elements, node, np.repeat(np.arange(COMPONENTS), carrying))
        values, inner = node.size, 3 * layout.modes
        batch, most = min(BATCH, count), max(values, layout.nodal + inner)
        self._filled = loops.Filled(
            K=np.zeros((batch, most, padded(most))),
            r=np.zeros((2, count, values)),
            gain=np.zeros((count, inner, values)),
            offset=np.zeros((count, inner)),
            energy=np.zeros((count, 2)),
            scale=np.zeros((len(COLUMNS), 2)),
            enhancement_residual=np.zeros(1),
        )
        shape = self.body.levels.shape
        self._unstressed = loops.Stresses(np.zeros((*shape, 3, 3)), np.zeros((*shape[:2], 2, 3)))
        self._noise = ROUND_OFF * unit_forces(reference.geometry, reference.shape, stiffest[:, None])

    def place(self, numbering: Numbering, constraints: Constraints) -> None:
        """Tell the term where its values go."""
        self._to: Destination = destination(self.elements, numbering)
        self._constraints = constraints
        self._transported: AnyArray = numbering.partly_held

    def couplings(self) -> Sequence[IntArray]:
        """See `Term`."""
        return [self.body.elements]

    def evaluate(
        self, instant: Instant, weights: Weights, insertion: Insertion | None, imposed: FloatArray | None
    ) -> Contribution:
        """See `Term`."""
        field = self.field.at(instant.state, instant.loading, second=insertion is not None)
        found = self._evaluate(instant, field, weights, insertion, imposed)
        assert found.energy is not None
        found.energy[:, MAGNETIC] -= self.field.half_energy(instant.state, instant.loading)
        return found

    def _evaluate(
        self,
        instant: Instant,
        field: LocalField,
        weights: Weights,
        insertion: Insertion | None,
        imposed: FloatArray | None,
    ) -> Contribution:
        """The same in a given field."""
        tangent = insertion is not None
        filled = self._filled if tangent else self._apart()
        filled.scale[:], filled.enhancement_residual[:] = 0.0, 0.0
        mixed = instant.prediction is not None
        request = Request(self.body.laws, field, mixed, tangent)
        stresses = self._unstressed if instant.prediction is None else instant.prediction
        for first in range(0, len(self.body.elements), len(filled.K)):
            element, determinant = loops.fill(
                self.body, instant.state, stresses, request, self._transported, first, filled
            )
            if element >= 0:
                raise InvertedElement(element, determinant)
            if insertion is not None:
                self._insert(first, weights, insertion, imposed)
        residual = self._at_nodes(filled.r[0])
        condensed = self._at_nodes(filled.r[1]) if tangent else residual
        scale, inner = filled.scale.sum(axis=1), float(np.sqrt(filled.enhancement_residual[0]))
        return Contribution(residual, condensed, scale, inner, filled.energy.copy() if tangent else filled.energy)

    def _apart(self) -> loops.Filled:
        """Arrays for a residual alone: it can be evaluated while another thread makes tangents of the same term."""
        kept = self._filled
        made = {name: np.zeros_like(getattr(kept, name)) for name in ("K", "energy", "scale", "enhancement_residual")}
        return kept._replace(r=np.zeros_like(kept.r[:1]), **made)

    def _at_nodes(self, forces: FloatArray) -> FloatArray:
        """Forces (elements, values), summed at the nodes, in their frames."""
        return to_frames(self._constraints, summed(self._to, forces, self._nodes))

    def _insert(self, first: int, weights: Weights, insertion: Insertion, imposed: FloatArray | None) -> None:
        """Put the matrices of elements from `first` on into the tangent, and their products with what is imposed."""
        K, constraints, values = self._filled.K, self._constraints, self.elements.node.size
        some = slice(first, first + len(K))
        if imposed is not None:
            given = to_global(constraints, imposed).ravel()[self._to.entry[some]]
            K_given = np.einsum("ekl,ek->el", K[: len(given), :values, :values], given)
            self._filled.r[1, some] += weights.displacement * K_given
        if len(constraints.frames):
            turn_matrices(self._to, first, K, constraints.frame_of, constraints.frames)
        add_matrices(self._to, first, K, weights.displacement, insertion.data)

    def energy(self, instant: Instant) -> FloatArray:
        """Elastic and magnetic energy of each element (elements, 2), J."""
        energy = self.evaluate(instant, STATIC, None, None).energy
        assert energy is not None
        return energy

    def load_rate(self, instant: Instant, rate: Loading) -> FloatArray:
        """See `Term`. Residuals are linear in the field, unless levels have stretches that follow it."""
        if not np.any(rate.drives):
            return np.zeros((self._nodes, COMPONENTS))
        along = self.field.rate(instant.state, instant.loading, rate)
        still, change = Instant(instant.state, instant.loading), np.zeros((self._nodes, COMPONENTS))
        now = self.field.at(instant.state, instant.loading, second=False)
        for step, weight in FORWARD if self.body.by_level is None else CENTRAL:
            there = LocalField(
                now.flux_density + step * along.flux_density,
                None if now.slopes is None or along.slopes is None else now.slopes + step * along.slopes,
            )
            change += weight * self._evaluate(still, there, STATIC, None, None).residual
        return change

    def own_rate(self, instant: Instant, change: Own, multiplier: float) -> FloatArray:
        """Derivative of the residual (nodes, 11) along a multiple of a change of the body's own field."""
        shape, still = self.body.levels.shape, Instant(instant.state, instant.loading)
        nothing = LocalField(np.zeros((*shape, 3)), np.zeros((*shape, GRADIENTS)))
        fields = with_own(nothing, change, multiplier), nothing
        whole, rest = (self._evaluate(still, field, STATIC, None, None).residual for field in fields)
        return whole - rest

    def predict(self, instant: Instant, increment: Increment) -> Prediction:
        """See `Term`."""
        shape = self.body.levels.shape
        stresses = loops.Stresses(np.zeros((*shape, 3, 3)), np.zeros((*shape[:2], 2, 3)))
        loops.predict_stresses(
            self.body, instant.state, self._seen(instant), increment.nodal, increment.alpha, stresses
        )
        return stresses

    def _seen(self, instant: Instant) -> FloatArray:
        """Flux density (elements, p, k, 3) that stretches of levels follow; anything where there are none."""
        if self.body.by_level is None:
            return np.zeros((1, *self.body.levels.shape[1:], 3))
        return self.field.at(instant.state, instant.loading, second=False).flux_density

    def recovered(self, nodal: FloatArray, whole: bool) -> FloatArray:
        """See `Term`. Δα = -offset - gain Δv."""
        filled, modes = self._filled, self.body.layout.modes
        d_alpha = np.einsum("eal,el->ea", filled.gain, nodal.ravel()[self._to.entry])
        if whole:
            d_alpha += filled.offset
        return -np.ascontiguousarray(np.swapaxes(d_alpha.reshape(len(d_alpha), 3, modes), 1, 2))

    def noise(self) -> FloatArray:
        """See `Term`."""
        return self._noise
