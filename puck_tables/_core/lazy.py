"""Names of a package that are loaded when they are asked for."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path
from typing import Any

NEEDED = ("numpy", "numba", "scipy", "h5py", "click")
_ABOVE: dict[str, str] = {}  # where names are, as the package tells
_ROOT = Path(__file__).resolve().parent.parent.parent
_FOR_TYPES = re.compile(r"^ {4}from (\S+) import (\([^)]*\)|.+)$", re.MULTILINE)
_CLONE = _ROOT if (_ROOT / "pyproject.toml").is_file() else None


def lazily(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """``__getattr__`` and ``__dir__`` of a package or module: what it imports for types alone.

    Its source says so once, below ``if TYPE_CHECKING``.  ``package``: its ``__name__``.

    >>> get, listed = lazily("puck_tables")
    >>> get("Puck").__name__, get("contact").__name__, "Puck" in listed()
    ('Puck', 'puck_tables.contact', True)
    """
    spec: Any = sys.modules[package].__spec__
    places = {}
    source = spec.loader.get_data(spec.origin).decode()
    for module, names in _FOR_TYPES.findall(source):
        for one in names.strip("()").split(","):
            there, _, here = one.strip().partition(" as ")
            places[here or there] = module, there

    def get(name: str) -> Any:
        if name not in places:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module, there = places[name]
        try:
            home: Any = import_module(f"{module}.{name}" if module == package else module)
        except ModuleNotFoundError as error:
            if error.name not in NEEDED:
                raise
            raise ModuleNotFoundError(
                f"{package} needs {error.name}, which this Python does not have: "
                f'python -m pip install "{_CLONE or package}", or take the Python that has it '
                "(in a clone .venv/bin/python)",
                name=error.name,
            ) from None
        value = home if module == package else getattr(home, there)
        setattr(sys.modules[package], name, value)
        return value

    return get, lambda: sorted({*vars(sys.modules[package]), *filter(None, places)})


def lead_up(homes: Mapping[str, str]) -> None:
    """Tell where that is which lower rooms ask for without knowing it.

    ``homes``: modules by names, or ``module:name`` where it has another name there.
    """
    _ABOVE.update(homes)


def names_above(beginning: str) -> list[str]:
    """The names that were told and begin so, in the order in which they were."""
    return [name for name in _ABOVE if name.startswith(beginning)]


def above(name: str) -> Any:
    """What stands above whoever asks for it: pictures stand above what they show."""
    module, _, original = _ABOVE[name].partition(":")
    return getattr(import_module(module), original or name)


def report_of(result: Any) -> str:
    """What a reader wants to know of a result, in words; its repr where nobody has told more."""
    name = f"report of {type(result).__name__}"
    return str(above(name)(result)) if name in _ABOVE else repr(result)


def with_neighbours(package: str, file: str) -> None:
    """Load cli/ and tables/ where they lie beside a package, not in it: in a clone.

    Python there takes the package's folder, whatever is installed.
    """
    for name in ("cli", "tables"):
        folder = Path(file).resolve().parent.parent / name
        if not (Path(file).resolve().parent / name).is_dir() and folder.is_dir():
            spec = spec_from_file_location(
                f"{package}.{name}",
                folder / "__init__.py",
                submodule_search_locations=[str(folder)],
            )
            assert spec is not None and spec.loader is not None
            module = sys.modules[spec.name] = module_from_spec(spec)
            spec.loader.exec_module(module)
            setattr(sys.modules[package], name, module)
