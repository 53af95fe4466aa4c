"""Kernels that compiled code calls by an address in a cell, and that are compiled when it does.

What few scenes need is not compiled for all.  A cell holds 0 until the first call, which then goes
through Python: the kernel is compiled, or read from disk, and its address put there.
"""

from __future__ import annotations

import _thread
import ctypes
import os
import threading
import traceback
from collections.abc import Callable
from typing import Any

from llvmlite import binding, ir
from numba.core import cgutils, types, typing
from numba.core.registry import cpu_target
from numba.core.typing.templates import AbstractTemplate
from numba.extending import lower_builtin

# numba's functions have no annotations
_code: Any = cgutils
_types: Any = types
_typing: Any = typing
_lowers: Any = lower_builtin
_Call: Any = AbstractTemplate
_SOON = 0.01  # s, until the code that waited is at work again
_WORD = ir.IntType(64)
_READY = ir.FunctionType(ir.VoidType(), [])
_cells: dict[str, Any] = {}  # by symbol: they live as long as the code that reads them


def put_cell(symbol: str, address: Callable[[], int]) -> None:
    """Let code find the cell of a symbol; ``address`` compiles what is called."""
    if symbol in _cells:
        return
    cell = ctypes.c_int64(0)

    def ready() -> None:
        interrupted = False
        while not cell.value:
            try:
                cell.value = address()
            except KeyboardInterrupt:  # nothing can be raised through compiled code: later
                interrupted = True
            except BaseException:
                traceback.print_exc()
                os.abort()
        if interrupted:
            threading.Timer(_SOON, _thread.interrupt_main).start()

    callback = ctypes.CFUNCTYPE(None)(ready)
    _cells[symbol] = cell, callback
    binding.add_symbol(symbol, ctypes.addressof(cell))
    binding.add_symbol(_ready_of(symbol), ctypes.cast(callback, ctypes.c_void_p).value)


def type_of_call(key: Any, returns: tuple[str, ...], symbol_for: Callable[[Any], str]) -> Any:
    """What such a kernel is to those that call it.

    ``key``: a function that stands for it; ``returns``: the types of the numbers that it gives;
    ``symbol_for``: makes the cell for arguments of some types.
    """
    kinds = tuple(getattr(_types, name) for name in returns)
    kind = kinds[0] if len(kinds) == 1 else _types.Tuple(kinds)

    def typed(_: Any, args: Any, __: Any) -> Any:
        return _typing.signature(kind, *map(_types.unliteral, args))

    def lowered(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        module, symbol = builder.module, symbol_for(sig.args)
        cell = module.globals.get(symbol) or ir.GlobalVariable(module, _WORD, symbol)
        ready = module.globals.get(_ready_of(symbol))
        ready = ready or ir.Function(module, _READY, _ready_of(symbol))
        with _code.if_unlikely(builder, builder.icmp_unsigned("==", builder.load(cell), _WORD(0))):
            builder.call(ready, [])
        called = context.call_conv.get_function_type(sig.return_type, sig.args)
        callee = builder.inttoptr(builder.load(cell), called.as_pointer())
        _, result = context.call_conv.call_function(
            builder, callee, sig.return_type, sig.args, args
        )
        return result

    _lowers(key, _types.VarArg(_types.Any))(lowered)
    cpu_target.target_context.refresh()
    return _types.Function(type(key.__name__, (_Call,), {"key": key, "generic": typed}))


def _ready_of(symbol: str) -> str:
    return f"{symbol}.ready"
