"""The common style of pictures, and how they are written or returned."""

from __future__ import annotations

import io
import os
import pathlib
from typing import TYPE_CHECKING, Any

from magshell.files import with_suffix, write_atomically

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from PIL.Image import Image
    from PIL.PngImagePlugin import PngInfo

MADE_BY = "magshell"
DPI = 160
INK = "#1a1f26"
GREY = "#4b5563"
PALE = "#8b95a1"
FAINT = "#d9dee5"
ACCENT = "#c2410c"
COLOURS = ("#1d4ed8", ACCENT, "#15803d", "#7e22ce", "#0891b2", "#be185d", "#65a30d", "#4b5563")
TEXT: dict[str, Any] = {"fontsize": 15, "color": INK}
TICKS: dict[str, Any] = {"labelsize": 13, "colors": GREY}


def deliver(figure: Figure, file: str | os.PathLike[str] | None) -> Image | None:
    """Write the figure as PNG if a file is named, else return it as a picture that a notebook shows.

    Raises
    ------
    InputError
        A name that does not end in `.png`.
    OSError
        The disk refuses; the message names the file.
    """
    target = None if file is None else with_suffix(file, ".png")
    content = compact_png(figure)
    if target is None:
        from PIL import Image

        return Image.open(io.BytesIO(content))
    write_atomically(target, content)
    return None


def compact_png(figure: Figure) -> bytes:
    """The figure as a PNG file without an opacity channel, which nobody needs and which makes it larger."""
    from PIL import Image

    drawn, compact = io.BytesIO(), io.BytesIO()
    figure.savefig(drawn, format="png", facecolor="white")
    Image.open(drawn).convert("RGB").save(compact, format="png", optimize=True, pnginfo=said())
    return compact.getvalue()


def said() -> PngInfo:
    """Metadata of every picture: that magshell made it."""
    from PIL.PngImagePlugin import PngInfo

    says = PngInfo()
    says.add_text("Software", MADE_BY)
    return says


def is_ours(file: pathlib.Path) -> bool:
    """Whether the metadata of a picture say that magshell made it."""
    with open(file, "rb") as opened:
        return MADE_BY.encode() in opened.read(1000)
