"""Operations that numba cannot write: whole vectors of a spline, bits of numbers.

In Python they stand in :mod:`puck_tables.kernels.as_written`.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

Written = Callable[[Callable[..., Any]], Any]
operation: Written = intrinsic
with_constants: Written = intrinsic(prefer_literal=True)  # arguments that are literals come so
fuses = False  # whether what is compiled just now may round a·b + c once


def _rounding() -> tuple[str, ...]:
    return ("contract",) if fuses else ()


def _everywhere(builder: Any, number: Any, lanes: Any) -> Any:
    """A register of that kind with the number in all lanes."""
    nothing, one = ir.Constant(lanes, ir.Undefined), ir.IntType(32)
    spread = ir.Constant(ir.VectorType(one, lanes.count), [0] * lanes.count)
    number = builder.insert_element(nothing, number, ir.Constant(one, 0))
    return builder.shuffle_vector(number, nothing, spread)


def _times_plus(builder: Any, one: Any, other: Any, more: Any) -> Any:
    product = builder.fmul(one, other, flags=_rounding())
    return builder.fadd(product, more, flags=_rounding()) if more else product


@with_constants
def weighted_rows(typing: Any, c: Any, k: Any, weights: Any, width: Any) -> Any:
    """Compiled (c, k, (a, b, …), width) → the sums a·c[k+m] + b·c[k+width+m] + … as a tuple.

    Neighbouring rows, as many as weights, of ``width`` numbers (a constant) of a flat array of
    double or single precision, weighted and added as whole vectors.  LLVM does not see by itself
    that it may (the sums could overwrite the table); in the stop look-up it is worth a fifth of the
    time.
    """
    count = width.literal_value
    double = ir.VectorType(ir.DoubleType(), count)

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
            weight = _everywhere(builder, builder.extract_value(args[2], row), double)
            product = builder.fmul(values, weight, flags=_rounding())
            total = product if row == 0 else builder.fadd(total, product, flags=_rounding())
        parts = [
            builder.extract_element(total, ir.Constant(ir.IntType(32), i)) for i in range(count)
        ]
        return context.make_tuple(builder, signature.return_type, parts)

    sums: Any = types.UniTuple(types.float64, count)  # type: ignore[no-untyped-call]
    return sums(c, k, weights, width), build


_LANES = 4  # functions side by side in one register


def _lanes_for(width: int) -> int:
    """Functions side by side: as many as the largest registers hold, where that leaves no gap.

    Where registers are shorter LLVM takes two; the numbers are the same.
    """
    return 2 * _LANES if width % (2 * _LANES) == 0 else _LANES


@with_constants
def spline_polynomials(
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
    side = _lanes_for(count)
    lanes = ir.VectorType(ir.DoubleType(), side)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        everywhere, times_plus = partial(_everywhere, builder), partial(_times_plus, builder)
        rows = len(signature.args[2])
        weight = [everywhere(builder.extract_value(args[2], row), lanes) for row in range(rows)]
        variable = everywhere(args[3], lanes)
        values, slopes = [], []
        for part in range(0, count, side):
            value = slope = ir.Constant(lanes, [0.0] * side)
            for power in range(top - 1, -1, -1):
                total = None
                for row in range(rows):
                    at = ir.Constant(args[1].type, (row * top + power) * count + part)
                    pointer = builder.gep(data, [builder.add(args[1], at)])
                    result = builder.load(builder.bitcast(pointer, lanes.as_pointer()), align=8)
                    total = times_plus(result, weight[row], total)
                if power == top - 1:
                    value = total
                else:
                    slope = value if power == top - 2 else times_plus(slope, variable, value)
                    value = times_plus(value, variable, total)
            for lane in range(side):
                at = ir.Constant(ir.IntType(32), lane)
                values.append(builder.extract_element(value, at))
                slopes.append(builder.extract_element(slope, at))
        return context.make_tuple(builder, signature.return_type, [*values, *slopes])

    result: Any = types.UniTuple(types.float64, 2 * count)  # type: ignore[no-untyped-call]
    return result(c, k, weights, s, width, powers), build


def _rows_first(slopes: bool, c: Any, k: Any, weights: Any, s: Any, width: Any, powers: Any) -> Any:
    """Rows evaluated first, then weighted and added; with derivatives by s behind the values."""
    count, top = width.literal_value, powers.literal_value
    side = _lanes_for(count) if slopes else _LANES
    lanes = ir.VectorType(ir.DoubleType(), side)

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        single = signature.args[0].dtype == types.float32
        stored = ir.VectorType(ir.FloatType(), side) if single else lanes
        data = context.make_array(signature.args[0])(context, builder, args[0]).data
        everywhere, times_plus = partial(_everywhere, builder), partial(_times_plus, builder)

        def coefficients(place: int) -> Any:
            at = builder.add(args[1], ir.Constant(args[1].type, place))
            pointer = builder.bitcast(builder.gep(data, [at]), stored.as_pointer())
            values = builder.load(pointer, align=4 if single else 8)
            return builder.fpext(values, lanes) if single else values

        rows = len(signature.args[2])
        weight = [everywhere(builder.extract_value(args[2], row), lanes) for row in range(rows)]
        variable = everywhere(args[3], lanes)
        result: list[list[Any]] = [[], []]
        for part in range(0, count, side):
            totals = [None, None]
            for row in range(rows):
                value, slope = coefficients((row * top + top - 1) * count + part), None
                for power in range(top - 2, -1, -1):
                    if slopes:
                        slope = times_plus(slope, variable, value) if slope else value
                    more = coefficients((row * top + power) * count + part)
                    value = times_plus(value, variable, more)
                totals[0] = times_plus(value, weight[row], totals[0])
                if slopes:
                    totals[1] = times_plus(slope, weight[row], totals[1])
            for total, numbers in zip(totals, result, strict=True):
                for lane in range(side if total else 0):
                    at = ir.Constant(ir.IntType(32), lane)
                    numbers.append(builder.extract_element(total, at))
        return context.make_tuple(builder, signature.return_type, [*result[0], *result[1]])

    each = 2 * count if slopes else count
    result: Any = types.UniTuple(types.float64, each)  # type: ignore[no-untyped-call]
    return result(c, k, weights, s, width, powers), build


@with_constants
def spline_values(
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
    return _rows_first(False, c, k, weights, s, width, powers)


@with_constants
def spline_slopes(
    typing: Any, c: Any, k: Any, weights: Any, s: Any, width: Any, powers: Any
) -> Any:
    """Compiled like :func:`spline_values`, with derivatives by s behind the values."""
    return _rows_first(True, c, k, weights, s, width, powers)


@operation
def bits_of(typing: Any, number: Any) -> Any:
    """Compiled float → the integer of the same bits."""

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.IntType(64))

    return types.int64(types.float64), build


@operation
def number_of(typing: Any, bits: Any) -> Any:
    """Compiled integer → the float of the same bits."""

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.bitcast(args[0], ir.DoubleType())

    return types.float64(types.int64), build


@operation
def summed(typing: Any, total: Any, more: Any) -> Any:
    """Compiled a + b in a sum whose order does not matter: a loop over it may keep several."""

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.fadd(args[0], args[1], flags=(*_rounding(), "reassoc", "nsz"))

    return types.float64(types.float64, types.float64), build


@operation
def patience(typing: Any, items: Any) -> Any:
    """Compiled (items): nothing."""

    def build(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return context.get_dummy_value()

    return types.void(types.int64), build
