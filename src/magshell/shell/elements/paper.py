r"""The element of Dadgar-Rad and Hossain: quadratic u, everything else bilinear, enhanced F[0].

Its six enhanced parameters are two vectors in g_3, with the modes ξ and η. Two relatives show what they do: one without
any, and one with 39 (thirteen vectors), the number that a footnote of the source gives for modes up to ξ²η and ξη². The
footnote does not list them; here g_3 has all of ξ, η, ξη, ξ², η², ξη², ξ²η, and g_1 and g_2 have those that the
derivatives of the serendipity functions lack. At 2 × 2 Gauss points 1 - 3ξ² vanishes, so these modes need 3 × 3.
"""

from __future__ import annotations

from dataclasses import replace

from magshell.shell.elements.definition import ElementType, Mode, gauss

PAPER = ElementType(
    name="paper",
    rest_nodes=4,
    stretch_nodes=4,
    rule=gauss(2),
    modes=(Mode(3, 1, 0), Mode(3, 0, 1)),
    complete=False,
)

PAPER_UNENHANCED = replace(PAPER, name="paper-unenhanced", modes=())

PAPER_39 = replace(
    PAPER,
    name="paper-39",
    rule=gauss(3),
    modes=(
        *(Mode(3, *powers) for powers in ((1, 0), (0, 1), (1, 1), (2, 0), (0, 2), (1, 2), (2, 1))),
        *(Mode(1, *powers) for powers in ((2, 0), (1, 2), (2, 1))),
        *(Mode(2, *powers) for powers in ((0, 2), (1, 2), (2, 1))),
    ),
)
