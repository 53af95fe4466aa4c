"""CONTRIBUTING's recipes, done once each on a copy of the house: as many files as it says.

The copy runs as it is written, in processes of its own.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from fnmatch import fnmatch
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
# by what is added: files, and for each what stands before the new text; a new file has no text yet
RECIPES: dict[str, dict[str, list[tuple[str, str]]]] = {
    "a pressure law": {
        "contact/pressure.py": [
            ('HERTZ = PressureLaw("hertz", _hertz, _hertz_moments)\n',
             "\n\ndef _bowl(rho: FloatArray) -> FloatArray:\n"
             "    return np.asarray(0.5 + rho**2)\n\n\n"
             'BOWL = PressureLaw("bowl", _bowl)\n'),
        ],
        "contact/laws.py": [
            ("import GALIN, HERTZ", ", BOWL"),
            ('partial(quadrature.integrals, law=HERTZ),\n',
             '    "bowl": partial(quadrature.integrals, law=BOWL),\n'),
        ],
    },
    "something that acts in a scene": {
        "scene/parts.py": [
            ('doc="force over relative speed squared", acts="drag"\n    )\n',
             '    cubic: float = of(\n        "number", 0.0, "kg s/m^2", low=0.0, acts="drag",\n'
             '        doc="force over relative speed cubed",\n    )\n'),
        ],
        "scene/forces.py": [
            ("DRAGS = 7  # how many\n", "CUBIC, DRAGS = 7, 8\n"),
            ("        lateral.spin_exponent,\n", "        drag.cubic / mass,\n"),
            ("return lateral.strength != 0.0", " or drag.cubic != 0.0"),
            ("abs(row[ACROSS])", " + row[CUBIC]"),
            ("return row[SLIDING] + row[QUADRATIC] * speed", " + row[CUBIC] * speed * speed"),
            ("return row[SLIDING] + 2.0 * row[QUADRATIC] * speed",
             " + 3.0 * row[CUBIC] * speed * speed"),
        ],
    },
    "a column": {
        "io/columns.py": [
            ('    "path_length": Column("m", "path length", "length of the path"),\n',
             '    "detour": Column("1", "detour", "path over distance", '
             '("path_length", "stop_x", "stop_y"),\n'
             "                     lambda way, x, y: way / np.hypot(x, y)),\n"),
        ],
    },
    "a format": {
        "io/tabbed.py": [
            ("", "import io\n\n\ndef encode(dataset):\n    table = dataset.table()\n"
             "    out = io.StringIO()\n"
             '    print(*table, sep="\\t", file=out)\n'
             "    for row in zip(*(one.values for one in table.values())):\n"
             '        print(*row, sep="\\t", file=out)\n    return out.getvalue().encode()\n'),
        ],
        "io/formats.py": [('FORMATS = {', '".tsv": "tabbed", ')],
    },
    "a picture": {
        "plot/dots_figure.py": [
            ("", "from puck_tables.plot.style import canvas\n\n\ndef draw(result):\n"
             "    figure = canvas(4.0, 3.0)\n    draw_on(figure.add_subplot(), result)\n"
             "    return figure\n\n\ndef draw_on(axes, result):\n"
             '    axes.plot(result.stop_x, result.stop_y, ".")\n    axes.set_title("dots")\n'),
        ],
        "stopping/stops.py": [("class Stops(Differentiated, Result):\n",
                               '    picture: ClassVar[str] = "dots"\n')],
    },
    "a law of restitution": {
        "scene/restitution.py": [
            ("VISCOELASTIC", ", FADING"),
            ('@dataclass(frozen=True, eq=False)\nclass RestitutionTable', ""),
            ('NAMED = {"viscoelastic": Viscoelastic, "plastic": Plastic', ', "fading": Fading'),
        ],
        "scene/restitution_at.py": [
            ("VISCOELASTIC, PLASTIC, TABLE = range(3)", "\nFADING = 3"),
            ("    kind, at = int(laws[first]), first + 1\n",
             "    if kind == FADING:\n        return laws[at] / (laws[at] + speed)\n"),
        ],
    },
    "a format of tracks": {
        "film/readers/stars.py": [
            ("", "from puck_tables._core.safe_read import read_whole\n"
             "from puck_tables.film.film import Reader\n\n\n"
             'READERS = (Reader(lambda path, head: head.startswith(b"t*"),\n'
             '                  as_text=lambda path, head: read_whole(path, 1 << 20)'
             '.replace(b"*", b",")),)\n'),
        ],
    },
    "a language": {
        "export/languages/toy.py": [
            ("", "from puck_tables.export.languages.python import Python\n\n\nclass Toy(Python):\n"
             '    key, title, endings = "toy", "Toy 1", (".toy",)\n\n\nLANGUAGE = Toy()\n'),
        ],
    },
    "a command": {
        "cli/greet.py": [
            ("", "import click\nfrom puck_tables.cli.printing import say\n\n\n@click.command()\n"
             'def greet() -> None:\n    """Greet."""\n    say("good morning")\n'),
        ],
        "cli/main.py": [
            ("from puck_tables.cli.fit import fit, track\n",
             "from puck_tables.cli.greet import greet\n"),
            ("(warm_up, asperity", ", greet"),
        ],
    },
}  # fmt: skip
FADING = '''@dataclass(frozen=True)
class Fading(Restitution):
    """V/(V + v)."""

    half: float
    source: ClassVar[str] = "a toy"

    @property
    def name(self) -> str:
        return f"fading:{self.half!r}"

    @property
    def numbers(self) -> FloatArray:
        return np.array([FADING, self.half])


'''


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the house to which everything was added."""
    house = tmp_path_factory.mktemp("house")
    for folder in ("puck_tables", "cli", "tables"):
        shutil.copytree(ROOT / folder, house / folder,
                        ignore=shutil.ignore_patterns("__pycache__"))  # fmt: skip
    for files in RECIPES.values():
        for name, places in files.items():
            path = house / name if name.startswith("cli/") else house / "puck_tables" / name
            source = path.read_text("utf-8") if path.exists() else ""
            for before, text in places:
                assert before in source, (name, before)
                source = source.replace(before, before + text, 1)
            path.write_text(source, "utf-8")
    path = house / "puck_tables/scene/restitution.py"
    source = path.read_text("utf-8")
    before = "@dataclass(frozen=True, eq=False)\nclass RestitutionTable"
    path.write_text(source.replace(before, FADING + before), "utf-8")
    return house


def told_by(house: Path, script: str, folder: Path) -> str:
    """What a script prints in that house, as the kernels are written."""
    environment = {**os.environ, "PYTHONPATH": str(house), "NUMBA_DISABLE_JIT": "1"}
    done = subprocess.run(
        [sys.executable, "-c", script], env=environment, cwd=folder, capture_output=True, text=True
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_each_takes_the_files_that_contributing_names():
    text = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
    told = dict(re.findall(r"^- \*\*([^*]+)\*\*(.*?)(?=^- |^$)", text, re.MULTILINE | re.DOTALL))
    for what, files in RECIPES.items():
        named = re.findall(r"`([\w/.]+)`", told[what])
        for file in files:
            may = {one.rstrip("/").replace("NAME", "*") for one in named}
            assert file.rpartition("/")[0] in may or any(fnmatch(file, one) for one in may), file


def test_a_force_acts_on_one_puck_on_a_board_in_plan_sweep_file_picture_and_help(house, tmp_path):
    """v' = −c v³/m: v = v₀/√(1 + 2 c v₀² t/m)."""
    script = """
import math
import puck_tables as pt
from click.testing import CliRunner
from puck_tables.cli.main import main
from puck_tables.scene.library import as_toml

def exact(c, m, v, t):
    return v / math.sqrt(1.0 + 2.0 * c * v * v * t / m)

drag, sent = pt.Drag(cubic=0.3), pt.Launch((1.5, 0.0))
one = pt.Scene(pt.Puck(0.04, mass=0.2), launch=sent, drag=drag, time=0.8)
run = one.simulate()
assert abs(run.last["vx"] - exact(0.3, 0.2, 1.5, 0.8)) < 1e-9, run.last["vx"]
assert run.energy_residual < 1e-8, run.energy_residual
far = pt.Puck(0.04, mass=0.2, launch=pt.Launch(position=(0.0, 9.0)))
board = pt.Scene(pucks=[pt.Puck(0.04, mass=0.2, launch=sent), far], drag=drag, time=0.8)
assert abs(board.simulate().last["vx"][0] - run.last["vx"]) < 1e-9
assert "drag" in run.explain()
swept = pt.Scene(one.puck, launch=sent, drag=pt.Drag(cubic=[0.1, 0.3]), time=0.8).sweep()
for c, v in zip((0.1, 0.3), swept.vx):
    assert abs(v - exact(c, 0.2, 1.5, 0.8)) < 1e-8
with open("cubic.toml", "w") as file:
    file.write(as_toml(one))
assert pt.Scene.load("cubic.toml") == one
run.plot("cubic.svg")
told = CliRunner().invoke(main, ["scene", "fields"]).stdout
assert "drag.cubic" in told and "force over relative speed cubed" in told
said = CliRunner().invoke(main, ["simulate", "--scene", "cubic.toml"]).stdout
assert "cubic 0.3 kg s/m^2" in said, said
"""
    told_by(house, script, tmp_path)


def test_a_law_of_restitution(house: Path, tmp_path: Path):
    """A puck that meets a wall at v leaves it at v V/(V + v)."""
    script = """
import puck_tables as pt
wall = pt.Wall((1.0, 0.0), normal=(-1.0, 0.0), restitution="fading:0.5")
scene = pt.Scene(pt.Puck(0.04), launch=pt.Launch((1.5, 0.0)), walls=[wall], time=0.9)
assert abs(scene.simulate().last["vx"] + 1.5 * 0.5 / 2.0) < 1e-12
"""
    told_by(house, script, tmp_path)


def test_pressure_column_format_picture(house: Path, tmp_path: Path):
    script = """
import numpy as np
import puck_tables as pt
from puck_tables.contact.laws import law_of
bowl = law_of("bowl")
assert abs(bowl.mean_square - (0.5 / 4 + 1.0 / 6)) < 1e-12  # of ∫ W ρ³ dρ
found = pt.Puck(0.04, friction=0.1).stop([[1.0, 0.0], [0.5, 0.2]], [20.0, 3.0])
assert np.allclose(found.detour, found.path_length / np.hypot(found.stop_x, found.stop_y))
found.save("stops.tsv")
assert "detour" in open("stops.tsv").readline().split("\\t")
found.plot("dots.svg")
"""
    told_by(house, script, tmp_path)


def test_tracks_language_command(house: Path, tmp_path: Path):
    (tmp_path / "film.stars").write_text(
        "t*x (m)*y (m)\n" + "".join(f"{n / 30}*{n / 60}*0\n" for n in range(9))
    )
    script = """
import puck_tables as pt
from click.testing import CliRunner
from puck_tables.cli.main import main
track, = pt.read_tracks("film.stars")
assert track.time.size == 9 and abs(track.place[-1, 0] - 8 / 60) < 1e-12
pt.export_source("toy", "resultants", tol=1e-3).save("stops.toy")
assert "def " in open("stops.toy").read()
assert CliRunner().invoke(main, ["greet"]).stdout == "good morning\\n"
assert "greet" in CliRunner().invoke(main, ["--help"]).stdout
"""
    told_by(house, script, tmp_path)
