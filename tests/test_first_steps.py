"""Python inside a clone, where ./puck_tables hides what README's first command installs."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

# what an editable install adds to Python, and no other install
PLAIN = """
import sys
sys.meta_path[:] = [one for one in sys.meta_path if "editable" not in repr(one).lower()]
"""


@pytest.fixture(scope="module")
def clone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("somewhere") / "a clone"
    folder.mkdir()
    for name in ("puck_tables", "cli", "tables"):
        shutil.copytree(ROOT / name, folder / name, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("README.md", "pyproject.toml"):
        shutil.copy(ROOT / name, folder)
    return folder


def inside(clone: Path, code: str, *flags: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, *flags, "-c", code], cwd=clone, capture_output=True, text=True, timeout=300
    )


def test_every_module_is_found_where_it_lies(clone: Path):
    names = ("puck_tables", "puck_tables.tables", "puck_tables.cli")
    code = f"{PLAIN}for name in {names}: print(__import__(name, fromlist=['x']).__file__)\n"
    walk = "import pkgutil; list(pkgutil.walk_packages(sys.modules['puck_tables'].__path__))\n"
    done = inside(clone, code + walk)
    assert done.stderr == ""
    homes = [Path(line).parent.relative_to(clone) for line in done.stdout.splitlines()]
    assert homes == [Path("puck_tables"), Path("tables"), Path("cli")]


@pytest.mark.thorough
def test_the_examples_of_the_readme(clone: Path):
    done = inside(
        clone, PLAIN + "import doctest; print(doctest.testfile('README.md', module_relative=False))"
    )
    assert "failed=0" in done.stdout and "attempted=0" not in done.stdout, done.stdout


def test_a_python_without_what_it_needs_is_told_so(clone: Path):
    """As a system's Python is, in a clone that nothing was installed of."""
    done = inside(clone, "import puck_tables; puck_tables.Puck", "-S")
    said = done.stderr.splitlines()[-1]
    assert done.returncode and said.startswith(
        "ModuleNotFoundError: puck_tables needs numpy, which"
    )
    assert str(clone) in said


def test_the_command_runs_as_a_module(clone: Path):
    """As the site asks it for the fields of scenes."""
    done = subprocess.run(
        [sys.executable, "-m", "puck_tables.cli.start", "scene", "fields"],
        cwd=clone, capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert done.stdout.startswith("puck.radius ") and not done.stderr
