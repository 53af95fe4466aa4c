"""Kernels count no references: what gives an array to one that does would free it too early."""

from __future__ import annotations

import ast
import typing
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

BARE = ("kernel", "inner", "inlined")
COUNTING = ("allocating", "look_up")


def compiled_functions() -> list[tuple[Path, ast.FunctionDef, str]]:
    """Every compiled function of the package, also those within others: file, source, kind."""
    found = []
    for path in sorted((ROOT / "puck_tables").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef):
                for mark in node.decorator_list:
                    if ast.unparse(mark) in (*BARE, *COUNTING):
                        found.append((path, node, ast.unparse(mark)))
    return found


def holds_arrays(hint: typing.Any) -> bool:
    if typing.get_origin(hint) is np.ndarray or hint is np.ndarray:
        return True
    if hasattr(hint, "_fields"):
        return any(holds_arrays(part) for part in typing.get_type_hints(hint).values())
    return any(holds_arrays(part) for part in typing.get_args(hint))


def gives_arrays(path: Path, function: ast.FunctionDef) -> bool:
    name = ".".join(path.relative_to(ROOT).with_suffix("").parts)
    module = __import__(name, fromlist=["*"])
    if function.name not in vars(module):  # within another: its factory says what it returns
        return "Array" in ast.unparse(function.returns or ast.Constant(None))
    value = vars(module)[function.name]
    return holds_arrays(typing.get_type_hints(getattr(value, "py_func", value))["return"])


@pytest.mark.thorough
def test_no_kernel_gives_arrays_to_a_function_that_counts():
    functions = compiled_functions()
    assert {kind for _, _, kind in functions} == {*BARE, *COUNTING}
    givers = {f.name for path, f, kind in functions if kind in BARE and gives_arrays(path, f)}
    assert "at_slip_zero" in givers  # the test sees those that there are
    for path, function, kind in functions:
        if kind in COUNTING:
            called = {
                ast.unparse(node.func) for node in ast.walk(function) if isinstance(node, ast.Call)
            }
            assert not called & givers, (path, function.name, called & givers)


@pytest.mark.thorough
def test_no_kernel_makes_arrays():
    """numba says so itself, but only where it has not compiled the same for another before."""
    numbers = {"np.cbrt", "np.cos", "np.floor", "np.sin", "np.sqrt", "np.uint64"}
    for path, function, kind in compiled_functions():
        made = {
            ast.unparse(node.func)
            for node in ast.walk(function)
            if isinstance(node, ast.Call) and ast.unparse(node.func).startswith("np.")
        } - numbers
        copies = [n for n in ast.walk(function) if getattr(n, "attr", "") == "copy"]
        assert kind in COUNTING or not (made or copies), (path, function.name, made)
