"""What the site is made of: docstrings that its reference can read, one place for each page."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import click
import pytest
from conftest import ROOT
from puck_tables.cli.main import main
from test_layers import parsed

import puck_tables
from puck_tables._core.colours import LEAST_CONTRAST, contrast, is_colour

DOCS = ROOT / "docs"
SOURCES = sorted(path for room in ("puck_tables", "cli") for path in (ROOT / room).rglob("*.py"))
GALLERY = sorted((DOCS / "gallery").rglob("*.py"))
PAGES = [ROOT / "README.md", *sorted(DOCS.glob("*.md"))]
NAMES = re.compile(r"\*{0,2}\w+(, \*{0,2}\w+)*( : .+)?")
ERRORS = re.compile(r"\w+(, \w+)*")
# what one shell or another takes for something else, or does not take off: quotes are double ones
ONE_SHELL = re.compile(r"['`\\^%&|;<!~*?{}$]")


def docstrings() -> Iterator[tuple[str, str]]:
    for path in SOURCES:
        for node in ast.walk(parsed(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                yield f"{path.relative_to(ROOT)}: {node.name}", ast.get_docstring(node) or ""


def sections(text: str) -> Iterator[tuple[str, list[str]]]:
    """Headings of numpydoc, and the lines below each that stand at its margin."""
    parts = re.split(r"^(\w[\w ]*)\n(-{3,})\n", text, flags=re.MULTILINE)
    for heading, _, body in zip(parts[1::3], parts[2::3], parts[3::3], strict=True):
        yield heading, [line for line in body.split("\n") if line and not line.startswith(" ")]


def test_prose_is_no_parameter_and_no_error() -> None:
    """The reference reads every line at the margin of these sections as names."""
    found = 0
    for where, text in docstrings():
        for heading, lines in sections(text):
            form = {"Parameters": NAMES, "Attributes": NAMES, "Raises": ERRORS}.get(heading)
            for line in lines if form else []:
                found += 1
                assert form is not None and form.fullmatch(line), (where, line)
    assert found > 500


def test_parameters_that_are_told_are_there() -> None:
    missed = []
    for path in SOURCES:
        for node in ast.walk(parsed(path.read_text(encoding="utf-8"))):
            if not isinstance(node, ast.FunctionDef) or node.args.kwarg:
                continue
            given = node.args
            names = {one.arg for one in (*given.posonlyargs, *given.args, *given.kwonlyargs)}
            if given.vararg:
                names.add(given.vararg.arg)
            for heading, lines in sections(ast.get_docstring(node) or ""):
                for line in lines if heading == "Parameters" else []:
                    told = {name.strip("* ") for name in line.split(" : ")[0].split(",")}
                    missed += [(path.name, node.name, name) for name in told - names]
    assert not missed


def test_every_public_name_has_a_page() -> None:
    pages = (DOCS / "reference").glob("*.rst")
    listed = "".join(path.read_text(encoding="utf-8") for path in pages)
    rooms = {"__version__", "chetaev", "contact", "errors", "motion", "results"}
    inner = {f"results.{name}" for name in puck_tables.results.__all__}
    inner |= {f"errors.{name}" for name in vars(puck_tables.errors) if name.endswith("Error")}
    twice = {"errors.InputError", "errors.PuckError"}
    for name in (set(puck_tables.__all__) - rooms) | inner - twice:
        assert f"\n   {name}\n" in listed, name


def in_toctrees(page: Path) -> list[list[Path]]:
    """The pages that a page leads to, as the navigation has them, a list for each section."""
    text = page.read_text(encoding="utf-8") if page.exists() else ""
    blocks = re.findall(r"```\{toctree\}\n(.*?)```", text, re.DOTALL)
    lines = [[line for line in block.split("\n") if line and line[0] != ":"] for block in blocks]
    return [[(page.parent / f"{line}.md").resolve() for line in block] for block in lines]


def test_every_page_has_one_place_in_the_navigation_and_no_list_is_long() -> None:
    waiting, met = [DOCS / "index.md"], []
    while waiting:
        page = waiting.pop()
        met.append(page.resolve())
        for section in in_toctrees(page):
            assert len(section) <= 10, page.name
            waiting += section
    assert len(met) == len(set(met))
    assert {path.resolve() for path in DOCS.glob("*.md")} <= set(met)
    shown = re.search(r'"header_links_before_dropdown": (\d+)', (DOCS / "conf.py").read_text())
    (top,) = in_toctrees(DOCS / "index.md")
    assert shown and int(shown[1]) >= len(top)  # none under "More"


def test_options_keep_their_dashes_and_examples_show_what_they_print() -> None:
    conf = ast.parse((DOCS / "conf.py").read_text(encoding="utf-8"))
    given = [one for one in conf.body if isinstance(one, ast.Assign)]
    values = {ast.unparse(one.targets[0]): one.value for one in given}
    assert ast.literal_eval(values["smartquotes"]) is False
    gallery = values["sphinx_gallery_conf"]
    assert isinstance(gallery, ast.Dict)
    names = [key and ast.unparse(key) for key in gallery.keys]
    shown = gallery.values[names.index("'capture_repr'")]
    assert ast.literal_eval(shown) == ()


@pytest.mark.parametrize("script", GALLERY, ids=lambda path: path.stem)
def test_colours_of_examples_are_seen_on_white(script: Path) -> None:
    for name in re.findall(r'colou?r="([^"]+)"', script.read_text(encoding="utf-8")):
        plain = name.removeprefix("tab:")
        if name == plain and is_colour(name):
            assert contrast(name) >= LEAST_CONTRAST, name


def of_pages() -> Iterator[tuple[str, str]]:
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        shown = re.sub(r"```sh\n.*?```", "", text, flags=re.DOTALL)  # of a machine of one kind
        for line in re.findall(r"^\$ (puck .*)$", shown, re.MULTILINE):
            yield page.name, line
        prose = re.sub(r"```.*?```", "", text, flags=re.DOTALL)
        for line in re.findall(r"`(puck [a-z][^`]*|--[a-z][^`]* [^`]*)`", prose):
            yield page.name, line


def of_help(command: click.Command, name: str = "puck") -> Iterator[tuple[str, str]]:
    texts = [command.help or "", *(getattr(one, "help", None) or "" for one in command.params)]
    for text in texts:
        for line in re.findall(r"^\s*(puck [a-z-]+ .*)$", text, re.MULTILINE):
            yield name, line
    if isinstance(command, click.Group):
        for one in command.commands.values():
            yield from of_help(one, f"{name} {one.name}")


def test_any_shell_takes_the_examples() -> None:
    """As they stand: nothing is quoted, joined or led elsewhere in the way of one shell alone."""
    lines = [*of_pages(), *of_help(main)]
    assert len(lines) > 100
    wrong = [line for line in lines if ONE_SHELL.search(line[1])]
    assert not wrong


def test_who_has_windows_is_told_how_to_begin() -> None:
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        if "bin/activate" in text:
            assert "Scripts\\activate" in text or "on Windows](tutorial.md#install)" in text, page
    for path in [*PAGES, *SOURCES]:
        assert not re.search(r"pip install (-e )?'", path.read_text(encoding="utf-8")), path


def test_everything_that_can_be_called_is_told_once() -> None:
    rows = [line.split("|") for line in (DOCS / "what-to-call.md").read_text("utf-8").split("\n")
            if line.startswith("|")]  # fmt: skip
    told = [name for row in rows for name in re.findall(r"`([\w-]+)`", "|".join(row[1:-2]))]
    known = [*main.commands, *(name for name in puck_tables.__all__ if name != "__version__")]
    twice = {name for name in known if known.count(name) > 1}  # command and function alike
    assert sorted(set(known) - set(told)) == []
    for name in known:
        assert told.count(name) == 1 + (name in twice), name
