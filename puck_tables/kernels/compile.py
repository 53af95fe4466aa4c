"""The one door to numba: how every compiled function of the package is made and cached."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

from puck_tables.kernels.cache import cache_folder

Function = TypeVar("Function", bound=Callable[..., Any])


def kernel(function: Function) -> Function:
    """Compile a function: no Python objects, no GIL, IEEE rules except fused multiply-add.

    Division by zero gives inf or NaN as in NumPy; kernels report trouble by status codes.
    """
    return _compile(function, forceinline=False)


def inlined(function: Function) -> Function:
    """Compile a function that is pasted into every caller, so that loops over it vectorise.

    The callers keep what was compiled; it needs no cache of its own.
    """
    return _compile(function, forceinline=True)


def _compile(function: Function, forceinline: bool) -> Function:
    compiled: Any = numba.njit(
        nogil=True, fastmath={"contract"}, error_model="numpy", forceinline=forceinline
    )(function)
    folder = None if forceinline else cache_folder()
    if folder is not None and hasattr(compiled, "enable_caching"):
        config: Any = numba.config
        before = config.CACHE_DIR
        config.CACHE_DIR = folder
        try:
            compiled.enable_caching()
        finally:
            config.CACHE_DIR = before
    return compiled
