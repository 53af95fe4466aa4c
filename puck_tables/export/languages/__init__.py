"""The languages of exported files: each is one module here, with its name in ``LANGUAGE``."""

from __future__ import annotations

from importlib import import_module
from pkgutil import iter_modules

from puck_tables.export.translate import Language

LANGUAGES: dict[str, Language] = {
    language.key: language
    for language in (
        import_module(f"{__name__}.{module.name}").LANGUAGE for module in iter_modules(__path__)
    )
}
