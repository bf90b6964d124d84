r"""Torsion springs of hinges: they act on the rotation of one side of a hinge against the other, about the edge.

The rotations of the sides are q_a and q_b; side b is turned against side a by p = q_a* q_b = (p_0, p). With the unit
tangent T of the undeformed edge the angle about the edge is ψ (`twist.py`), continuous up to two turns, and the spring
has the energy ½ k ψ² per length of the edge. Spins turn p by δp = ½ Ω p with Ω = R_aᵀ(δω_b - δω_a), so that δψ = g · Ω,
and the couples are -k ψ R_a g on b and the opposite on a. They are summed over the nodes of each straight edge by
Simpson's rule, or the trapezoidal rule where only corners have rotations.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.mesh.edges import SIDES
from magshell.model.elastic import Elastic
from magshell.model.hinge import Hinge
from magshell.model.loads.cross import cross_matrix
from magshell.model.loads.dead import nodal
from magshell.model.loads.load import Pairs
from magshell.model.rows import OMEGA, Rows
from magshell.model.shell import Shell
from magshell.model.twist import twist, twist_slope
from magshell.shell import rotation
from magshell.shell.state import State


def hinge_springs(shell: Shell, rows: Rows) -> tuple[Elastic, ...]:
    """The springs of the hinges that have any."""
    return tuple(_springs(shell, rows, hinge) for hinge in shell.hinges if hinge.stiffness)


def _springs(shell: Shell, rows: Rows, hinge: Hinge) -> _HingeSprings:
    found = [one for edge in shell.mesh.edge_groups[hinge.group] for one in _of_edge(shell, rows, edge)]
    a, b, lengths, tangents = (np.array([one[k] for one in found]) for k in range(4))
    return _HingeSprings(a, b, hinge.stiffness * lengths, tangents)


def _of_edge(shell: Shell, rows: Rows, edge: IntArray) -> Iterator[tuple[int, int, float, FloatArray]]:
    """Rows of two sides, their part of the edge's length, and the tangent."""
    mesh, root = shell.mesh, shell.images.root
    elements = root[mesh.elements]
    chord = mesh.points[edge[1]] - mesh.points[edge[0]]
    length = float(np.linalg.norm(chord))
    shares = (1 / 6, 1 / 6, 2 / 3) if shell.element.rest_nodes == 8 else (0.5, 0.5)
    owners, number = np.nonzero(elements[:, 4:] == root[edge[2]])
    side = SIDES[number]
    for node, share in zip(edge, shares, strict=False):
        slots = side[np.arange(len(side)), np.argmax(elements[owners[:, None], side] == root[node], axis=1)]
        sides = rows.source[rows.elements[owners, slots], OMEGA.start]
        for a, b in zip(sides[:-1].tolist(), sides[1:].tolist(), strict=True):
            if a != b:
                yield a, b, share * length, chord @ shell.images.rotation[node] / length


@dataclass(frozen=True, eq=False)
class _HingeSprings:
    """Springs between rows a and b (n,) about tangents (n, 3); stiffness (n,) in N m/rad."""

    a: IntArray
    b: IntArray
    stiffness_of: FloatArray
    tangents: FloatArray

    @property
    def conservative(self) -> bool:
        return True

    @property
    def pairs(self) -> Sequence[Pairs]:
        rows, columns = np.concatenate([self.b, self.b, self.a, self.a]), np.concatenate([self.b, self.a] * 2)
        return (Pairs("omega", "omega", rows, columns),)

    def _angles(self, state: State) -> tuple[FloatArray, FloatArray, FloatArray]:
        """ψ (n,), g (n, 3) and R_a (n, 3, 3)."""
        p = rotation.product(rotation.conjugate(state.q[self.a]), state.q[self.b])
        ψ, g = twist(p, self.tangents)
        return ψ, g, rotation.matrix(state.q[self.a])

    def forces(self, state: State) -> FloatArray:
        """Couples on the spins."""
        ψ, g, R_a = self._angles(state)
        couples, on_b = np.zeros_like(state.u), -(self.stiffness_of * ψ)[:, None] * np.einsum("nij,nj->ni", R_a, g)
        np.add.at(couples, self.b, on_b)
        np.add.at(couples, self.a, -on_b)
        return nodal("omega", couples)

    def stiffness(self, state: State) -> list[FloatArray]:
        """Minus the derivatives of the couples."""
        ψ, g, R_a = self._angles(state)
        k, kψ = self.stiffness_of[:, None, None], (self.stiffness_of * ψ)[:, None, None]
        g_a = np.einsum("nij,nj->ni", R_a, g)
        change = R_a @ self._slope(state) @ np.swapaxes(R_a, 1, 2)
        own = k * g_a[:, :, None] * g_a[:, None, :] + kψ * change
        turned = kψ * cross_matrix(g_a)
        return [np.concatenate([own, -own - turned, -own, own + turned])]

    def _slope(self, state: State) -> FloatArray:
        """dg/dΩ (n, 3, 3)."""
        p = rotation.product(rotation.conjugate(state.q[self.a]), state.q[self.b])
        return twist_slope(p, self.tangents)

    def energy(self, state: State) -> float:
        """½ Σ k ψ²."""
        return 0.5 * float(np.sum(self.stiffness_of * self._angles(state)[0] ** 2))
