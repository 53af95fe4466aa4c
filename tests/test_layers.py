"""The plan of the house: which rooms a room may import, and where the doors to libraries are."""

from __future__ import annotations

import ast
import importlib
import inspect
import re
from collections.abc import Iterable, Iterator, Mapping
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
    "accuracy": "_core errors",
    "chetaev": "_core contact errors io result",
    "kernels": "_core contact errors",
    "table": "_core _version contact errors io kernels",
    "motion": "_core accuracy contact errors kernels table",
    "stopping": "_core accuracy bulk contact errors io kernels motion result table",
    "trajectory": "_core accuracy errors io motion result stopping table",
    "scene": "_core bulk contact errors io kernels motion result stopping table trajectory",
    "wrench": "_core contact errors io kernels motion result scene",
    "verbs_of_many": "_core bulk contact errors stopping table wrench",
    "puck": "motion stopping table trajectory verbs_of_many",
    "world": "_core bulk contact errors io kernels motion puck result scene stopping table",
    "film": "_core errors io",
    "fitting": "_core _version accuracy contact errors film io kernels motion puck result "
    "stopping table trajectory",
    "autodiff": "contact errors stopping",
    "export": "_core _version contact errors kernels puck scene stopping world",
    "explore": "export",
    "warming": "bulk kernels puck scene world",
    "reference": "_core errors film io motion result scene trajectory world",
    "tradeoff": "_core _version accuracy contact io kernels motion puck result scene stopping "
    "table world",
    "report": "_core accuracy bulk fitting io motion reference scene stopping table tradeoff "
    "trajectory world",
    "plot": "_core _version accuracy bulk chetaev errors export film fitting io motion reference "
    "result scene stopping tradeoff trajectory world wrench",
    "gym": "_core contact errors plot puck scene world",
    "cli": "_core _version accuracy bulk chetaev contact errors explore export film fitting io "
    "kernels motion plot puck reference report result scene stopping table tradeoff trajectory "
    "warming world",
    "results": "_core export fitting puck reference result scene stopping table trajectory world "
    "wrench",
    "__init__": "_core _version",
}
DOORS = {
    "numba": {
        "kernels.ahead", "kernels.register_blocks", "kernels.compiled", "kernels.kept_code",
        "kernels.linking", "kernels.on_demand", "kernels.compile", "kernels.quick_compiler",
        "kernels.records", "kernels.vectors",
    },
    "llvmlite": {
        "kernels.ahead", "kernels.kept_code", "kernels.linking", "kernels.on_demand",
        "kernels.records", "kernels.register_blocks", "kernels.vectors",
    },
    "h5py": {"film.readers.poses", "io.hdf5", "table.file"},
    "xarray": {"io.formats"},
    "svgelements": {"_core.drawn_outlines"},
    "pandas": {"io.formats"},
    "pyarrow": {"io.parquet"},
    "matplotlib": {"plot"},
    "zarr": {"bulk.store"},
    "distributed": {"bulk.cluster"},
    "dask": {"bulk.cluster"},
    "scipy": {
        "_core.monotone", "bulk.spreads", "chetaev", "export.compact_tables", "export.law_values",
        "fitting", "stopping", "table.speed_patch", "tradeoff", "wrench.push",
    },
    "click": {"cli"},
    "gymnasium": {"gym"},
    "pettingzoo": {"gym.two_players"},
    "jax": {"autodiff.jax"},
    "torch": {"autodiff.torch"},
}  # fmt: skip


parsed = cache(ast.parse)
# a text that could name a module, or with a dot at its end all in a room
NAMED = re.compile(r"[\"'](puck_tables\.|[a-z_0-9]+(?:\.[a-z_0-9]+)+\.?)[\"'{:]")
_BLOCKS = (ast.stmt, ast.excepthandler, ast.match_case)


@cache
def modules() -> dict[str, Path]:
    """The files of the package by their names in it."""
    found = {}
    for base, prefix in ((ROOT / "puck_tables", ()), (ROOT / "cli", ("cli",))):
        for path in base.rglob("*.py"):
            found[".".join([*prefix, *path.relative_to(base).with_suffix("").parts])] = path
    return found


Import = tuple[str, str]  # what is imported, and how: "runs", "types" or "text"


@cache
def imports_of(path: Path) -> tuple[Import, ...]:
    """What a file imports anywhere in it; a text that could name a module may be an import too."""
    source = path.read_text(encoding="utf-8")
    texts = [("puck_tables." + one.removeprefix("puck_tables."), "text") for one in
             NAMED.findall(source)]  # fmt: skip
    return (*_statements(parsed(source), path), *texts)


def _statements(tree: ast.Module, path: Path) -> Iterator[Import]:
    waiting: list[tuple[ast.AST, str]] = [(tree, "runs")]
    while waiting:
        node, how = waiting.pop()
        if isinstance(node, ast.ImportFrom):
            assert not node.level, f"{path}: imports are absolute"
            yield from ((f"{node.module}.{alias.name}", how) for alias in node.names)
        elif isinstance(node, ast.Import):
            yield from ((alias.name, how) for alias in node.names)
        elif isinstance(node, ast.If) and getattr(node.test, "id", "") == "TYPE_CHECKING":
            waiting += [(child, "types") for child in node.body]
            waiting += [(child, how) for child in node.orelse]
        else:  # only in statements: expressions import nothing, and are most of a tree
            children = ast.iter_child_nodes(node)
            waiting += [(child, how) for child in children if isinstance(child, _BLOCKS)]


@cache
def imported(path: Path) -> tuple[str, ...]:
    """What a file imports when it is loaded or used."""
    return tuple(name for name, how in imports_of(path) if how == "runs")


def files_named(target: str, how: str) -> list[str]:
    """The files that an import leads to: of a text those of a module, or of all in a room."""
    top, _, module = target.partition(".")
    if top != "puck_tables":
        return []
    if how == "text":
        whole = not module or module.endswith(".")
        return [name for name in modules() if name == module or (whole and name.startswith(module))]
    while module:
        for name in (module, f"{module}.__init__"):
            if name in modules():
                return [name]
        module = module.rpartition(".")[0]
    return ["__init__"]


@cache
def arrows() -> dict[str, set[str]]:
    """The files that each file leads to: when it runs, for types, or by a text."""
    return {
        name: {file for one in imports_of(path) for file in files_named(*one)} - {name}
        for name, path in modules().items()
    }


def circles(graph: Mapping[str, Iterable[str]]) -> list[list[str]]:
    """Files that import each other, directly or through others, after Tarjan."""
    number: dict[str, int] = {}
    lowest: dict[str, int] = {}
    open_: list[str] = []
    found: list[list[str]] = []

    def visit(name: str) -> None:
        number[name] = lowest[name] = len(number)
        open_.append(name)
        for other in graph[name]:
            if other not in number:
                visit(other)
                lowest[name] = min(lowest[name], lowest[other])
            elif other in open_:
                lowest[name] = min(lowest[name], number[other])
        if lowest[name] == number[name]:
            at = open_.index(name)
            circle, open_[at:] = open_[at:], []
            if len(circle) > 1:
                found.append(sorted(circle))

    for name in graph:
        if name not in number:
            visit(name)
    return found


def test_the_plan_names_every_room_and_no_circle():
    rooms = {name.partition(".")[0] for name in modules()}
    assert rooms == set(ROOMS)
    for n, (room, allowed) in enumerate(ROOMS.items()):
        assert set(allowed.split()) <= set(list(ROOMS)[:n]), room


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_only_what_it_may(room: str):
    for name in modules():
        if name.partition(".")[0] == room:
            for other in arrows()[name] if room != "__init__" else ():
                assert other.partition(".")[0] in {room, *ROOMS[room].split()}, (name, other)


def test_no_files_import_each_other_in_a_circle():
    """Imports for types, within functions and by a text count; no file is left out."""
    assert circles(arrows()) == []


def test_few_files_import_by_a_text():
    """The lazy names of packages, and rooms whose files do the same thing each in its own way."""
    ways = re.compile(r"\b(import_module|__import__|exec_module)\b")
    assert {name for name, path in modules().items() if ways.search(path.read_text("utf-8"))} == {
        "_core.lazy", "export.languages.__init__", "film.readers.__init__", "io.formats",
        "plot.drawn",
    }  # fmt: skip


def test_circles_are_seen():
    graph = {"a": "b", "b": "cd", "c": "a", "d": "e", "e": "", "f": "gf", "g": "f"}
    assert circles(graph) == [["a", "b", "c"], ["f", "g"]]


def test_no_way_to_import_is_overlooked(tmp_path: Path):
    path = tmp_path / "some.py"
    path.write_text(
        "from puck_tables._core import arrays\n"
        "if TYPE_CHECKING:\n    from puck_tables.puck import Puck\n"
        "else:\n    import puck_tables.result\n"
        "def late(name):\n"
        "    from puck_tables import fit\n"
        "    import_module('puck_tables.plot.movie'), import_module('bulk.work:Work')\n"
        "    import_module(f'puck_tables.autodiff.{name}')\n"
    )
    found = {file for one in imports_of(path) for file in files_named(*one)}
    rooms = {"autodiff.__init__", "autodiff.host", "autodiff.jax", "autodiff.torch"}
    assert found == rooms | {
        "__init__", "_core.arrays", "bulk.work", "plot.movie", "puck", "result",
    }  # fmt: skip
    assert set(imported(path)) == {
        "puck_tables._core.arrays", "puck_tables.result", "puck_tables.fit",
    }  # fmt: skip


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


@pytest.mark.parametrize("package", ["", "chetaev", "contact", "motion", "results"])
def test_every_public_name_is_there(package: str):
    home = importlib.import_module(f"puck_tables.{package}".rstrip("."))
    assert [name for name in home.__all__ if not hasattr(home, name)] == []


@pytest.mark.parametrize("package", ["", "chetaev", "contact", "motion", "results"])
def test_no_public_name_is_a_module_s_too(package: str):
    """Whoever imports that module puts it in the place of the name."""
    home = importlib.import_module(f"puck_tables.{package}".rstrip("."))
    lies_there = {name.removeprefix(f"{package}.") for name in modules()}
    names = {name for name in home.__all__ if not inspect.ismodule(getattr(home, name))}
    assert names & lies_there == set()
