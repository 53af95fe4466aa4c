"""The functions of a mathematics library, for code that is compiled for other machines.

Sums, products, quotients and square roots alone, which IEEE rounds the same everywhere: so the same
calls give the same bits on every machine.  Errors are some units in the last place; of a power
times its logarithm, of angles beyond 1e5 rad those of the angle.  Where C tells what two infinities
give, this says NaN.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from puck_tables.kernels.compile import inner
from puck_tables.kernels.elementary import angle_of, cosine_sine_of, exp_of, log_of

_LEAST_NORMAL = 2.3e-308  # less is multiplied by what follows
_TWO_54, _LN_TWO_54 = 2.0**54, 37.42994775023704670  # and its logarithm
_LARGEST_ANGLE = 1e15  # rad: beyond it neighbouring numbers are a quarter of a radian apart
_LOST = 4e16  # beside it 1 is nothing
_HALVED = 700.0  # exponentials of more are squares
_LN2 = 0.69314718055994530942  # ln 2


@inner
def sin(x: float) -> float:
    """Sine of x; NaN where x tells no angle."""
    return cosine_sine_of(x)[1] if abs(x) <= _LARGEST_ANGLE else math.nan


@inner
def cos(x: float) -> float:
    """Cosine of x; NaN where x tells no angle."""
    return cosine_sine_of(x)[0] if abs(x) <= _LARGEST_ANGLE else math.nan


@inner
def exp(x: float) -> float:
    """eˣ, from 0 to inf."""
    if abs(x) <= _HALVED or x != x:
        return x if x != x else exp_of(x)
    if abs(x) > 2.0 * _HALVED:
        return math.inf if x > 0.0 else 0.0
    root = exp_of(0.5 * x)
    return root * root


@inner
def log(x: float) -> float:
    """Ln x; −inf of 0, NaN of less."""
    if not x > 0.0 or x == math.inf:
        return -math.inf if x == 0.0 else (x if x > 0.0 else math.nan)
    return log_of(x) if x >= _LEAST_NORMAL else log_of(x * _TWO_54) - _LN_TWO_54


@inner
def log1p(x: float) -> float:
    """Ln(1 + x); what rounding 1 + x leaves out is made good by the ratio."""
    if not abs(x) < _LOST:
        return log(x)
    whole = 1.0 + x
    return x if whole == 1.0 else log(whole) * (x / (whole - 1.0)) if whole != 0.0 else -math.inf


@inner
def expm1(x: float) -> float:
    """eˣ − 1; what rounding eˣ leaves out is made good by the ratio."""
    power = exp(x)
    if power == 1.0 or not abs(x) < 40.0:
        return x if power == 1.0 else power - 1.0
    return (power - 1.0) * (x / log(power))


@inner
def pow(x: float, y: float) -> float:
    """A power, x to the y; NaN of a negative number, unless y is whole."""
    if y == 0.0 or x == 1.0:
        return 1.0
    power = exp(y * log(abs(x)))
    if x >= 0.0 or x != x or not abs(y) < math.inf:
        return power
    if y != math.floor(y):
        return math.nan if x > -math.inf else power
    return -power if 0.5 * y != math.floor(0.5 * y) else power


@inner
def cbrt(x: float) -> float:
    """The cube root: one step of Newton's method."""
    size = abs(x)
    if not 0.0 < size < math.inf:
        return x
    root = exp_of(log(size) / 3.0)
    root -= (root - size / (root * root)) / 3.0
    return root if x > 0.0 else -root


@inner
def hypot(x: float, y: float) -> float:
    """√(x² + y²), whose squares may be too large or too small for floating point."""
    long, short = abs(x), abs(y)
    if long < short:
        long, short = short, long
    if 1e-140 < long < 1e150:
        return math.sqrt(long * long + short * short)
    if not 0.0 < long < math.inf:
        return long + short
    ratio = short / long
    return long * math.sqrt(1.0 + ratio * ratio)


@inner
def atan2(y: float, x: float) -> float:
    """The angle of (x, y), from −π to π."""
    if x != x or y != y:
        return math.nan
    if math.copysign(1.0, x) > 0.0:
        return angle_of(y, x)
    return math.copysign(math.pi - angle_of(abs(y), -x), y)


@inner
def atan(x: float) -> float:
    """Arc tangent."""
    return atan2(x, 1.0)


@inner
def asin(x: float) -> float:
    """Arc sine; NaN beyond 1."""
    return atan2(x, math.sqrt((1.0 - x) * (1.0 + x))) if abs(x) <= 1.0 else math.nan


@inner
def acos(x: float) -> float:
    """Arc cosine; NaN beyond 1."""
    return atan2(math.sqrt((1.0 - x) * (1.0 + x)), x) if abs(x) <= 1.0 else math.nan


@inner
def sinh(x: float) -> float:
    """(eˣ − e⁻ˣ)/2."""
    size = abs(x)
    if size > _HALVED:
        root = exp(0.5 * size)
        return math.copysign(0.5 * root * root, x)
    more = expm1(size)
    return math.copysign(0.5 * (more + more / (more + 1.0)), x)


@inner
def cosh(x: float) -> float:
    """(eˣ + e⁻ˣ)/2."""
    root = exp(0.5 * abs(x))
    return 0.5 * root * root + 0.5 / root / root


@inner
def tanh(x: float) -> float:
    """(e²ˣ − 1)/(e²ˣ + 1)."""
    size = min(abs(x), 25.0) if x == x else x  # beyond it 1
    more = expm1(2.0 * size)
    return math.copysign(more / (more + 2.0), x)


@inner
def asinh(x: float) -> float:
    """Ln(x + √(x² + 1))."""
    size = abs(x)
    if size > 1e8:
        return math.copysign(log(size) + _LN2, x)
    square = size * size
    return math.copysign(log1p(size + square / (1.0 + math.sqrt(1.0 + square))), x)


@inner
def atanh(x: float) -> float:
    """Ln((1 + x)/(1 − x))/2; NaN beyond 1."""
    size = abs(x)
    if size >= 1.0 or size != size:
        return math.copysign(math.inf, x) if size == 1.0 else math.nan
    return math.copysign(0.5 * log1p(2.0 * size / (1.0 - size)), x)


FUNCTIONS: dict[str, Callable[..., float]] = {
    one.__name__: one for one in (
        sin, cos, exp, log, log1p, expm1, pow, cbrt, hypot, atan2, atan, asin, acos, sinh, cosh,
        tanh, asinh, atanh,
    )
}  # fmt: skip
