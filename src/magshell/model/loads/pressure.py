r"""A pressure that stays normal to the deformed surface.

On the mid-surface x = Σ N_I x_I with a_α = x,α it has, per unit parent area, the force p a_1 × a_2, so that

    F_I = p ∫ N_I a_1 × a_2,     K_IJ = -∂F_I/∂u_J = p ∫ N_I [N_J,1 a_2 - N_J,2 a_1]×.

The functions are those of `functions.py`: the nodes alone say where the loaded surface is. Their degree is
2 in ξ and in η, so the integrands are of degree 5, and 3 × 3 points are exact: the sum of the forces, and of their
moments at the deformed nodes, is that of the surface. On triangles, with the bubble, degrees are 7 in ξ and 8 in η, for
which there are 5 × 5.

The load is conservative on a closed surface, where F_I = ∂(p V)/∂x_I with the enclosed volume V; over any group,
the variation of p/3 ∫ x · a_1 × a_2 has a further term, p/3 ∮ (x × δx) · dx along the rim. So the tangent is
symmetric but for pairs of nodes of the rim, and wholly where these are held. (Hibbitt, Int. J. Numer. Methods Engrg.
14, 1979; Schweizerhof and Ramm, Comput. Struct. 18, 1984.)
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.keys import HISTORY, Key
from magshell.mesh.edges import find_edges
from magshell.mesh.geometry import centres, unit
from magshell.model.loads.checks import number
from magshell.model.loads.cross import cross_matrix
from magshell.model.loads.dead import nodal
from magshell.model.loads.distribution import nodal_areas
from magshell.model.loads.load import Applied, Arrows, Load, Pairs, Size
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.shell import rotation
from magshell.shell.loaded import loaded
from magshell.shell.shape_functions import gauss_legendre
from magshell.shell.state import State
from magshell.units import FORCE, STRESS, Dimension, show

POINTS, POINTS_WITH_TRIANGLES = 3, 5


@dataclass(frozen=True, eq=False)
class Pressure(Load):
    """A pressure on the mid-surface, normal to it as it deforms and per deformed area.

    Parameters
    ----------
    group : str or None
        A group of elements; None: the whole shell.
    pressure : float
        Pa; positive pushes along the director, to the side that the mesh's normal points to.
    history : sequence of float, optional
        Multiplier at the end of each stage; by default 1 at the end of the first and from then on.
    """

    kind: ClassVar[str] = "pressure"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": Key("Name", "Group of elements that it acts on.", "the whole shell"),
        "pressure": Key("Pressure", "Per area of the deformed mid-surface; positive pushes along its normal."),
        "history": HISTORY,
    }
    amount: ClassVar[tuple[str, Dimension]] = ("pressure", STRESS)
    letter: ClassVar[str] = "$p$"
    on: ClassVar[Literal["nodes", "elements"]] = "elements"

    group: str | None
    pressure: float
    history: Sequence[float] | None = None

    def applied(self, shell: Shell, rows: Rows) -> Applied:
        """The load on a mesh; conservative where the group is a closed surface (see the module on the others)."""
        with self.located():
            members = self.members(shell)
            elements = shell.mesh.elements[members]
            pressure = number("pressure", self.pressure)
        parent, weights = gauss_legendre(POINTS_WITH_TRIANGLES if shell.mesh.triangles[members].any() else POINTS)
        functions = loaded(shell.element, parent, shell.mesh.points[elements])
        return _Pressing(
            shell.mesh.points,
            elements,
            pressure * weights[:, None] * functions.values,
            np.asarray(functions.derivatives),
            find_edges(elements).closed,
        )

    def words(self, shell: Shell, forces: FloatArray) -> str:
        """Side and force on the undeformed area."""
        force = float(self.pressure) * float(nodal_areas(shell, self.members(shell)).sum())
        side = "along" if self.pressure > 0.0 else "against"
        return (
            f"{self.given}, {side} the normal of {self.extent(shell)}, at first {show(abs(force), FORCE)} on their area"
        )

    def size(self, forces: FloatArray) -> Size:
        """The pressure."""
        return Size(pressure=abs(float(self.pressure)))

    def arrows(self, shell: Shell, forces: FloatArray) -> Arrows:
        """Along or against the normal."""
        points, elements = shell.mesh.points, shell.mesh.elements[self.members(shell)]
        x = points[elements]
        normals = unit(np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]))
        name = f"{self.group or 'whole shell'}: {self.kind}, {self.magnitude}"
        return Arrows(centres(points, elements), np.sign(self.pressure) * normals, name)


@dataclass(frozen=True, eq=False)
class _Pressing:
    """Points (nodes, 3), elements (e, 8), weighted functions (e, p, 8), N, and derivatives (e, p, 2, 8)."""

    points: FloatArray
    elements: IntArray
    weighted: FloatArray
    derivatives: FloatArray
    conservative: bool

    @property
    def pairs(self) -> Sequence[Pairs]:
        return (Pairs("u", "u", np.repeat(self.elements, 8, axis=1).ravel(), np.tile(self.elements, 8).ravel()),)

    def _base(self, state: State) -> tuple[FloatArray, FloatArray]:
        """a_1 and a_2 (e, p, 3)."""
        x = (self.points + state.displacement(len(self.points)))[self.elements]
        a = self.derivatives @ x[:, None]
        return a[:, :, 0], a[:, :, 1]

    def forces(self, state: State) -> FloatArray:
        """F_I on u."""
        a_1, a_2 = self._base(state)
        on_u = np.zeros_like(self.points)
        np.add.at(on_u, self.elements, np.swapaxes(self.weighted, 1, 2) @ rotation.cross(a_1, a_2))
        return nodal("u", on_u)

    def stiffness(self, state: State) -> list[FloatArray]:
        """K_IJ, J fastest."""
        a_1, a_2 = self._base(state)
        N_1, N_2 = self.derivatives[:, :, 0, :, None], self.derivatives[:, :, 1, :, None]
        arms = N_1 * a_2[:, :, None] - N_2 * a_1[:, :, None]
        vectors = np.swapaxes(self.weighted, 1, 2) @ arms.reshape(*arms.shape[:2], -1)
        return [cross_matrix(vectors.reshape(-1, 3))]
