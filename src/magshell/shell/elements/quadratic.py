"""Quadratic u, w and micro-rotation, bilinear thickness stretch, reduced integration."""

from __future__ import annotations

from magshell.shell.elements.definition import ElementType, gauss

QUADRATIC = ElementType(name="quadratic", rest_nodes=8, stretch_nodes=4, rule=gauss(2))
