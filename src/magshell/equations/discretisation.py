"""From the model to equations: the sum of their terms, as the solver sees it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import reduce
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray
from magshell.equations.dependence import Dependence
from magshell.equations.dipoles import DipoleTerm
from magshell.equations.frames import to_frames, to_global
from magshell.equations.insertion import Insertion
from magshell.equations.instant import STATIC, Increment, Instant, Prediction
from magshell.equations.loads import LoadTerm
from magshell.equations.local_field import FieldAtLevels
from magshell.equations.magnets import Magnets
from magshell.equations.numbering import Numbering, Ordering
from magshell.equations.own_field import OwnField
from magshell.equations.shell import ShellTerm
from magshell.equations.springs import SpringTerm
from magshell.equations.term import Term, squares_by_kind
from magshell.magnetics.fields.own import has_own, own_multiplier
from magshell.model.course import Loading
from magshell.model.hinge_springs import hinge_springs
from magshell.model.model import Model
from magshell.model.reference import make_of, reference_of_model, stiffest_of
from magshell.openblas import allocate_buffers
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS, COMPONENTS, UNKNOWNS
from magshell.wording import place

KINDS = (*COLUMNS, "alpha")
# Largest change of an unknown, in its unit, over which the body's own field is differentiated.
DIFFERENCE = 1e-6


class Assembly(NamedTuple):
    """Residual and tangent at an instant.

    Attributes
    ----------
    matrix : csc_array or None
        Condensed tangent of the free unknowns; the next assembly overwrites its values.
    right_side : ndarray, shape (dofs,)
        Minus the condensed residual and the imposed increments' share.
    residual : ndarray, shape (rows, 11)
        Internal minus external forces in the nodes' frames; at held components the reactions. What rows share is in
        that of the mesh node.
    relative : dict of str to float
        Residual by kind of unknown over the elements' internal and magnetic forces and the loads of that kind.
    energy : ndarray, shape (elements, 2)
        Elastic and magnetic, J.
    """

    matrix: sp.csc_array | None
    right_side: FloatArray
    residual: FloatArray
    relative: dict[str, float]
    energy: FloatArray

    @property
    def worst(self) -> tuple[str, float]:
        """Kind with the largest relative residual, and that."""
        return max(self.relative.items(), key=lambda item: item[1])


class Discretisation:
    """The model's equations, a sum of terms.

    Parameters
    ----------
    model : Model
    ordering : callable
        From the node graph (nodes, nodes) to the nodes' elimination order.

    Attributes
    ----------
    model : Model
    mesh : Mesh
    dofs : int
        Free unknowns.
    shell : ShellTerm
    loads : LoadTerm
    springs, hinges : SpringTerm
    dipoles : DipoleTerm
    terms : sequence of Term
        Those that there are.
    reference : Reference
        Arrays of the undeformed shell.
    materials, couplings : sequence of Material, sequence of Coupling
        Laws of the parts of the shell, by the numbers that its levels have.
    rows : Rows
        Of the nodal arrays: the nodes of the mesh first.
    carried, free : ndarray of bool, shape (rows, 11)
        Which unknowns there are, and which of them no support holds.
    """

    def __init__(self, model: Model, ordering: Ordering) -> None:
        allocate_buffers()
        self.model, self.mesh, self.rows = model, model.shell.mesh, model.rows
        make = make_of(model)
        self.reference, self.materials = reference_of_model(model, make), make.materials
        self.couplings = make.couplings
        magnets = Magnets(model.shell, self.rows)
        own = self._own_field(magnets)
        field = FieldAtLevels(model.field, self.reference, own)
        self.shell = ShellTerm(self.reference, len(self.rows.of), stiffest_of(make), field)
        self.loads = LoadTerm(model.applied, model.constraints)
        self.springs = SpringTerm(model.elastic, model.constraints)
        hinges = hinge_springs(model.shell, self.rows)
        self.hinges = SpringTerm(hinges, model.constraints)
        self.dipoles = DipoleTerm(magnets, model.field, own, model.constraints)
        nodal = (self.loads, self.springs, self.hinges, self.dipoles)
        users = (model.applied, model.elastic, hinges, self.dipoles.present)
        self._nodal = [term for term, some in zip(nodal, users, strict=True) if some]
        self.terms: Sequence[Term] = (self.shell, *self._nodal)
        self.carried = self.rows.carried
        self.free = self.carried & ~model.constraints.fixed
        cliques = [clique for term in self.terms for clique in term.couplings()]
        self.dependence = Dependence(self.rows)
        self._levers = self.dependence.levers(self.undeformed())
        self.numbering = Numbering(self.rows, self.free, cliques, ordering)
        self.dofs = self.numbering.dofs
        self._insertion = Insertion(self.numbering, model.constraints)
        self.shell.place(self.numbering, model.constraints)
        for term in nodal:
            term.place(self._insertion, self.dependence)
        self._noise = _sum(term.noise() for term in self.terms)

    def _own_field(self, magnets: Magnets) -> OwnField | None:
        """The body's own field, if it is a part of the field."""
        if not has_own(self.model.field):
            return None
        shell = self.model.shell
        return OwnField(self.reference, self.couplings, shell.element, shell.mesh.elements, magnets)

    @property
    def exact_tangent(self) -> bool:
        """Whether the tangent is the derivative of the residual; `left_out` is what is missing."""
        return self.shell.field.own is None

    def left_out(self, instant: Instant, increment: Increment) -> FloatArray:
        """Product (dofs,) of the derivative that the tangent has not, of the body's own field, with an increment.

        By a difference over a small part of the increment.
        """
        own, multiplier = self.shell.field.own, own_multiplier(self.model.field, instant.loading.drives)
        product, largest = np.zeros(self.dofs), self.largest(increment)[0]
        if own is None or not multiplier or not largest:
            return product
        size = DIFFERENCE / largest
        change = own.change(instant.state, self.moved(instant.state, size * increment), size)
        residual = self.shell.own_rate(instant, change, multiplier)
        if self.dipoles.present:
            residual += self.to_frames(self.dipoles.own_rate(instant, change, multiplier))
        product[self.numbering.equations] = self.rows.folded(residual)[self.free]
        return product

    @property
    def units(self) -> FloatArray:
        """Of the unknowns (dofs,): body lengths, directors, thickness ratios and radians."""
        units, found = np.empty(self.free.shape), np.empty(self.dofs)
        units[:] = [self._unit(column) for column in range(COMPONENTS)]
        found[self.numbering.equations] = units[self.free]
        return found

    @property
    def normals(self) -> FloatArray:
        """Unit normals (nodes, 3) of the undeformed mid-surface; `rows` has those of every sheet of a joint."""
        return self.model.normals

    def undeformed(self) -> State:
        """State of no deformation."""
        return State.undeformed(len(self.rows.of), len(self.mesh.elements), self.reference.body.layout.modes)

    def assemble(self, instant: Instant, imposed: FloatArray | None = None, tangent: bool = True) -> Assembly:
        """Residual and tangent at an instant.

        Parameters
        ----------
        instant : Instant
            Field and loads are those of its loading; what is held is the state's.
        imposed : ndarray, shape (nodes, 11), optional
            Increments of held components, in the nodes' frames, that the right side accounts for.
        tangent : bool
            Without it only the residual is made.

        Raises
        ------
        InvertedElement
            det F is not positive at a point of an element.
        FieldLost
            The field is not known at a point of an element.
        """
        insertion = self._insertion if tangent else None
        if insertion is not None:
            insertion.data[:] = 0.0
            self._levers = self.dependence.levers(instant.state)
        parts = [term.evaluate(instant, STATIC, insertion, imposed) for term in self.terms]
        residual = self.rows.folded(_sum(part.residual for part in parts))
        right_side = np.zeros(self.dofs)
        if tangent:
            condensed = self.rows.folded(_sum(part.condensed for part in parts))
            right_side[self.numbering.equations] = -condensed[self.free]
        squares = _sum(part.scale for part in parts)
        inner = max(part.inner for part in parts)
        matrix = self._insertion.tangent() if tangent else None
        energy = _sum(part.energy for part in parts if part.energy is not None)
        return Assembly(matrix, right_side, residual, self._relative(residual, squares, inner), energy)

    def from_nodes(self, instant: Instant) -> FloatArray:
        """Residual (rows, 11) of what acts at the nodes: loads, springs and magnets of rigid bodies."""
        total = np.zeros((len(self.rows.of), COMPONENTS))
        for term in self._nodal:
            total += term.evaluate(instant, STATIC, None, None).residual
        return self.rows.folded(total)

    def load_direction(self, instant: Instant, rate: Loading, assembly: Assembly) -> FloatArray:
        """Right side (dofs,) of the tangent for the increment of the unknowns per load factor.

        `rate` is the derivative of the loading with respect to the load factor, `assembly` that of the instant with
        nothing imposed.
        """
        direction = np.zeros(self.dofs)
        change = self.rows.folded(_sum(term.load_rate(instant, rate) for term in self.terms))
        direction[self.numbering.equations] = -change[self.free]
        if np.any(rate.held):
            moving = self.assemble(instant, self.imposed(rate.held)).right_side
            direction += moving - assembly.right_side
        return direction

    def predicted(self, instant: Instant, increment: Increment | None = None) -> Prediction:
        """What the mixed tangent takes of a state after an increment, linear in it; by default of the state itself."""
        if increment is None:
            increment = Increment(np.zeros((len(self.rows.of), COMPONENTS)), np.zeros_like(instant.state.alpha))
        return self.shell.predict(instant, increment)

    def correction(self, solution: FloatArray) -> Increment:
        """Increment of all unknowns that a solution (dofs,) of the last tangent makes with its right side."""
        return self._expanded(solution, None, whole=True)

    def direction(self, solution: FloatArray, imposed: FloatArray | None = None) -> Increment:
        """Increment of all unknowns along a solution (dofs,) for another right side, and imposed components."""
        return self._expanded(solution, imposed, whole=False)

    def _expanded(self, solution: FloatArray, imposed: FloatArray | None, whole: bool) -> Increment:
        nodal = np.zeros((len(self.rows.of), COMPONENTS)) if imposed is None else imposed.copy()
        nodal[self.free] = solution[self.numbering.equations]
        independent = self.to_global(self.rows.jumped(self.rows.shared(nodal)))
        alpha = self.shell.recovered(independent, whole)
        return Increment(self.dependence.spread(independent, self._levers), alpha)

    def moved(self, state: State, increment: Increment) -> State:
        """A state after an increment; dependent values are exactly those of the others."""
        return self.dependence.settled(state.moved(increment.nodal, increment.alpha))

    def to_global(self, nodal: FloatArray) -> FloatArray:
        """Turn nodal columns (nodes, 11) from the nodes' frames to the global axes."""
        return to_global(self.model.constraints, nodal)

    def to_frames(self, nodal: FloatArray) -> FloatArray:
        """Turn nodal columns (nodes, 11) from the global axes to the nodes' frames."""
        return to_frames(self.model.constraints, nodal)

    def imposed(self, held: FloatArray) -> FloatArray:
        """What is held of nodal values (nodes, 11) in the nodes' frames; zero elsewhere."""
        return self.rows.jumped(np.where(self.model.constraints.fixed, held, 0.0))

    def with_imposed(self, increment: Increment, held: FloatArray) -> Increment:
        """An increment whose held components are put to values (nodes, 11) in the nodes' frames."""
        fixed = self.model.constraints.fixed
        nodal = self.rows.jumped(np.where(fixed, held, self.to_frames(increment.nodal)))
        return Increment(self.to_global(nodal), increment.alpha)

    def largest(self, increment: Increment) -> tuple[float, str]:
        """Largest magnitude in an increment, in body lengths, directors, thickness ratios and radians, and where."""
        units = np.array([self._unit(column) for column in range(COMPONENTS)])
        magnitudes = np.abs(increment.nodal) / units
        node, column = np.unravel_index(np.argmax(magnitudes), magnitudes.shape)
        where = f"{self.rows.words(int(node))} at {place(self.rows.points[node])}"
        return float(magnitudes[node, column]), f"{UNKNOWNS[column]} of {where}"

    def _unit(self, column: int) -> float:
        if column < COLUMNS["u"].stop:
            return self.mesh.size
        return 1.0 / self.model.shell.greatest_thickness if column == COLUMNS["phi"].start else 1.0

    def _relative(self, residual: FloatArray, squares: FloatArray, inner: float) -> dict[str, float]:
        """Norms by kind above their round-off, over the elements' forces and the loads of that kind.

        s and α have the unit of w (all work on directors) and are measured against the same forces. The forces of u
        vanish in pure bending; they count for no less than the moments over the body's size.
        """
        free = residual * self.free
        norms = np.sqrt([*squares_by_kind(free), inner**2])
        scales = np.sqrt(squares)
        scales[0] = max(scales[0], scales[1] / self.mesh.size, scales[3] / self.mesh.size)
        above = np.maximum(norms - self._noise, 0.0)
        relative = np.divide(above, scales[[0, 1, 2, 3, 1, 1]], out=above.copy(), where=above > 0.0)
        return dict(zip(KINDS, relative.tolist(), strict=True))


def _sum(arrays: Iterable[FloatArray]) -> FloatArray:
    return reduce(np.add, arrays)
