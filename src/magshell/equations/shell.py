"""The shell as a term of the equations: its elements, with their own parameters condensed."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from magshell.arrays import AnyArray, FloatArray, IntArray
from magshell.equations.insertion import (
    Destination,
    Elements,
    Insertion,
    Sums,
    add_forces,
    add_matrices,
    destination,
)
from magshell.equations.instant import Increment, Instant, Prediction, Weights
from magshell.equations.numbering import Numbering
from magshell.equations.term import Contribution, InvertedElement
from magshell.model.course import Loading
from magshell.model.supports import Constraints
from magshell.shell import loops
from magshell.shell.body import Reference
from magshell.shell.element import padded
from magshell.shell.geometry import unit_forces
from magshell.shell.section import Request
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS, COMPONENTS

ROUND_OFF = 8.0 * np.finfo(float).eps
# Elements whose matrices are made before they are inserted: they stay in the processor's cache.
BATCH = 32


class ShellTerm:
    """Elastic and magnetic forces of a shell.

    Parameters
    ----------
    reference : Reference
    nodes : int
        Of the mesh.
    stiffest : ndarray, shape (elements, levels)
        Largest modulus of the material, Pa.
    """

    def __init__(self, reference: Reference, nodes: int, stiffest: FloatArray) -> None:
        self.body, self._nodes = reference.body, nodes
        layout, count = self.body.layout, len(self.body.elements)
        carrying = [layout.u] * 3 + [layout.w] * 3 + [layout.phi] + [layout.q] * 3
        node = np.concatenate([np.arange(number) for number in carrying])
        self.elements = Elements(self.body.elements, node, np.repeat(np.arange(COMPONENTS), carrying))
        values, inner = node.size, 3 * layout.modes
        batch = min(BATCH, count)
        self._filled = loops.Filled(
            K=np.zeros((batch, values + inner, padded(values + inner))),
            r=np.zeros((batch, values + inner, 2)),
            gain=np.zeros((count, inner, values)),
            offset=np.zeros((count, inner)),
            energy=np.zeros((count, 2)),
            scale=np.zeros((len(COLUMNS), 2)),
            enhancement_residual=np.zeros(1),
        )
        shape = self.body.levels.shape
        self._unstressed = loops.Stresses(np.zeros((*shape, 3, 3)), np.zeros((*shape[:2], 2, 3)))
        self._noise = ROUND_OFF * unit_forces(reference.geometry, reference.shape, stiffest[:, None])
        self._no_matrix, self._free = np.zeros(0), np.zeros((nodes, COMPONENTS))

    def place(self, numbering: Numbering, constraints: Constraints) -> None:
        """Tell the term where its values go."""
        self._to: Destination = destination(self.elements, numbering, constraints)
        spins = numbering.number[:, COLUMNS["omega"]]
        self._transported: AnyArray = np.sum(spins < 0, axis=1) == 1

    def couplings(self) -> Sequence[IntArray]:
        """See `Term`."""
        return [self.body.elements]

    def evaluate(
        self, instant: Instant, weights: Weights, insertion: Insertion | None, imposed: FloatArray | None
    ) -> Contribution:
        """See `Term`."""
        filled, tangent = self._filled, insertion is not None
        filled.scale[:], filled.enhancement_residual[:] = 0.0, 0.0
        data = self._no_matrix if insertion is None else insertion.data
        sums = Sums(data, np.zeros((self._nodes, COMPONENTS)), np.zeros((self._nodes, COMPONENTS)))
        given = self._free if imposed is None else imposed
        mixed = instant.prediction is not None
        request = Request(instant.loading.flux_density, mixed, tangent)
        stresses = self._unstressed if instant.prediction is None else instant.prediction
        for first in range(0, len(self.body.elements), len(filled.K)):
            element, determinant = loops.fill(
                self.body, instant.state, stresses, request, self._transported, first, filled
            )
            if element >= 0:
                raise InvertedElement(element, determinant)
            add_forces(self._to, first, filled.r, sums)
            if tangent:
                add_matrices(self._to, first, filled.K, weights.displacement, given, sums)
        scale, inner = filled.scale.sum(axis=1), float(np.sqrt(filled.enhancement_residual[0]))
        return Contribution(sums.residual, sums.condensed, scale, inner)

    def energy(self, instant: Instant) -> FloatArray:
        """Elastic and magnetic energy of each element (elements, 2), J."""
        self.evaluate(instant, Weights(1.0, 0.0, 0.0), None, None)
        return self._filled.energy.copy()

    def load_rate(self, instant: Instant, rate: Loading) -> FloatArray:
        """See `Term`. Residuals are linear in the flux density."""
        if not np.any(rate.flux_density):
            return np.zeros((self._nodes, COMPONENTS))
        loading = instant.loading
        ahead = loading._replace(flux_density=loading.flux_density + rate.flux_density)
        static = Weights(1.0, 0.0, 0.0)
        after, now = (
            self.evaluate(Instant(instant.state, one), static, None, None).residual for one in (ahead, loading)
        )
        return np.asarray(after - now)

    def predict(self, state: State, increment: Increment) -> Prediction:
        """See `Term`. Where φ is eliminated at the points, stresses cannot be predicted from nodal values."""
        if self.body.plane_stress:
            return None
        shape = self.body.levels.shape
        stresses = loops.Stresses(np.empty((*shape, 3, 3)), np.empty((*shape[:2], 2, 3)))
        loops.predict_stresses(self.body, state, increment.nodal, increment.alpha, stresses)
        return stresses

    def recovered(self, nodal: FloatArray, whole: bool) -> FloatArray:
        """See `Term`."""
        filled, layout = self._filled, self.body.layout
        d_alpha = np.empty((len(self.body.elements), layout.modes, 3))
        offset = filled.offset if whole else np.zeros_like(filled.offset)
        loops.recover_enhancement(self.body.elements, layout, nodal, filled.gain, offset, d_alpha)
        return d_alpha

    def noise(self) -> FloatArray:
        """See `Term`."""
        return self._noise
