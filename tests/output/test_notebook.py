"""How objects show themselves in a notebook."""

from __future__ import annotations

import base64
import dataclasses
import io
import re
import subprocess
import sys
import time

import numpy as np
import pytest
from magnetics.fields.cases import SHAPES
from PIL import Image

import magshell as ms
from magshell.magnetics.fields import MagnetField, Motion, Source
from magshell.output.sketch import paint, tessellate

LENGTH = 10e-3


def strip_model(**changes):
    mesh = ms.mesh.rectangle(LENGTH, 2e-3, elements=(4, 1))
    mesh = dataclasses.replace(mesh, element_groups={"<root>": np.array([0, 1])}, node_groups={"corner": np.array([0])})
    rubber = ms.MicropolarNeoHookean(303e3, 7.3e6, 30.3e3, 8e-5)
    shell = ms.Shell(mesh, 0.8e-3, rubber, ms.remanence.constant([143e-3, 0, 0]))
    parts = {"field": ms.UniformField([0, 0, 5e-3]), "probes": {"tip & end": (LENGTH, 1e-3, 0)}}
    return ms.Model(shell, [ms.Clamp("left")], **{**parts, **changes})


@pytest.fixture(scope="module")
def path():
    return ms.solve(strip_model())


@pytest.fixture(scope="module")
def buckled():
    return ms.buckling(strip_model(field=ms.UniformField([-5e-3, 0, 0])), modes=2)


def picture(shown: str) -> Image.Image:
    """The one picture of a page."""
    (source,) = re.findall(r'src="data:image/png;base64,([^"]+)"', shown)
    return Image.open(io.BytesIO(base64.b64decode(source))).convert("RGB")


def shades(image: Image.Image) -> int:
    """How many colours there are that cover more than a few pixels."""
    return sum(count > 5 for count, _ in image.getcolors(1 << 24))


def table(shown: str) -> str:
    return re.sub(r"<[^>]+>", " ", re.sub("<img[^>]*>", "", shown))


def test_a_mesh_shows_its_groups():
    shown = strip_model().shell.mesh._repr_html_()
    assert shades(picture(shown)) > 20
    text = table(shown)
    for part in ("4, 23", "10 mm × 2 mm × 0", "&lt;root&gt; (2)", "left (1)", "corner (1)"):
        assert part in text, text


def test_a_model_shows_what_acts():
    shown = strip_model()._repr_html_()
    assert shades(picture(shown)) > 20
    text = table(shown)
    for part in ("0.8 mm", "303 kPa", "143 mT", "(0, 0, 5 mT)", "Clamp on left", "tip &amp; end"):
        assert part in text, text


def test_a_problem_shows_its_title_and_doubts(tmp_path):
    file = tmp_path / "strip.toml"
    thick = ms.problem.load("strip-10").text.replace('thickness = "1.1 mm"', 'thickness = "4 mm"')
    file.write_text(thick)
    shown = ms.problem.load(file)._repr_html_()
    assert "Strip of aspect ratio 10" in table(shown)
    warned = [line for line in table(shown).splitlines() if "thick" in line]
    assert warned, table(shown)


def test_a_path_shows_where_it_ended(path):
    shown = path._repr_html_()
    image = picture(shown)
    assert image.width > 900, "the curves are not there"
    assert shades(image) > 60
    text = table(shown)
    u1, u3 = (f"{1e3 * path.probe('tip & end').u[-1, i]:.4g}" for i in (0, 2))
    for part in ("yes", "|B| = 5 mT", "u of tip &amp; end", f"({u1}, 0, {u3}) mm"):
        assert part in text, text


def test_a_path_that_failed_says_why(path):
    failed = dataclasses.replace(path, steps=path.steps[:2], converged=False, reason="element 3 turned <inside out>")
    assert "no: element 3 turned &lt;inside out&gt;" in table(failed._repr_html_())
    assert "element 3 turned" in repr(failed)


def test_a_path_without_steps_or_with_one(path):
    nothing = dataclasses.replace(path, steps=[], converged=False, reason="not finished")
    assert "<img" not in nothing._repr_html_()
    assert "not finished" in nothing._repr_html_()
    start = dataclasses.replace(path, steps=path.steps[:1], converged=False, reason="not finished")
    assert shades(picture(start._repr_html_())) > 3


def test_buckling_shows_its_modes(buckled):
    shown = buckled._repr_html_()
    assert shades(picture(shown)) > 60
    for mode in buckled.modes:
        assert f"load factor {mode.load_factor:.5g}" in table(shown), table(shown)


def test_without_matplotlib_the_table_stands_alone(path, monkeypatch):
    for module in [name for name in sys.modules if name.split(".")[0] == "matplotlib"]:
        monkeypatch.setitem(sys.modules, module, None)
    for thing in (path.model.shell.mesh, path.model, path):
        shown = thing._repr_html_()
        assert "<img" not in shown
        assert "<table" in shown


def test_a_large_mesh_is_hardly_slower():
    """With 25 times as many elements."""
    spent = []
    for elements in ((20, 10), (100, 50)):
        mesh = ms.mesh.cylinder(10e-3, 40e-3, elements=elements, angle=(0, 300))
        mesh._repr_html_()
        start = time.process_time()
        mesh._repr_html_()
        spent.append(time.process_time() - start)
    assert spent[1] < 6 * spent[0], spent


@pytest.mark.parametrize("above", ["red", "blue"])
def test_what_is_nearer_hides_what_is_behind(above):
    """Two sheets, one over the other, seen from above: of the lower one less is seen."""
    from matplotlib.colors import to_rgb
    from matplotlib.figure import Figure

    below = "blue" if above == "red" else "red"
    sheet, up = ms.mesh.rectangle(1.0, 1.0, elements=(2, 2)), np.array([0.0, 0.0, 0.2])
    points = np.vstack([sheet.points, sheet.points + up])
    both = ms.mesh.Mesh(points, np.vstack([sheet.elements, sheet.elements + len(sheet.points)]))
    cells = tessellate(both)
    colours = cells.on_elements(np.repeat([to_rgb(below), to_rgb(above)], 4, axis=0))
    figure, drawn = Figure(figsize=(3, 3), dpi=80, facecolor="white"), io.BytesIO()
    paint(figure.add_axes((0, 0, 1, 1)), both, cells, np.zeros_like(points), colours)
    figure.savefig(drawn, format="png")
    red, _, blue = (np.asarray(Image.open(drawn).convert("RGB"))[..., k].astype(int) for k in range(3))
    seen = {"red": int((red - blue > 100).sum()), "blue": int((blue - red > 100).sum())}
    assert seen[below] > 500, seen
    assert seen[above] > 1.3 * seen[below], seen


def test_the_words_are_few(path, buckled):
    shown = [path, path.steps[1], path.model, path.model.shell, path.model.shell.mesh, *buckled.modes]
    shown += [ms.problem.load("magnetic-arch")]
    for thing in shown:
        text = repr(thing)
        assert text.startswith(type(thing).__name__), text
        assert len(text) < 1500, text
        assert "array(" not in text, text
        assert "0x" not in text, text


def test_the_core_does_not_import_pictures():
    code = "import sys, magshell.mesh, magshell.model.model, magshell.solver.path; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"magshell.output.notebook", "magshell.output.sketch", "matplotlib", "PIL"} & set(loaded)


def test_magnets_are_drawn_where_they_are():
    motion = Motion(history=(1.0,), displacement=((0, 0, 0),))
    magnet = MagnetField([Source(SHAPES["cylinder"], (0.0, 0.0, -30e-3))], motion)
    path = ms.solve(strip_model(field=magnet))
    for html in (path._repr_html_(), path.model._repr_html_()):
        content = re.search(r"base64,([^\"]*)", html)[1]
        picture = np.asarray(Image.open(io.BytesIO(base64.b64decode(content))).convert("RGB"), dtype=int)
        red, blue = picture[..., 0] - picture[..., 2] > 90, picture[..., 2] - picture[..., 0] > 90
        assert min(red.mean(), blue.mean()) > 0.01
        assert np.nonzero(red)[0].mean() < np.nonzero(blue)[0].mean(), "the north pole is above"
