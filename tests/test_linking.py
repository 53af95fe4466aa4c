"""What only kernels call is compiled once, without machine code of its own, behind every door."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

import numba
import numpy as np
import pytest

from puck_tables.kernels import compiled, kept_code, quick_compiler
from puck_tables.kernels.compile import Door, inlined, inner, kernel, look_up, on_demand
from puck_tables.kernels.compiled import dispatcher_of
from puck_tables.kernels.linking import Behind, Pasted
from puck_tables.kernels.records import Record
from puck_tables.world.group import Scales, buffer_for


@pytest.fixture(scope="module", autouse=True)
def own_folder(tmp_path_factory: pytest.TempPathFactory):
    """What an earlier run kept would not be compiled."""
    folder = tmp_path_factory.mktemp("compiled")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kept_code, "cache_folder", lambda: folder)
        yield


@inlined
def _twice(x: float) -> float:
    return 2.0 * x


@inner
def _deep(x: float, times: int) -> float:
    for _ in range(times):
        x = _twice(x)
    return x


@inner
def _deeper(x: float) -> float:
    return _deep(x, 2) + _deep(x, 3)


@kernel
def _door(x: float) -> float:
    return _deeper(x) + _deep(x, 1)


@kernel
def _other_door(values: np.ndarray) -> float:
    total = 0.0
    for x in values:
        total += _door(x) + _deeper(x)
    return total


def libraries(function) -> list:
    of_numba = (
        function.compiled if isinstance(function, Door) else dispatcher_of(function, fuses=False)
    )
    return [overload.library for overload in of_numba.overloads.values()]


def test_what_lies_deep_is_linked_into_every_door():
    assert _door(1.0) == 4.0 + 8.0 + 2.0
    assert _other_door(np.array([1.0, 0.5])) == 1.5 * (14.0 + 12.0)


def test_it_is_compiled_once_whatever_the_constants_and_has_no_machine_code():
    _door(1.0)
    for function in (_twice, _deep, _deeper):
        (library,) = libraries(function)
        assert isinstance(library, Pasted)
        assert library._compiled_object is None
    assert all(isinstance(library, Behind) for library in libraries(_door))
    assert _deep(3.0, 2) == 12.0  # from Python as it is written


def test_a_door_that_was_kept_is_linked_into_others_too():
    expected = _door(1.0)  # compiled, and kept on disk
    kept = kernel(_door.py_func)

    @kernel
    def through(x: float) -> float:
        return kept(x)

    assert through(1.0) == expected
    assert sum(kept.compiled._cache_hits.values()) == 1


@on_demand("float64", "int64")
def _rare(values: np.ndarray, x: float) -> tuple[float, int]:
    return values[0] * x, values.size


@kernel
def _rarely(values: np.ndarray, x: float, also: bool) -> float:
    if also:
        product, size = _rare(values, x)
        return product + size
    return x


@on_demand("float64")
def _long(x: float) -> float:
    return 3.0 * x


@kernel
def _calls_long(x: float) -> float:
    return _long(x) + 1.0


def test_what_is_compiled_on_demand_is_compiled_by_the_first_that_calls_it():
    values = np.array([3.0, 1.0])
    assert _rarely(values, 2.0, False) == 2.0
    assert not _rare.compiled.overloads
    with ThreadPoolExecutor(8) as pool:
        answers = list(pool.map(lambda x: _rarely(values, x, True), np.arange(8.0)))
    assert answers == [3.0 * x + 2.0 for x in range(8)]
    assert len(_rare.compiled.overloads) == 1


def test_an_interrupt_while_something_is_compiled_on_demand_is_raised_after_it():
    compiles = _long.compiled.compile

    def interrupted(kinds: tuple) -> None:
        _long.compiled.compile = compiles
        raise KeyboardInterrupt

    _long.compiled.compile = interrupted
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt):
            _calls_long(2.0)
            for _ in range(500):  # a long sleep would not be woken
                time.sleep(0.01)
    finally:
        signal.signal(signal.SIGINT, before)
    assert _calls_long(2.0) == 7.0


def _larger(door):
    @door
    def larger(x: float, y: float) -> float:
        return max(x * y, x) + abs(y)

    return larger


def test_functions_of_numba_that_are_found_once_are_those_found_anew(monkeypatch):
    texts: list[str] = []
    optimize = Behind._optimize_final_module

    def written(self):
        texts.append(re.sub(r"B\d*v\d+B| at 0x[0-9a-f]+", "", str(self._final_module)))
        optimize(self)

    monkeypatch.setattr(Behind, "_optimize_final_module", written)
    monkeypatch.setattr(compiled.kept_code, "load_overload", lambda *_: None)
    for quickly in (quick_compiler.quick, contextlib.nullcontext):
        monkeypatch.setattr(compiled, "quick", quickly)
        for door in (kernel, look_up):  # with other options for the same types
            assert _larger(door)(3.0, 0.5) == 3.5
    assert texts[:2] == texts[2:] and texts[0] != texts[1]


class _Wide(NamedTuple):
    one: np.ndarray
    other: np.ndarray
    number: float
    third: np.ndarray
    fourth: np.ndarray


def test_wide_tuples_of_the_package_go_by_their_address_and_those_of_others_as_numba_does_it():
    assert type(numba.typeof(buffer_for(1, 1))) is Record
    assert type(numba.typeof(Scales(1.0, 1.0, 1e-9))) is not Record  # three numbers
    square = np.zeros((2, 2))
    assert type(numba.typeof(_Wide(square, square, 0.5, square, square))) is numba.types.NamedTuple


def test_a_kernel_of_no_module_cannot_be_compiled_on_demand():
    with pytest.raises(TypeError, match="kernel of a module"):

        @on_demand("float64")
        def local(x: float) -> float:
            return x


_SAYS = (
    "import sys, numba.core.codegen, numpy as np\n"
    "{}\n"
    "import puck_tables as p\n"
    "stops = p.stop((1.0, 0.2), np.linspace(-3.0, 5.0, 99), delta=0.5)\n"
    "run = p.Puck(0.04, 0.02, 0.15).simulate((1.0, 0.2), 5.0)\n"
    "print(stops.stop_time.tolist(), stops.stop_position.tolist(), run.stop_time)\n"
)


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("without", "kept"),
    [
        ("del numba.core.codegen.JITCodeLibrary", "*.code"),
        ("sys.modules['puck_tables.kernels.kept_code'] = None", "*.nbc"),
    ],
)
def test_a_numba_without_its_private_parts_compiles_the_same(without, kept, tmp_path):
    said = []
    for number, line in enumerate(("", without, without)):
        folder = tmp_path / str(bool(number))
        settings = {"NUMBA_DISABLE_JIT": "0", "NUMBA_CACHE_DIR": str(folder)}
        ended = subprocess.run(
            [sys.executable, "-c", _SAYS.format(line)], env={**os.environ, **settings},
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        said.append(ended.stdout)
        if number == 1:
            files = {path: path.stat().st_mtime_ns for path in folder.glob(f"compiled-*/**/{kept}")}
    assert said[0] == said[1] == said[2]
    assert files
    assert files == {path: path.stat().st_mtime_ns for path in folder.rglob(kept)}  # and read again


_DOORS = """
import sys
import numpy as np
from puck_tables.kernels.compile import kernel, on_demand

@on_demand("float64")
def rare(x: float) -> float:
    return 0.0 * x

@kernel
def unrelated(x: float) -> float:
    return x + 1.0

@kernel
def inside(x: float) -> float:
    return 3.0 * x

@kernel
def outside(values) -> float:
    total = 0.0
    for x in values:
        total += inside(x)
    return total + rare(total) if total > 10.0 else total

if __name__ != "__main__":
    from puck_tables.kernels.patience import here
    type(here).at_once = True
"""
_CALLED = """
import sys
import numpy as np
import doors_here
for name in sys.argv[1:]:
    getattr(doors_here, name)(1.0)
print(doors_here.outside(np.arange(4.0)), sum(doors_here.outside.compiled._cache_hits.values()))
"""


@pytest.mark.thorough
def test_a_door_behind_a_door_is_called_where_it_is_and_may_be_compiled_anew(tmp_path: Path):
    """Its symbol is another one in each process: whoever is read finds it by address."""
    (tmp_path / "doors_here.py").write_text(_DOORS)
    folder = tmp_path / "kept"

    def told(*first: str) -> list[str]:
        return subprocess.run(
            [sys.executable, "-c", _CALLED, *first], cwd=tmp_path, capture_output=True, text=True,
            check=True, env={**os.environ, "NUMBA_CACHE_DIR": str(folder)},
        ).stdout.split()  # fmt: skip

    assert told() == ["18.0", "0"]
    names = {path.name.rpartition("-")[0] for path in folder.rglob("*.code")}
    assert names == {"doors_here-inside", "doors_here-outside", "doors_here-rare"}
    assert told("unrelated") == ["18.0", "1"]
    for name in ("inside", "rare"):
        (path,) = folder.rglob(f"doors_here-{name}-*")
        path.unlink()
        assert told("unrelated", "unrelated") == ["18.0", "1"]
        assert len(list(folder.rglob(f"doors_here-{name}-*"))) == 1
