"""Wheels that bring compiled code along: one for each platform that numba has wheels for.

    python .ci/native_wheel.py dist/puck_tables-1.0-py3-none-any.whl dist

The pure wheel is installed in an empty environment, `code_elsewhere.py` compiles there what `puck
warm-up` does, for all platforms at once, and what it made for one goes into a copy of the wheel
with its tag.  That code is run where Python and numba are those that it was made with; else
functions are compiled when they are first used, as from the pure wheel.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
import venv
from pathlib import Path

COMPILE = Path(__file__).with_name("code_elsewhere.py")
INTERPRETER = f"cp{sys.version_info.major}{sys.version_info.minor}"


def main(pure: Path, into: Path) -> None:
    """Write the wheels into a folder, and say their names."""
    into.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        made = Path(work, "made")
        venv.create(Path(work, "empty"), with_pip=True)
        python = Path(work, "empty", "Scripts" if os.name == "nt" else "bin", "python")
        run(python, "-m", "pip", "install", "--quiet", pure, "wheel")
        run(python, COMPILE, made, NUMBA_CACHE_DIR=str(Path(work, "kept")))
        for folder in sorted(made.iterdir()):
            here = Path(work, folder.name)
            run(python, "-m", "wheel", "unpack", "--dest", here, pure)
            (root,) = here.iterdir()
            (code,) = folder.iterdir()
            shutil.copytree(code, root / "puck_tables" / code.name)
            run(python, "-m", "wheel", "pack", "--dest-dir", here, root)
            tags = {"python": INTERPRETER, "abi": INTERPRETER, "platform": folder.name}
            options = [f"--{kind}-tag={tag}" for kind, tag in tags.items()]
            run(python, "-m", "wheel", "tags", "--remove", *options, *here.glob("*.whl"))
            for wheel in here.glob("*.whl"):
                print(shutil.move(wheel, into / wheel.name))


def run(*command: object, **environment: str) -> None:
    """Run a command, and end with it where it fails."""
    subprocess.run([*map(str, command)], check=True, env=os.environ | environment)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
