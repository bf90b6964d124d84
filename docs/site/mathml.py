r"""Formulas as MathML, which browsers draw themselves: no script from elsewhere, and a page reads the same offline.

What the translator does not know is a warning, so that the strict build fails where a reader would otherwise find
the name of a LaTeX command.
"""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging

LOGGER = logging.getLogger(__name__)
# \mathcal C to \mathcal{C}, which the translator turns into the letter itself; browsers know no other way.
ALPHABET = re.compile(r"\\(mathcal|mathbb|mathsf)\s+([A-Za-z])")
# Accents sit on their letters, and bars of a norm stand next to what they enclose.
SPACING = {
    "<mover><mi>": '<mover accent="true"><mi>',
    '<mo stretchy="false">&#x0007C;</mo>': '<mo stretchy="false" lspace="0" rspace="0">&#x0007C;</mo>',
    "<mo>&#x0007C;</mo>": '<mo lspace="0" rspace="0">&#x0007C;</mo>',
}


def _inline(translator: Any, node: nodes.Element) -> None:
    translator.body.append(_markup(node, "inline"))
    raise nodes.SkipNode


def _block(translator: Any, node: nodes.Element) -> None:
    translator.body.append(f'<div class="formula">{_markup(node, "block")}</div>\n')
    raise nodes.SkipNode


def _markup(node: nodes.Element, display: str) -> str:
    code = ALPHABET.sub(r"\\\1{\2}", node.astext().strip())
    if r"\\" in code and r"\begin{" not in code:
        code = rf"\begin{{aligned}}{code}\end{{aligned}}"
    try:
        markup = convert(code, display=display)
    except Exception as error:  # the translator has no common class of errors
        markup = f"\\{type(error).__name__}"
    for plain, spaced in SPACING.items():
        markup = markup.replace(plain, spaced)
    if "\\" in markup or re.search('mathvariant="(?!normal)', markup):
        LOGGER.warning("this formula is not understood: %s", code, location=node)
    return markup


def setup(app: Sphinx) -> dict[str, bool]:
    """Registered as `html_math_renderer = "mathml"`."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
