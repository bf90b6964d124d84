"""Pictures of the gallery that are no matplotlib figures: those that magshell's own functions return."""

from __future__ import annotations

from typing import Any

from PIL.Image import Image
from sphinx_gallery.scrapers import figure_rst


class Pictures:
    """Shows the pictures that an example has put into variables since the block before."""

    def __init__(self) -> None:
        self._shown: list[Image] = []  # themselves, as the id of one that is gone may be that of a new one

    def __repr__(self) -> str:
        return "Pictures()"

    def __call__(self, block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
        """Save them where the page looks for them, and say so in its source."""
        files = []
        for value in list(block_vars["example_globals"].values()):
            if isinstance(value, Image) and not any(value is one for one in self._shown):
                self._shown.append(value)
                files.append(next(block_vars["image_path_iterator"]))
                value.save(files[-1])
        return figure_rst(files, gallery_conf["src_dir"])
