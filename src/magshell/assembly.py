"""From the model to equations: numbering, the matrix pattern (built once), residual and tangent of a state."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.materials.law import strain_energy
from magshell.model import Model
from magshell.nodal import COLUMNS, COMPONENTS
from magshell.numbering import columns_of, pattern_of, whole
from magshell.shell import loops, rotation
from magshell.shell.bubble import held_energy, hold
from magshell.shell.element import Layout
from magshell.shell.evaluation import evaluate, micropolar_stretch, plane_stress_stretch
from magshell.shell.geometry import interpolation, least_shifts, section_geometry, unit_forces
from magshell.shell.state import State

LEVELS = 2
ROUND_OFF = 8.0 * np.finfo(float).eps
KINDS = ("u", "w", "phi", "omega", "alpha")
Ordering = Callable[[sp.csr_array], IntArray]


class InvertedElement(ArithmeticError):
    """A trial state turns an element inside out."""

    def __init__(self, element: int, determinant: float) -> None:
        super().__init__(element, determinant)
        self.element, self.determinant = element, determinant


class Assembly(NamedTuple):
    """Residual and tangent at a state.

    Attributes
    ----------
    matrix : csc_array or None
        Condensed tangent of the free unknowns; the next assembly overwrites its values.
    right_side : ndarray, shape (dofs,)
        Minus the condensed residual and the imposed increments' share.
    residual : ndarray, shape (nodes, 10)
        Internal minus external forces in the nodes' frames; at held components the reactions.
    relative : dict of str to float
        Residual by kind of unknown over the elements' internal and magnetic forces and the loads of that kind.
    """

    matrix: sp.csc_array | None
    right_side: FloatArray
    residual: FloatArray
    relative: dict[str, float]

    @property
    def worst(self) -> tuple[str, float]:
        """Kind with the largest relative residual, and that."""
        return max(self.relative.items(), key=lambda item: item[1])


class Discretisation:
    """The model's equations.

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
    """

    def __init__(self, model: Model, ordering: Ordering) -> None:
        self.model, self.mesh = model, model.shell.mesh
        mesh = self.mesh
        element, thickness = model.shell.element, model.shell.thickness
        coordinates, normals = mesh.points[mesh.elements], model.normals[mesh.elements]
        shape = interpolation(coordinates, normals, element, model.shell.micro_rotation)
        geometry = section_geometry(coordinates, normals, shape, element.rule.weights, thickness, LEVELS)
        _check_thickness(least_shifts(geometry, thickness))
        functions = element.functions(8, element.rule.points, coordinates)
        positions = np.einsum("epn,enx->epx", functions.values, coordinates)
        remanence = np.ascontiguousarray(model.shell.remanence(mesh, positions), dtype=float)
        if not np.all(np.isfinite(remanence)):
            bad = int(np.flatnonzero(~np.isfinite(remanence).all(axis=(1, 2)))[0])
            raise InputError(f"remanence: it is not finite in element {bad}")
        self.modes = element.vectors
        held = hold(coordinates, element, thickness, model.shell.material.shear_modulus)
        layout = Layout(8, element.rest_nodes, element.stretch_nodes, shape.rotation.shape[-1], self.modes)
        self.body = loops.Body(
            np.ascontiguousarray(mesh.elements), layout, geometry, shape, remanence,
            model.shell.thickness_stretch == "plane-stress", held,
        )  # fmt: skip
        self._number_equations(ordering)
        material = model.shell.material
        stiffest = 2.0 * material.shear_modulus + material.lame_lambda
        self._noise = ROUND_OFF * stiffest * unit_forces(geometry, shape)
        elements, values = len(mesh.elements), self.equations.local_node.size
        self._out = loops.Assembled(
            np.zeros(self.pattern.indices.size),
            np.zeros((len(mesh.points), COMPONENTS)),
            np.zeros((len(mesh.points), COMPONENTS)),
            np.zeros((elements, 3 * self.modes, values)),
            np.zeros((elements, 3 * self.modes)),
            np.zeros((len(COLUMNS), 2)),
            np.zeros(1),
        )
        self._matrix = sp.csc_array(
            (self._out.data, self.pattern.indices, self.pattern.indptr.astype(self.pattern.indices.dtype)),
            shape=(self.dofs, self.dofs),
        )
        self._loads = self.to_frames(model.nodal_loads)
        self._load_squares = np.array([np.sum(self._loads[:, columns] ** 2) for columns in COLUMNS.values()])
        self._transport = self._spin_transport()

    def _number_equations(self, ordering: Ordering) -> None:
        mesh, constraints = self.mesh, self.model.constraints
        nodes, per_element = len(mesh.points), mesh.elements.shape[1]
        carried = columns_of(self.model.shell.carriers)
        free = carried & ~constraints.fixed
        self.carried, self.free = carried, free
        incidence = sp.csr_array(
            (
                np.ones(mesh.elements.size, dtype=np.int32),
                mesh.elements.ravel(),
                np.arange(0, mesh.elements.size + 1, per_element),
            ),
            shape=(len(mesh.elements), nodes),
        )
        graph = sp.csr_array(incidence.T @ incidence)
        order = ordering(graph)
        counts = free.sum(axis=1)
        first = np.empty(nodes, dtype=np.int64)
        first[order] = np.cumsum(counts[order]) - counts[order]
        rank = np.cumsum(free, axis=1) - 1
        number = np.where(free, first[:, None] + rank, -1)
        self.pattern, row_offset = pattern_of(graph, order, counts)
        layout = self.body.layout
        carrying = [layout.u] * 3 + [layout.w] * 3 + [layout.phi] + [layout.q] * 3
        local_node = np.concatenate([np.arange(count) for count in carrying])
        local_component = np.repeat(np.arange(COMPONENTS), carrying)
        pairs = mesh.elements
        offset = (
            np.asarray(
                row_offset[np.repeat(pairs, per_element, axis=1).ravel(), np.tile(pairs, (1, per_element)).ravel()]
            ).reshape(len(pairs), per_element, per_element)
            - 1
        )
        self.equations = loops.Equations(
            local_node.astype(np.int64),
            local_component.astype(np.int64),
            number,
            rank,
            whole(free, mesh.elements, carrying),
            self.pattern.indptr,
            offset,
            np.ascontiguousarray(constraints.frame_of),
            np.ascontiguousarray(constraints.frames),
        )
        self.dofs = self.pattern.dofs
        self._free_index = number[free]

    @property
    def normals(self) -> FloatArray:
        """Unit normals (nodes, 3) of the undeformed mid-surface."""
        return self.model.normals

    # -- what the solver sees ------------------------------------------------------------------------------------

    def undeformed(self) -> State:
        """State of no deformation."""
        return State.undeformed(len(self.mesh.points), len(self.mesh.elements), self.modes)

    def stresses_at(self, state: State) -> loops.Stresses:
        """Stresses of the state itself, as a start for the mixed tangent."""
        return self.predicted_stresses(state, np.zeros((len(self.mesh.points), COMPONENTS)), np.zeros_like(state.alpha))

    def predicted_stresses(self, state: State, increment: FloatArray, d_alpha: FloatArray) -> loops.Stresses:
        """Stresses predicted linearly from a state for a nodal increment (nodes, 10) and Δα."""
        elements, points, levels = self.body.geometry.volume.shape
        stresses = loops.Stresses(np.empty((elements, points, levels, 3, 3)), np.empty((elements, points, 2, 3)))
        loops.predict_stresses(self.model.shell.material, self.body, state, increment, d_alpha, stresses)
        return stresses

    def assemble(
        self,
        state: State,
        load_factor: float,
        stresses: loops.Stresses | None = None,
        imposed: FloatArray | None = None,
        tangent: bool = True,
    ) -> Assembly:
        """Residual and tangent of a state.

        Parameters
        ----------
        state : State
        load_factor : float
        stresses : Stresses, optional
            For the geometric part of the mixed tangent; None: the state's own, the plain tangent.
        imposed : ndarray, shape (nodes, 10), optional
            Increments of held components, in the nodes' frames, that the right side accounts for.
        tangent : bool
            Without it only the residual is made.

        Raises
        ------
        InvertedElement
            det F is not positive at a point of an element.
        """
        model, out = self.model, self._out
        elements, points, levels = self.body.geometry.volume.shape
        mixed = stresses is not None and not self.body.plane_stress
        if stresses is None:
            stresses = loops.Stresses(np.zeros((elements, points, levels, 3, 3)), np.zeros((elements, points, 2, 3)))
        if imposed is None:
            imposed = np.zeros_like(out.residual)
        element, determinant = loops.assemble(
            model.shell.material, model.shell.material.couple_modulus, model.coupling,
            load_factor * model.field.vector, self.body, state, stresses, mixed, tangent, imposed,
            self.equations, out,
        )  # fmt: skip
        if element >= 0:
            raise InvertedElement(element, determinant)
        self._add_loads(load_factor, tangent)
        right_side = np.zeros(self.dofs)
        matrix = None
        if tangent:
            right_side[self._free_index] = -out.condensed[self.free]
            matrix = self._matrix
        return Assembly(matrix, right_side, out.residual.copy(), self._relative_residual(load_factor))

    def load_direction(
        self, state: State, load_factor: float, stresses: loops.Stresses | None, residual: FloatArray
    ) -> FloatArray:
        """Right side (dofs,) of the tangent for the increment of the unknowns per load factor.

        Field and loads are linear in the load factor. `residual` is that of the state.
        """
        ahead = self.assemble(state, load_factor + 1.0, tangent=False).residual
        right_side = np.zeros(self.dofs)
        right_side[self._free_index] = (residual - ahead)[self.free]
        imposed = self.imposed(1.0)
        if np.any(imposed):
            held = self.assemble(state, load_factor, stresses).right_side
            right_side += self.assemble(state, load_factor, stresses, imposed).right_side - held
        return right_side

    def _add_loads(self, load_factor: float, tangent: bool) -> None:
        """Take the loads, which are dead, off the residual, and the transport of their couples off the tangent."""
        out, loads = self._out, load_factor * self._loads
        out.residual[:] -= loads
        if tangent:
            out.condensed[:] -= loads
            at, values = self._transport
            out.data[at] += load_factor * values

    def _spin_transport(self) -> tuple[IntArray, FloatArray]:
        """Places in the tangent of -[c]×/2, and its values, for the dead couples c of the nodes at load factor 1.

        Elements differentiate in the chart exp(ϑ) R̃, in which a couple c on the spins of the new state is
        c + c × ϑ / 2: so K = K_chart - [c]×/2, with the sum c of the couples of a node's elements. (On those spins a
        dead couple is constant and adds nothing.) In equilibrium c is the dead couple where no rotation is held. Where
        exactly one is, the loops over elements have all of c, load and reaction; where more are, [c]× does not meet
        two free rotations.
        """
        numbers = self.equations.number[:, COLUMNS["omega"]]
        couples = self._loads[:, COLUMNS["omega"]]
        nodes = np.flatnonzero(np.any(couples, axis=1) & np.all(numbers >= 0, axis=1))
        if not nodes.size:
            return np.empty(0, dtype=np.int64), np.empty(0)
        rows, columns = (
            numbers[nodes][:, [*rotation.NEXT, *rotation.LAST]],
            numbers[nodes][:, [*rotation.LAST, *rotation.NEXT]],
        )
        entry = self._matrix.copy()
        entry.data = np.arange(1.0, entry.nnz + 1.0)
        at = np.asarray(entry[rows.ravel(), columns.ravel()]).astype(np.int64) - 1
        return at, np.hstack([0.5 * couples[nodes], -0.5 * couples[nodes]]).ravel()

    def _relative_residual(self, load_factor: float) -> dict[str, float]:
        """Norms by kind above their round-off, over the elements' forces and the loads of that kind.

        α has the unit of w (both work on directors) and is measured against the same forces.
        """
        residual = np.where(self.free, self._out.residual, 0.0)
        norms = [float(np.linalg.norm(residual[:, columns])) for columns in COLUMNS.values()]
        norms.append(float(np.sqrt(self._out.enhancement_residual[0])))
        scales = np.sqrt(self._out.scale.sum(axis=1) + load_factor**2 * self._load_squares)
        above = np.maximum(np.array(norms) - self._noise, 0.0)
        relative = np.divide(above, scales[[0, 1, 2, 3, 1]], out=above.copy(), where=above > 0.0)
        return dict(zip(KINDS, relative.tolist(), strict=True))

    def expand(self, solution: FloatArray, imposed: FloatArray | None = None) -> FloatArray:
        """Nodal increment (nodes, 10) in global axes of free unknowns (dofs,) and imposed components."""
        increment = np.zeros((len(self.mesh.points), COMPONENTS)) if imposed is None else imposed.copy()
        increment[self.free] = solution[self._free_index]
        return self.to_global(increment)

    def to_global(self, nodal: FloatArray) -> FloatArray:
        """Turn nodal columns (nodes, 10) from the nodes' frames to the global axes."""
        return self._turned(nodal, "nji,nj->ni")

    def to_frames(self, nodal: FloatArray) -> FloatArray:
        """Turn nodal columns (nodes, 10) from the global axes to the nodes' frames."""
        return self._turned(nodal, "nij,nj->ni")

    def _turned(self, nodal: FloatArray, rule: str) -> FloatArray:
        turned, constraints = nodal.copy(), self.model.constraints
        for field, columns in enumerate(COLUMNS[name] for name in ("u", "w", "omega")):
            oblique = np.flatnonzero(constraints.frame_of[:, field] >= 0)
            frames = constraints.frames[constraints.frame_of[oblique, field]]
            turned[oblique, columns] = np.einsum(rule, frames, nodal[oblique, columns])
        return turned

    def imposed(self, d_factor: float) -> FloatArray:
        """Increments (nodes, 10) of the held components, in the nodes' frames, for an increment of the load factor."""
        return np.where(self.model.constraints.fixed, d_factor * self.model.constraints.value, 0.0)

    def with_imposed(self, increment: FloatArray, d_factor: float) -> FloatArray:
        """A nodal increment in global axes whose held components are put to what the load factor asks."""
        local = self.to_frames(increment)
        fixed = self.model.constraints.fixed
        local[fixed] = self.imposed(d_factor)[fixed]
        return self.to_global(local)

    def recover(self, increment: FloatArray) -> FloatArray:
        """Δα (elements, modes, 3) of the last assembled tangent for a nodal increment in global axes."""
        d_alpha = np.empty((len(self.mesh.elements), self.modes, 3))
        loops.recover_enhancement(
            self.body.elements, self.body.layout, increment, self._out.gain, self._out.offset, d_alpha
        )
        return d_alpha

    # -- what pictures and files see -----------------------------------------------------------------------------

    def nodal_director(self, state: State) -> FloatArray:
        """Director d = D + w (nodes, 3)."""
        return self.normals + self._filled(state.w, self.body.layout.w)

    def nodal_phi(self, state: State) -> FloatArray:
        """Thickness stretch φ (nodes,), 1/m."""
        return self._filled(state.phi, self.body.layout.phi)

    def nodal_rotation(self, state: State) -> FloatArray:
        """Micro-rotation vector (nodes, 3), rad, of magnitude at most π."""
        q = state.q
        if self.body.layout.q == 4:
            ends = self._mid_side_ends
            first, second = q[ends[:, 0]], q[ends[:, 1]]
            sign = np.where(np.sum(first * second, axis=1, keepdims=True) < 0.0, -1.0, 1.0)
            mean = first + sign * second
            q = q.copy()
            q[self._mid_sides] = mean / np.linalg.norm(mean, axis=1, keepdims=True)
        return rotation.logarithm(q)

    def element_remanence(self, state: State) -> FloatArray:
        """Remanence in the current configuration, J⁻¹ F B̃ (elements, 3), T, mean over the volume."""
        F = evaluate(self.body, state).F
        values = np.einsum("epkxy,epy->epkx", F, self.body.remanence) / np.linalg.det(F)[..., None]
        return np.asarray(self._volume_mean(values))

    def element_thickness_ratio(self, state: State) -> FloatArray:
        """Deformed over undeformed thickness (elements,), mean of |F D|."""
        F = evaluate(self.body, state).F
        return np.asarray(
            self._volume_mean(np.linalg.norm(np.einsum("epkxy,epy->epkx", F, self.body.geometry.D), axis=-1))
        )

    def element_energy(self, state: State) -> FloatArray:
        """Strain energy (elements,), J, couple stress included."""
        body, geometry, material = self.body, self.body.geometry, self.model.shell.material
        φ = plane_stress_stretch(body, state, material) if body.plane_stress else None
        fields = evaluate(body, state, φ)
        stretch = (strain_energy(material, micropolar_stretch(fields)) * geometry.volume).sum(axis=(1, 2))
        wryness = np.einsum("epab,epax,epbx->e", geometry.metric, fields.kappa, fields.kappa)
        held = held_energy(self.body.hold, state.u[self.mesh.elements], state.alpha)
        return np.asarray(stretch + 0.5 * material.couple_modulus * wryness + held)

    def _volume_mean(self, values: FloatArray) -> FloatArray:
        volume = self.body.geometry.volume
        weights = volume / volume.sum(axis=(1, 2), keepdims=True)
        return np.asarray(np.einsum("epk,epk...->e...", weights, values))

    @cached_property
    def _mid_sides(self) -> IntArray:
        return self.mesh.elements[:, 4:].ravel()

    @cached_property
    def _mid_side_ends(self) -> IntArray:
        """Corner nodes (mid-sides, 2) on either side of each of `_mid_sides`."""
        corners = self.mesh.elements[:, :4]
        return np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)

    def _filled(self, nodal: FloatArray, carriers: int) -> FloatArray:
        """A field of an element's first nodes; where these are the corners, mid-sides take the mean of their ends."""
        if carriers == 8:
            return nodal
        values = nodal.copy()
        values[self._mid_sides] = nodal[self._mid_side_ends].mean(axis=1)
        return values


def _check_thickness(shifts: FloatArray) -> None:
    """A shell thicker than twice a radius of curvature has layers that overlap."""
    bad = np.flatnonzero((shifts <= 0.0).any(axis=(1, 2)))
    if bad.size:
        raise InputError(
            f"shell: thickness is larger than the curvature of element {bad[0]} allows (it would overlap itself inside)"
        )
