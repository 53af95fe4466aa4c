"""The angle of a body about the vertical from quaternions."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.errors import InputError

_UNIT = 2e-3  # of lengths: what three digits leave
_TILTED = math.radians(20.0)


def turned(where: str, quaternions: FloatArray, up: int) -> FloatArray:
    """How far a body has turned about the vertical since the first row, rad, without leaps.

    Whatever axes the body has, the turn from the first row to another is about the vertical.

    Parameters
    ----------
    where : the file, for messages
    quaternions : ndarray (n, 4), w x y z
    up : 1 for y, 2 for z: the axis that points up

    Raises
    ------
    InputError
        If one is not normalised, or the tilt has changed by over 20 degrees since the first row:
        then their order, or the axis, is another.

    Examples
    --------
    >>> half = np.array([0.0, 0.4])
    >>> q = np.column_stack([np.cos(half), 0 * half, 0 * half, np.sin(half)])
    >>> turned("a.csv", q, 2).round(9).tolist()
    [0.0, 0.8]
    """
    lengths = np.sqrt((quaternions**2).sum(axis=1))
    off = np.flatnonzero(~(np.abs(lengths - 1.0) <= _UNIT))
    if off.size:
        row = int(off[0])
        raise InputError(
            f"{where}: the quaternion in row {row + 1} of its numbers has the length "
            f"{lengths[row]:.4g}, it must be 1: normalise them, or say with columns (--columns) "
            "which columns are qw, qx, qy, qz"
        )
    unit = quaternions / lengths[:, None]
    w0, v0 = unit[0, 0], unit[0, 1:]
    w, v = unit[:, 0], unit[:, 1:]
    # q times the conjugate of the first
    real = w * w0 + v @ v0
    vector = -w[:, None] * v0 + w0 * v - np.cross(v, v0)
    tilt = 2.0 * np.arccos(np.clip(np.hypot(real, vector[:, up]), 0.0, 1.0))
    if tilt.max() > _TILTED:
        row = int(np.argmax(tilt > _TILTED))
        raise InputError(
            f"{where}: by its quaternions the puck has tilted by {math.degrees(tilt[row]):.0f} "
            f"degrees from row 1 to row {row + 1}, which no case does: their order must be w, "
            "x, y, z, or say it with columns (--columns), or another axis points up (--up)"
        )
    angle: FloatArray = np.unwrap(2.0 * np.arctan2(vector[:, up], real))
    return angle
