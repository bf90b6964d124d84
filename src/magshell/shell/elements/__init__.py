"""Element types, one per file, as declared data."""

from __future__ import annotations

from magshell.shell.elements.definition import ElementType
from magshell.shell.elements.paper import PAPER
from magshell.shell.elements.quadratic import QUADRATIC

ELEMENTS = {element.name: element for element in (QUADRATIC, PAPER)}

__all__ = ["ELEMENTS", "PAPER", "QUADRATIC", "ElementType"]
