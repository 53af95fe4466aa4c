"""What lies in the cache of compiled code is run only if it is whole and nobody else's."""

from __future__ import annotations

import json
import os
import platform
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from rarely import few, thorough

from puck_tables._core.own_folder import _said, make_private, refuse_shared
from puck_tables._core.sources import source_digest
from puck_tables.kernels import cache, kept_code
from puck_tables.kernels.compile import kernel

LIMIT = 1.531389372173909906  # tan φ₀ at δ = 0
COMMAND = [sys.executable, "-c", "import puck_tables as p; print(float(p.motion.limit_ratio(0.0)))"]


LINKED = """
import numpy as np
from numba import njit
from puck_tables.kernels.quadratic import HEADER, section_at

@njit
def mine(coefficients, out):
    section_at(coefficients, 0.25, out)

coefficients, out = np.ones((1, 1, 5)), np.zeros((1, HEADER + 3))
{}
mine(coefficients, out)
print(out[0, HEADER + 1])
"""


def run(
    folder: Path, command: list[str] = COMMAND, found: float = LIMIT, **environment: str
) -> subprocess.CompletedProcess[str]:
    ended = subprocess.run(
        command,
        env={**os.environ, "NUMBA_DISABLE_JIT": "0", "NUMBA_CACHE_DIR": str(folder), **environment},
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert float(ended.stdout) == pytest.approx(found, abs=1e-14)
    return ended


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of compiled code of this test's own."""
    monkeypatch.setattr(kept_code, "cache_folder", lambda: tmp_path)
    return tmp_path


def compiled() -> Any:
    """The same function, as a program that starts anew has it."""

    def third(x: float) -> float:
        return x / 3.0

    return kernel(third)


@pytest.mark.parametrize(("some", "drawn"), [(5, 4), thorough(1, 40)])
def test_every_flipped_bit_is_compiled_anew(some: int, drawn: int, folder: Path):
    assert compiled()(6.0) == 2.0
    (path,) = folder.iterdir()
    whole = path.read_bytes()
    again = compiled()
    assert again(6.0) == 2.0
    assert sum(again.compiled.stats.cache_hits.values()) == 1  # what is whole is used
    rng = np.random.default_rng(9)
    for position in [*range(0, 40, some), *rng.integers(40, len(whole), drawn), len(whole) - 1]:
        harmed = bytearray(whole)
        harmed[position] ^= 1 << rng.integers(8)
        path.write_bytes(harmed)
        loaded = compiled()
        assert loaded(6.0) == 2.0
        assert not loaded.compiled.stats.cache_hits
        assert path.read_bytes() != bytes(harmed)  # healed


@pytest.mark.parametrize("content", [b"", b"short", bytes(32), bytes(1000)])
def test_what_is_no_compiled_code_is_replaced(content: bytes, folder: Path):
    compiled()(6.0)
    (path,) = folder.iterdir()
    path.write_bytes(content)
    assert compiled()(6.0) == 2.0
    assert len(path.read_bytes()) > 1000


@pytest.mark.thorough
def test_a_function_of_somebody_else_may_call_what_is_kept(tmp_path: Path):
    for first in ("", *["section_at(coefficients, 0.5, out)"] * 2):  # alone, beside, and read
        run(tmp_path, [sys.executable, "-c", LINKED.format(first)], 0.25)


INNER = """
from numba import njit
from puck_tables.kernels.base_boundary import line_sums
from puck_tables.kernels.quadratic import section_at
section_at.compiled

@njit
def mine(x):
    return line_sums(1.0, 1.0, x, 0.0, 0.0, x)[0]

mine(1.0)
"""


def test_what_only_kernels_call_is_no_name_to_a_function_of_somebody_else():
    ended = subprocess.run([sys.executable, "-c", INNER], capture_output=True, text=True)
    assert ended.returncode == 1 and "Untyped global name 'line_sums'" in ended.stderr


def test_code_of_another_function_under_this_name_is_not_taken(folder: Path):
    compiled()(6.0)
    (path,) = folder.iterdir()

    def double(x: float) -> float:
        return 2.0 * x

    kernel(double)(1.0)
    (other,) = set(folder.iterdir()) - {path}
    other.replace(path)
    assert compiled()(6.0) == 2.0


def test_a_full_disk_still_computes(folder: Path, monkeypatch: pytest.MonkeyPatch):
    def full(*given: object, **named: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.replace", full)
    assert compiled()(6.0) == 2.0
    assert list(folder.iterdir()) == []


def test_the_folder_is_private(tmp_path: Path):
    os.umask(before := os.umask(0))
    run(tmp_path / "cache")
    (folder,) = (tmp_path / "cache").iterdir()
    assert folder.stat().st_mode & 0o777 == 0o700
    assert {path.stat().st_mode & 0o077 for path in folder.iterdir()} == {0}
    assert os.umask(before) == before


@pytest.mark.parametrize("mode", few(1, [0o707, 0o777, 0o770]))
def test_a_folder_that_others_may_write_is_not_used(mode: int, tmp_path: Path):
    shared = tmp_path / "shared"
    shared.mkdir()
    shared.chmod(mode)
    if mode == 0o770:
        if os.geteuid() != 0:
            pytest.skip("needs another group")
        os.chown(shared, 0, 12345)
    said = run(shared).stderr
    assert "others may write to the folder" in said
    assert str(shared) in said
    assert list(shared.iterdir()) == []


def test_a_planted_folder_is_not_used(tmp_path: Path):
    """Others made it before, by the name that ours would have."""
    mine = tmp_path / f"compiled-{source_digest()}"
    mine.mkdir()
    mine.chmod(0o777)
    planted = mine / "planted.code"
    planted.write_bytes(b"planted")
    assert "others may write to the folder" in run(tmp_path).stderr
    assert list(mine.iterdir()) == [planted]


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give files away")
def test_a_folder_of_somebody_else_is_not_used(tmp_path: Path):
    other = tmp_path / "other"
    other.mkdir()
    os.chown(other, 12345, 12345)
    with pytest.raises(PermissionError, match="belongs to another user"):
        make_private(other)
    with pytest.raises(PermissionError, match="belongs to another user"):
        make_private(other / "deep" / "below")
    assert list(other.iterdir()) == []
    link = tmp_path / "link"
    link.symlink_to(tmp_path)
    os.chown(link, 12345, 12345, follow_symlinks=False)  # it may lead elsewhere tomorrow
    with pytest.raises(PermissionError, match="belongs to another user"):
        refuse_shared(link / "cache")


def test_a_folder_below_one_like_tmp_is_used(tmp_path: Path):
    tmp_path.chmod(0o1777)
    make_private(tmp_path / "kept")
    with pytest.raises(PermissionError, match="others may write"):
        make_private(tmp_path)


def test_the_users_cache_is_judged_alike(tmp_path, monkeypatch, request):
    from click.testing import CliRunner
    from puck_tables.cli.main import main
    from puck_tables.cli.tables import kept_files

    from puck_tables.table import table_store

    request.addfinalizer(cache.cache_folder.cache_clear)  # it may be asked here first

    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    tmp_path.chmod(0o777)
    _said.clear()
    said: list[str] = []
    monkeypatch.setattr(table_store, "say", said.append)
    assert table_store.table_for("ring", 1e-4).tolerance == 1e-4
    assert "others may write" in said[0]
    assert list(tmp_path.iterdir()) == []
    assert kept_files() == []
    refused = CliRunner().invoke(main, ["tables", "--remove", "x"])
    assert refused.exit_code == 2
    assert "no table x is kept" in refused.stderr


@pytest.mark.thorough
def test_nothing_appears_beside_the_package_where_no_folder_will_do(tmp_path: Path):
    """numba's own cache would turn to __pycache__ there, and serve stale code after edits."""
    from conftest import ROOT

    run(Path("/proc/none"), HOME="/proc/none")
    beside = {path.suffix for path in (ROOT / "puck_tables").glob("**/__pycache__/*")}
    assert beside <= {".pyc"}


@pytest.fixture
def brought(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder beside it, with code as a wheel brings it along, for this machine."""
    compiled()(6.0)
    (path,) = folder.iterdir()
    along = folder.parent / f"{folder.name}-along"
    along.mkdir()
    path.replace(along / path.name)
    monkeypatch.setattr(kept_code, "brought_folder", lambda: along)
    kept_code.brought_for.cache_clear()
    return along


def say_target(folder: Path, *needs: str) -> None:
    codegen = compiled().compiled.targetctx.codegen().magic_tuple()
    place = sys.platform, platform.machine().lower()
    target = {"place": place, "codegen": codegen, "needs": needs}
    (folder / "target.json").write_text(json.dumps(target), encoding="utf-8")


def test_code_that_came_along_is_run(folder: Path, brought: Path):
    say_target(brought)
    again = compiled()
    assert again(6.0) == 2.0
    assert sum(again.compiled.stats.cache_hits.values()) == 1
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("harm", ["a processor", "no target", "another system", "a flipped bit"])
def test_code_that_came_along_for_others_is_not_run(harm: str, folder: Path, brought: Path):
    say_target(brought, *(["avx1024"] if harm == "a processor" else []))
    target = brought / "target.json"
    (code,) = brought.glob("*.code")
    if harm == "no target":
        target.write_text("{}", encoding="utf-8")
    if harm == "another system":
        target.write_text(target.read_text().replace(sys.platform, "beos"), encoding="utf-8")
    if harm == "a flipped bit":
        whole = code.read_bytes()
        code.write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
    again = compiled()
    assert again(6.0) == 2.0
    assert not again.compiled.stats.cache_hits
    assert len(list(folder.iterdir())) == 1


def test_whoever_names_a_processor_gets_code_for_it(brought: Path, monkeypatch: pytest.MonkeyPatch):
    say_target(brought)
    monkeypatch.setattr("numba.config.CPU_NAME", "generic")
    again = compiled()
    assert again(6.0) == 2.0
    assert not again.compiled.stats.cache_hits


ELSEWHERE = """
import sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
import code_elsewhere, puck_tables
puck_tables.warm_up = lambda: puck_tables.motion.limit_ratio(0.0)
code_elsewhere.main(Path(sys.argv[2]))
"""
BROUGHT = f"""
import sys
from pathlib import Path
from puck_tables.kernels import kept_code
kept_code.brought_folder = lambda: Path(sys.argv[1])
{COMMAND[-1]}
"""
# how object files begin: ELF, Mach-O, and the numbers of processors in COFF
BEGIN = {
    "manylinux": b"\x7fELF", "macosx": b"\xcf\xfa\xed\xfe", "win_amd64": b"\x64\x86",
    "win_arm64": b"\x64\xaa",
}  # fmt: skip


@pytest.mark.thorough
def test_code_for_all_machines_is_made_on_one(tmp_path: Path):
    """What it makes for this one is run in place of what numba would compile."""
    from conftest import ROOT
    from numba.core import serialize

    def python(program: str, *arguments: object) -> str:
        environment = {
            **os.environ, "NUMBA_DISABLE_JIT": "0", "NUMBA_CACHE_DIR": str(tmp_path / "own"),
        }  # fmt: skip
        return subprocess.run(
            [sys.executable, "-c", program, *map(str, arguments)],
            env=environment, capture_output=True, text=True, check=True,
        ).stdout  # fmt: skip

    python(ELSEWHERE, ROOT / ".ci", tmp_path / "made")
    here = None
    for platform_of in (tmp_path / "made").iterdir():
        (folder,) = platform_of.iterdir()
        for path in folder.glob("*.code"):
            content = kept_code.read_sealed(path)
            assert content is not None
            _, _, ((_, _, (made, _)), *_) = serialize.loads(content)
            (begin,) = (one for tag, one in BEGIN.items() if platform_of.name.startswith(tag))
            assert made.startswith(begin)
        target = json.loads((folder / "target.json").read_text(encoding="utf-8"))
        if target["place"] == [sys.platform, platform.machine().lower()]:
            here = folder
    (own,) = (tmp_path / "own").iterdir()
    for path in own.iterdir():
        path.unlink()
    assert float(python(BROUGHT, here)) == pytest.approx(LIMIT, abs=1e-14)
    assert list(own.iterdir()) == []
