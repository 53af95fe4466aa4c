"""A record and its arrays as another machine has them in memory."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numba
import numpy as np
from llvmlite import binding, ir
from numba.core import types
from numba.core.registry import cpu_target

_types: Any = types
_typeof: Any = numba.typeof
_WORD, _BYTE = ir.IntType(64), ir.IntType(8)
_ALIGNED = 16  # bytes: arrays, for vectors


def arrays_for(triple: str, record: Any, known: Sequence[Any], symbol: str) -> bytes:
    """An object file with a record as it is now, and the arrays that it is made of.

    Under its only symbol a table of addresses: of the record, then of arrays of it, and others,
    that are to be ``known`` outside.  ``triple``, ``record``: see
    :func:`puck_tables.kernels.ahead.code_for`.
    """
    machine, module, data = machine_for(triple), ir.Module("arrays"), _Data()
    content = _constant(module, data, _typeof(record), record)
    place = ir.GlobalVariable(module, content.type, "record")
    place.initializer, place.align, place.linkage = content, _ALIGNED, "internal"
    rows = [place.bitcast(ir.PointerType(_BYTE)), *(data.address(module, one) for one in known)]
    addresses = ir.Constant.literal_array(rows)
    table = ir.GlobalVariable(module, addresses.type, symbol)
    table.initializer, table.global_constant = addresses, True
    return bytes(machine.emit_object(as_module([str(module)], machine)))


def machine_for(triple: str) -> Any:
    """The machine that LLVM knows by a name."""
    binding.initialize_all_targets()
    binding.initialize_all_asmprinters()
    relocation = "static" if triple.startswith("wasm") else "pic"
    return binding.Target.from_triple(triple).create_target_machine(opt=3, reloc=relocation)


def as_module(texts: list[str], machine: Any) -> Any:
    """One module of all texts, whose functions are there once."""
    whole = None
    for text in texts:
        module = binding.parse_assembly(text)
        module.triple, module.data_layout = machine.triple, str(machine.target_data)
        for function in module.functions:
            if not function.is_declaration:
                function.linkage = "weak_odr"
        if whole is None:
            whole = module
        else:
            whole.link_in(module)
    return whole


class _Data:
    """The arrays of a record as globals of a module; what shares memory there shares it here."""

    def __init__(self) -> None:
        self._made: dict[int, Any] = {}

    def address(self, module: Any, array: Any) -> Any:
        """Where an array lies, a constant."""
        owner, offset = _whole_of(array)
        place = owner.ctypes.data
        if place not in self._made:
            content = owner.tobytes()
            kind = ir.ArrayType(_BYTE, max(len(content), 1))
            made = ir.GlobalVariable(module, kind, f"array{len(self._made)}")
            made.initializer = ir.Constant(kind, bytearray(content) if any(content) else None)
            made.align, made.linkage = _ALIGNED, "internal"
            self._made[place] = made
        return self._made[place].gep([ir.Constant(_WORD, 0), ir.Constant(_WORD, offset)])


def _whole_of(array: Any) -> tuple[Any, int]:
    """The array whose memory an array lies in, and where, in bytes."""
    owner = array
    while isinstance(owner.base, np.ndarray):
        owner = owner.base
    return owner, array.ctypes.data - owner.ctypes.data


def _constant(module: Any, data: _Data, kind: Any, value: Any) -> Any:
    """A record, an array or a number, as numba has it in memory."""
    if isinstance(kind, _types.Array):
        shape, strides = (
            ir.Constant(ir.ArrayType(_WORD, len(row)), list(row))
            for row in (value.shape, value.strides)
        )
        nothing = ir.Constant(ir.PointerType(_BYTE), None)
        address = data.address(module, value)
        sizes = (ir.Constant(_WORD, value.size), ir.Constant(_WORD, value.itemsize))
        return ir.Constant.literal_struct([nothing, nothing, *sizes, address, shape, strides])
    if isinstance(kind, _types.BaseTuple):
        parts = zip(kind.types, value, strict=True)
        return ir.Constant.literal_struct([_constant(module, data, *part) for part in parts])
    model = cpu_target.target_context.data_model_manager.lookup(kind)
    return ir.Constant(model.get_value_type(), value)
