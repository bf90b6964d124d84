"""From the model to equations: numbering, the matrix pattern (built once), residual and tangent of a state."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from magshell.arrays import FloatArray, IntArray
from magshell.equations.external import External
from magshell.equations.frames import to_frames, to_global
from magshell.equations.numbering import columns_of, pattern_of, whole
from magshell.errors import InputError
from magshell.evaluation.points import evaluate, micropolar_stretch, plane_stress_stretch
from magshell.materials.law import strain_energy
from magshell.model.course import Loading
from magshell.model.loads import Pairs
from magshell.model.model import Model
from magshell.openblas import allocate_buffers
from magshell.shell import loops, rotation
from magshell.shell.bubble import held_energy, hold
from magshell.shell.element import Layout
from magshell.shell.geometry import interpolation, least_shifts, section_geometry, unit_forces
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS, COMPONENTS

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
        allocate_buffers()
        self.model, self.mesh = model, model.shell.mesh
        mesh = self.mesh
        element, thickness = model.shell.element, model.shell.thickness
        coordinates, normals = mesh.points[mesh.elements], model.normals[mesh.elements]
        shape = interpolation(coordinates, normals, element, model.shell.micro_rotation)
        _, weights = element.integration(coordinates)
        geometry = section_geometry(coordinates, normals, shape, weights, thickness, LEVELS)
        _check_thickness(least_shifts(geometry, thickness))
        self.modes = element.vectors
        held = hold(coordinates, element, thickness, model.shell.material.shear_modulus)
        layout = Layout(8, element.rest_nodes, element.stretch_nodes, shape.rotation.shape[-1], self.modes)
        self.body = loops.Body(
            np.ascontiguousarray(mesh.elements), layout, geometry, shape, model.shell.remanence_at_points,
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
        turning = np.all(self.equations.number[:, COLUMNS["omega"]] >= 0, axis=1)
        self.external = External(model.applied, model.constraints, self._places, turning)

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
        self.pattern, self._row_offset = pattern_of(graph, order, counts)
        layout = self.body.layout
        carrying = [layout.u] * 3 + [layout.w] * 3 + [layout.phi] + [layout.q] * 3
        local_node = np.concatenate([np.arange(count) for count in carrying])
        local_component = np.repeat(np.arange(COMPONENTS), carrying)
        pairs = mesh.elements
        offset = (
            np.asarray(
                self._row_offset[
                    np.repeat(pairs, per_element, axis=1).ravel(), np.tile(pairs, (1, per_element)).ravel()
                ]
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
        loading: Loading,
        stresses: loops.Stresses | None = None,
        imposed: FloatArray | None = None,
        tangent: bool = True,
        mixed: bool | None = None,
    ) -> Assembly:
        """Residual and tangent of a state.

        Parameters
        ----------
        state : State
        loading : Loading
            Of the field and the loads; what is held is the state's.
        stresses : Stresses, optional
            For the geometric part of the mixed tangent; None: the state's own, the plain tangent.
        imposed : ndarray, shape (nodes, 10), optional
            Increments of held components, in the nodes' frames, that the right side accounts for.
        tangent : bool
            Without it only the residual is made.
        mixed : bool, optional
            Whether the stresses are used. By default unless φ is eliminated: `predicted_stresses` know nothing of it.

        Raises
        ------
        InvertedElement
            det F is not positive at a point of an element.
        """
        model, out = self.model, self._out
        elements, points, levels = self.body.geometry.volume.shape
        if mixed is None:
            mixed = stresses is not None and not self.body.plane_stress
        if stresses is None:
            stresses = loops.Stresses(np.zeros((elements, points, levels, 3, 3)), np.zeros((elements, points, 2, 3)))
        if imposed is None:
            imposed = np.zeros_like(out.residual)
        element, determinant = loops.assemble(
            model.shell.material, model.shell.material.couple_modulus, model.coupling, loading.flux_density,
            self.body, state, stresses, mixed, tangent, imposed, self.equations, out,
        )  # fmt: skip
        if element >= 0:
            raise InvertedElement(element, determinant)
        forces = self.external.forces(state, loading.loads)
        local = self.to_frames(forces)
        out.residual[:] -= local
        right_side = np.zeros(self.dofs)
        matrix = None
        if tangent:
            self.external.add_stiffness(state, loading.loads, forces, out.data)
            right_side[self._free_index] = (local - out.condensed)[self.free]
            matrix = self._matrix
        return Assembly(matrix, right_side, out.residual.copy(), self._relative_residual(local))

    def load_direction(
        self, state: State, loading: Loading, rate: Loading, stresses: loops.Stresses | None, assembly: Assembly
    ) -> FloatArray:
        """Right side (dofs,) of the tangent for the increment of the unknowns per load factor.

        Residuals are linear in the flux density. `rate` is the derivative of the loading with respect to the load
        factor, `assembly` that of the state with the same stresses and nothing imposed.
        """
        direction = np.zeros(self.dofs)
        if np.any(rate.flux_density):
            ahead = self.assemble(state, loading.plus(rate), tangent=False).residual
            direction[self._free_index] = (assembly.residual - ahead)[self.free]
        else:
            forces = self.to_frames(self.external.forces(state, rate.loads))
            direction[self._free_index] = forces[self.free]
        if np.any(rate.held):
            moving = self.assemble(state, loading, stresses, self.imposed(rate.held)).right_side
            direction += moving - assembly.right_side
        return direction

    def _places(self, pairs: Pairs) -> IntArray:
        """Positions (n, 3, 3) in the tangent's values of the blocks of pairs; -1 where a component is held."""
        if not pairs.rows.size:
            return np.empty((0, 3, 3), dtype=np.int64)
        number, rank = self.equations.number, self.equations.rank
        rows, columns = COLUMNS[pairs.row_field], COLUMNS[pairs.column_field]
        offset = np.asarray(self._row_offset[pairs.columns, pairs.rows]).reshape(-1) - 1
        row_number, column_number = number[pairs.rows, rows], number[pairs.columns, columns]
        column_start = np.asarray(self.pattern.indptr)[column_number]
        at = column_start[:, None, :] + offset[:, None, None] + rank[pairs.rows, rows][:, :, None]
        return np.where((row_number[:, :, None] >= 0) & (column_number[:, None, :] >= 0), at, -1)

    def _relative_residual(self, loads: FloatArray) -> dict[str, float]:
        """Norms by kind above their round-off, over the elements' forces and the loads (nodes, 10) of that kind.

        α has the unit of w (both work on directors) and is measured against the same forces. The forces of u vanish in
        pure bending; they count for no less than the moments over the body's size.
        """
        residual = np.where(self.free, self._out.residual, 0.0)
        norms = [float(np.linalg.norm(residual[:, columns])) for columns in COLUMNS.values()]
        norms.append(float(np.sqrt(self._out.enhancement_residual[0])))
        squares = np.array([np.sum(loads[:, columns] ** 2) for columns in COLUMNS.values()])
        scales = np.sqrt(self._out.scale.sum(axis=1) + squares)
        scales[0] = max(scales[0], scales[1] / self.mesh.size, scales[3] / self.mesh.size)
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
        return to_global(self.model.constraints, nodal)

    def to_frames(self, nodal: FloatArray) -> FloatArray:
        """Turn nodal columns (nodes, 10) from the global axes to the nodes' frames."""
        return to_frames(self.model.constraints, nodal)

    def imposed(self, held: FloatArray) -> FloatArray:
        """What is held of nodal values (nodes, 10) in the nodes' frames; zero elsewhere."""
        return np.where(self.model.constraints.fixed, held, 0.0)

    def with_imposed(self, increment: FloatArray, held: FloatArray) -> FloatArray:
        """A nodal increment in global axes whose held components are put to values in the nodes' frames."""
        fixed = self.model.constraints.fixed
        return self.to_global(np.where(fixed, held, self.to_frames(increment)))

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
