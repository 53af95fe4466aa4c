"""Every example of the README and of the pages in docs runs and prints what it says."""

from __future__ import annotations

import doctest
import re
import shlex
from pathlib import Path

import pytest
from commands import invoke
from conftest import ROOT

NUMBER = re.compile(r"-?\d+\.?\d*(?:e[-+]?\d+)?")
PAGES = {path.name: path for path in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]}
TEXTS = {name: path.read_text(encoding="utf-8") for name, path in PAGES.items()}
EXAMPLES = sorted((ROOT / "docs" / "gallery").rglob("*.py"))
every_page = pytest.mark.parametrize("page", PAGES)
# their commands take long
LONG = (
    "curling.md", "fits.md", "command-line.md", "several-pucks.md", "explorer.md", "scenes.md",
    "export.md", "paths.md", "sweeps.md",
)  # fmt: skip


def console_examples(text: str) -> list[tuple[str, str]]:
    examples = []
    for block in re.findall(r"```console\n(.*?)```", text, re.DOTALL):
        for part in block.split("$ ")[1:]:
            command, _, output = part.partition("\n")
            examples.append((command, output.strip()))
    return examples


@pytest.mark.parametrize(
    "page", [pytest.param(name, marks=[pytest.mark.thorough] * (name in LONG)) for name in PAGES]
)
def test_console_examples(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """In order, in one folder: numbers to seven digits, those of rounding size to a factor 10."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("puck_tables.plot.movie._PICTURES", 2)  # a second: a gif takes its time
    for command, output in console_examples(TEXTS[page]):
        program, *arguments = shlex.split(command)
        assert program == "puck"
        Path("run.png").unlink(missing_ok=True)
        result = invoke(*arguments)
        assert result.exit_code == 0, (command, result.output)
        if not output:
            continue
        printed = result.stdout.strip()
        assert NUMBER.sub("#", printed) == NUMBER.sub("#", output)
        pairs = zip(NUMBER.findall(printed), NUMBER.findall(output), strict=True)
        for mine, theirs in ((float(a), float(b)) for a, b in pairs):
            if abs(theirs) < 1e-6:
                assert abs(theirs) / 10 <= abs(mine) <= abs(theirs) * 10
            else:
                assert mine == pytest.approx(theirs, rel=1e-7)


@pytest.mark.parametrize(
    "page",
    [pytest.param(name, marks=[pytest.mark.thorough] * (name == "export.md")) for name in PAGES],
)
def test_library_examples(page: str):
    found = doctest.testfile(str(PAGES[page]), module_relative=False, encoding="utf-8")
    assert found.attempted == len(re.findall(r"^ *>>> ", TEXTS[page], re.MULTILINE))
    assert found.failed == 0


def test_there_are_examples():
    assert {"README.md", "command-line.md", "scenes.md"} <= {
        page for page in PAGES if console_examples(TEXTS[page])
    }
    assert {"README.md", "library.md", "scenes.md"} <= {
        page for page in PAGES if ">>> " in TEXTS[page]
    }


def test_the_readme_is_short():
    assert len(TEXTS["README.md"].splitlines()) <= 150


@pytest.mark.parametrize("script", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_is_short_and_compiles(script: Path):
    """The site runs them; here only what a change of the library could not break."""
    text = script.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 30
    compile(text, script.name, "exec")


@every_page
def test_links_lead_somewhere(page: str):
    prose = re.sub(r"```.*?```", "", TEXTS[page], flags=re.DOTALL)
    for picture, name in re.findall(r"(!?)\[[^\]]*\]\(([^)#:]+)\)", prose):
        size = (PAGES[page].parent / name).stat().st_size
        assert size > (10_000 if picture else 500), name
