"""The frame of a launch: between the world and natural units.

In natural units a motion starts along x with positive spin, Q₀ = J = r = 1; in the world its places
are turned by the heading, mirrored for negative spin, and scaled: times by Q₀/J, places by Q₀²/J.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.motion.state import PSI, THETA, U, X, Y


class Frame(NamedTuple):
    """A launch as a frame: ``speed`` v, ``rim`` r|ω|, ``slip`` Q₀ m/s, ``time`` s, ``length`` m.

    ``side`` is −1 for clockwise spin, ``east``, ``north`` and ``heading`` the direction of the
    velocity, x where there is none.
    """

    speed: float
    rim: float
    slip: float
    time: float
    length: float
    radius: float
    side: float
    east: float
    north: float
    heading: float

    def place(self, x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray]:
        """World coordinates, m, from natural ones."""
        along, left = self.length * x, self.side * self.length * y
        return (
            along * self.east - left * self.north + 0.0,
            along * self.north + left * self.east + 0.0,
        )

    def unit_times(self, times: FloatArray, stop_time: float) -> FloatArray:
        """Times (n,) s in natural units; infinite from the stop on."""
        scaled: FloatArray = np.where(times < stop_time, times, np.inf) / (self.time or 1.0)
        return scaled

    def states(self, q: FloatArray, y: FloatArray) -> tuple[FloatArray, ...]:
        """States of the puck from Q/Q₀ (n,) and natural states (n, 8).

        Returns
        -------
        six arrays (n,)
            x, y m; heading rad, from that at the launch; body angle rad; v m/s; ω rad/s.
        """
        cosine, sine = direction(y[:, U])
        turned = self.side * y[:, THETA] * (self.length / self.radius) + 0.0
        spin = self.side * (self.slip * q * sine / self.radius) + 0.0  # Q/r may overflow, ω not
        speed = self.slip * q * cosine
        return *self.place(y[:, X], y[:, Y]), self.side * y[:, PSI], turned, speed, spin


def frame_of(velocity: tuple[float, float], spin: float, decel: float, radius: float) -> Frame:
    """The frame of a launch.

    Parameters
    ----------
    velocity, spin : m/s, rad/s
    decel, radius : J m/s², r m

    Examples
    --------
    >>> frame = frame_of((0.0, 3.0), -2.0, 5.0, 2.0)
    >>> frame.slip, frame.time, frame.length
    (5.0, 1.0, 5.0)
    >>> [float(x) for x in frame.place(np.array(1.0), np.array(0.5))]
    [2.5, 5.0]
    """
    vx, vy = velocity
    speed, rim = math.hypot(vx, vy), radius * abs(spin)
    slip = math.hypot(speed, rim)
    east, north = (vx / speed, vy / speed) if speed > 0.0 else (1.0, 0.0)
    return Frame(
        speed, rim, slip, slip / decel, slip / decel * slip, radius, -1.0 if spin < 0.0 else 1.0,
        east, north, math.atan2(vy, vx) if speed > 0.0 else 0.0,
    )  # fmt: skip


def direction(u: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Cos φ and sin φ from u = ln tan φ, to the last digits at both ends.

    >>> [float(x.round(6)) for x in direction(np.array(-np.inf))]
    [1.0, 0.0]
    """
    k = np.exp(-np.abs(u))
    large = 1.0 / np.sqrt(1.0 + k * k)
    return np.where(u > 0.0, k * large, large), np.where(u > 0.0, large, k * large)
