"""Values and Jacobians of arrays of arguments, as the libraries ask for them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from puck_tables.contact.laws import HOMOGENEOUS, Law
from puck_tables.stopping.jacobian import LAUNCH_NAMES, MOMENT_NAMES, STATE_NAMES, STOP_NAMES
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


def found(arguments: Any, kind: PuckKind, jacobian: bool) -> Any:
    """Stops or states of arguments (…, 6) or (…, 7), the order of the columns of Jacobians.

    Raises
    ------
    InputError

    Examples
    --------
    >>> found(np.array([1.0, 0.0, 5.0, 0.5, 1.0, 1.0]), PLAIN, False).stop_time.round(6)
    np.float64(3.962992)
    """
    given = np.asarray(arguments, np.float64)
    how: dict[str, Any] = {
        "delta": given[..., 3], "decel": given[..., 4], "radius": given[..., 5],
        "pressure": kind.pressure, "gyration": kind.gyration, "jacobian": jacobian,
    }  # fmt: skip
    if given.shape[-1] == len(LAUNCH_NAMES):
        return stop(given[..., :2], given[..., 2], tol=_TOL, **how)
    return states(given[..., :2], given[..., 2], given[..., 6], **how)


def values(arguments: Any, kind: PuckKind) -> Array:
    """Results (…, rows) of arguments (…, columns)."""
    result = found(arguments, kind, jacobian=False)
    return np.stack([getattr(result, name) for name in result.JACOBIAN_ROWS], axis=-1)


def slopes(given: Any, kind: PuckKind) -> Array:
    """Jacobians (…, rows, columns) of arguments ``given`` (…, columns).

    The path of pure spin, which grows like |v|, has slope 0 here: a number is needed even where it
    is multiplied by 0.
    """
    arguments = np.asarray(given, np.float64)
    jacobian: Array = found(arguments, kind, jacobian=True).jacobian
    if jacobian.shape[-2] == len(STOP_NAMES):
        spins = (arguments[..., 0] == 0.0) & (arguments[..., 1] == 0.0)
        jacobian[spins, STOP_NAMES.index("path_length"), :2] = 0.0
    return jacobian
