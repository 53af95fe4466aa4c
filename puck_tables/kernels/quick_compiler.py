"""numba's compiler, kept from doing the same again and again: a fifth less, and the same code.

It looks up at every + of two numbers among all its kinds of numbers which addition that is, and
lists after every step over a function which variables are alive, but reads the last list only.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

from numba.core.postproc import PostProcessor, VariableLifetime
from numba.core.targetconfig import ConfigStack
from numba.core.transforms import canonicalize_cfg
from numba.core.types.functions import BaseFunction

# numba's objects have no annotations
_Called: Any = BaseFunction
_AfterStep: Any = PostProcessor
_alive: Any = VariableLifetime
_canonical: Any = canonicalize_cfg
_options: Any = ConfigStack
_find_type: Any = _Called.get_call_type
_list_all: Any = _AfterStep.run
# by function, types and options: signature, what lowers it
_signatures: dict[Any, tuple[Any, Any]] = {}


def _call_type(function: Any, context: Any, args: Any, named: Any) -> Any:
    """Which function of that name is called with such arguments; found once."""
    key = function, context, args, tuple(named.items()), _options.top_or_none()
    if key in _signatures:
        signature, function._impl_keys[signature.args] = _signatures[key]
    else:
        signature = _find_type(function, context, args, named)
        _signatures[key] = signature, function._impl_keys[signature.args]
    return signature


def _list_at_end(after: Any, emit_dels: bool = False, extend_lifetimes: bool = False) -> None:
    """What is alive where: now, if that is read, or else when it is."""
    code = after.func_ir
    if emit_dels or code.is_generator:
        _list_all(after, emit_dels, extend_lifetimes)
    else:
        code.blocks = _canonical(code.blocks)
        code.variable_lifetime = _alive(code.blocks)


@contextlib.contextmanager
def quick() -> Iterator[None]:
    """What is compiled within, under numba's lock, is compiled so."""
    before = _Called.get_call_type, _AfterStep.run
    _Called.get_call_type, _AfterStep.run = _call_type, _list_at_end
    try:
        yield
    finally:
        _Called.get_call_type, _AfterStep.run = before
