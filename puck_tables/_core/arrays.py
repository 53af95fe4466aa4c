"""Arrays and numbers from whatever a caller passes, or a sentence what is wrong.

``aligned``: where tables begin in memory.
"""

from __future__ import annotations

import math
from decimal import ROUND_CEILING, Context
from typing import Any

import numpy as np
import numpy.typing as npt

from puck_tables._core.units import SHOWN, UNIT_EACH, quantity, unit_meant, without_unit
from puck_tables.errors import InputError

_SHOWN = 60  # characters of a value in a message
FloatArray = npt.NDArray[np.float64]
_LINE = 64  # bytes that a processor loads at a time


def refuse_mask(name: str, values: object) -> None:
    """Refuse masked values: no function here can carry a mask through to its results.

    >>> refuse_mask("spin", np.ma.masked_array([1.0, 2.0], [False, True]))
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: spin has masked values: leave them out, as spin.compressed() does
    """
    if np.ma.is_masked(values):
        raise InputError(f"{name} has masked values: leave them out, as {name}.compressed() does")


def real_array(name: str, values: npt.ArrayLike, unit: str) -> FloatArray:
    """Values as an array of float64; complex numbers and dates are refused.

    Texts are numbers with their unit, such as '2 km/h', where the unit is one of SI.

    ``name``, ``unit``: for the message; ``values``: array_like.

    >>> real_array("w0", [1, 2], "rad/s")
    array([1., 2.])
    >>> real_array("velocity", ("36 km/h", 0), "m/s")
    array([10.,  0.])
    """
    refuse_mask(name, values)
    try:
        array = np.asarray(values)
        if array.dtype.kind == "U" and unit in SHOWN:
            return _measured(name, array, unit)
        if array.dtype.kind not in "buif":
            raise TypeError
        return array.astype(np.float64)
    except InputError:
        raise
    except (TypeError, ValueError, OverflowError, UserWarning):  # the last: a masked one in a list
        raise InputError(f"{name} must be real numbers{_in(unit)}") from None


def _measured(name: str, texts: npt.NDArray[np.str_], unit: str) -> FloatArray:
    """Numbers, each with its unit, as real_array takes them."""
    written = texts.ravel().tolist()
    if bare := without_unit(written, unit):
        raise InputError(f"{name}: {UNIT_EACH.format(bare)}")
    # what is no number is named, not one beside it that lacks a unit
    measured = {text: number_in(name, text, unit) for text in written if math.isnan(_plain(text))}
    for text in written:
        if text not in measured:
            measured[text] = 0.0 if _plain(text) == 0.0 else number_in(name, text, unit)
    return np.array([measured[text] for text in written]).reshape(texts.shape)


def _plain(text: str) -> float:
    """A number without a unit; NaN: it is none."""
    try:
        return float(text)
    except ValueError:
        return math.nan


def number_in(name: str, text: str, unit: str) -> float:
    """A number with its unit behind it, in an SI unit.

    >>> number_in("spin", "30rpm", "rad/s")
    3.141592653589793
    """
    value = quantity(text, unit)
    if value is None:
        why = unit_meant(text) or f"or one with its unit, as '{SHOWN[unit]}'"
        raise InputError(f"{name} must be a number{bracketed(unit)}, got {shown(text)}: {why}")
    return value


def real_view(name: str, values: npt.ArrayLike, unit: str) -> FloatArray:
    """Real numbers as an array; one of float64 is given back as it is, not copied.

    >>> entries = np.ones(3)
    >>> real_view("w0", entries, "rad/s") is entries
    True
    """
    if type(values) is np.ndarray and values.dtype == np.float64:
        return values
    if type(values) is float:
        return np.array(values)
    return real_array(name, values, unit)


def _in(unit: str) -> str:
    return "" if unit == "1" else f" in {unit}"


# numbers that BLAS multiplies so; where others work, too, its threads wait for each other for ms
_ON_ONE_THREAD = 10_000


def finite_array(name: str, values: npt.ArrayLike, unit: str) -> FloatArray:
    """Values as an array of finite numbers."""
    array = real_array(name, values, unit)
    # one pass; it may overflow
    squares = np.vdot(array, array) if array.size <= _ON_ONE_THREAD else math.nan
    if not (math.isfinite(squares) or np.isfinite(array).all()):
        raise InputError(
            f"{name} must be finite numbers{_in(unit)}, got {array[~np.isfinite(array)].flat[0]}"
        )
    return array


def shown(value: object) -> str:
    """A value in a message: on one line and short, however large, deep or odd it is.

    >>> shown(np.zeros((2, 2))), len(shown("a" * 1000))
    ('array([[0., 0.], [0., 0.]])', 60)
    """
    plain = value.item() if isinstance(value, np.generic) else value
    try:
        text = " ".join(repr(plain).split())
    except (ValueError, RecursionError):  # integers of thousands of digits, lists without end
        text = "a whole number of thousands of digits" if isinstance(value, int) else "a list"
    return text if len(text) <= _SHOWN else text[: _SHOWN - 3] + "..."


def pair_of(what: str, raw: Any) -> tuple[Any, Any]:
    """Two values; ``what``: what must be such two, for the message.

    >>> pair_of("noise must be two numbers", [1, 2])
    (1, 2)
    """
    try:
        first, second = raw
    except (TypeError, ValueError):
        raise InputError(f"{what}, got {shown(raw)}") from None
    return first, second


def instance(name: str, value: object, *kinds: type) -> None:
    """Refuse a value that is not of one of these kinds.

    >>> instance("table", "coarse.h5", dict)
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: table must be a dict, got a str
    """
    if not isinstance(value, kinds):
        names = " or a ".join(kind.__name__ for kind in kinds if kind is not type(None))
        raise InputError(f"{name} must be a {names}, got a {type(value).__name__}")


def listed(name: str, values: object, what: str) -> list[Any]:
    """What stands in a list, a tuple or an array; a text is none."""
    try:
        if isinstance(values, str | bytes):
            raise TypeError
        result: list[Any] = list(values)  # type: ignore[call-overload]
    except TypeError:
        raise InputError(f"{name} must be a list of {what}, got {shown(values)}") from None
    return result


def broadcast(**arrays: FloatArray) -> list[FloatArray]:
    """Arrays broadcast against each other, in the order given.

    >>> [a.shape for a in broadcast(phi=np.zeros((3, 1)), delta=np.zeros(4))]
    [(3, 4), (3, 4)]
    """
    try:
        return list(np.broadcast_arrays(*arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise InputError(f"shapes do not broadcast: {shapes}") from None


def rounded_up(value: float, digits: int = 1) -> float:
    """A number > 0 to so many digits, not less.

    >>> rounded_up(2.1e-7), rounded_up(2.11e-7, 2)
    (3e-07, 2.2e-07)
    """
    return float(Context(digits, ROUND_CEILING).create_decimal(repr(float(value))))


def whole(name: str, value: Any, low: int, high: int | None = None) -> int:
    """A whole number from ``low`` on, or to ``high``.

    >>> whole("frames", 5, 1, 10)
    5
    >>> whole("frames", 2.5, 1)
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: frames must be a whole number from 1 on, got 2.5
    """
    known = isinstance(value, int | np.integer) and not isinstance(value, bool | np.timedelta64)
    if not known or value < low or (high is not None and value > high):
        until = "on" if high is None else f"to {high}"
        raise InputError(f"{name} must be a whole number from {low} {until}, got {shown(value)}")
    return int(value)


def positive(name: str, value: float, unit: str) -> float:
    """A finite number greater than zero."""
    number = real(name, value, unit)
    if not number > 0.0:
        raise InputError(f"{name} must be greater than 0{bracketed(unit)}, got {number:g}")
    return number


def real(name: str, value: float, unit: str) -> float:
    """A finite number."""
    if type(value) is float and math.isfinite(value):
        return value
    if isinstance(value, str) and unit in SHOWN:
        return number_in(name, value, unit)
    refuse_mask(name, value)
    try:
        # what float() would take all the same: texts, spans of time, lists of one
        if isinstance(value, str | bytes | bytearray | np.timedelta64) or np.ndim(value):
            raise TypeError
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name} must be a number{bracketed(unit)}, got {shown(value)}") from None
    if not math.isfinite(number):
        raise InputError(f"{name} must be a finite number{bracketed(unit)}, got {number}")
    return number


def bracketed(unit: str) -> str:
    """A unit for a message; nothing of a pure number.

    >>> bracketed("m"), bracketed("1")
    (' (m)', '')
    """
    return "" if unit == "1" else f" ({unit})"


def velocity_array(
    velocity: npt.ArrayLike, name: str = "velocity", parts: str = "vx, vy", unit: str = "m/s"
) -> FloatArray:
    """Velocities of shape (…, 2), m/s; or other vectors, by their name, components and unit."""
    array = finite_array(name, velocity, unit)
    if array.ndim == 0 or array.shape[-1] != 2:
        raise InputError(
            f"{name} must have two components ({parts}) in {unit}, got an array of {array.shape}"
        )
    return array


def one_velocity(velocity: npt.ArrayLike) -> tuple[float, float]:
    """One velocity (vx, vy), m/s."""
    array = velocity_array(velocity)
    if array.shape != (2,):
        raise InputError(f"velocity must be one (vx, vy) in m/s, got an array of {array.shape}")
    vx, vy = array.tolist()
    return vx, vy


def checked_threads(threads: int | None) -> None:
    """Refuse a number of threads that is none."""
    if threads is not None:
        whole("threads", threads, 1)


def checked_flag(name: str, value: object) -> None:
    """Refuse what is neither true nor false."""
    if not isinstance(value, bool | np.bool_):
        raise InputError(f"{name} must be True or False, got {shown(value)}")


def checked_progress(progress: object) -> None:
    """Refuse what cannot be told how far work is."""
    if progress is not None and not callable(progress):
        raise InputError(f"progress must be a function of (done, total), got {shown(progress)}")


def aligned(values: FloatArray) -> FloatArray:
    """A copy that cannot be written and begins where a cache line does.

    Of tables with rows of 32 bytes no load then takes two lines, a tenth of the time of look-ups.
    """
    room = np.empty(values.nbytes + _LINE, np.uint8)
    start = -room.__array_interface__["data"][0] % _LINE
    kept = room[start : start + values.nbytes].view(values.dtype).reshape(values.shape)
    kept[...] = values
    kept.flags.writeable = False
    return kept
