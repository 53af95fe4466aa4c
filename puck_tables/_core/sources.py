"""The digest of the sources: what they computed is known by it."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent.parent
_ASIDE = ("cli", "tables")  # they compute nothing, and in a clone they lie beside the package


@cache
def source_digest(*folders: str) -> str:
    """Digest of the sources in these folders of the package, or of all (16 hexadecimal digits)."""
    digest = hashlib.sha256()
    within = [_PACKAGE / folder for folder in folders] or [_PACKAGE]
    for path in sorted(path for folder in within for path in folder.rglob("*.py")):
        name = path.relative_to(_PACKAGE)
        if name.parts[0] not in _ASIDE:
            digest.update(name.as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]
