"""Lines of a drawing joined end to end: closed outlines, and lines that mark parts of them."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, replace

import numpy as np

from magshell.arrays import FloatArray, IntArray
from magshell.errors import InputError
from magshell.mesh.drawings.pieces import Piece

GAP = 1e-4
"""Of the size of a drawing: ends closer than this are joined, unless another distance is asked for."""
EXACT = 1e-9
"""Of its size: ends closer than this are the same, without a note."""


@dataclass(frozen=True, eq=False)
class Chain:
    """Pieces, each of which begins where the one before ends."""

    pieces: tuple[Piece, ...]

    @property
    def layer(self) -> str:
        """On which most of its length lies."""
        lengths: dict[str, float] = defaultdict(float)
        for piece in self.pieces:
            lengths[piece.layer] += piece.length
        return max(lengths, key=lambda layer: lengths[layer])

    @property
    def begin(self) -> FloatArray:
        """Its first point."""
        begin: FloatArray = self.pieces[0].points[0]
        return begin

    @property
    def end(self) -> FloatArray:
        """Its last point."""
        end: FloatArray = self.pieces[-1].points[-1]
        return end

    @property
    def closed(self) -> bool:
        """Whether it ends where it begins."""
        return bool((self.begin == self.end).all())

    def fine(self) -> FloatArray:
        """Points of all pieces; of a closed one the first point is the last."""
        return np.concatenate([*(piece.fine()[:-1] for piece in self.pieces), [self.end]])


class Joined:
    """Outlines, and the lines that are left.

    Parameters
    ----------
    pieces : list of Piece
        In mm.
    gap : float or None
        Distance of ends that are joined, mm; None: 1e-4 of the size.
    merging : bool
        Whether lines in a row and in one direction become one.

    Attributes
    ----------
    outlines, open : list of Chain
    size : float
        Diagonal of the drawing, mm.
    gap : float
        As above.
    notes : list of str
        What was done.

    Raises
    ------
    InputError
        Nothing is drawn, or more than two lines of a layer meet at an end.
    """

    def __init__(self, pieces: list[Piece], gap: float | None, merging: bool = False) -> None:
        self.notes: list[str] = []
        self._merging = merging
        if not pieces:
            raise InputError("draws no lines")
        self.size = float(np.linalg.norm(np.ptp(np.concatenate([piece.points for piece in pieces]), axis=0)))
        if not self.size > 0.0:
            raise InputError("draws nothing: none of its lines has a length")
        self.gap = GAP * self.size if gap is None else gap
        self._widest, self._gaps = 0.0, 0
        self.outlines: list[Chain] = []
        loose = self._without_closed_ones(self._long_enough(pieces))
        layers: dict[str, list[Piece]] = defaultdict(list)
        for piece in self._without_repetitions(loose):
            layers[piece.layer].append(piece)
        left: list[Chain] = []
        for own in layers.values():
            chains = self._chains([Chain((piece,)) for piece in own], strict=True)
            self.outlines += [chain for chain in chains if chain.closed]
            left += [chain for chain in chains if not chain.closed]
        chains = self._chains(left, strict=False)
        self.outlines += [chain for chain in chains if chain.closed]
        self.open = [chain for chain in chains if not chain.closed]
        if self._widest > EXACT * self.size:
            self.notes.append(
                f"{self._gaps} gap{'s' * (self._gaps > 1)} between ends of lines closed, up to {self._widest:.2g} mm"
            )

    def _long_enough(self, pieces: list[Piece]) -> list[Piece]:
        pieces = [piece for piece in pieces if piece.length > EXACT * self.size]
        kept = [piece for piece in pieces if piece.length > self.gap]
        if short := len(pieces) - len(kept):
            self.notes.append(
                f"{short} line{'s' * (short > 1)} left out, shorter than the gap that is closed ({self.gap:.2g} mm)"
            )
        return kept

    def _without_closed_ones(self, pieces: list[Piece]) -> list[Piece]:
        """The pieces but for those of polylines that are closed by themselves, which become outlines."""
        entities: dict[int, list[Piece]] = defaultdict(list)
        for piece in pieces:
            entities[piece.entity].append(piece)
        loose = entities.pop(-1, [])
        for own in entities.values():
            chains = self._chains([Chain((piece,)) for piece in own], strict=False)
            if len(chains) == 1 and chains[0].closed:
                self.outlines += chains
            else:
                loose += own
        return loose

    def _without_repetitions(self, pieces: list[Piece]) -> list[Piece]:
        """Each piece once."""
        kept: list[Piece] = []
        known: set[tuple[object, ...]] = set()
        twice = 0
        for piece in pieces:
            middle = piece.fine()
            rounded = [
                tuple(np.round(point / (1e-7 * self.size)).astype(np.int64).tolist())
                for point in (
                    piece.points[0],
                    piece.points[-1],
                    middle[len(middle) // 2],
                    middle[(len(middle) - 1) // 2],
                )
            ]
            key = (piece.layer, piece.line, *sorted(rounded))
            twice += key in known
            if key not in known:
                known.add(key)
                kept.append(piece)
        if twice:
            self.notes.append(f"{twice} line{'s' * (twice > 1)} left out, drawn twice")
        return kept

    def _chains(self, chains: list[Chain], strict: bool) -> list[Chain]:
        """Chains joined where the ends of just two of them meet."""
        done = [chain for chain in chains if chain.closed]
        chains = [chain for chain in chains if not chain.closed]
        if not chains:
            return done
        ends = np.array([end for chain in chains for end in (chain.begin, chain.end)])
        node = self._nodes(ends)
        meeting: dict[int, list[int]] = defaultdict(list)
        for number, where in enumerate(node.tolist()):
            meeting[where].append(number)
        for at in meeting.values():
            if strict and len(at) > 2:
                x, y = ends[at].mean(axis=0)
                raise InputError(
                    f"layer '{chains[at[0] // 2].layer}': {len(at)} lines meet at ({x:.6g}, {y:.6g}) mm. An outline "
                    "has no branches: draw areas that share a side as outlines of their own, each on its layer"
                )
        partner = np.full(len(ends), -1)
        for at in meeting.values():
            if len(at) == 2:
                partner[at[0]], partner[at[1]] = at[1], at[0]
        seen = np.zeros(len(chains), dtype=bool)
        starts = sorted(range(len(ends)), key=lambda end: (partner[end] >= 0, end))
        for start in starts:
            if not seen[start // 2]:
                done.append(self._walked(chains, ends, partner, start, seen))
        return done

    def _nodes(self, ends: FloatArray) -> IntArray:
        """Number of the place where each end is: ends closer than the gap are at one place."""
        from scipy.sparse import coo_matrix
        from scipy.sparse.csgraph import connected_components
        from scipy.spatial import cKDTree

        pairs = cKDTree(ends).query_pairs(self.gap, output_type="ndarray")
        graph = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=2 * (len(ends),))
        node: IntArray = connected_components(graph, directed=False)[1].astype(np.int64)
        return node

    def _walked(self, chains: list[Chain], ends: FloatArray, partner: IntArray, start: int, seen: IntArray) -> Chain:
        """The pieces from one end on, until there is no other to go on with."""
        pieces: list[Piece] = []
        at = start
        while True:
            number, turned = divmod(at, 2)
            seen[number] = True
            own = chains[number].pieces
            pieces += [piece.reversed for piece in reversed(own)] if turned else own
            far = at ^ 1
            at = int(partner[far])
            if at < 0 or seen[at // 2]:
                break
        walked = self._without_gaps(pieces, closed=at >= 0)
        return Chain(tuple(straightened(walked, self.size) if self._merging else walked))

    def _without_gaps(self, pieces: list[Piece], closed: bool) -> list[Piece]:
        """Pieces moved so that each begins where the one before ends: half way between the two ends."""
        begins = [piece.points[0] for piece in pieces]
        ends = [piece.points[-1] for piece in pieces]
        for number in range(len(pieces) if closed else len(pieces) - 1):
            following = (number + 1) % len(pieces)
            apart = float(np.linalg.norm(begins[following] - ends[number]))
            if apart > 0.0:
                ends[number] = begins[following] = 0.5 * (begins[following] + ends[number])
            if apart > EXACT * self.size:
                self._widest, self._gaps = max(self._widest, apart), self._gaps + 1
        return [
            piece if (begin == piece.points[0]).all() and (end == piece.points[-1]).all() else piece.between(begin, end)
            for piece, begin, end in zip(pieces, begins, ends, strict=True)
        ]


def straightened(pieces: list[Piece], size: float) -> list[Piece]:
    """Lines in a row, on one layer and in one direction, as one line."""
    kept: list[Piece] = []
    for piece in pieces:
        if kept and _in_line(kept[-1], piece, size):
            kept[-1] = replace(piece, points=np.array([kept[-1].points[0], piece.points[-1]]))
        else:
            kept.append(piece)
    closed = len(kept) > 3 and (kept[0].points[0] == kept[-1].points[-1]).all()
    if closed and _in_line(kept[-1], kept[0], size):
        kept[0] = replace(kept[0], points=np.array([kept.pop().points[0], kept[0].points[-1]]))
    return kept


def _in_line(one: Piece, other: Piece, size: float) -> bool:
    if not (one.line and other.line and one.layer == other.layer):
        return False
    ahead, following = one.points[1] - one.points[0], other.points[1] - other.points[0]
    off = abs(ahead[0] * following[1] - ahead[1] * following[0]) / np.linalg.norm(ahead + following)
    return bool(ahead @ following > 0.0 and off <= EXACT * size)
