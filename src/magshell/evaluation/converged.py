"""A converged state with its loading, of which outputs are evaluated."""

from __future__ import annotations

from functools import cached_property
from typing import Protocol

import numpy as np

from magshell.arrays import FloatArray
from magshell.equations.discretisation import Assembly, Discretisation
from magshell.equations.instant import Instant
from magshell.evaluation.balance import Balance, magnetic
from magshell.evaluation.patches import patches_of
from magshell.evaluation.points import magnetic_torque as torque_of_points
from magshell.evaluation.reactions import Reaction, held_forces, reactions
from magshell.evaluation.resultants import Resultants
from magshell.evaluation.sources import forces_on_sources
from magshell.evaluation.strain import FACES, Deformation, Face
from magshell.evaluation.work import Acting, Work, acting, work_between
from magshell.magnetics.fields.field import known
from magshell.magnetics.law import X
from magshell.model.course import Loading
from magshell.shell import rotation
from magshell.shell.deformed import PointFields, evaluate, level_stretch, of_couplings
from magshell.shell.point import INTERNAL
from magshell.shell.section import LocalField
from magshell.shell.state import State
from magshell.shell.unknowns import COLUMNS, COMPONENTS


class Converged:
    """A state of equilibrium.

    Parameters
    ----------
    discretisation : Discretisation
    state : State
    loading : Loading

    Attributes
    ----------
    balance : Balance or None
        Global equilibrium, where it is known.
    work : Work or None
        Along the path up to here, where that is known.
    """

    balance: Balance | None = None
    work: Work | None = None

    def __init__(self, discretisation: Discretisation, state: State, loading: Loading) -> None:
        self.discretisation, self.state, self.loading = discretisation, state, loading
        self.mesh = discretisation.mesh

    @cached_property
    def assembly(self) -> Assembly:
        """The residual: at held components the reactions."""
        return self.discretisation.assemble(Instant(self.state, self.loading), tangent=False)

    @property
    def energies(self) -> FloatArray:
        """Elastic and magnetic energy of each element (elements, 2), J; the couple of the field has none."""
        return self.assembly.energy

    @cached_property
    def support_forces(self) -> FloatArray:
        """Forces of all supports on the unknowns of the rows (rows, 11), global axes."""
        return held_forces(self.discretisation, self.assembly.residual)

    @property
    def spring_energy(self) -> float:
        """Energy of all springs, J."""
        return self.discretisation.springs.energy(self.state) + self.discretisation.hinges.energy(self.state)

    @cached_property
    def reactions(self) -> list[Reaction]:
        """Force and moment of each named support, then of each spring."""
        return reactions(self.discretisation, self.state, self.support_forces)

    @cached_property
    def magnetic_torque(self) -> FloatArray:
        """Total torque of the field (3,), N m."""
        if self.balance is not None:
            return self.balance.magnetic_torque
        return magnetic(self.discretisation, self.state, self.loading).torque

    @property
    def body_motions(self) -> FloatArray:
        """Displacement and rotation vector of each rigid body (bodies, 2, 3), m and rad."""
        bodies = self.discretisation.rows.bodies
        return np.stack([self.state.u[bodies], rotation.logarithm(self.state.q[bodies])], axis=1)

    @property
    def body_forces(self) -> FloatArray:
        """Force and moment that each rigid body exerts on the shell (bodies, 2, 3), N and N m."""
        forces = self._exerted[self.discretisation.rows.bodies]
        return np.stack([forces[:, COLUMNS["u"]], forces[:, COLUMNS["omega"]]], axis=1)

    @property
    def jumps(self) -> FloatArray:
        """Jump of each periodic motion, m, and the force with which the next cell pulls at it, N, (periodic, 2, 3)."""
        rows = self.discretisation.rows.jumps
        return np.stack([self.state.u[rows], self._exerted[rows, COLUMNS["u"]]], axis=1)

    @property
    def _exerted(self) -> FloatArray:
        """Forces (rows, 11), global axes, that bodies and jumps exert on the shell."""
        d = self.discretisation
        if d.rows.places == d.rows.nodes:
            return np.zeros((d.rows.places, COMPONENTS))
        return d.to_global(self.assembly.residual - d.from_nodes(Instant(self.state, self.loading)))

    @cached_property
    def source_forces(self) -> FloatArray:
        """Force and torque on each part of a field that varies (parts, 2, 3), N and N m."""
        return forces_on_sources(self.discretisation, self.state, self.loading)

    @cached_property
    def acting(self) -> Acting:
        """The nodal forces that do work."""
        return acting(self.discretisation, self.state, self.loading, self.assembly.residual, self.support_forces)

    def work_from(self, before: Acting) -> Work:
        """The work from another state on the path to this one, by the trapezoidal rule."""
        return work_between(before, self.acting)

    @cached_property
    def fields(self) -> PointFields:
        """Deformation gradient, micro-rotation and wryness at the points."""
        return evaluate(self.discretisation.reference, self.state, self._level_stretch)

    @cached_property
    def local_field(self) -> LocalField:
        """The external field at the levels."""
        return self.discretisation.shell.field.at(self.state, self.loading, second=False)

    @cached_property
    def _level_stretch(self) -> FloatArray | None:
        """Stretch that levels have of their own (elements, p, k)."""
        return level_stretch(self.discretisation.reference, self.state, self.local_field)

    @property
    def displacement(self) -> FloatArray:
        """Displacement (nodes, 3), m."""
        return self.state.displacement(len(self.mesh.points))

    @cached_property
    def _deformation(self) -> Deformation:
        return Deformation(self.discretisation, self.state, self._level_stretch)

    @cached_property
    def _faces(self) -> dict[str, Face]:
        return {name: Face(self._deformation, name) for name in FACES}

    @cached_property
    def _resultants(self) -> Resultants:
        return Resultants(self._deformation, self.state, self.fields, self.local_field)

    def at_face(self, name: str, face: str) -> FloatArray:
        """A quantity of `Face`, by its name, at the rows of the patches."""
        return np.asarray(getattr(self._faces[face], name))

    def resultant(self, name: str) -> FloatArray:
        """A quantity of `Resultants`, by its name, at the rows of the patches."""
        return np.asarray(getattr(self._resultants, name))

    def energy_density(self) -> FloatArray:
        """Strain energy per undeformed volume (elements,), J/m³, mean over the element."""
        return self.energies[:, INTERNAL] / self.discretisation.reference.geometry.volume.sum(axis=(1, 2))

    def torque_density(self) -> FloatArray:
        """Torque of the field per undeformed volume (elements, 3), N/m², mean over the element."""
        d = self.discretisation
        forces = of_couplings(d.reference, d.couplings, self.fields, self.local_field)
        return self.mean(torque_of_points(d.reference, self.fields, forces))

    def magnetic_force_density(self) -> FloatArray:
        """Force of the field per undeformed volume (elements, 3), N/m³, mean over the element."""
        d = self.discretisation
        return -self.mean(of_couplings(d.reference, d.couplings, self.fields, self.local_field)[..., X : X + 3])

    def flux_density(self) -> FloatArray:
        """External flux density at the deformed nodes (nodes, 3), T; NaN where the field is not known."""
        return known(self.discretisation.model.field, self.loading.drives, self.mesh.points + self.displacement)

    def self_flux_density(self) -> FloatArray:
        """What the body's own field adds (elements, 3), T, mean over the element; zero where it does not act."""
        return self.mean(self.discretisation.shell.field.own_at(self.state, self.loading))

    def director(self) -> FloatArray:
        """Director d at the rows of the patches (rows, 3): that of the sheet and the section."""
        return self._of_patches(self.element_directors())

    def phi(self) -> FloatArray:
        """Thickness stretch φ at the rows of the patches (rows,), 1/m."""
        return self._of_patches(self.element_phi())

    def normal(self) -> FloatArray:
        """Unit normal D of the undeformed sheet at the rows of the patches (rows, 3)."""
        rows = self.discretisation.rows
        return self._of_patches(rows.normals[rows.elements])

    def element_directors(self) -> FloatArray:
        """Director at the nodes of each element (elements, 8, 3): where sections differ each has its own length."""
        rows = self.discretisation.rows
        d = self._of_elements(rows.normals + self.state.w, self.discretisation.reference.body.layout.w)
        return np.asarray((1.0 + self.element_stretch()[..., None]) * d)

    def element_stretch(self) -> FloatArray:
        """Stretch s of the director at the nodes of each element (elements, 8), zero but where sections differ."""
        return self._of_elements(self.state.s, self.discretisation.reference.body.layout.w)

    def element_phi(self) -> FloatArray:
        """Thickness stretch φ at the nodes of each element (elements, 8), 1/m."""
        return self._of_elements(self.state.phi, self.discretisation.reference.body.layout.phi)

    def _of_elements(self, of_rows: FloatArray, carriers: int) -> FloatArray:
        """A field of the rows at the nodes of each element (elements, 8, ...); its first nodes carry it."""
        values = of_rows[self.discretisation.reference.body.elements]
        if carriers == 4:
            corners = values[:, :4]
            values = np.concatenate([corners, 0.5 * (corners + np.roll(corners, -1, axis=1))], axis=1)
        return np.asarray(values)

    def rotation(self) -> FloatArray:
        """Micro-rotation vector at the rows of the patches (rows, 3), rad, of magnitude at most π."""
        q = self._of_elements(self.state.q, self.discretisation.reference.body.layout.q)
        return rotation.logarithm(self._of_patches(q / np.linalg.norm(q, axis=2, keepdims=True)))

    def remanence(self) -> FloatArray:
        """Remanence in the current configuration, J⁻¹ F B̃ (elements, 3), T, mean over the volume."""
        F, remanence = self.fields.F, self.discretisation.reference.remanence
        values = np.einsum("epkxy,epky->epkx", F, remanence) / np.linalg.det(F)[..., None]
        return self.mean(values)

    def thickness_ratio(self) -> FloatArray:
        """Deformed over undeformed thickness (elements,), mean of |F D|."""
        D = self.discretisation.reference.geometry.D
        return self.mean(np.linalg.norm(np.einsum("epkxy,epy->epkx", self.fields.F, D), axis=-1))

    def mean(self, values: FloatArray) -> FloatArray:
        """Mean over the volume (elements, ...) of values at the points (elements, p, k, ...)."""
        volume = self.discretisation.reference.geometry.volume
        weights = volume / volume.sum(axis=(1, 2), keepdims=True)
        return np.asarray(np.einsum("epk,epk...->e...", weights, values))

    def _of_patches(self, values: FloatArray) -> FloatArray:
        """What is one in each patch: from the nodes of the elements (elements, 8, ...) to the rows (rows, ...)."""
        patches = patches_of(self.discretisation.model.shell)
        found = np.empty((len(patches.nodes), *values.shape[2:]))
        found[patches.elements] = values
        return found


class Reached(Protocol):
    """A state on a path, with what acts there."""

    @property
    def state(self) -> State:
        """Unknowns."""

    @property
    def flux_density(self) -> FloatArray:
        """T, (3,)."""

    @property
    def stage(self) -> int:
        """Of the path, from 0."""

    @property
    def load_factor(self) -> float:
        """Of that stage."""


def converged(discretisation: Discretisation, reached: Reached) -> Converged:
    """What outputs are evaluated of, at a step or another state of the path. (What is held is the state's.)

    Critical points and buckling modes do not keep multipliers of loads and amounts of the field: these are then those
    of the histories.
    """
    loading = discretisation.model.course(reached.stage).at(reached.load_factor)
    loads = getattr(reached, "loads", None)
    drives = getattr(reached, "drives", loading.drives)
    there = loading._replace(
        flux_density=reached.flux_density,
        loads=loading.loads if loads is None else loads,
        drives=drives if len(drives) == len(loading.drives) else loading.drives,
    )
    found = Converged(discretisation, reached.state, there)
    found.balance = getattr(reached, "balance", None)
    return found
