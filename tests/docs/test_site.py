"""The documentation site: built strictly, its tutorial and an example executed; all examples in `make verify`."""

from __future__ import annotations

import html
import importlib
import inspect
import operator
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest
from PIL import Image

import magshell as ms
from magshell.output.rendering import RenderingUnavailable, require_rendering

ROOT = pathlib.Path(__file__).parents[2]
NOT_PAGES = ("_build", "worked-examples", "generated", "__pycache__")
GALLERY = sorted(path.stem for path in (ROOT / "docs" / "gallery").glob("plot_*.py"))
EXECUTED = "plot_1_strip"
PAGES = sorted(path.relative_to(ROOT / "docs").with_suffix("").as_posix() for path in (ROOT / "docs").glob("*.md"))
MODULES = ("magshell.mesh", "magshell.magnetics.remanence", "magshell.problem")


def built(folder, *options):
    """The folder of the site; its sources are copied, so that nothing of an earlier build is in it."""
    try:
        require_rendering()
    except RenderingUnavailable as unavailable:
        pytest.skip(str(unavailable))
    shutil.copytree(ROOT / "docs", folder / "docs", ignore=shutil.ignore_patterns(*NOT_PAGES))
    shutil.copy(ROOT / "CHANGELOG.md", folder)
    built = subprocess.run(
        [sys.executable, "-m", "sphinx", "-b", "html", "-j", "2", "-W", "--keep-going", "-q", *options, "docs", "html"],
        cwd=folder,
        env={**os.environ, "OMP_NUM_THREADS": "1", "MPLBACKEND": "agg"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stderr[-6000:]
    return folder / "html"


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """With one of the examples executed: all of them take minutes."""
    return built(tmp_path_factory.mktemp("site"), "-D", f"sphinx_gallery_conf.filename_pattern={EXECUTED}")


@pytest.fixture(scope="module")
def pages(site):
    """Text of every page, by name."""
    return {path.relative_to(site).as_posix(): path.read_text() for path in site.rglob("*.html")}


@pytest.mark.parametrize("name", PAGES)
def test_every_page_is_reached_from_the_front_page(pages, name):
    linked, waiting = set(), ["index.html"]
    while waiting:
        page = waiting.pop()
        if page in linked or page not in pages:
            continue
        linked.add(page)
        folder = pathlib.PurePosixPath(page).parent
        for target in re.findall(r'<a[^>]* href="([^"#:]+\.html)', pages[page]):
            waiting.append(os.path.normpath(folder / target))
    assert f"{name}.html" in linked, sorted(linked)


def check_pictures(site, name):
    page = (site / "worked-examples" / f"{name}.html").read_text()
    assert re.search(r'<img[^>]* src="(\.\./_images/sphx_glr_|data:image/png)', page), name
    thumbnail = Image.open(site / "_images" / f"sphx_glr_{name}_thumb.png").convert("L")
    dark = sum(count for grey, count in enumerate(thumbnail.histogram()) if grey < 200)
    assert dark > 300, f"{name}: {dark} pixels that are not background"


def test_an_example_has_pictures(site):
    check_pictures(site, EXECUTED)


@pytest.mark.verify
def test_examples_have_pictures(tmp_path):
    site = built(tmp_path)
    for name in GALLERY:
        check_pictures(site, name)


@pytest.mark.parametrize("name", GALLERY)
def test_what_examples_import_exists(name):
    """The small twin: names of magshell that an example says, `ms.` and what follows, are there."""
    text = (ROOT / "docs" / "gallery" / f"{name}.py").read_text()
    compile(text, name, "exec")
    said = sorted(set(re.findall(r"\bms((?:\.[A-Za-z]\w*)+)", text)))
    assert said
    for names in said:
        operator.attrgetter(names[1:])(ms)


def test_the_tutorial_was_executed(pages):
    text = pages["tutorial.html"]
    assert "formula 0.0" in text, "the comparison with the formula is not there"
    assert text.count("data:image/png") + text.count("_images/") >= 5
    assert "There is no group &#39;lefft&#39;" in text or "There is no group 'lefft'" in text


def test_no_page_has_an_empty_list_of_its_section(pages):
    empty = [name for name, text in pages.items() if 'class="bd-toc-item navbar-nav"></div>' in text]
    assert not empty, "list them in html_sidebars of docs/conf.py"


def test_nothing_comes_from_elsewhere(site, pages):
    loads = (
        r'<(?:script|img|iframe|source)[^>]* src="([^"]+)"|<link[^>]* rel="(?:stylesheet|preload)"[^>]* href="([^"]+)"'
    )
    for name, text in pages.items():
        for found in re.findall(loads, text):
            address = html.unescape("".join(found))
            assert not re.match(r"https?:|//", address), f"{name}: {address}"
    for sheet in site.rglob("*.css"):
        remote = re.findall(r"(?:url\(|@import )['\"]?(?:https?:|//)[^)'\"]*", sheet.read_text())
        assert not remote, f"{sheet.name}: {remote}"


def test_formulas_are_drawn(pages):
    theory = pages["theory.html"]
    assert theory.count("<math") > 200, theory.count("<math")
    for formula in re.findall(r"<math.*?</math>", theory, re.DOTALL):
        assert "\\" not in formula, formula


def public_names():
    """(module, name) of everything public."""
    yield from (("magshell", name) for name in ms.__all__ if not inspect.ismodule(getattr(ms, name)))
    for module in MODULES:
        yield from ((module, name) for name in importlib.import_module(module).__all__)


@pytest.mark.parametrize(("module", "name"), list(public_names()))
def test_the_reference_has_every_public_name(pages, module, name):
    page = f"api/generated/{module}.{name}.html"
    assert page in pages, "list it in docs/api/index.md"
    assert f'id="{module}.{name}"' in pages[page]
