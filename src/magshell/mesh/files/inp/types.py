"""Types of elements of Abaqus and CalculiX."""

from __future__ import annotations

import re
from typing import Literal

from magshell.mesh.files.cells import LINE2, QUAD4, QUAD8, QUAD9, TRIANGLE3, TRIANGLE6, Kind

LINE3 = Kind("3-node lines", 1, 3, (0, 2, 1))
"""End, middle, end."""
Other = Literal["solid", "no surface", "unknown"]

_TYPES: tuple[tuple[str, Kind | Other], ...] = (
    (r"(STRI65|(S|SFM3D|M3D|CPS|CPE|DS)6\w*)", TRIANGLE6),
    (r"((S|SFM3D|M3D|CPS|CPE|DS)8\w*)", QUAD8),
    (r"(S9R5|M3D9R?)", QUAD9),
    (r"(STRI3|(S|SFM3D|M3D|R3D|CPS|CPE|DS)3\w*)", TRIANGLE3),
    (r"((S|SFM3D|M3D|R3D|CPS|CPE|DS)4\w*)", QUAD4),
    (r"(T[23]D3\w*|(B|PIPE|ELBOW)[23]2\w*)", LINE3),
    (r"(T[23]D2\w*|(B|PIPE|ELBOW)[23][13]\w*|FRAME[23]D|RB?[23]D2)", LINE2),
    (r"((C|AC|CIN|COH|DC|EC|EMC|F|GK|PC|PD|Q)3D\d*\w*|CCL\d+\w*|CSS8|SC[68]R\w*)", "solid"),
    (r"(MASS|ROTARYI|HEATCAP|SPRING\w+|DASHPOT\w+|CONN[23]D2|JOINTC|JOINT[23]D|GAP(UNI|CYL|SPHER)\w*)", "no surface"),
    (r"(DCOUP[23]D|DGAP|DRAG[23]D|ITT\w+|ITS(UNI|CYL)\w*|ASI1|DMASS\d*|DC1D[23]\w*|AC1D[23]\w*|D)", "no surface"),
)
_PLANE = re.compile(r"CP[SE]\w+")
_BEAM = re.compile(r"(B|PIPE|ELBOW|FRAME)3\w+")


def kind_of(type_name: str) -> Kind | Other:
    """What elements of a type (in capitals) are.

    `"unknown"` may be a surface: shells and membranes of other types, axisymmetric ones, user elements.
    """
    return next((kind for pattern, kind in _TYPES if re.fullmatch(pattern, type_name)), "unknown")


def is_plane(type_name: str) -> bool:
    """Whether elements of this type are the section of a solid, so that their faces S1, S2, ... are edges."""
    return _PLANE.fullmatch(type_name) is not None


def may_have_direction(type_name: str) -> bool:
    """Whether a node that gives the direction of the section may stand behind the element's own nodes."""
    return _BEAM.fullmatch(type_name) is not None
