"""Formats of tracks, a file each, found by being here: each lists its ``READERS``."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from puck_tables.film.film import Reader


def readers() -> list[Reader]:
    """All formats but tables of text, which a file is where it is none of these."""
    modules = [import_module(f"{__name__}.{module.name}") for module in iter_modules(__path__)]
    return [reader for module in modules for reader in module.READERS]
