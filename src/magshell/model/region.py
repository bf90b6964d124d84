"""What a user makes a shell of: regions of elements, and layers through the thickness."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

from magshell.arrays import IntArray
from magshell.magnetics.remanence import Remanence, constant
from magshell.model.thickness import Thickness

NO_REMANENCE = constant((0.0, 0.0, 0.0))
Group: TypeAlias = str | Sequence[str] | Sequence[int] | IntArray
OFFSETS = ("middle", "top", "bottom")


@dataclass(frozen=True, eq=False)
class Layer:
    """A layer of the thickness.

    Parameters
    ----------
    thickness : float or Thickness
        m; see `magshell.thickness` for one that varies.
    material : Material
        A law with its parameters, for instance `MicropolarNeoHookean`.
    remanence : Remanence, optional
        Remanent flux density of the undeformed material, see `magshell.remanence`; by default none.
    density : float, optional
        Mass per undeformed volume, kg/m³; by default that of the region.
    """

    thickness: float | Thickness
    material: Any
    remanence: Remanence = NO_REMANENCE
    density: float | None = None


@dataclass(frozen=True, eq=False)
class Region:
    """Elements with properties of their own; what is None is as in the rest of the shell.

    Parameters
    ----------
    group : str, sequence of str or sequence of int
        Element group, several, or the numbers of elements.
    thickness : float or Thickness, optional
        m; see `magshell.thickness` for one that varies.
    material : Material, optional
    remanence : Remanence, optional
    density : float, optional
        Mass per undeformed volume, kg/m³; with layers that of the layers that do not say their own.
    layers : sequence of Layer, optional
        From the bottom (the side that the normal points away from) to the top, in place of thickness, material and
        remanence.
    offset : {"middle", "top", "bottom"} or float, optional
        Where the mesh lies: in the mid-plane, at the top or the bottom face, or this far above the mid-plane along the
        normal, m.
    levels : int, optional
        Gauss points through the thickness of each layer.
    """

    group: Group
    thickness: float | Thickness | None = None
    material: Any = None
    remanence: Remanence | None = None
    density: float | None = None
    layers: Sequence[Layer] = ()
    offset: str | float | None = None
    levels: int | None = None
