"""Operations that numba cannot write: numbers of a block, to and fro as whole registers.

In Python they stand in :mod:`puck_tables.kernels.as_written`.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types

from puck_tables.kernels.as_written import BLOCK, LINE
from puck_tables.kernels.vectors import operation, with_constants

_LANES = 4  # numbers side by side in one register


@with_constants
def row_of(typing: Any, block: Any, row: Any, n: Any) -> Any:
    """Compiled (block, row, n) → number n of a row (a constant) of a flat array of such rows.

    Of rows of one array at known distances LLVM sees that they do not overlap, so that a loop over
    them is done for several numbers at once; arrays of their own it would have to compare, and
    gives up where they are many.
    """
    first = row.literal_value * BLOCK

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        at = builder.add(args[2], ir.Constant(args[2].type, first), flags=("nsw",))
        return builder.load(builder.gep(data, [at], inbounds=True))

    return types.float64(block, row, n), build


@with_constants
def into_row(typing: Any, block: Any, row: Any, n: Any, value: Any) -> Any:
    """Compiled (block, row, n, value): number n of a row is the value, see :func:`row_of`."""
    first = row.literal_value * BLOCK

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        at = builder.add(args[2], ir.Constant(args[2].type, first), flags=("nsw",))
        builder.store(args[3], builder.gep(data, [at], inbounds=True))
        return context.get_dummy_value()

    return types.void(block, row, n, types.float64), build


@with_constants
def rows_of(typing: Any, block: Any, row: Any, count: Any, n: Any) -> Any:
    """Compiled (block, row, count, n) → number n of so many rows from one on, as a tuple."""
    first, rows = row.literal_value, count.literal_value

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        parts = []
        for k in range(rows):
            place = ir.Constant(args[3].type, (first + k) * BLOCK)
            at = builder.add(args[3], place, flags=("nsw",))
            parts.append(builder.load(builder.gep(data, [at], inbounds=True)))
        return context.make_tuple(builder, signature.return_type, parts)

    result: Any = types.UniTuple(types.float64, rows)  # type: ignore[no-untyped-call]
    return result(block, row, count, n), build


@with_constants
def into_rows(typing: Any, block: Any, row: Any, n: Any, values: Any) -> Any:
    """Compiled (block, row, n, values): number n of rows from one on are those of a tuple."""
    first = row.literal_value

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        for k in range(len(signature.args[3])):
            place = ir.Constant(args[2].type, (first + k) * BLOCK)
            at = builder.add(args[2], place, flags=("nsw",))
            value = builder.extract_value(args[3], k)
            builder.store(value, builder.gep(data, [at], inbounds=True))
        return context.get_dummy_value()

    return types.void(block, row, n, values), build


@operation
def into_line(typing: Any, out: Any, at: Any, values: Any) -> Any:
    """Compiled (out, at, values): the numbers of a tuple side by side in a flat array, from at on.

    As whole registers, as many as are full; as single numbers LLVM would move each by itself.
    """
    lanes = ir.VectorType(ir.DoubleType(), _LANES)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        parts = [builder.extract_value(args[2], k) for k in range(len(signature.args[2]))]
        for first in range(0, len(parts), _LANES):
            at = builder.add(args[1], ir.Constant(args[1].type, first))
            place = builder.gep(data, [at], inbounds=True)
            line = ir.Constant(lanes, ir.Undefined)
            for k, part in enumerate(parts[first : first + _LANES]):
                line = builder.insert_element(line, part, ir.Constant(ir.IntType(32), k))
            builder.store(line, builder.bitcast(place, lanes.as_pointer()), align=8)
        return context.get_dummy_value()

    if len(values) % _LANES:
        return None
    return types.void(out, types.int64, values), build


@operation
def turn_square(
    typing: Any, source: Any, at: Any, step: Any, out: Any, goal: Any, further: Any
) -> Any:
    """Compiled (source, at, step, out, goal, further): a square of four by four numbers turned.

    Four numbers side by side in a flat array from ``at`` on, four from ``step`` behind and so on,
    into another: the first of each side by side from ``goal`` on, the second ones ``further``
    behind and so on.  As whole registers, where LLVM would move each number by itself.
    """
    half = ir.VectorType(ir.DoubleType(), _LANES // 2)
    lanes = ir.VectorType(ir.DoubleType(), _LANES)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        taken = context.make_array(signature.args[0])(context, builder, args[0]).data
        target = context.make_array(signature.args[3])(context, builder, args[3]).data

        def place(data: Any, number: Any, kind: Any) -> Any:
            return builder.bitcast(builder.gep(data, [number]), kind.as_pointer())

        def mixed(one: Any, other: Any, *order: int) -> Any:
            return builder.shuffle_vector(
                one, other, ir.Constant(ir.VectorType(ir.IntType(32), _LANES), order)
            )

        rows = [args[1]]
        for _ in range(_LANES - 1):
            rows.append(builder.add(rows[-1], args[2]))
        goal = args[4]
        for begin in (0, 2):  # two halves of rows make a register without leaving memory
            halves = []
            for row in rows:
                number = builder.add(row, ir.Constant(row.type, begin))
                halves.append(builder.load(place(taken, number, half), align=8))
            even, odd = (mixed(halves[k], halves[k + 2], 0, 1, 2, 3) for k in (0, 1))
            for order in ((0, 4, 2, 6), (1, 5, 3, 7)):
                builder.store(mixed(even, odd, *order), place(target, goal, lanes), align=8)
                goal = builder.add(goal, args[5])
        return context.get_dummy_value()

    number = types.int64
    return types.void(source, number, number, out, number, number), build


@operation
def stream_line(typing: Any, source: Any, begin: Any, out: Any, at: Any) -> Any:
    """Compiled (source, begin, out, at): a whole line of the cache, eight numbers, past it.

    Where they go is a multiple of 64 bytes.
    """
    line = ir.VectorType(ir.DoubleType(), LINE)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        def place(array: int) -> Any:
            data = context.make_array(signature.args[array])(context, builder, args[array]).data
            return builder.bitcast(builder.gep(data, [args[array + 1]]), line.as_pointer())

        stored = builder.store(builder.load(place(0), align=8), place(2), align=8 * LINE)
        one = ir.Constant(ir.IntType(32), 1)
        stored.set_metadata("nontemporal", builder.module.add_metadata([one]))
        return context.get_dummy_value()

    return types.void(source, types.int64, out, types.int64), build
