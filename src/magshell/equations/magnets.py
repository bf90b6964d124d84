"""Magnetic moments of rigid bodies: which they are, where, and how they have turned."""

from __future__ import annotations

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.model.rigid_body import members_of
from magshell.model.rows import Rows
from magshell.model.shell import Shell
from magshell.shell import rotation
from magshell.shell.state import State


class Magnets:
    """The rigid bodies with a magnetic moment.

    Parameters
    ----------
    shell : Shell
    rows : Rows

    Attributes
    ----------
    rows : ndarray, shape (n,)
        Their rows in nodal arrays.
    moments : ndarray, shape (n, 3)
        Undeformed, A m².
    on_elements : ndarray of bool, shape (n, elements)
        Elements with a node of the body.
    """

    def __init__(self, shell: Shell, rows: Rows) -> None:
        numbers = [number for number, body in enumerate(shell.rigid) if np.any(body.moment)]
        self.rows = rows.nodes + np.array(numbers, dtype=np.int64)
        self.moments = np.array([shell.rigid[number].moment for number in numbers]).reshape(-1, 3)
        self._points = rows.points[self.rows]
        owner = members_of(shell.mesh, shell.rigid)[shell.mesh.elements]
        self.on_elements: AnyArray = np.zeros((len(numbers), len(owner)), dtype=bool)
        for place, number in enumerate(numbers):
            self.on_elements[place] = (owner == number).any(axis=1)

    def __len__(self) -> int:
        return len(self.rows)

    def positions(self, state: State) -> FloatArray:
        """Where they are (n, 3), m."""
        return np.asarray(self._points + state.u[self.rows])

    def turned(self, state: State) -> FloatArray:
        """R m (n, 3), A m²."""
        return np.asarray(np.einsum("nij,nj->ni", rotation.matrix(state.q[self.rows]), self.moments))
