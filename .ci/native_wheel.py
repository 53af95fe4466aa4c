"""A wheel that brings compiled code along, for machines like this one and this Python.

    python .ci/native_wheel.py dist/puck_tables-1.0-py3-none-any.whl dist

The pure wheel is installed in an empty environment, `puck warm-up` compiles there for the oldest
processors that are served, and what it kept goes into a copy of the wheel that is tagged for the
platform.  That code is run where numba has the version it was made with, whatever the
processor has besides; else functions are compiled when they are first used, as from the pure wheel.
"""

from __future__ import annotations

import json
import os
import platform
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import venv
from pathlib import Path

# numba's name of the oldest processors, and the features that code for them uses
PROCESSORS = {
    "x86_64": ("x86-64-v3", ["avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"]),
    "amd64": ("x86-64-v3", ["avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe"]),
    "aarch64": ("generic", []),
    "arm64": ("generic", []),
}
TRIPLE = "import llvmlite.binding as b; print(b.get_process_triple())"


def main(pure: Path, into: Path) -> None:
    """Write the wheel into a folder, and say its name."""
    name, needs = PROCESSORS[platform.machine().lower()]
    with tempfile.TemporaryDirectory() as work:
        kept, unpacked = Path(work, "kept"), Path(work, "unpacked")
        venv.create(Path(work, "empty"), with_pip=True)
        python = Path(work, "empty", "Scripts" if os.name == "nt" else "bin", "python")
        run(python, "-m", "pip", "install", "--quiet", pure, "wheel")
        machine = {"NUMBA_CPU_NAME": name, "NUMBA_CPU_FEATURES": "", "NUMBA_CACHE_DIR": str(kept)}
        run(python, "-c", "import puck_tables; puck_tables.warm_up()", **machine)
        run(python, "-m", "wheel", "unpack", "--dest", unpacked, pure)
        (root,), (folder,) = unpacked.iterdir(), kept.iterdir()
        brought = root / "puck_tables" / folder.name
        shutil.copytree(folder, brought, ignore=shutil.ignore_patterns(".*"))
        triple = subprocess.check_output([python, "-c", TRIPLE], text=True).strip()
        target = {"codegen": [triple, name, ""], "needs": needs}
        (brought / "target.json").write_text(json.dumps(target), encoding="utf-8")
        run(python, "-m", "wheel", "pack", "--dest-dir", work, root)
        (packed,) = Path(work).glob("*.whl")
        interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
        tags = ["--python-tag", interpreter, "--abi-tag", interpreter, "--platform-tag", place()]
        run(python, "-m", "wheel", "tags", "--remove", *tags, packed)
        (tagged,) = Path(work).glob("*.whl")
        into.mkdir(parents=True, exist_ok=True)
        print(shutil.move(tagged, into / tagged.name))


def place() -> str:
    """The platform tag.  No file is a library: what numba runs on, this does."""
    named = re.sub(r"\W", "_", sysconfig.get_platform())
    return re.sub("^linux", "manylinux_2_17", named)


def run(*command: object, **environment: str) -> None:
    """Run a command, and end with it where it fails."""
    subprocess.run([*map(str, command)], check=True, env=os.environ | environment)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
