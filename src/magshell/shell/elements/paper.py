"""The element of Dadgar-Rad and Hossain: quadratic u, everything else bilinear, six enhanced parameters."""

from __future__ import annotations

from magshell.shell.elements.definition import ElementType, Mode, gauss

PAPER = ElementType(
    name="paper",
    rest_nodes=4,
    stretch_nodes=4,
    rule=gauss(2),
    modes=(Mode(3, 1, 0), Mode(3, 0, 1)),
    complete=False,
)
