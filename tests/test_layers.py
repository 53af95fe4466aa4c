"""The plan of the house: which rooms a room may import, and where the doors to libraries are."""

from __future__ import annotations

import ast
import importlib
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
# From the ground up: a room imports what its line names, and every name stands on a line before.
ROOMS = {
    "errors": "",
    "_version": "",
    "_core": "errors",
    "contact": "_core errors",
    "io": "_core _version errors",
    "result": "_core io",
    "bulk": "_core _version errors io result",
    "accuracy": "errors",
    "chetaev": "_core contact errors io result",
    "kernels": "_core contact errors",
    "table": "_core _version contact errors kernels",
    "motion": "_core accuracy contact errors kernels table",
    "verbs_of_many": "_core errors",
    "verbs": "verbs_of_many",
    "puck": "_core contact errors motion verbs",
    "stopping": "_core accuracy bulk contact errors io kernels motion puck result table "
    "verbs_of_many",
    "trajectory": "_core accuracy errors io motion puck result stopping table",
    "film": "_core errors io",
    "fitting": "_core _version accuracy contact errors film io kernels motion puck result "
    "stopping table",
    "autodiff": "contact errors stopping",
    "export": "_core _version contact errors puck stopping",
    "explore": "export",
    "scene": "_core bulk contact errors io kernels motion puck result stopping table",
    "wrench": "_core contact errors io kernels puck result scene",
    "world": "_core bulk contact errors io kernels motion puck result scene stopping table",
    "sweeps": "_core bulk contact errors io result scene world",
    "warming": "bulk kernels puck scene",
    "reference": "_core contact errors film io puck result scene trajectory world",
    "tradeoff": "_core _version accuracy contact io kernels motion puck result stopping table",
    "plot": "_core _version accuracy bulk chetaev errors film fitting io motion reference result "
    "scene stopping sweeps tradeoff trajectory world wrench",
    "cli": "_core _version accuracy bulk chetaev contact errors explore export film fitting io "
    "kernels motion plot puck reference scene stopping sweeps table tradeoff warming world",
    "__init__": "_core _version",
}
DOORS = {
    "numba": {
        "kernels.blocks",
        "kernels.compiled",
        "kernels.kept_code",
        "kernels.linking",
        "kernels.numba_settings",
        "kernels.vectors",
    },
    "llvmlite": {"kernels.blocks", "kernels.linking", "kernels.vectors"},
    "h5py": {"film.poses", "io.hdf5", "table.file"},
    "xarray": {"io.frames"},
    "pandas": {"io.frames"},
    "pyarrow": {"io.parquet"},
    "matplotlib": {"plot"},
    "zarr": {"bulk.store"},
    "distributed": {"bulk.cluster"},
    "dask": {"bulk.cluster"},
    "scipy": {
        "bulk.spreads",
        "chetaev",
        "export.fit",
        "export.law_values",
        "fitting",
        "stopping",
        "table.speed_fit",
        "tradeoff",
        "wrench.models",
    },
    "click": {"cli"},
    "jax": {"autodiff.jax"},
    "torch": {"autodiff.torch"},
}


def modules() -> dict[str, Path]:
    """The files of the package by their names in it."""
    found = {}
    for base, prefix in ((ROOT / "puck_tables", ()), (ROOT / "cli", ("cli",))):
        for path in base.rglob("*.py"):
            found[".".join([*prefix, *path.relative_to(base).with_suffix("").parts])] = path
    return found


_BLOCKS = (ast.stmt, ast.excepthandler, ast.match_case)


@cache
def imported(path: Path) -> tuple[str, ...]:
    """What a file imports anywhere in it, but for types."""
    return tuple(_imported(path))


def _imported(path: Path) -> Iterator[str]:
    waiting: list[ast.AST] = [ast.parse(path.read_text(encoding="utf-8"))]
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING":
            continue
        if isinstance(node, ast.ImportFrom):
            assert not node.level, f"{path}: imports are absolute"
            yield node.module or ""
        elif isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        # only in statements: expressions import nothing, and are most of a tree
        waiting += [child for child in ast.iter_child_nodes(node) if isinstance(child, _BLOCKS)]


def test_the_plan_names_every_room_and_no_circle():
    rooms = {name.partition(".")[0] for name in modules()}
    assert rooms == set(ROOMS)
    for n, (room, allowed) in enumerate(ROOMS.items()):
        assert set(allowed.split()) <= set(list(ROOMS)[:n]), room


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_only_what_it_may(room: str):
    for name, path in modules().items():
        if name.partition(".")[0] == room:
            for module in imported(path):
                top, _, rest = module.partition(".")
                if top == "puck_tables" and rest:
                    assert rest.partition(".")[0] in {room, *ROOMS[room].split()}, (name, module)


@pytest.mark.parametrize("library", DOORS)
def test_a_library_has_its_doors(library: str):
    through = {
        name for name, path in modules().items()
        if any(module.partition(".")[0] == library for module in imported(path))
    }  # fmt: skip
    doors = DOORS[library]
    assert {name for name in through if not {name, name.partition(".")[0]} & doors} == set()
    assert doors <= through | {name.partition(".")[0] for name in through}, "a door nobody uses"


def test_few_modules_lie_flat():
    flat = {path.stem for path in (ROOT / "puck_tables").glob("*.py")} - {"__init__"}
    assert len(flat) <= 8, flat


@pytest.mark.parametrize("package", ["", "chetaev", "contact", "motion"])
def test_every_public_name_is_there(package: str):
    home = importlib.import_module(f"puck_tables.{package}".rstrip("."))
    assert [name for name in home.__all__ if not hasattr(home, name)] == []


@pytest.mark.parametrize("package", ["", "chetaev", "contact", "motion"])
def test_no_public_name_is_a_module_s_too(package: str):
    """Whoever imports that module puts it in the place of the name."""
    home = importlib.import_module(f"puck_tables.{package}".rstrip("."))
    lies_there = {name.removeprefix(f"{package}.") for name in modules()}
    assert {name for name in home.__all__ if name in lies_there} == set()
