"""Compiled code on disk never outlives an edit of any file it came from."""

from __future__ import annotations

import importlib
import os
import pkgutil
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import ROOT

import puck_tables
from puck_tables._core import sources
from puck_tables.kernels.cache import cache_folder
from puck_tables.kernels.compile import Door

LIMIT = 1.531389372173909906  # tan φ₀ at δ = 0
COMPILED = {"NUMBA_DISABLE_JIT": "0"}


def limit(package: Path, folder: Path) -> float:
    """The limit ratio, by a compiled function of puck_tables/motion that calls others."""
    ended = subprocess.run(
        [sys.executable, "-c", "import puck_tables as p; print(float(p.motion.limit_ratio(0.0)))"],
        env={**os.environ, **COMPILED, "PYTHONPATH": str(package), "NUMBA_CACHE_DIR": str(folder)},
        cwd=package, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return round(float(ended.stdout), 12)


@pytest.mark.thorough
def test_an_edit_in_another_file_is_never_stale(tmp_path: Path):
    package, folder = tmp_path / "source", tmp_path / "cache"
    shutil.copytree(
        ROOT / "puck_tables", package / "puck_tables", ignore=shutil.ignore_patterns("__pycache__")
    )
    assert limit(package, folder) == round(LIMIT, 12)
    compiled = sorted(folder.rglob("*.code"))
    assert compiled
    assert limit(package, folder) == round(LIMIT, 12)
    assert sorted(folder.rglob("*.code")) == compiled  # the second run compiled nothing

    # the compiled caller stands in motion/limits.py; edit what it calls, elsewhere
    callee = package / "puck_tables" / "contact" / "closed_form.py"
    text = callee.read_text(encoding="utf-8")
    edited = text.replace("/ 9.0", "/ 9.5")
    assert edited != text
    callee.write_text(edited, encoding="utf-8")
    assert abs(limit(package, folder) - LIMIT) > 0.01


def modules() -> list[str]:
    walked = pkgutil.walk_packages(puck_tables.__path__, "puck_tables.")
    return [found.name for found in walked if "puck_tables.cli" not in found.name]


@pytest.mark.thorough
def test_an_edit_of_any_file_empties_the_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """The folder of compiled code has another name then; what was compiled before is not found."""
    package = tmp_path / "puck_tables"
    shutil.copytree(ROOT / "puck_tables", package, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(sources, "_PACKAGE", package)
    digest = sources.source_digest.__wrapped__
    seen = {digest()}
    kernels = [
        p
        for p in package.rglob("*.py")
        if re.search("^@(kernel|inlined|allocating|look_up)", p.read_text(), re.M)
    ]
    assert {path.parent.name for path in kernels} >= {"kernels", "motion", "stopping", "tradeoff"}
    for path in kernels:
        path.write_bytes(path.read_bytes() + b"# edited\n")
        seen.add(digest())
    assert len(seen) == len(kernels) + 1
    kernels[0].rename(kernels[0].with_name("renamed.py"))
    assert digest() not in seen


def test_a_clone_and_what_is_installed_from_it_share_compiled_code(tmp_path, monkeypatch):
    """Installed, the commands and tables lie in the package."""
    monkeypatch.setattr(sources, "_PACKAGE", tmp_path)
    digest = sources.source_digest.__wrapped__
    for name in ("kernels", "cli", "tables", "motion"):
        before = digest()
        (tmp_path / name).mkdir()
        (tmp_path / name / "main.py").write_text(name)
        assert (digest() == before) is (name in ("cli", "tables"))


def test_every_compiled_function_is_kept_in_that_folder():
    folder = Path(cache_folder() or "")
    kept = set()
    for name in modules():
        if name.startswith("puck_tables.autodiff"):  # doors to what may not be installed
            continue
        for value in vars(importlib.import_module(name)).values():
            if isinstance(value, Door):
                assert folder == Path(value.compiled._cache.cache_path), (name, value)
                kept.add(value.py_func.__module__.split(".")[1])
    assert kept >= {"kernels", "motion", "stopping", "tradeoff"}


@pytest.mark.thorough
def test_four_processes_may_fill_the_cache_at_once(tmp_path: Path):
    command = [
        sys.executable, "-c", "import puck_tables as p; print(float(p.motion.limit_ratio(0.0)))",
    ]  # fmt: skip
    env = {**os.environ, **COMPILED, "NUMBA_CACHE_DIR": str(tmp_path)}
    running = [
        subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True) for _ in range(4)
    ]
    printed = {process.communicate()[0] for process in running}
    assert len(printed) == 1
    assert all(process.returncode == 0 for process in running)


@pytest.mark.thorough
def test_no_writable_folder_still_computes(tmp_path: Path):
    ended = subprocess.run(
        [sys.executable, "-c", "import puck_tables as p; print(float(p.motion.limit_ratio(0.0)))"],
        env={**os.environ, **COMPILED, "NUMBA_CACHE_DIR": "/proc/none"}, cwd=tmp_path,
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert float(ended.stdout) == pytest.approx(LIMIT, abs=1e-14)
    assert len(ended.stderr.splitlines()) == 1
    assert "compiled code is not kept for the next time" in ended.stderr


def test_the_cache_lies_outside_the_package_and_old_ones_go(tmp_path: Path):
    cache = tmp_path / "puck-tables"
    old, recent = cache / f"compiled-{0:016}", cache / f"compiled-{1:016}"
    for folder in (old, recent):
        folder.mkdir(parents=True)
    os.utime(old, (0, time.time() - 31 * 86400))
    environment = {**os.environ, **COMPILED, "XDG_CACHE_HOME": str(tmp_path)}
    environment.pop("NUMBA_CACHE_DIR", None)
    subprocess.run(
        [sys.executable, "-c", "import puck_tables as p; p.motion.limit_ratio(0.0)"],
        env=environment, check=True,
    )  # fmt: skip
    assert not old.exists()
    assert recent.exists()
    assert len(list(cache.glob("*/*.code"))) > 0
    # nothing but Python's own byte code appears beside the sources
    beside = {path.suffix for path in (ROOT / "puck_tables").glob("**/__pycache__/*")}
    assert beside <= {".pyc"}
