"""What a force and a moment with a total over a group have in common."""

from __future__ import annotations

from magshell.arrays import FloatArray
from magshell.keys import Key
from magshell.model.loads.load import Load
from magshell.model.shell import Shell

GROUP = Key("Name", "Group of edges, nodes or elements that it acts on, or the name of a rigid body.")
FOLLOWER = Key("Switch", "Whether it turns with the micro-rotations of its nodes.")


class TotalLoad(Load):
    """A total over a group, dead or turning with the micro-rotation."""

    follower: bool

    def words(self, shell: Shell, forces: FloatArray) -> str:
        """Total and number of nodes."""
        return f"{self.given}, {self.extent(shell)}" + ", turns with the micro-rotation" * self.follower
