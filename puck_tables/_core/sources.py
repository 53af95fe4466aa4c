"""The digest of the sources: what they computed is known by it."""

from __future__ import annotations

import hashlib
from functools import cache
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent.parent


@cache
def source_digest(*folders: str) -> str:
    """Digest of the sources in these folders of the package, or of all (16 hexadecimal digits)."""
    digest = hashlib.sha256()
    within = [_PACKAGE / folder for folder in folders] or [_PACKAGE]
    for path in sorted(path for folder in within for path in folder.rglob("*.py")):
        digest.update(path.relative_to(_PACKAGE).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]
