"""The recipe for conda says what the project says; where a tool of conda is, it builds."""

import shutil
import subprocess
import tomllib
from pathlib import Path

import pytest

from puck_tables._version import __version__

yaml = pytest.importorskip("yaml", reason="PyYAML comes with the extra cluster")
ROOT = Path(__file__).parent.parent
RECIPE = ROOT / "docs" / "conda" / "recipe.yaml"


def test_the_recipe_says_what_the_project_says():
    recipe = yaml.safe_load(RECIPE.read_text())
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    needs = [f"python{project['requires-python']}", *project["dependencies"]]
    assert [need.replace(" ", "") for need in recipe["requirements"]["run"]] == needs
    assert recipe["context"]["version"] == __version__
    assert recipe["about"]["license"] == project["license"]
    assert recipe["about"]["summary"] == project["description"]
    (command,) = recipe["build"]["python"]["entry_points"]
    assert command == f"puck = {project['scripts']['puck']}"
    assert (RECIPE.parent / recipe["source"]["path"]).resolve() == ROOT


@pytest.mark.nightly
@pytest.mark.skipif(not shutil.which("rattler-build"), reason="no rattler-build here")
def test_the_recipe_builds(tmp_path):
    call = ["rattler-build", "build", "--recipe", str(RECIPE), "-c", "conda-forge"]
    subprocess.run([*call, "--output-dir", str(tmp_path)], check=True)
