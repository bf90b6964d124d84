"""Nastran's bulk data written in free, small and long fields."""

from __future__ import annotations

import numpy as np


def short(value):
    """A number in 8 columns, as Nastran writes it: 1.5-3 for 0.0015."""
    if isinstance(value, (int, np.integer)) or value == "":
        return str(value)
    for digits in range(7, 0, -1):
        text = f"{value:.{digits}g}"
        mantissa, _, exponent = text.partition("e")
        mantissa = mantissa if "." in mantissa else f"{mantissa}."
        text = f"{mantissa}{int(exponent):+d}" if exponent else mantissa
        if len(text) <= 8:
            return text
    raise AssertionError(value)


def card(name, *fields, form="small"):
    """One card on as many lines as it needs."""
    texts = [f"{field:.9E}" if form == "long" and isinstance(field, float) else short(field) for field in fields]
    if form == "free":
        rows = [texts[start : start + 8] for start in range(0, len(texts), 8)]
        return "\n".join(f"{name if not row else ''},{','.join(each)}" for row, each in enumerate(rows))
    per, width, mark = (4, 16, "*") if form == "long" else (8, 8, "")
    rows = [texts[start : start + per] for start in range(0, len(texts), per)]
    heads = [f"{name}{mark}", *[mark or "+"] * len(rows)]
    return "\n".join(
        f"{head:<8}" + "".join(f"{text:<{width}}" for text in row) for head, row in zip(heads, rows, strict=False)
    )


def deck(points, elements, form="small", grid=lambda number, point: (number, "", *point), more=()):
    """Quadrilaterals of 4 or 8 nodes, triangles of 3 or 6, with their property: (nodes, property)."""
    names = {3: "CTRIA3", 4: "CQUAD4", 6: "CTRIA6", 8: "CQUAD8"}
    lines = ["SOL 101", "CEND", "BEGIN BULK", "$ a comment, with a comma", *more]
    lines += [card("GRID", *grid(number, point), form=form) for number, point in enumerate(points.tolist(), 1)]
    for number, (nodes, belongs) in enumerate(elements, 1):
        lines.append(card(names[len(nodes)], number, belongs, *(int(node) + 1 for node in nodes), form=form))
    return "\n".join([*lines, "ENDDATA", ""])
