"""Every example of the README runs and prints what it says."""

from __future__ import annotations

import doctest
import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner
from conftest import ROOT
from puck_tables.cli.main import main

NUMBER = re.compile(r"-?\d+\.?\d*(?:e[-+]?\d+)?")
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def console_examples() -> list[tuple[str, str]]:
    examples = []
    for block in re.findall(r"```console\n(.*?)```", TEXT, re.DOTALL):
        for part in block.split("$ ")[1:]:
            command, _, output = part.partition("\n")
            examples.append((command, output.strip()))
    return examples


def test_console_examples(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """In order, in one folder: numbers to seven digits, those of rounding size to a factor 10."""
    monkeypatch.chdir(tmp_path)
    examples = console_examples()
    assert len(examples) >= 10
    for command, output in examples:
        program, *arguments = shlex.split(command)
        assert program == "puck"
        if arguments[0] == "paper":  # test_paper_command.py runs it
            continue
        Path("run.png").unlink(missing_ok=True)
        result = CliRunner().invoke(main, arguments)
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


def test_library_examples():
    found = doctest.testfile(str(ROOT / "README.md"), module_relative=False, encoding="utf-8")
    assert found.attempted >= 12
    assert found.failed == 0


def test_pictures_of_the_readme_exist():
    for name in re.findall(r"!\[.*?\]\((.*?)\)", TEXT):
        assert (ROOT / name).stat().st_size > 10_000
