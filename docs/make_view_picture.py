"""Make the pictures of `docs/pictures.md`: the page of the gripper in a browser, and its animation.

python docs/make_view_picture.py       half a minute; needs Chromium and chromedriver
"""

from __future__ import annotations

import io
import pathlib
import sys
import tempfile

from magshell.cli import main
from magshell.files import write_atomically

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "tests"))

from browser.chromium import browser

DOCS = pathlib.Path(__file__).parent
PROBLEM, STEP = "gripper", 7
SHOWN = f"""
at("arrows").click();
go({STEP});
await new Promise(drawn => requestAnimationFrame(() => requestAnimationFrame(drawn)));
"""


def run() -> None:
    """Solve, write the page and the animation, and take a picture of the page."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for command in (
            ["run", PROBLEM, "--out", f"{folder}/results"],
            ["view", f"{folder}/results"],
            ["plot", f"{folder}/results", "--animate", f"{folder}/film.gif"],
        ):
            status = main(command)
            if status:
                raise SystemExit(status)
        write_atomically(DOCS / "images" / "gripper-film.gif", (folder / "film.gif").read_bytes())
        with browser(1400, 900) as window:
            window.open(folder / "results" / "view.html")
            window.do(SHOWN)
            content = io.BytesIO()
            window.picture().save(content, format="png", optimize=True)
        write_atomically(DOCS / "images" / "view.png", content.getvalue())


if __name__ == "__main__":
    run()
