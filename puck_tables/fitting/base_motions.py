"""Motions of a body on a base that is not round, and how they change with launch, height and size.

They depend on how the body stands to its velocity, so they are no one curve: each is integrated.
With θ the angle of the body at the launch and R(θ) the rotation by it,

    s(v, θ) = R(θ) s(R(−θ) v, 0) ,   ds/dθ = J s − (ds/dv) J v ,   J = R(π/2) ,

so what is known of θ = 0 tells all.  Derivatives are differences of motions nearby.
"""

from __future__ import annotations

import math
from copy import copy
from functools import lru_cache
from typing import Self

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.base import Base
from puck_tables.fitting.unit_motions import UnitMotions, cartesian
from puck_tables.kernels.base_friction import packed
from puck_tables.stopping.base_solver import followed

_LOCAL = 1e-8  # of a step; a film knows places to 1e-4 of the path
_STEP = 1e-3  # of each argument, to both sides: slopes to some 1e-5


class BaseMotions(UnitMotions):
    """Pucks on one base, up to the height at which part of it would lift.

    ``radius`` of a launch is the reach of the base; ``gyration``: over that.

    >>> box = BaseMotions(Base.box(0.2, 0.1), 0.5)
    >>> launch = np.array([[1.0, 0.0, 0.0, 0.0, 2.0, box.reach]]).T
    >>> box.states(launch, np.array([[0.25, 9.0]]))[0].round(9).tolist()  # v t - J t²/2
    [[0.1875, 0.25]]
    """

    angle: float = 0.0
    accuracy = _LOCAL

    def __init__(self, base: Base, gyration: float) -> None:
        self._gyration = gyration
        self.reach, self._packed = base.reach, packed(base, 0.0)
        self.highest = (4.0 - 1e-12) * base.highest_lever / base.reach  # a puck of it is one, too

    def facing(self, angle: float) -> Self:
        """Motions of a base that stands at an angle (rad) at the launch."""
        found = copy(self)
        found.angle = angle
        return found

    def states(self, launches: FloatArray, times: FloatArray) -> FloatArray:
        """Integrated, at times that ascend."""
        rows = launches.copy()
        cosine, sine = math.cos(self.angle), math.sin(self.angle)
        turn = np.array([[cosine, -sine], [sine, cosine]])
        rows[:2] = turn.T @ launches[:2]
        rows[3], rows[5] = 0.25 * launches[3] * launches[5], self._gyration * launches[5]
        slip = np.hypot(np.hypot(rows[0], rows[1]), rows[5] * rows[2])
        moments = times * (rows[4] / np.maximum(slip, 1e-300))[:, None]
        ends = times.shape[1] * np.arange(len(times) + 1)
        _, found, status = followed(self._packed, rows, _LOCAL, moments.ravel(), ends, 1)
        found[np.repeat(status != 0, times.shape[1])] = math.nan
        out = cartesian(found.T.reshape(-1, *times.shape), 0.0)
        out[:2] = np.tensordot(turn, out[:2], 1)
        out[3:5] = np.tensordot(turn, out[3:5], 1)
        return out

    def states_and_slopes(
        self, launch: FloatArray, times: FloatArray
    ) -> tuple[FloatArray, FloatArray]:
        """By motions to both sides in every argument, and in time."""
        slip = math.hypot(launch[0], launch[1], launch[5] * launch[2])
        sizes = np.array([slip, slip, slip / launch[5], self.highest, *launch[4:]])
        steps = _STEP * sizes
        nearby = launch[:, None] + np.diag(steps) * np.array([1.0, -1.0])[:, None, None]
        every = np.concatenate([launch[:, None], *nearby], axis=1)
        base, later = self.states(every, np.tile(times, (13, 1))), _STEP * slip / launch[4]
        slopes = np.empty((times.size, 6, 7))
        ahead, behind = base[:, 1:7], base[:, 7:]
        slopes[:, :, :6] = ((ahead - behind) / (2.0 * steps[:, None])).transpose(2, 0, 1)
        one = launch[:, None]
        soon = [self.states(one, np.maximum(times + by, 0.0)[None])[:, 0] for by in (later, -later)]
        slopes[:, :, 6] = (soon[0] - soon[1]).T / (2.0 * later)
        slopes[:, :3, 6] = base[3:, 0].T[:, :3]
        return base[:, 0], slopes


@lru_cache(maxsize=64)
def base_motions_of(base: Base, gyration: float) -> BaseMotions:
    """The motions of a body; ``gyration`` over the reach.

    >>> round(base_motions_of(Base.disc(0.05), 0.5**0.5).highest, 9)
    1.0
    """
    return BaseMotions(base, gyration)
