"""Animations as files: GIF, and videos by ffmpeg."""

from __future__ import annotations

import io
import os
import pathlib
import tempfile
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from magshell.errors import InputError

if TYPE_CHECKING:
    from PIL.Image import Image

RATE = 25
"""Pictures in a second of a video."""
VIDEO = (".mp4", ".mov", ".m4v")


def require_writer(file: str | os.PathLike[str]) -> Callable[[Sequence[Image], Sequence[float]], bytes]:
    """What turns pictures and their seconds into the content of an animation of this suffix.

    Raises
    ------
    InputError
        A suffix that is none, or a video without the extra.
    """
    suffix = pathlib.Path(file).suffix.lower()
    if suffix == ".gif":
        return _gif
    if suffix not in VIDEO:
        raise InputError(f"{file}: an animation ends in .gif, {', '.join(VIDEO[:-1])} or {VIDEO[-1]}")
    try:
        import imageio_ffmpeg  # noqa: F401
    except ImportError:
        raise InputError(
            f"{file}: a video needs another package: pip install 'magshell[video]'. A .gif needs nothing"
        ) from None
    return lambda pictures, seconds: _video(pictures, seconds, suffix)


def _gif(pictures: Sequence[Image], seconds: Sequence[float]) -> bytes:
    from PIL.Image import Dither

    content = io.BytesIO()
    indexed = [picture.quantize(255, dither=Dither.NONE) for picture in pictures]
    duration = [10 * round(100 * time) for time in seconds]
    indexed[0].save(content, format="gif", save_all=True, append_images=indexed[1:], duration=duration, loop=0)
    return content.getvalue()


def _video(pictures: Sequence[Image], seconds: Sequence[float], suffix: str) -> bytes:
    import imageio_ffmpeg

    ends = np.rint(RATE * np.cumsum(seconds)).astype(int)
    counts = np.maximum(np.diff(ends, prepend=0), 1)
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / f"film{suffix}"
        ffmpeg = imageio_ffmpeg.write_frames(
            str(file), pictures[0].size, fps=RATE, codec="libx264", quality=8, macro_block_size=2
        )
        ffmpeg.send(None)
        for picture, count in zip(pictures, counts, strict=True):
            content = picture.tobytes()
            for _ in range(count):
                ffmpeg.send(content)
        ffmpeg.close()
        return file.read_bytes()
