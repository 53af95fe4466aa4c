"""Wide named tuples are read where they lie, not handed over number by number.

A board and the arrays to work in are some 370 numbers and addresses: numba makes each an argument
of each call, which was two fifths of all that it wrote down for a scene, and a twelfth of its run.
Here a call takes one address, and what of a tuple is read is loaded from there.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import extending
from numba.core import cgutils, types
from numba.core.datamodel.models import PrimitiveModel
from numba.core.imputils import impl_ret_borrowed
from numba.core.typing.typeof import Purpose, typeof_impl

_WIDE = 30  # numbers and addresses: fewer go into registers
_PACKAGE = __name__.partition(".")[0] + "."  # of own classes of records
_FIRST = ir.Constant(ir.IntType(32), 0)

# numba's objects have no annotations
_code: Any = cgutils
_types: Any = types
_borrowed: Any = impl_ret_borrowed
_extending: Any = extending
_NamedTuple: Any = types.NamedTuple
_Model: Any = PrimitiveModel
_type_of_tuple: Any = typeof_impl.dispatch(tuple)


class Record(_NamedTuple):  # type: ignore[misc]
    """The type of a wide named tuple that Python hands in; it lives until the call is over."""


def _width(kind: Any) -> int:
    """How many numbers and addresses an argument is."""
    if isinstance(kind, _types.Array):
        return int(5 + 2 * kind.ndim)
    return sum(map(_width, kind.types)) if isinstance(kind, _types.BaseTuple) else 1


@typeof_impl.register(tuple)
def _type_of(value: Any, purpose: Any) -> Any:
    kind = _type_of_tuple(value, purpose)
    if not isinstance(kind, _types.BaseNamedTuple) or purpose.purpose is Purpose.constant:
        return kind
    own = kind.instance_class.__module__.startswith(_PACKAGE)
    return Record(kind.types, kind.instance_class) if own and _width(kind) > _WIDE else kind


class RecordModel(_Model):  # type: ignore[misc]
    """A record is the address of its numbers, one after the other: ``content``."""

    content: Any

    def __init__(self, models: Any, kind: Any) -> None:
        parts = [models.lookup(one) for one in kind.types]
        self.content = ir.LiteralStructType(
            [one.content if isinstance(one, RecordModel) else one.get_value_type() for one in parts]
        )
        super().__init__(models, kind, self.content.as_pointer())


def _at(builder: Any, record: Any, number: int) -> Any:
    return builder.gep(record, [_FIRST, ir.Constant(ir.IntType(32), number)], inbounds=True)


def _field(context: Any, builder: Any, kind: Any, record: Any, name: str) -> Any:
    number = kind.fields.index(name)
    part, at = kind.types[number], _at(builder, record, number)
    return _borrowed(context, builder, part, at if isinstance(part, Record) else builder.load(at))


def _unboxed(kind: Any, value: Any, c: Any) -> Any:
    place = _code.alloca_once(c.builder, c.context.data_model_manager.lookup(kind).content)
    failed = _code.alloca_once_value(c.builder, _code.false_bit)
    cleanups: list[Any] = []
    _unbox_into(place, kind, value, c, failed, cleanups)

    def clean_up() -> None:
        for one in reversed(cleanups):
            one()

    return _extending.NativeValue(place, cleanup=clean_up, is_error=c.builder.load(failed))


def _unbox_into(
    place: Any, kind: Any, value: Any, c: Any, failed: Any, cleanups: list[Any]
) -> None:
    for number, part in enumerate(kind.types):
        one, at = c.pyapi.tuple_getitem(value, number), _at(c.builder, place, number)
        if isinstance(part, Record):
            _unbox_into(at, part, one, c, failed, cleanups)
            continue
        native = c.unbox(part, one)
        c.builder.store(native.value, at)
        with c.builder.if_then(native.is_error, likely=False):
            c.builder.store(_code.true_bit, failed)
        if native.cleanup is not None:
            cleanups.append(native.cleanup)


_extending.register_model(Record)(RecordModel)
_extending.unbox(Record)(_unboxed)
_extending.lower_getattr_generic(Record)(_field)
