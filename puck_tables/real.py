"""Arrays of real numbers from whatever a caller passes, or a sentence that says what is wrong."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from puck_tables.errors import InputError

FloatArray = npt.NDArray[np.float64]


def refuse_mask(name: str, values: object) -> None:
    """Refuse masked values: no function here can carry a mask through to its results.

    Raises
    ------
    InputError

    Examples
    --------
    >>> refuse_mask("w0", np.ma.masked_array([1.0, 2.0], [False, True]))
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: w0 has masked values: leave them out, as w0.compressed() does
    """
    if np.ma.is_masked(values):
        raise InputError(f"{name} has masked values: leave them out, as {name}.compressed() does")


def real_array(name: str, values: npt.ArrayLike, unit: str) -> FloatArray:
    """Values as an array of float64; texts, complex numbers and dates are refused.

    Parameters
    ----------
    name, unit : str
        For the message.
    values : array_like

    Raises
    ------
    InputError
        If the values are not real numbers that fit a double, or some are masked.

    Examples
    --------
    >>> real_array("w0", [1, 2], "rad/s")
    array([1., 2.])
    """
    refuse_mask(name, values)
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "buif":
            raise TypeError
        return array.astype(np.float64)
    except (TypeError, ValueError, OverflowError, UserWarning):  # the last: a masked one in a list
        raise InputError(f"{name} must be real numbers in {unit}") from None


def finite_array(name: str, values: npt.ArrayLike, unit: str) -> FloatArray:
    """Values as an array of finite numbers.

    Raises
    ------
    InputError

    Examples
    --------
    >>> finite_array("w0", [1, 2], "rad/s")
    array([1., 2.])
    """
    array = real_array(name, values, unit)
    if not np.isfinite(array).all():
        raise InputError(
            f"{name} must be finite numbers in {unit}, got {array[~np.isfinite(array)].flat[0]}"
        )
    return array


def instance(name: str, value: object, *kinds: type) -> None:
    """Refuse a value that is not of one of these kinds.

    Raises
    ------
    InputError

    Examples
    --------
    >>> instance("table", "coarse.h5", dict)
    Traceback (most recent call last):
    ...
    puck_tables.errors.InputError: table must be a dict, got a str
    """
    if not isinstance(value, kinds):
        names = " or a ".join(kind.__name__ for kind in kinds if kind is not type(None))
        raise InputError(f"{name} must be a {names}, got a {type(value).__name__}")


def broadcast(**arrays: FloatArray) -> list[FloatArray]:
    """Arrays broadcast against each other, in the order given.

    Raises
    ------
    InputError
        If their shapes do not fit.

    Examples
    --------
    >>> [a.shape for a in broadcast(phi=np.zeros((3, 1)), delta=np.zeros(4))]
    [(3, 4), (3, 4)]
    """
    try:
        return list(np.broadcast_arrays(*arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise InputError(f"shapes do not broadcast: {shapes}") from None


def rounded_up(value: float) -> float:
    """A number > 0 to one digit, not less.

    Examples
    --------
    >>> rounded_up(2.1e-7)
    3e-07
    """
    power = int(np.floor(np.log10(value)))
    return float(f"{int(np.ceil(value / 10.0**power - 1e-9))}e{power}")
