"""The Tab key: what a shell is offered."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from click.shell_completion import ShellComplete
from puck_tables.cli.main import main

from puck_tables.contact.laws import law_of

AIR_GAMES = {"air-hockey", "air-hockey-goals", "air-hockey-mallet", "air-table"}


def offered(words: list[str], begun: str) -> dict[str, str]:
    found = ShellComplete(main, {}, "puck", "_PUCK_COMPLETE").get_completions(words, begun)
    return {item.value: item.type for item in found}


@pytest.mark.parametrize(
    ("words", "begun", "named", "files"),
    [
        (["simulate", "--scene"], "inc", {"incline"}, True),
        (["aim", "--scene"], "cro", {"crokinole"}, True),
        (["scene", "check"], "air", AIR_GAMES, True),
        (["scene", "show"], "car", {"carrom-break"}, False),
        (["simulate", "--pressure"], "h", {"hertz"}, True),
        (["build-tables", "--pressure"], "g", {"galin"}, True),
        (["sweep", "--no-such"], "sim", set(), False),
        ([], "sim", {"simulate"}, False),
    ],
)  # fmt: skip
def test_offers(words: list[str], begun: str, named: set[str], files: bool):
    found = offered(words, begun)
    assert {name for name, kind in found.items() if kind == "plain"} == named
    assert ("file" in found.values()) is files


def test_laws_that_are_offered_are_laws():
    for name in offered(["simulate", "--pressure"], ""):
        if name:
            assert law_of(name + "0.5" if name.endswith(":") else name).name.startswith(name)


def test_the_shell_s_script_is_printed_as_the_page_says():
    asked = {**os.environ, "_PUCK_COMPLETE": "bash_source"}
    begin = "import sys; sys.argv[0] = 'puck'; from puck_tables.cli.start import main; main()"
    program = [sys.executable, "-c", begin]
    script = subprocess.run(program, env=asked, capture_output=True, text=True, check=True).stdout
    assert "complete -o nosort -F _puck_completion puck" in script
