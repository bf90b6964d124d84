"""Where letters stand in a picture: beside what they name, clear of each other and of what is drawn."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from magshell.arrays import AnyArray, FloatArray
from magshell.output.marks import Mark, Solids

if TYPE_CHECKING:
    from magshell.output.scene import Camera

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


def write_letters(axes: Any, marks: list[Mark], camera: Camera) -> list[Mark]:
    """Write the letters of marks where they cover neither marks nor each other; marks that say if some had no room."""
    from matplotlib.patheffects import withStroke

    def on_page(points: FloatArray) -> FloatArray:
        return np.array([axes.transAxes.transform(camera.on_picture(point)) for point in points]).reshape(-1, 2)

    point = axes.figure.dpi / 72.0
    written, texts = [], []
    for mark in marks:
        for text, position, towards in mark.letters:
            label = axes.text(
                0.0, 0.0, text, transform=None, ha="center", va="center", color=mark.colour, fontsize=14,
                path_effects=[withStroke(linewidth=3.0, foreground="white")],
            )  # fmt: skip
            box = label.get_window_extent()
            size = (box.width + 2.0 * point, box.height)
            written.append((mark, label))
            texts.append(Text(on_page(position[None])[0], size, towards, mark.solids is not Solids.BALLS))
    scale = axes.bbox.width / (2.0 * camera.half_width)
    boxes = [_boxes(on_page(mark.covered), max(0.5 * scale * mark.width, 2.0 * point)) for mark in marks]
    kept = [box for mark, box in zip(marks, boxes, strict=True) if mark.letters]
    spared = [box for mark, box in zip(marks, boxes, strict=True) if not mark.letters]
    none = np.zeros((0, 4))
    page = np.array(axes.bbox.extents)
    middles = placed(texts, np.concatenate([none, *kept]), np.concatenate([none, *spared]), page, BESIDE * point)
    without: dict[int, int] = {}
    for (mark, label), middle in zip(written, middles, strict=True):
        if np.isnan(middle).any():
            label.remove()
            without[id(mark)] = without.get(id(mark), 0) + 1
        else:
            label.set_position(middle)
    return [_told(mark, without.get(id(mark), 0)) for mark in marks]


def _told(mark: Mark, without: int) -> Mark:
    """With the number of names in the legend if some places have none."""
    named, count = len(mark.letters) - without, len(mark.places)
    some = mark.solids is Solids.BALLS and mark.letters and named < count
    return replace(mark, name=f"{mark.name}, {named} of {count} named") if some else mark


def _boxes(points: FloatArray, half: float) -> FloatArray:
    """Squares (n, 4) about points (n, 2)."""
    return np.concatenate([points - half, points + half], axis=1)


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
