"""How far from their targets launches end, by integration."""

from __future__ import annotations

import math

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.motion.friction_source import source_of
from puck_tables.motion.puck_spec import PuckSpec
from puck_tables.stopping.exact import integrated_stops
from puck_tables.stopping.launch_family import SECTION_ACCURACY, cosine_of

_CHECK_LOCAL = 1e-11  # of a step: finer than an answer, and another than it was found with


def misses(
    puck: PuckSpec, target: FloatArray, velocity: FloatArray, spin: FloatArray,
    threads: int | None = None,
) -> FloatArray:  # fmt: skip
    """How far from its target (n, 2) or (2,) the integrated motion of each launch ends, (n,) m.

    From the launches as they are given.  Friction of a plain puck is that of the table, where
    launches are found with closed forms or with the table of stops.

    Examples
    --------
    >>> from puck_tables import Puck
    >>> puck = Puck.similar(delta=0.0)
    >>> slide = np.array([[1.0, 0.0]]), np.zeros(1)  # stops after half a metre
    >>> misses(puck, np.array([0.5, 0.1]), *slide).round(9).tolist()
    [0.1]
    """
    cut = source_of(puck.body).friction(SECTION_ACCURACY).cut
    place = np.broadcast_to(target[..., 0] + 1j * target[..., 1], spin.shape)
    distance, miss = np.abs(place), np.zeros(spin.size)
    moved = distance > 0.0  # pure spin stays where it is
    distance, launched, turning = distance[moved], velocity[moved], spin[moved]
    with np.errstate(divide="ignore"):
        speed = np.log(np.hypot(*launched.T))
        rim = np.log(np.abs(turning)) + math.log(puck.radius)
    u = rim - speed
    heights = np.full(u.size, puck.delta)
    stops = integrated_stops(u, heights, cut, _CHECK_LOCAL, cosine_of(u), threads)
    log_q = np.maximum(speed, rim) + 0.5 * np.log1p(np.exp(-2.0 * np.abs(u)))
    way = stops[:, 1] + 1j * np.copysign(1.0, turning) * stops[:, 2]
    # logarithms: Q²/J may be far larger than the distance
    scale = 2.0 * log_q - math.log(puck.decel) - np.log(distance)
    way *= np.exp(scale + 1j * np.arctan2(launched[:, 1], launched[:, 0]))
    miss[moved] = distance * np.abs(way - place[moved] / distance)
    return miss
