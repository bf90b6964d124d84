r"""Elastic supports: springs that act on the displacement of a group.

A spring density k over a group has the energy

    ½ ∫ k |u|² = ½ Σ u_I · K_IJ u_J,      K_IJ = k ∫ N_I N_J 1,

with the functions N_I that loads on the group have (`loads/distribution.py`): where the displacement is uniform, a
spring pulls as a traction of that size does. Along a direction n, fixed in space, 1 is n ⊗ n. Springs are slack in the
undeformed shell, and no load factor scales them.

A new kind of spring is a class that inherits from `ElasticSupport`, and an entry of `SPRINGS`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.keys import Key
from magshell.model.checked import three_numbers
from magshell.model.elastic import Anchored, ElasticSupport
from magshell.model.loads.dead import nodal
from magshell.model.loads.distribution import Products, centroid_weights, products
from magshell.model.loads.load import Pairs
from magshell.model.places import Places
from magshell.model.shell import Shell
from magshell.model.support import REACTION
from magshell.model.torsion_spring import TorsionSpring
from magshell.shell.state import State
from magshell.units import AREA_STIFFNESS, LINE_STIFFNESS, STIFFNESS, Dimension, show
from magshell.wording import counted, vector


@dataclass(frozen=True, eq=False)
class Spring(ElasticSupport):
    """Springs on the displacement of a group, in all directions or along one.

    Give one of the three stiffnesses.

    Parameters
    ----------
    group : str
        Group of nodes, edges or elements; or the name of a rigid body, whose reference point the spring holds.
    stiffness : float, optional
        Of all springs of the group together, N/m. Nodes share it equally; along edges and over elements it is uniform.
    per_length : float, optional
        Per undeformed length of a group of edges, N/m².
    per_area : float, optional
        Per undeformed area of a group of elements, N/m³ (Winkler's foundation).
    direction : array_like, shape (3,), optional
        The springs resist displacement along it; it is fixed in space. By default they resist any displacement.
    name : str, optional
        Of the reaction; by default the group.
    point : array_like, shape (3,), optional
        Point, fixed in space, that the reaction's moment is about, m; by default the centroid of the group, where it is
        after the deformation.
    """

    kind: ClassVar[str] = "translation"
    keys: ClassVar[Mapping[str, Key]] = {
        "group": Key("Name", "Group of nodes, edges or elements that the springs hold, or the name of a rigid body."),
        "stiffness": Key("Stiffness", "Of all springs together.", "one of the three is needed"),
        "per_length": Key("LineStiffness", "Per undeformed length of a group of edges.", "one of the three is needed"),
        "per_area": Key("AreaStiffness", "Per undeformed area of a group of elements.", "one of the three is needed"),
        "direction": Key("Direction", "Along which they resist displacement, fixed in space.", "every direction"),
        "name": Key("Name", "Of the reaction in the results.", "the group"),
        "point": Key("Position", REACTION["point"].meaning, "the group's centroid"),
    }
    amounts: ClassVar[Mapping[str, Dimension]] = {
        "stiffness": STIFFNESS,
        "per_length": LINE_STIFFNESS,
        "per_area": AREA_STIFFNESS,
    }

    group: str
    stiffness: float | None = None
    per_length: float | None = None
    per_area: float | None = None
    direction: ArrayLike | None = None

    def applied(self, shell: Shell, places: Places) -> Anchored:
        """The springs on the nodal arrays of a shell.

        Raises
        ------
        InputError
            Unknown group, none or several stiffnesses, one that does not fit the kind of the group, values that are no
            positive numbers.
        """
        with self.located():
            key, value = self._amount()
            shared = self._products(shell, places, key)
            density = value / float(shared.values.sum()) if key == "stiffness" else value
            weights = np.zeros(places.number)
            if places.is_body(self.group):
                weights[places.named(self.group)] = 1.0
            else:
                weights[: len(shell.mesh.points)] = centroid_weights(shell, [self.group])
        blocks = density * shared.values[:, None, None] * self._projection
        about = None if self.point is None else three_numbers(self.label, "point", self.point)
        return _Springs(shared.rows, shared.columns, blocks, weights, about)

    def _products(self, shell: Shell, places: Places, key: str) -> Products:
        mesh = shell.mesh
        if places.is_body(self.group):
            place = places.named(self.group)
            found, kind = Products(place, place, np.ones(1)), "rigid bodies"
        else:
            places.named(self.group)
            found = products(shell, self.group)
            kind = "edges" if self.group in mesh.edge_groups else "nodes"
            kind = "elements" if self.group in mesh.element_groups else kind
        needed: dict[str, Literal["edges", "elements"]] = {"per_length": "edges", "per_area": "elements"}
        if key in needed and kind != needed[key]:
            what = f"is a group of {kind}" if kind != "rigid bodies" else "is a rigid body"
            raise InputError(f"{key} needs a group of {needed[key]}, and '{self.group}' {what}; give stiffness, in N/m")
        return found

    def _amount(self) -> tuple[str, float]:
        """Key and value of the stiffness that is given."""
        given = {key: getattr(self, key) for key in self.amounts if getattr(self, key) is not None}
        if len(given) != 1:
            said = " and ".join(given) + " are given" if given else "no stiffness is given"
            raise InputError(f"{said}; give one of {', '.join(self.amounts)}")
        ((key, value),) = given.items()
        try:
            found = float(value)
        except (TypeError, ValueError):
            raise InputError(f"{key} is {value!r}; it takes one number") from None
        if not 0.0 < found < np.inf:
            raise InputError(f"{key} is {value!r}; it must be positive and finite")
        return key, found

    @property
    def _projection(self) -> FloatArray:
        """1 or n ⊗ n (3, 3)."""
        if self.direction is None:
            return np.eye(3)
        unit = three_numbers(self.label, "direction", self.direction)
        if not np.any(unit):
            raise InputError(f"{self.label}: direction is {self.direction!r}; it must not be zero")
        unit = unit / np.linalg.norm(unit)
        return np.outer(unit, unit)

    def words(self, shell: Shell) -> str:
        """The springs in `magshell check`."""
        key, value = self._amount()
        along = "" if self.direction is None else f" along {vector(np.ravel(self.direction))}"
        in_all = " in all" if key == "stiffness" else ""
        return f"{show(value, self.amounts[key])}{in_all}{along}, {counted(len(shell.nodes_of(self.group)), 'node')}"

    @property
    def along(self) -> FloatArray | None:
        """Their direction."""
        return None if self.direction is None else three_numbers(self.label, "direction", self.direction)

    @property
    def legend(self) -> str:
        """The springs in pictures."""
        key, value = self._amount()
        return f"springs, {show(value, self.amounts[key])}"


SPRINGS: dict[str, type[ElasticSupport]] = {spring.kind: spring for spring in (Spring, TorsionSpring)}
"""The springs that problem files know, by their kind."""


@dataclass(frozen=True, eq=False)
class _Springs:
    """Blocks (n, 3, 3) between the displacements of rows and columns (n,), N/m."""

    rows: IntArray
    columns: IntArray
    blocks: FloatArray
    weights: FloatArray
    about: FloatArray | None

    @property
    def conservative(self) -> bool:
        return True

    @property
    def pairs(self) -> Sequence[Pairs]:
        return (Pairs("u", "u", self.rows, self.columns),)

    def forces(self, state: State) -> FloatArray:
        """-K u on u."""
        on_u = np.zeros_like(state.u)
        np.add.at(on_u, self.rows, -np.einsum("nij,nj->ni", self.blocks, state.u[self.columns]))
        return nodal("u", on_u)

    def stiffness(self, state: State) -> list[FloatArray]:
        """K."""
        return [self.blocks]

    def energy(self, state: State) -> float:
        """½ u · K u."""
        return -0.5 * float(np.vdot(self.forces(state)[:, :3], state.u))
