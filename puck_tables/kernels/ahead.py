"""Kernels compiled ahead of time, for another machine.

What is taken is the text that numba writes down before it optimises: afterwards sizes and addresses
of this machine are in it.  It is done in a process of its own, where nothing was compiled before
that could be taken over.

So are a record and its arrays, as that machine has them in memory.
"""

from __future__ import annotations

import hashlib
import os
import re
import subprocess
import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

import numba
import numpy as np
from llvmlite import binding, ir
from numba.core import cgutils, serialize, types
from numba.core.registry import cpu_target

from puck_tables._core.own_folder import say
from puck_tables.errors import PuckError
from puck_tables.kernels import compiled
from puck_tables.kernels.cache import cache_folder
from puck_tables.kernels.kept_code import read_sealed, write_sealed
from puck_tables.kernels.linking import LinkedAtDoors, Pasted
from puck_tables.kernels.mathematics import FUNCTIONS

_types: Any = types
_ALIGNED = 16  # bytes: arrays, for vectors
_code: Any = cgutils
_dumps: Any = serialize.dumps
_typeof: Any = numba.typeof
_Library: Any = Pasted
_Compiler: Any = LinkedAtDoors
_WORD, _STATUS, _BYTE = ir.IntType(64), ir.IntType(32), ir.IntType(8)
_DOUBLE, _ADDRESS = ir.DoubleType(), ir.PointerType(_BYTE)
_PREFIX = "puck_"  # of what a machine's own library may have under the same name
# how a text calls a function of a mathematics library, and where it allows to round a·b + c once
_CALLS = re.compile(rf'@"?(?:llvm\.)?({"|".join(FUNCTIONS)})(?:\.f64)?"?(?=\()')
_CONTRACTS = re.compile(r"(?<= )contract (?=double|<)")
_CHILD = "from puck_tables.kernels import ahead; ahead.answer()"


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
        owner = array  # whose memory it lies in
        while isinstance(owner.base, np.ndarray):
            owner = owner.base
        place = owner.ctypes.data
        if place not in self._made:
            content = owner.tobytes()
            kind = ir.ArrayType(_BYTE, max(len(content), 1))
            made = ir.GlobalVariable(module, kind, f"array{len(self._made)}")
            made.initializer = ir.Constant(kind, bytearray(content) if any(content) else None)
            made.align, made.linkage = _ALIGNED, "internal"
            self._made[place] = made
        return self._made[place].gep(
            [ir.Constant(_WORD, 0), ir.Constant(_WORD, array.ctypes.data - place)]
        )


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


class _WrittenCode(_Library):  # type: ignore[misc]
    """The code of a function as it is written down."""

    def __init__(self, codegen: Any, name: str) -> None:
        super().__init__(codegen, name)
        self.texts: list[str] = []

    def add_ir_module(self, module: Any) -> None:
        """Keep its text; numba would optimise it for this machine."""
        text = _CONTRACTS.sub("", _code.normalize_ir_text(str(module)))
        self.texts.append(_CALLS.sub(rf"@{_PREFIX}\1", text))
        self._final_module.link_in(binding.parse_assembly(self.texts[-1]))


class _Writer(_Compiler):  # type: ignore[misc]
    """numba's compiler, with these libraries."""

    library, has_doors = _WrittenCode, False


# a reshape of what lies in one piece, which kernels only read: its strides
_RESHAPE = """
define i32 @numba_attempt_nocopy_reshape(i64 %0, ptr %1, ptr %2, i64 %count, ptr %shape,
                                         ptr %strides, i64 %size, i32 %3) {
first:
  br label %head
head:
  %left = phi i64 [ %count, %first ], [ %k, %body ]
  %stride = phi i64 [ %size, %first ], [ %wider, %body ]
  %more = icmp sgt i64 %left, 0
  br i1 %more, label %body, label %done
body:
  %k = sub i64 %left, 1
  %at = getelementptr i64, ptr %strides, i64 %k
  store i64 %stride, ptr %at
  %from = getelementptr i64, ptr %shape, i64 %k
  %length = load i64, ptr %from
  %wider = mul i64 %stride, %length
  br label %head
done:
  ret i32 1
}
"""


class Outside(NamedTuple):
    """A function there, ``puck_`` and its name: the kernel, and numbers like what it takes."""

    name: str
    kernel: Any
    arguments: tuple[int | float, ...]


def code_for(triple: str, record: Any, doors: Sequence[Outside]) -> bytes:
    """An object file for a machine: doors to kernels that work in a record.

    It is kept, for it takes a minute and is the same for all records of a type.  Its arithmetic is
    that of IEEE, nothing is rounded but what is written, and its mathematics is its own: the same
    calls give the same bits on every machine.

    ``triple``: of the machine, as LLVM has it; ``record``: a named tuple of arrays and numbers, the
    first argument of all kernels; ``doors``: functions of the address of a record, whole numbers
    (32 bits) and doubles, that give a whole number.  Raises PuckError if it cannot be compiled.
    """
    kind = _typeof(record)
    names = [(one.name, one.kernel.__qualname__, one.arguments) for one in doors]
    request = repr((kind, names, numba.__version__, binding.llvm_version_info))
    folder = cache_folder()
    digest = hashlib.sha256(request.encode()).hexdigest()[:16]
    kept = folder and folder / f"{triple}-{digest}.object"
    if kept is not None and (content := read_sealed(kept)) is not None:
        return content
    say("compiling the kernels for another machine, once: about a minute")
    done = subprocess.run(
        [sys.executable, "-c", _CHILD], input=_dumps((triple, kind, doors)), capture_output=True,
        env=os.environ | {"NUMBA_DISABLE_JIT": "0"}, check=False,
    )  # fmt: skip
    if done.returncode != 0:
        raise PuckError(f"kernels cannot be compiled for {triple}: {done.stderr.decode()[-500:]}")
    if kept is not None:
        write_sealed(kept, done.stdout)
    return done.stdout


def answer() -> None:
    """Compile what a parent process asks for."""
    compiled.linked_at_doors = _Writer
    type(cpu_target.target_context.codegen())._library_class = _WrittenCode
    sys.stdout.buffer.write(_compiled(*serialize.loads(sys.stdin.buffer.read())))


def _compiled(triple: str, kind: Any, doors: Sequence[Outside]) -> bytes:
    """The object file."""
    outer = ir.Module("doors")
    texts: dict[str, None] = {}
    codes = []
    for name, kernel, arguments in doors:
        codes.append(_written(kernel.py_func, kernel.fuses, (kind, *map(_typeof, arguments))))
        inputs = [_STATUS if isinstance(one, int) else _DOUBLE for one in arguments]
        _add_function(outer, name, codes[-1], [_ADDRESS, *inputs], _STATUS)
    for name, function in FUNCTIONS.items():
        count = function.__code__.co_argcount
        codes.append(_written(function, False, (_typeof(1.0),) * count))
        _add_function(outer, name, codes[-1], [_DOUBLE] * count, _DOUBLE)
    for code in codes:
        seen: dict[Any, None] = {}
        waiting = [code.library]
        while waiting:
            if (library := waiting.pop()) not in seen:
                seen[library] = None
                waiting += library._linking_libraries
        texts |= {text: None for one in seen for text in one.texts}
    machine = machine_for(triple)
    whole = as_module([str(outer), *texts, _RESHAPE], machine)
    public = {_PREFIX + door.name for door in doors}
    for part in (*whole.functions, *whole.global_variables):
        if not part.is_declaration:
            part.linkage = "external" if part.name in public else "internal"
    options = binding.create_pipeline_tuning_options(speed_level=3)
    options.loop_vectorization = options.slp_vectorization = False  # not every machine has vectors
    passes = binding.create_pass_builder(machine, options)
    passes.getModulePassManager().run(whole, passes)
    return bytes(machine.emit_object(whole))


def _written(function: Any, fuses: bool, kinds: tuple[Any, ...]) -> Any:
    """What numba makes of a kernel, with the texts of it and of all that it calls."""
    made = compiled.dispatcher_of(function, fuses)
    made.compile(kinds)
    return made.overloads[kinds]


def _add_function(module: Any, name: str, code: Any, inputs: list[Any], result: Any) -> None:
    """Write down a function that calls what numba made, and gives what that gives."""
    outside = ir.Function(module, ir.FunctionType(result, inputs), _PREFIX + name)
    convention: Any = cpu_target.target_context.call_conv
    called = convention.get_function_type(code.signature.return_type, code.signature.args)
    inside = ir.Function(module, called, code.fndesc.llvm_func_name)
    builder = ir.IRBuilder(outside.append_basic_block())
    result_at = builder.alloca(_WORD if result == _STATUS else result)
    handed = [result_at, builder.alloca(_ADDRESS), *outside.args]
    for n, (one, argument) in enumerate(zip(handed, inside.args, strict=True)):
        if one.type == _STATUS:
            handed[n] = builder.sext(one, _WORD)
        elif one.type != argument.type:
            handed[n] = builder.bitcast(one, argument.type)
    builder.call(inside, handed)
    value = builder.load(result_at)
    builder.ret(builder.trunc(value, _STATUS) if result == _STATUS else value)
