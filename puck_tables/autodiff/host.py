"""Values and Jacobians of arrays of arguments, as the libraries ask for them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.errors import InputError
from puck_tables.stopping.jacobian import (
    DEFAULT_DECEL,
    DEFAULT_DELTA,
    DEFAULT_GRAVITY,
    DEFAULT_HEIGHT,
    LAUNCH_NAMES,
    MOMENT_NAMES,
    STATE_NAMES,
    STOP_NAMES,
    refuse_both,
)
from puck_tables.stopping.states import states
from puck_tables.stopping.stops import stop

Array = npt.NDArray[np.float64]

ROWS = {len(LAUNCH_NAMES): len(STOP_NAMES), len(MOMENT_NAMES): len(STATE_NAMES)}
_TOL = 2e-10  # of Q/J, Q²/J: twice the error of the stop table, so that it is taken


class PuckKind(NamedTuple):
    """What is not differentiated: pressure law and radius of gyration, as of a Puck."""

    pressure: str | Law = "uniform"
    gyration: float = HOMOGENEOUS


PLAIN = PuckKind()


def by_arguments(arguments: Any, kind: PuckKind, jacobian: bool) -> Any:
    """Stops or states of arguments (…, 6) or (…, 7), the order of the columns of Jacobians.

    Raises InputError.

    >>> by_arguments(np.array([1.0, 0.0, 5.0, 0.5, 1.0, 1.0]), PLAIN, False).stop_time.round(6)
    np.float64(3.962992)
    """
    inputs = np.asarray(arguments, np.float64)
    how: dict[str, Any] = {
        "delta": inputs[..., 3], "decel": inputs[..., 4], "radius": inputs[..., 5],
        "pressure": kind.pressure, "gyration": kind.gyration, "jacobian": jacobian,
    }  # fmt: skip
    if inputs.shape[-1] == len(LAUNCH_NAMES):
        return stop(inputs[..., :2], inputs[..., 2], tol=_TOL, **how)
    return states(inputs[..., :2], inputs[..., 2], inputs[..., 6], **how)


def values(arguments: Any, kind: PuckKind) -> Array:
    """Results (…, rows) of arguments (…, columns)."""
    result = by_arguments(arguments, kind, jacobian=False)
    return np.stack([getattr(result, name) for name in result.JACOBIAN_ROWS], axis=-1)


def slopes(inputs: Any, kind: PuckKind) -> Array:
    """Jacobians (…, rows, columns) of arguments ``inputs`` (…, columns).

    The path of pure spin, which grows like |v|, has slope 0 here: a number is needed even where it
    is multiplied by 0.
    """
    arguments = np.asarray(inputs, np.float64)
    jacobian: Array = by_arguments(arguments, kind, jacobian=True).jacobian
    if jacobian.shape[-2] == len(STOP_NAMES):
        spins = (arguments[..., 0] == 0.0) & (arguments[..., 1] == 0.0)
        jacobian[spins, STOP_NAMES.index("path_length"), :2] = 0.0
    return jacobian


def refuse_shape(shape: tuple[int, ...]) -> None:
    """Refuse velocities that are no pairs."""
    if not shape or shape[-1] != 2:
        raise InputError(f"velocity must have the shape (..., 2), got {shape}")


_ARGUMENTS = """
    Parameters
    ----------
    velocity : (…, 2), m/s
    spin, {time}delta, decel, radius : (…), rad/s, {second}1, m/s², m
    friction, height, gravity : (…), 1, m, m/s², in place of delta and decel
    pressure, gyration : as :class:`puck_tables.Puck`; not differentiated

    Returns
    -------
    (…, {count}) in double precision
        {results}

    Raises
    ------
    InputError
        If a number is in single precision, the shape of ``velocity`` is wrong, or as
        :func:`puck_tables.{name}`.
    """


def functions(
    of: Callable[[Any, PuckKind], Any], merged: Callable[..., Any], array: Callable[[Any], Any]
) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The functions ``stop`` and ``states`` of a library.

    ``of``: results of arguments (…, columns), differentiated; ``merged``: arguments (…, columns)
    from a velocity (…, 2) and numbers (…); ``array``: a number (…) in double precision.
    """

    def puck(
        delta: Any, decel: Any, radius: Any, friction: Any, height: Any, gravity: Any
    ) -> tuple[Any, Any, Any]:
        if not refuse_both(delta, decel, friction, height, gravity):
            return delta, decel, radius
        f, size = array(friction), array(radius)
        return 2.0 * f * array(height) / size, f * array(gravity), size

    def stop(
        velocity: Any, spin: Any = 0.0, *, delta: Any = DEFAULT_DELTA, decel: Any = DEFAULT_DECEL,
        radius: Any = 1.0, friction: Any = None, height: Any = DEFAULT_HEIGHT,
        gravity: Any = DEFAULT_GRAVITY, pressure: str | Law = "uniform",
        gyration: float = HOMOGENEOUS,
    ) -> Any:  # fmt: skip
        numbers = puck(delta, decel, radius, friction, height, gravity)
        return of(merged(velocity, spin, *numbers), PuckKind(pressure, gyration))

    def states(
        velocity: Any, spin: Any, time: Any, *, delta: Any = DEFAULT_DELTA,
        decel: Any = DEFAULT_DECEL, radius: Any = 1.0, friction: Any = None,
        height: Any = DEFAULT_HEIGHT, gravity: Any = DEFAULT_GRAVITY,
        pressure: str | Law = "uniform", gyration: float = HOMOGENEOUS,
    ) -> Any:  # fmt: skip
        numbers = puck(delta, decel, radius, friction, height, gravity)
        return of(merged(velocity, spin, *numbers, time), PuckKind(pressure, gyration))

    stop.__doc__ = "Stops of pucks, as :func:`puck_tables.stop`.\n" + _ARGUMENTS.format(
        time="", second="", count=5, name="stop",
        results="Stop time, x, y, path length and body angle.",
    )  # fmt: skip
    states.__doc__ = "States of pucks, as :func:`puck_tables.states`.\n" + _ARGUMENTS.format(
        time="time, ", second="s, ", count=6, name="states",
        results="x, y, orientation, vx, vy, spin.",
    )  # fmt: skip
    return stop, states
