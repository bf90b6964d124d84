"""Element types as declared data."""

from __future__ import annotations

from magshell.shell.elements.definition import ElementType
from magshell.shell.elements.paper import PAPER, PAPER_39, PAPER_UNENHANCED
from magshell.shell.elements.quadratic import QUADRATIC

ELEMENTS = {element.name: element for element in (QUADRATIC, PAPER, PAPER_UNENHANCED, PAPER_39)}

__all__ = ["ELEMENTS", "PAPER", "PAPER_39", "PAPER_UNENHANCED", "QUADRATIC", "ElementType"]
