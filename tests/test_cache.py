"""Compiled code on disk never outlives an edit of any file it came from."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

from conftest import ROOT


def spin(package: Path, cache: Path) -> float:
    ended = subprocess.run(
        [sys.executable, "-c", "import puck_tables as p; print(float(p.resultants(0, 1).spin))"],
        env={**os.environ, "PYTHONPATH": str(package), "NUMBA_CACHE_DIR": str(cache)},
        cwd=package, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return float(ended.stdout)


def test_an_edit_in_another_file_is_never_stale(tmp_path: Path):
    package, cache = tmp_path / "source", tmp_path / "cache"
    shutil.copytree(
        ROOT / "puck_tables", package / "puck_tables", ignore=shutil.ignore_patterns("__pycache__")
    )
    assert spin(package, cache) == 0.375
    compiled = sorted(cache.rglob("*.nbc"))
    assert compiled
    assert spin(package, cache) == 0.375
    assert sorted(cache.rglob("*.nbc")) == compiled  # the second run compiled nothing

    # the compiled caller stands in kernels/closed_form.py; edit what it calls, elsewhere
    callee = package / "puck_tables" / "contact" / "closed_form.py"
    text = callee.read_text(encoding="utf-8")
    edited = text.replace("/ 9.0", "/ 4.5")
    assert edited != text
    callee.write_text(edited, encoding="utf-8")
    assert spin(package, cache) > 0.5


def test_two_processes_may_fill_the_cache_at_once(tmp_path: Path):
    command = [sys.executable, "-c", "import puck_tables as p; print(p.resultants(0.3, 1.0).spin)"]
    env = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    running = [
        subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True) for _ in range(3)
    ]
    printed = {process.communicate()[0] for process in running}
    assert len(printed) == 1
    assert all(process.returncode == 0 for process in running)


def test_no_writable_folder_still_computes(tmp_path: Path):
    ended = subprocess.run(
        [sys.executable, "-c", "import puck_tables as p; print(float(p.resultants(0, 1).spin))"],
        env={**os.environ, "NUMBA_CACHE_DIR": "/proc/none"}, cwd=tmp_path,
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert ended.stdout == "0.375\n"


def test_the_cache_lies_outside_the_package_and_old_ones_go(tmp_path: Path):
    cache = tmp_path / "puck-tables"
    old, recent = cache / f"compiled-{0:016}", cache / f"compiled-{1:016}"
    for folder in (old, recent):
        folder.mkdir(parents=True)
    os.utime(old, (0, time.time() - 31 * 86400))
    environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)
    subprocess.run(
        [sys.executable, "-c", "import puck_tables as p; p.resultants(0, 1)"],
        env=environment, check=True,
    )  # fmt: skip
    assert not old.exists()
    assert recent.exists()
    assert len(list(cache.glob("*/*/*.nbc"))) > 0
    # nothing but Python's own byte code appears beside the sources
    beside = {path.suffix for path in (ROOT / "puck_tables").glob("**/__pycache__/*")}
    assert beside <= {".pyc"}
