"""The site: ``sphinx-build -W --keep-going docs docs/_build``, offline, the gallery executed."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx_gallery.scrapers import figure_rst

import puck_tables
from puck_tables.explore.page import explorer_page
from puck_tables.plot.played_board import board_page
from puck_tables.world.scene import Scene

HERE = Path(__file__).parent

project = "puck-tables"
author = "the authors of puck-tables"
release = version = puck_tables.__version__
extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.viewcode",
    "numpydoc",
    "myst_parser",
    "sphinx_click",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = ["_build", "paper/**", "gallery/**", "engines/**", "_templates", "_extra"]
templates_path = ["_templates"]
nitpicky = False

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 3
suppress_warnings = ["config.cache"]
smartquotes = False  # --w0 is an option, no dash

autosummary_generate = True
autodoc_typehints = "none"  # numpydoc's sections give types in words and units
numpydoc_show_class_members = False
numpydoc_validation_checks: set[str] = set()


def figure_of(block: tuple[str, str, int], names: dict[str, Any], conf: dict[str, Any]) -> str:
    """The picture of an example: what it calls ``figure``, whether pyplot knows of it or not."""
    figure = names["example_globals"].get("figure")
    if figure is None or getattr(figure, "is_shown", False):
        return ""
    figure.is_shown = True
    path = next(names["image_path_iterator"])
    if figure.get_layout_engine() is None:  # of another library: nothing of it is cut off
        figure.set_layout_engine("tight")
    figure.savefig(path, dpi=110)
    plt.close(figure)  # or the next example draws on it
    return figure_rst([path], conf["src_dir"])


sphinx_gallery_conf = {
    "examples_dirs": ["gallery"],
    "gallery_dirs": ["examples"],
    "filename_pattern": r"\.py",
    "remove_config_comments": True,
    "show_memory": False,
    "abort_on_example_error": True,
    "capture_repr": (),  # an example shows what it prints
    "image_scrapers": (figure_of,),
    "min_reported_time": 1000,
    "within_subsection_order": "FileNameSortKey",
    "subsection_order": [
        "gallery/shots", "gallery/explained", "gallery/scenes", "gallery/boards",
        "gallery/films", "gallery/many",
    ],
}  # fmt: skip

html_theme = "pydata_sphinx_theme"
html_title = "puck-tables"
html_theme_options = {
    "navigation_with_keys": False,
    "show_nav_level": 1,
    "header_links_before_dropdown": 6,
    "show_toc_level": 2,
}
html_context = {"default_mode": "auto"}
html_sidebars = {"index": [], "tutorial": [], "explorer": []}  # no pages below them to show
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_extra_path = ["_extra"]
(HERE / "_extra").mkdir(exist_ok=True)
html_show_sourcelink = False


def said_by_the_program(app: Sphinx) -> None:
    """What the program itself can say is not written twice: fields of scenes, the explorer."""
    told = subprocess.run(
        [sys.executable, "-m", "puck_tables.cli.start", "scene", "fields"],
        check=True, capture_output=True, text=True,
    ).stdout  # fmt: skip
    explorer = HERE / "_extra" / "explore.html"  # explorer.html is the page that tells of it
    explorer.parent.mkdir(exist_ok=True)
    explorer.write_text(explorer_page(), encoding="utf-8")
    for name, scene in (("carrom", "carrom-break"), ("air-hockey", "air-hockey-mallet")):
        played = explorer.with_name(f"{name}.html")
        played.write_text(board_page(Scene.load(scene)), encoding="utf-8")
    page = "# Fields of scenes\n\nWhat `puck scene fields` prints.\n\n```text\n" + told + "```\n"
    path = HERE / "reference" / "scene-fields.md"
    path.parent.mkdir(exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != page:
        path.write_text(page, encoding="utf-8")


def bars_are_bars(*given: Any) -> None:
    """|φ| in a docstring is an absolute value, not a substitution of reStructuredText."""
    lines: list[str] = given[-1]
    for n, line in enumerate(lines):
        if "``" not in line and not line.lstrip().startswith((">>>", "...")):
            lines[n] = re.sub(r"\|(?=\S)", r"\|", line)


def arrows_have_names(app: Sphinx, failed: Exception | None) -> None:
    """The arrows that open a part of the menu say so to those who hear the page."""
    bare = '<summary><span class="toctree-toggle"'
    said = bare.replace("<summary>", '<summary aria-label="Show or hide the pages of this part">')
    for path in Path(app.outdir).rglob("*.html"):
        text = path.read_text(encoding="utf-8")
        if bare in text:
            path.write_text(text.replace(bare, said), encoding="utf-8")


def examples_have_pictures(app: Sphinx, failed: Exception | None) -> None:
    """An example that lost its picture stops the build."""
    for script in (HERE / "gallery").rglob("*.py") if not failed else ():
        page = Path(app.outdir) / "examples" / script.parent.name / f"{script.stem}.html"
        if f"sphx_glr_{script.stem}_001.png" not in page.read_text(encoding="utf-8"):
            raise ExtensionError(f"{script.name} has no picture: it is to be called figure")


def setup(app: Sphinx) -> None:
    """Called by Sphinx."""
    app.connect("build-finished", examples_have_pictures)
    app.connect("build-finished", arrows_have_names)
    app.connect("builder-inited", said_by_the_program)
    app.connect("autodoc-process-docstring", bars_are_bars, priority=900)
