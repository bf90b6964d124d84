"""Planned areas drawn and meshed by gmsh."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from magshell.arrays import FloatArray
from magshell.mesh.drawings.joining import Chain
from magshell.mesh.drawings.nesting import NEAR, Plan
from magshell.mesh.drawings.pieces import Piece
from magshell.mesh.files.assembling import FileMesh
from magshell.mesh.files.cad import ATTEMPTS, MANY, QUASI_STRUCTURED, Attempt, best, use_size
from magshell.mesh.files.session import session

SPAN = np.radians(60.0)
"""Longest arc that is one curve: a hole has six elements around it or more."""
SMOOTH = np.radians(30.0)
"""Short lines that meet at a smaller angle stand for a curve."""
FEWEST = 3
"""So many in a row."""


def mesh_plan(plan: Plan, name: str, size: float) -> FileMesh:
    """Mesh with elements of a size, mm; gmsh is to be in a process of its own."""
    with session(name) as gmsh:
        pencil = _Pencil(gmsh, plan, size)
        pencil.draw()
        use_size(gmsh, size, plan.area, "mm")
        attempts: tuple[Attempt, ...] = ATTEMPTS
        if plan.area > MANY * size**2:
            attempts = tuple(sorted(attempts, key=lambda each: (not each.recombine, each == QUASI_STRUCTURED)))
        mesh = best(gmsh, name, "mm", False, attempts)
    changes = (*plan.notes, *pencil.notes, *mesh.origin.changes)
    return replace(mesh, origin=replace(mesh.origin, changes=changes))


class _Pencil:
    """Draws a plan with gmsh's OpenCASCADE kernel, in mm."""

    def __init__(self, gmsh: Any, plan: Plan, size: float) -> None:
        self.gmsh, self.plan, self.size = gmsh, plan, size
        self._tags: dict[tuple[float, ...], int] = {}
        self._smoothed, self._off = 0, 0.0

    @property
    def notes(self) -> list[str]:
        """What is not as drawn."""
        if not self._smoothed:
            return []
        return [
            f"{self._smoothed} lines shorter than an element, in rows that bend smoothly, put on curves through their "
            f"ends, at most {self._off:.2g} mm off them"
        ]

    def draw(self) -> None:
        """Surfaces that share their curves, facing up, and their groups."""
        occ = self.gmsh.model.occ
        surfaces: list[list[tuple[int, int]]] = []
        for face in self.plan.faces:
            own = [(2, self._surface(face.outline))]
            if face.cut:
                own, _ = occ.cut(own, [(2, self._surface(hole)) for hole in face.cut])
            surfaces.append([pair for pair in own if pair[0] == 2])
        marks = [(1, tag) for mark in self.plan.marks for tag in self._curves(mark)]
        every = [pair for own in surfaces for pair in own]
        if len(every) > 1 or marks:
            _, made = occ.fragment(every[:1], every[1:] + marks)
            begin = 0
            for number, own in enumerate(surfaces):
                surfaces[number] = [pair for parts in made[begin : begin + len(own)] for pair in parts if pair[0] == 2]
                begin += len(own)
        occ.synchronize()
        model = self.gmsh.model
        inside = {pair for face in model.getEntities(2) for pair in model.mesh.getEmbedded(*face)}
        loose = [
            pair for pair in model.getEntities(1) if pair not in inside and not len(model.getAdjacencies(*pair)[0])
        ]
        if loose:
            occ.remove(loose, recursive=True)
            occ.synchronize()
        self._name_surfaces(surfaces)
        self._name_curves()
        for _, tag in self.gmsh.model.getEntities(2):
            low, high = self.gmsh.model.getParametrizationBounds(2, tag)
            middle = [0.5 * (begin + end) for begin, end in zip(low, high, strict=True)]
            if self.gmsh.model.getNormal(tag, middle)[2] < 0.0:
                self.gmsh.model.mesh.setReverse(2, tag)

    def _name_surfaces(self, surfaces: list[list[tuple[int, int]]]) -> None:
        """Each surface is in the group of the deepest face that it is a part of."""
        owner = {}
        for face, own in zip(self.plan.faces, surfaces, strict=True):
            owner.update(dict.fromkeys(own, face.group))
        for group in dict.fromkeys(face.group for face in self.plan.faces):
            tags = [tag for (_, tag), name in owner.items() if name == group]
            if tags:
                self.gmsh.model.addPhysicalGroup(2, tags, name=group)

    def _name_curves(self) -> None:
        """Each curve is in the groups whose pieces it lies on."""
        from shapely import MultiLineString, MultiPoint

        near = NEAR * self.plan.size + self._off
        middles = {}
        for _, tag in self.gmsh.model.getEntities(1):
            (low,), (high,) = self.gmsh.model.getParametrizationBounds(1, tag)
            at = self.gmsh.model.getValue(1, tag, [low + share * (high - low) for share in (0.25, 0.5, 0.75)])
            middles[tag] = MultiPoint(np.reshape(at, (3, 3))[:, :2])
        for group, pieces in self.plan.edges.items():
            along = MultiLineString([piece.fine() for piece in pieces]).buffer(near)
            tags = [tag for tag, at in middles.items() if along.contains(at)]
            if tags:
                self.gmsh.model.addPhysicalGroup(1, tags, name=group)

    def _surface(self, chain: Chain) -> int:
        occ = self.gmsh.model.occ
        return int(occ.addPlaneSurface([occ.addCurveLoop(self._curves(chain))]))

    def _curves(self, chain: Chain) -> list[int]:
        tags: list[int] = []
        self._tags.clear()  # with its surface, a hole takes its points away
        for run in self._runs(chain):
            if len(run) > 1:
                points = np.concatenate([*(piece.points[:-1] for piece in run), run[-1].points[-1:]])
                tags += self._splines(points)
                self._smoothed += len(run)
                turns = [_turn(one, other) for one, other in pairwise(run)]
                longest = max(piece.length for piece in run if piece.line) if any(p.line for p in run) else 0.0
                self._off = max(self._off, 0.125 * longest * max(turns))
            elif run[0].line:
                tags.append(self.gmsh.model.occ.addLine(*map(self._point, run[0].points)))
            elif run[0].arc:
                tags += self._arcs(run[0])
            else:
                tags += self._splines(run[0].points)
        return tags

    def _runs(self, chain: Chain) -> list[list[Piece]]:
        """Pieces one by one, but those shorter than an element together where they bend smoothly."""
        pieces = list(chain.pieces)
        joined = [
            one.length < self.size and other.length < self.size and _turn(one, other) < SMOOTH
            for one, other in zip(pieces, pieces[1:] + pieces[:1], strict=True)
        ]
        if chain.closed and not all(joined):
            first = joined.index(False) + 1
            pieces = pieces[first:] + pieces[:first]
            joined = joined[first:] + joined[:first]
        runs: list[list[Piece]] = [[]]
        for piece, goes_on in zip(pieces, joined, strict=True):
            runs[-1].append(piece)
            if not goes_on:
                runs.append([])
        result: list[list[Piece]] = []
        for run in runs:
            result += [run] if len(run) >= FEWEST else [[piece] for piece in run]
        return result

    def _point(self, position: FloatArray) -> int:
        place = tuple(position.tolist())
        if place not in self._tags:
            self._tags[place] = self.gmsh.model.occ.addPoint(*place, 0.0)
        return self._tags[place]

    def _arcs(self, piece: Piece) -> list[int]:
        centre = self.gmsh.model.occ.addPoint(*piece.centre(), 0.0)
        away = (piece.points - piece.centre()) @ (1.0, 1.0j)
        span = abs(float(np.unwrap(np.angle(away))[-1] - np.angle(away[0])))
        ends = np.linspace(0, len(piece.points) - 1, int(np.ceil(span / SPAN - 1e-6)) + 1).round().astype(int)
        tags = []
        for begin, end in pairwise(ends.tolist()):
            one, other = self._point(piece.points[begin]), self._point(piece.points[end])
            tags.append(self.gmsh.model.occ.addCircleArc(one, centre, other))
        self.gmsh.model.occ.remove([(0, centre)])
        return tags

    def _splines(self, points: FloatArray) -> list[int]:
        """A curve through points; a closed one in three pieces that meet smoothly."""
        parts = 3 if (points[0] == points[-1]).all() else 1
        ends = np.linspace(0, len(points) - 1, parts + 1).round().astype(int)
        tags = []
        for begin, end in pairwise(ends.tolist()):
            tags.append(self.gmsh.model.occ.addSpline([self._point(point) for point in points[begin : end + 1]]))
        return tags


def _turn(one: Piece, other: Piece) -> float:
    """Angle between the end of a piece and the beginning of the next, rad."""
    ahead, following = one.points[-1] - one.points[-2], other.points[1] - other.points[0]
    across = ahead[0] * following[1] - ahead[1] * following[0]
    return float(abs(np.arctan2(across, ahead @ following)))
