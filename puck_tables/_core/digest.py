"""Which work this is: a digest of everything that determines the bits of its results."""

from __future__ import annotations

import hashlib
import json
import os
import platform
import sys
from collections.abc import Mapping
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np

from puck_tables._core.safe_read import read_whole
from puck_tables._core.sources import source_digest
from puck_tables.errors import InputError

_LARGEST_FILE = 1 << 26  # bytes, 64 MiB: a file that work names is read whole for its digest


def work_digest(**what: Any) -> str:
    """Digest of everything that determines the bits of a long work.

    ``what``: numbers, texts, None, arrays, and lists and mappings of them: the arguments by
    content, of a file not its name, but what :func:`files_named` reads of it.  The sources of the
    package and what compiles and runs them are added here.

    >>> work_digest(tol=1e-8, w0=np.arange(3)) == work_digest(tol=1e-8, w0=np.arange(3.0))
    False
    """
    text = json.dumps([what, program()], sort_keys=True, default=_apart)
    return hashlib.sha256(text.encode()).hexdigest()


@cache
def program() -> tuple[str, ...]:
    """What computes here: the sources of the package, and what compiles and runs them."""
    libraries = ("numba", "llvmlite", "numpy", "scipy")
    runs = [version(name) for name in libraries]
    return source_digest(), *runs, platform.machine(), platform.processor(), sys.version


def _apart(value: Any) -> Any:
    """An array as a digest of all that it is; whatever else JSON does not know is refused."""
    if isinstance(value, np.ndarray | np.generic):
        array = np.asarray(value)
        content = hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()
        return [str(array.dtype), array.shape, content]
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"{type(value).__name__} does not say what it is")


def files_named(value: Any) -> dict[str, str]:
    """Digests of the content of all files whose names stand anywhere in a nested structure.

    >>> files_named({"force": {"file": "/nowhere/force.csv"}, "wall": [{"x": 1.0}]})
    {'/nowhere/force.csv': 'cannot be read'}
    """
    if isinstance(value, Mapping):
        value = list(value.values())
    if isinstance(value, list | tuple):
        return {name: digest for item in value for name, digest in files_named(item).items()}
    if not isinstance(value, str) or not (value.lower().endswith(".csv") or os.path.isfile(value)):
        return {}
    try:
        content = read_whole(value, _LARGEST_FILE)
    except (OSError, ValueError):  # whoever needs it says why
        return {value: "cannot be read"}
    return {value: hashlib.sha256(content).hexdigest()}


def refuse_changed(whole: Any, read: Mapping[str, str]) -> None:
    """Refuse to go on when a file that a structure names is not what it was."""
    if files_named(whole) != read:
        raise InputError(
            f"a file that this scene names was changed while it was swept ({', '.join(read)}), or "
            "is another one on this machine: begin again"
        )
