"""Operations that numba cannot write: whole vectors of a spline, bits of numbers, rows of blocks.

In Python they stand in :mod:`puck_tables.kernels.as_written`.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from puck_tables.kernels.as_written import BLOCK, LINE


def _weighted_rows(typing: Any, c: Any, k: Any, weights: Any, width: Any) -> Any:
    """Compiled (c, k, (a, b, …), width) → the sums a·c[k+m] + b·c[k+width+m] + … as a tuple.

    Neighbouring rows, as many as weights, of ``width`` numbers (a constant) of a flat array of
    double or single precision, weighted and added as whole vectors.  LLVM does not see by itself
    that it may (the sums could overwrite the table); in the stop look-up it is worth a fifth of the
    time.
    """
    count = width.literal_value
    double = ir.VectorType(ir.DoubleType(), count)
    nothing = ir.Constant(double, ir.Undefined)
    spread = ir.Constant(ir.VectorType(ir.IntType(32), count), [0] * count)
    first = ir.Constant(ir.IntType(32), 0)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        single = signature.args[0].dtype == types.float32
        stored = ir.VectorType(ir.FloatType(), count) if single else double
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        total = None
        for row in range(len(signature.args[2])):
            place = builder.add(args[1], ir.Constant(args[1].type, row * count))
            values = builder.load(
                builder.bitcast(builder.gep(data, [place]), stored.as_pointer()),
                align=4 if single else 8,
            )
            values = builder.fpext(values, double) if single else values
            weight = builder.extract_value(args[2], row)
            weight = builder.insert_element(nothing, weight, first)
            weight = builder.shuffle_vector(weight, nothing, spread)
            product = builder.fmul(values, weight, flags=("contract",))
            total = product if row == 0 else builder.fadd(total, product, flags=("contract",))
        parts = [
            builder.extract_element(total, ir.Constant(ir.IntType(32), i)) for i in range(count)
        ]
        return context.make_tuple(builder, signature.return_type, parts)

    sums: Any = types.UniTuple(types.float64, count)  # type: ignore[no-untyped-call]
    return sums(c, k, weights, width), build


weighted_rows: Any = intrinsic(prefer_literal=True)(_weighted_rows)


_LANES = 4  # functions side by side in one register


def _spline_polynomials(
    typing: Any, c: Any, k: Any, weights: Any, s: Any, width: Any, powers: Any
) -> Any:
    """Compiled (c, k, (a, b, …), s, width, powers) → polynomials in s and their derivatives.

    Rows of a flat array, one after the other and as many as weights, each of ``powers`` times
    ``width`` numbers (constants; width a multiple of four): coefficients of as many functions, side
    by side, powers of s ascending.  The rows are weighted and added, and the sums evaluated by
    Horner's rule, functions in the lanes of registers from end to end; a tuple of the values, then
    of the derivatives by s.
    """
    count, top = width.literal_value, powers.literal_value
    lanes = ir.VectorType(ir.DoubleType(), _LANES)
    nothing, spread = ir.Constant(lanes, ir.Undefined), [0] * _LANES
    first = ir.Constant(ir.IntType(32), 0)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data

        def everywhere(number: Any) -> Any:
            number = builder.insert_element(nothing, number, first)
            return builder.shuffle_vector(
                number, nothing, ir.Constant(ir.VectorType(ir.IntType(32), _LANES), spread)
            )

        def times_plus(one: Any, other: Any, more: Any) -> Any:
            product = builder.fmul(one, other, flags=("contract",))
            return builder.fadd(product, more, flags=("contract",))

        rows = len(signature.args[2])
        weight = [everywhere(builder.extract_value(args[2], row)) for row in range(rows)]
        variable = everywhere(args[3])
        values, slopes = [], []
        for part in range(0, count, _LANES):
            value = slope = ir.Constant(lanes, [0.0] * _LANES)
            for power in range(top - 1, -1, -1):
                total = None
                for row in range(rows):
                    at = ir.Constant(args[1].type, (row * top + power) * count + part)
                    pointer = builder.gep(data, [builder.add(args[1], at)])
                    found = builder.load(builder.bitcast(pointer, lanes.as_pointer()), align=8)
                    if total is None:
                        total = builder.fmul(found, weight[row], flags=("contract",))
                    else:
                        total = times_plus(found, weight[row], total)
                if power == top - 1:
                    value = total
                else:
                    slope = value if power == top - 2 else times_plus(slope, variable, value)
                    value = times_plus(value, variable, total)
            for lane in range(_LANES):
                at = ir.Constant(ir.IntType(32), lane)
                values.append(builder.extract_element(value, at))
                slopes.append(builder.extract_element(slope, at))
        return context.make_tuple(builder, signature.return_type, [*values, *slopes])

    found: Any = types.UniTuple(types.float64, 2 * count)  # type: ignore[no-untyped-call]
    return found(c, k, weights, s, width, powers), build


spline_polynomials: Any = intrinsic(prefer_literal=True)(_spline_polynomials)


def _spline_values(
    typing: Any, c: Any, k: Any, weights: Any, s: Any, width: Any, powers: Any
) -> Any:
    """Compiled (c, k, (a, b, …), s, width, powers) → polynomials in s, splined, as a tuple.

    Rows of a flat array of double or single precision, one after the other and as many as weights,
    each of ``powers`` times ``width`` numbers (constants; width a multiple of four): coefficients
    of as many functions, side by side, powers of s ascending.  Each row is evaluated by Horner's
    rule and the rows are weighted and added, functions in the lanes of registers from end to end:
    a table whose polynomials were evaluated before, with one power, gives the same bits.  LLVM does
    not see by itself that it may (the sums could overwrite the table).
    """
    count, top = width.literal_value, powers.literal_value
    lanes = ir.VectorType(ir.DoubleType(), _LANES)
    nothing = ir.Constant(lanes, ir.Undefined)
    spread = ir.Constant(ir.VectorType(ir.IntType(32), _LANES), [0] * _LANES)
    first = ir.Constant(ir.IntType(32), 0)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        single = signature.args[0].dtype == types.float32
        stored = ir.VectorType(ir.FloatType(), _LANES) if single else lanes
        data = context.make_array(signature.args[0])(context, builder, args[0]).data

        def everywhere(number: Any) -> Any:
            number = builder.insert_element(nothing, number, first)
            return builder.shuffle_vector(number, nothing, spread)

        def times_plus(one: Any, other: Any, more: Any) -> Any:
            product = builder.fmul(one, other, flags=("contract",))
            return builder.fadd(product, more, flags=("contract",))

        def coefficients(place: int) -> Any:
            at = builder.add(args[1], ir.Constant(args[1].type, place))
            pointer = builder.bitcast(builder.gep(data, [at]), stored.as_pointer())
            values = builder.load(pointer, align=4 if single else 8)
            return builder.fpext(values, lanes) if single else values

        rows = len(signature.args[2])
        weight = [everywhere(builder.extract_value(args[2], row)) for row in range(rows)]
        variable = everywhere(args[3])
        values = []
        for part in range(0, count, _LANES):
            total = None
            for row in range(rows):
                value = coefficients((row * top + top - 1) * count + part)
                for power in range(top - 2, -1, -1):
                    more = coefficients((row * top + power) * count + part)
                    value = times_plus(value, variable, more)
                if total is None:
                    total = builder.fmul(value, weight[row], flags=("contract",))
                else:
                    total = times_plus(value, weight[row], total)
            for lane in range(_LANES):
                at = ir.Constant(ir.IntType(32), lane)
                values.append(builder.extract_element(total, at))
        return context.make_tuple(builder, signature.return_type, values)

    found: Any = types.UniTuple(types.float64, count)  # type: ignore[no-untyped-call]
    return found(c, k, weights, s, width, powers), build


spline_values: Any = intrinsic(prefer_literal=True)(_spline_values)


def _bits_of(typing: Any, number: Any) -> Any:
    """Compiled float → the integer of the same bits."""

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.IntType(64))

    return types.int64(types.float64), build


def _number_of(typing: Any, bits: Any) -> Any:
    """Compiled integer → the float of the same bits."""

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.DoubleType())

    return types.float64(types.int64), build


def _summed(typing: Any, total: Any, more: Any) -> Any:
    """Compiled a + b in a sum whose order does not matter: a loop over it may keep several."""

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fadd(args[0], args[1], flags=("contract", "reassoc", "nsz"))

    return types.float64(types.float64, types.float64), build


summed: Any = intrinsic(_summed)
bits_of: Any = intrinsic(_bits_of)
number_of: Any = intrinsic(_number_of)


def _row_of(typing: Any, block: Any, row: Any, n: Any) -> Any:
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


def _into_row(typing: Any, block: Any, row: Any, n: Any, value: Any) -> Any:
    """Compiled (block, row, n, value): number n of a row is the value, see :func:`row_of`."""
    first = row.literal_value * BLOCK

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        at = builder.add(args[2], ir.Constant(args[2].type, first), flags=("nsw",))
        builder.store(args[3], builder.gep(data, [at], inbounds=True))
        return context.get_dummy_value()

    return types.void(block, row, n, types.float64), build


row_of: Any = intrinsic(prefer_literal=True)(_row_of)
into_row: Any = intrinsic(prefer_literal=True)(_into_row)


def _rows_of(typing: Any, block: Any, row: Any, count: Any, n: Any) -> Any:
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

    found: Any = types.UniTuple(types.float64, rows)  # type: ignore[no-untyped-call]
    return found(block, row, count, n), build


def _into_rows(typing: Any, block: Any, row: Any, n: Any, values: Any) -> Any:
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


rows_of: Any = intrinsic(prefer_literal=True)(_rows_of)
into_rows: Any = intrinsic(prefer_literal=True)(_into_rows)


def _into_columns(typing: Any, block: Any, row: Any, n: Any, out: Any, at: Any, step: Any) -> Any:
    """Compiled (block, row, n, out, at, step): a square of four by four numbers turned over.

    Numbers n to n + 3 of four rows of a block into a flat array, those of one number side by side
    from ``at`` on, those of the next ``step`` further: as whole registers, where LLVM would move
    each number by itself.
    """
    lanes = ir.VectorType(ir.DoubleType(), _LANES)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        source = context.make_array(signature.args[0])(context, builder, args[0]).data
        target = context.make_array(signature.args[3])(context, builder, args[3]).data

        def place(data: Any, number: Any) -> Any:
            return builder.bitcast(builder.gep(data, [number]), lanes.as_pointer())

        def mixed(one: Any, other: Any, *order: int) -> Any:
            return builder.shuffle_vector(
                one, other, ir.Constant(ir.VectorType(ir.IntType(32), _LANES), order)
            )

        number = builder.add(builder.mul(args[1], ir.Constant(args[1].type, BLOCK)), args[2])
        rows = [
            builder.load(
                place(source, builder.add(number, ir.Constant(number.type, k * BLOCK))), align=8
            )
            for k in range(_LANES)
        ]
        even = [mixed(rows[k], rows[k + 1], 0, 4, 2, 6) for k in (0, 2)]
        odd = [mixed(rows[k], rows[k + 1], 1, 5, 3, 7) for k in (0, 2)]
        columns = [
            mixed(*pair, *order) for order in ((0, 1, 4, 5), (2, 3, 6, 7)) for pair in (even, odd)
        ]
        goal = args[4]
        for column in columns:
            builder.store(column, place(target, goal), align=8)
            goal = builder.add(goal, args[5])
        return context.get_dummy_value()

    return types.void(block, types.int64, types.int64, out, types.int64, types.int64), build


def _stream_line(typing: Any, source: Any, begin: Any, out: Any, at: Any) -> Any:
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


into_columns: Any = intrinsic(_into_columns)
stream_line: Any = intrinsic(_stream_line)
