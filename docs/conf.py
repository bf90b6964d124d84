"""The documentation site: `make docs` builds it into docs/_build/html, and fails on any warning.

Pages are the Markdown files of this folder, which are read on GitHub too. Examples in gallery/ and the notebook are
executed by the build. Nothing is fetched from elsewhere, neither by the build nor by the pages.
"""

from __future__ import annotations

import pathlib
import sys

from sphinx.application import Sphinx

import magshell

HERE = pathlib.Path(__file__).parent
sys.path.insert(0, str(HERE / "site"))

from pictures import Pictures  # noqa: E402

project = "magshell"
author = "The magshell developers"
copyright = author
version = release = magshell.__version__

extensions = [
    "mathml",
    "myst_nb",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx_copybutton",
    "sphinx_gallery.gen_gallery",
]
nitpicky = True
exclude_patterns = ["_build", "*_study", "site", "gallery", "worked-examples/*.ipynb"]
templates_path = ["site/templates"]
nitpick_ignore_regex = [("py:class", r"(numpy|collections\.abc)\..*")]

myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 4
myst_dmath_double_inline = True
html_math_renderer = "mathml"
nb_execution_mode = "force"
nb_execution_timeout = 900
nb_execution_raise_on_error = True
nb_execution_show_tb = True
nb_merge_streams = True

autosummary_generate = True
autosummary_ignore_module_all = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
toc_object_entries_show_parents = "hide"
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "worked-examples",
    "filename_pattern": "plot_",
    "backreferences_dir": None,
    "write_computation_times": False,
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": ("matplotlib", Pictures()),
    "reset_modules": ("matplotlib",),
    "download_all_examples": False,
    "show_signature": False,
    "thumbnail_size": (480, 336),
    "remove_config_comments": True,
    "abort_on_example_error": True,
    "nested_sections": False,
}

copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True
copybutton_exclude = ".linenos, .gp"

html_theme = "pydata_sphinx_theme"
html_title = "magshell"
html_static_path = ["site/static"]
html_css_files = ["magshell.css"]
html_show_sourcelink = False
html_copy_source = False
html_context = {"default_mode": "auto"}
html_theme_options = {
    "logo": {"text": "magshell"},
    "navigation_with_keys": False,
    "show_prev_next": True,
    "show_toc_level": 2,
    "navbar_align": "left",
    "header_links_before_dropdown": 7,
    "secondary_sidebar_items": ["page-toc"],
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "tango",
    "pygments_dark_style": "github-dark",
}
html_sidebars = {"index": [], "tutorial": [], "layout": [], "changelog": []}


def setup(app: Sphinx) -> None:
    """Fields of named tuples stand under Attributes already."""
    app.connect("autodoc-skip-member", lambda *told: True if type(told[3]).__name__ == "_tuplegetter" else None)
