"""Where letters stand in a picture: beside what they name, clear of each other and of what is drawn."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray

BESIDE = 9.0
"""Points from a place to the letters beside it."""
FARTHER = (1.0, 2.0, 3.2)
"""Distances over `BESIDE`; the last is for letters that are needed, others would seem to name something else."""
DIRECTIONS = 16


class Text(NamedTuple):
    """Letters to be placed; all lengths are of the picture.

    Attributes
    ----------
    place : FloatArray, shape (2,)
        What they name.
    size : (float, float)
        Width and height.
    towards : (float, float)
        The direction in which they stand best; (0, 0): on the place.
    needed : bool
        Placed even if they cover something.
    """

    place: FloatArray
    size: tuple[float, float]
    towards: tuple[float, float]
    needed: bool


def placed(texts: list[Text], kept: FloatArray, spared: FloatArray, page: FloatArray, beside: float) -> AnyArray:
    """Middles (texts, 2) of the letters, one after the other; NaN for those that have no room.

    Parameters
    ----------
    texts : list of Text
    kept : FloatArray, shape (n, 4)
        Boxes (left, bottom, right, top) that no letters may cover.
    spared : FloatArray, shape (m, 4)
        Boxes of which they cover as few as can be.
    page : FloatArray, shape (4,)
        The box in which letters must be.
    beside : float
        From a place to the letters.
    """
    middles = np.full((len(texts), 2), np.nan)
    for number, text in enumerate(texts):
        found = _candidates(text, beside)
        half = 0.5 * np.array(text.size)
        boxes = np.concatenate([found - half, found + half], axis=1)
        inside = ((boxes[:, :2] >= page[:2]) & (boxes[:, 2:] <= page[2:])).all(axis=1)
        hard = _overlaps(boxes, kept) + 100 * ~inside
        if not text.needed and hard.min() > 0:
            continue
        best = int(np.lexsort((np.arange(len(found)), _overlaps(boxes, spared), hard))[0])
        middles[number] = found[best]
        kept = np.concatenate([kept, boxes[best : best + 1]])
    return middles


def _candidates(text: Text, beside: float) -> FloatArray:
    """Middles (n, 2) to try, the best first: on the place if it may be, then around it, nearer ones first."""
    towards = np.array(text.towards)
    first = np.arctan2(towards[1], towards[0])
    steps = np.arange(DIRECTIONS)
    turns = np.where(steps % 2, 1, -1) * ((steps + 1) // 2) * (2.0 * np.pi / DIRECTIONS)
    around = np.stack([np.cos(first + turns), np.sin(first + turns)], axis=1)
    half = 0.5 * np.array(text.size)
    # As far along each direction as it takes for the box to leave a circle about the place.
    reach = np.minimum(*(half / np.maximum(np.abs(around), 1e-9)).T)
    rings = [text.place + around * (reach + factor * beside)[:, None] for factor in FARTHER[: 3 if text.needed else 2]]
    return np.concatenate([[text.place] if not towards.any() else np.zeros((0, 2)), *rings])


def _overlaps(boxes: FloatArray, others: FloatArray) -> AnyArray:
    """How many of the others each box covers."""
    a, b = boxes[:, None], others[None]
    return np.asarray(((a[..., :2] < b[..., 2:]) & (a[..., 2:] > b[..., :2])).all(axis=-1).sum(axis=1))
