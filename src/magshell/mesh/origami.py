"""Folded sheets of equal parallelograms."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.arguments import angle, divisions, positive
from magshell.mesh.edges import find_edges
from magshell.mesh.grid import Grid, grid
from magshell.mesh.mesh import Mesh


def miura(sides: Sequence[float], sector: float, fold: float, cells: Sequence[int], elements: Sequence[int]) -> Mesh:
    r"""Miura-ori: a sheet of equal parallelograms in some folded state, with its creases named.

    Parameters
    ----------
    sides : (float, float)
        Sides of a panel, m: b, in the zigzag lines, which run along X1, and a, in the lines along X2.
    sector : float
        Acute angle γ of a panel, degrees.
    fold : float
        Angle θ between the panels and the plane X1-X2, degrees: 0 is flat, 90 folded together.
    cells : (int, int)
        Number of cells along X1 and X2, of two by two panels each.
    elements : (int, int)
        Number of elements of a panel along these.

    Returns
    -------
    Mesh
        Of second order, its normal towards +X3, with an element group panel-I-J for each panel (counted from 1 along X1
        and X2), the edge groups mountain and valley (creases that are ridges and grooves seen from +X3), and left,
        right, bottom and top, as of a rectangle.

    Raises
    ------
    InputError
        Sides that are not positive, angles out of range, numbers below 1.

    Notes
    -----
    With $t = \cos\theta\tan\gamma$ a cell is $2S$ wide, $2L$ long and $H$ high, and its zigzag lines go up and down by
    $V$ along X2:

        H = a sin θ sin γ,  S = b t / √(1 + t²),  L = a √(1 - sin²θ sin²γ),  V = b / √(1 + t²).

    M. Schenk and S. D. Guest, "Geometry of Miura-folded metamaterials", PNAS 110 (2013).
    """
    pair = tuple(sides) if isinstance(sides, Sequence) else ()
    if len(pair) != 2:
        raise InputError(f"miura: sides = {sides!r} is not allowed; it must be two lengths, in m.")
    b, a = (positive("miura", "sides", side) for side in pair)
    γ = math.radians(angle("miura", "sector", sector, 0.0, 90.0))
    if fold != 0.0:
        fold = angle("miura", "fold", fold, 0.0, 90.0)
    θ = math.radians(fold)
    panels = tuple(2 * number for number in divisions("miura", cells, "cells"))
    per_panel = divisions("miura", elements)
    pattern = grid(panels[0] * per_panel[0], panels[1] * per_panel[1])
    t = math.cos(θ) * math.tan(γ)
    S, V = b * t / math.hypot(1.0, t), b / math.hypot(1.0, t)
    L, H = a * math.sqrt(1.0 - (math.sin(θ) * math.sin(γ)) ** 2), a * math.sin(θ) * math.sin(γ)
    x, y = (pattern.parameters * panels).T
    points = np.stack([S * x, L * y + V * _zigzag(x), H * _zigzag(y)], axis=1)
    outer = pattern.sides({"left": (0, 0.0), "right": (0, 1.0), "bottom": (1, 0.0), "top": (1, 1.0)})
    return Mesh(points, pattern.elements, _panels(pattern, panels), _creases(pattern, panels) | outer)


def _zigzag(x: FloatArray) -> FloatArray:
    """0 at even numbers, 1 at odd ones, linear between."""
    return np.asarray(1.0 - np.abs(x % 2.0 - 1.0))


def _panels(pattern: Grid, panels: tuple[int, ...]) -> dict[str, IntArray]:
    """Elements of each panel, row by row."""
    centre = pattern.parameters[pattern.elements[:, :4]].mean(axis=1) * panels
    number = np.floor(centre).astype(int) @ [1, panels[0]]
    members = np.split(np.argsort(number, kind="stable"), np.cumsum(np.bincount(number))[:-1])
    names = [f"panel-{i + 1}-{j + 1}" for j in range(panels[1]) for i in range(panels[0])]
    return dict(zip(names, members, strict=True))


def _creases(pattern: Grid, panels: tuple[int, ...]) -> dict[str, IntArray]:
    """Edges (k, 3) between panels: the zigzag lines are ridges and grooves by turns, the others change at each."""
    edges = find_edges(pattern.elements)
    rows = edges.sides[edges.first_side[edges.sharing == 2]]
    at = pattern.parameters[rows] * panels
    line = np.rint(at)
    on = (np.abs(at - line) < 1e-9).all(axis=1)
    zigzag, straight = on[:, 1], on[:, 0]
    i, j = line[:, 0, 0], np.floor(at[:, 2, 1])
    ridge = np.where(zigzag, line[:, 0, 1] % 2 == 1, (i + j) % 2 == 0)
    return {"mountain": rows[(zigzag | straight) & ridge], "valley": rows[(zigzag | straight) & ~ridge]}
