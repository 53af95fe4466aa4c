"""The patches of a table where the friction coefficient depends on the slip speed.

Where the integrals are singular, and in which coordinates they are not, stands in
:mod:`puck_tables.kernels.speed_spline`; here is the way back, from the coordinates of a patch to
the slip of the puck, and the choice of the breaks b_k.  Besides the corners of the law there are
breaks of convenience, so that no patch is wider than five times its distance from slip zero, the
scale on which anything varies there.

Under a load with edges within the rim (an annulus, a profile) every edge has such lines, each in
another direction, and they cross.  Those that matter most are where the centre of rotation crosses
an edge, rays from slip zero: patches lie between them, and nodes crowd at them.  Smooth laws have
no others.  Under a profile those of corners are left to the splines: half powers, from 2.5 on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from puck_tables._core.arrays import FloatArray
from puck_tables.contact.friction_laws import FrictionLaw
from puck_tables.contact.integrals import SlipDirection
from puck_tables.contact.round_load import RoundLoad
from puck_tables.contact.speed_law import SpeedLaw
from puck_tables.errors import InputError
from puck_tables.kernels.speed_spline import CORNER_POWER, EDGE_POWER

NO_RAYS = np.empty(0)
COARSEST_CELLS, HALVINGS = 10, 6  # cells of a patch along an axis, and how often they are halved
MOST_CORNERS = 40  # patches grow with their square; weaker ones are left to the splines
_STEEPEST = 6.0  # between neighbouring breaks
_LEAST_SCALE = 1e-9  # of the top speed
_SAME = 1e-9  # two corners as near as this to each other are one


@dataclass(frozen=True)
class _InSlab:
    """A patch in one interval of the breaks, ``slab``, of U = v + r|ω|."""

    breaks: FloatArray
    slab: int

    @property
    def top(self) -> float:
        """The fastest slip in it, m/s."""
        return float(self.breaks[self.slab + 1])

    @property
    def is_mirrored(self) -> bool:
        """Whether one half mirrors the other."""
        return False


@dataclass(frozen=True)
class SlipPatch(_InSlab):
    """A part of the plane of slips on which the integrals are smooth.

    ``breaks``: array (k + 1,), m/s; ``slab``: which interval of the breaks U = v + r|ω| lies in;
    ``part``: which part of the slips W = |v − r|ω||, 0 … slab + 1; the last up to W = U; ``fast``:
    whether r|ω| > v; ``grade``: how strongly the nodes of the first slab crowd at slip zero.
    """

    part: int
    fast: bool
    grade: int = 1

    @property
    def is_mirrored(self) -> bool:
        """Whether one half mirrors the other."""
        return self.slab > 0 and self.part == self.slab + 1

    def place(self, xi: FloatArray, zeta: FloatArray) -> tuple[SlipDirection, FloatArray]:
        """Slip direction and Q in m/s at coordinates in [0, 1] that broadcast.

        In the last part of a slab W > U stands for the mirror image, that has the same integrals.
        """
        b, k = self.breaks, self.slab
        if k == 0:
            tau = zeta**4
            ratio = (1.0 - tau) / (1.0 + tau)
            Q = b[1] * xi**self.grade * np.sqrt(1.0 + ratio**2) / (1.0 + ratio)
        else:
            width = b[k + 1] - b[k]
            mirrored = self.is_mirrored
            at_corner = self.part == k and not self.fast
            power = CORNER_POWER if at_corner else EDGE_POWER  # how its nodes crowd at edges
            U = b[k] + width * (xi if mirrored else xi**power)
            if mirrored:
                W = b[k] + width * zeta
            elif self.part == 0:
                W = 0.5 * b[1] * zeta**4
            else:
                low = 0.5 * b[1] if self.part == 1 else b[self.part - 1]
                W = b[self.part] - (b[self.part] - low) * (1.0 - zeta) ** power
            ratio, Q = np.abs(U - W) / (U + W), np.sqrt(0.5 * (U**2 + W**2))
        ratio, Q = np.broadcast_arrays(ratio, Q)
        return SlipDirection(ratio, np.full(ratio.shape, self.fast)), Q


@dataclass(frozen=True)
class RayPatch(_InSlab):
    """A part of the plane of slips between two rays from slip zero.

    ``breaks``, ``slab``, ``grade``: as of a :class:`SlipPatch`; ``low``, ``high``: of (v − r|ω|)/(v
    + r|ω|).
    """

    low: float
    high: float
    grade: int = 1

    def place(self, xi: FloatArray, zeta: FloatArray) -> tuple[SlipDirection, FloatArray]:
        """Slip direction and Q in m/s at coordinates in [0, 1] that broadcast."""
        begin, end = self.breaks[self.slab : self.slab + 2]
        U = begin + (end - begin) * (xi**self.grade if self.slab == 0 else xi)
        near, far = zeta**4, (1.0 - zeta) ** 4
        middle = (self.low * far + self.high * near) / (near + far)
        U, middle = np.broadcast_arrays(U, middle)
        ratio = (1.0 - np.abs(middle)) / (1.0 + np.abs(middle))
        return SlipDirection(ratio, middle < 0.0), U * np.sqrt(1.0 + ratio**2) / (1.0 + ratio)


def is_pile(law: object, load: RoundLoad) -> bool:
    """Whether the table is that of a disc, in which each disc of a load is looked up.

    Where a law has corners each edge within the rim has lines of its own for every one, and they
    cross.

    >>> from puck_tables.contact.laws import law_of
    >>> corners = SpeedLaw([0.0, 1.0], [0.2, 0.3])
    >>> [is_pile(corners, RoundLoad(law_of(name))) for name in ("uniform", "annulus:0.5", "ring")]
    [False, True, False]
    """
    return isinstance(law, SpeedLaw) and not load.is_simple and len(load.discs) > 0


def rays_under(law: object, load: RoundLoad) -> FloatArray:
    """(v − r|ω|)/(v + r|ω|) where the centre of rotation crosses an edge; none of the rim alone.

    >>> from puck_tables.contact.laws import law_of
    >>> rays_under(None, RoundLoad(law_of("annulus:0.5"))).round(6).tolist()
    [-0.333333, 0.0]
    """
    if load.is_simple or is_pile(law, load):
        return NO_RAYS
    radii = np.array(load.edges)
    return np.asarray((radii - 1.0) / (radii + 1.0))


def patches_of(
    breaks: FloatArray, grade: int = 1, rays: FloatArray = NO_RAYS
) -> tuple[SlipPatch | RayPatch, ...]:  # fmt: skip
    """The patches between breaks, in the order in which compiled code numbers them.

    >>> len(patches_of(np.array([0.0, 1.0, 2.0])))
    8
    >>> len(patches_of(np.array([0.0, 1.0, 2.0]), 1, np.array([-0.5, 0.0])))
    6
    """
    if len(rays):
        ends = [-1.0, *rays.tolist(), 1.0]
        return tuple(
            RayPatch(breaks, slab, low, high, grade)
            for slab in range(len(breaks) - 1) for low, high in pairwise(ends)
        )  # fmt: skip
    return tuple(
        SlipPatch(breaks, slab, part, fast, grade)
        for fast in (False, True)
        for slab in range(len(breaks) - 1)
        for part in range(slab + 2 if slab > 0 else 1)
    )


def breaks_of(
    law: SpeedLaw | Callable[..., object], top_speed: float | None, scale: float | None
) -> FloatArray:
    """Speeds from 0 to the top between which patches lie, m/s.

    ``law``: SpeedLaw, FrictionLaw or another callable; ``top_speed``: m/s; needed for a callable;
    ``scale``: the speed below which a callable is nearly cubic, m/s; default ``top_speed``.

    >>> breaks_of(SpeedLaw([0.0, 1.0, 9.0], [0.3, 0.2, 0.2]), None, None).round(3).tolist()
    [0.0, 1.0, 3.0, 9.0]
    """
    if isinstance(law, SpeedLaw):
        top = law.top_speed if top_speed is None else float(top_speed)
        if top > law.top_speed:
            raise InputError(
                f"top_speed = {top:g} m/s is outside this friction law (0 to {law.top_speed:g} m/s)"
            )
        corners = _corners(law)
    else:
        if top_speed is None:
            raise InputError("a friction law given as a function needs top_speed= in m/s")
        top = float(top_speed)
        corners = np.array(sorted(law.scales) if isinstance(law, FrictionLaw) else [])
    if not 0.0 < top < np.inf:
        raise InputError(f"top_speed must be finite and greater than 0 m/s, got {top:g}")
    if scale is not None:
        if not _LEAST_SCALE * top <= scale < np.inf:
            raise InputError(
                f"scale must be finite and at least {_LEAST_SCALE:g} of the top speed {top:g} m/s, "
                f"got {scale:g}"
            )
        corners = np.union1d(corners, [scale])
    breaks = [0.0]
    for corner in (*corners[corners < (1.0 - _SAME) * top], top):
        if corner <= breaks[-1] * (1.0 + _SAME):
            continue
        if breaks[-1] > 0.0:
            steps = int(np.ceil(np.log(corner / breaks[-1]) / np.log(_STEEPEST)))
            breaks += np.geomspace(breaks[-1], corner, steps + 1)[1:-1].tolist()
        breaks.append(float(corner))
    return np.array(breaks)


def _corners(law: SpeedLaw) -> FloatArray:
    """The inner points of a law, or the first and those where a derivative jumps the most."""
    speeds = np.asarray(law.speeds)
    inner = speeds[1:-1]
    if inner.size <= MOST_CORNERS:
        return np.asarray(inner)
    c, width = law.coefficients, np.diff(speeds)
    ends = (
        c[:, 1] + width * (2.0 * c[:, 2] + width * 3.0 * c[:, 3]),
        c[:, 2] + 3.0 * width * c[:, 3],
    )
    reach = 0.5 * (width[1:] + width[:-1])
    jump = np.abs(c[1:, 1] - ends[0][:-1]) * reach + np.abs(c[1:, 2] - ends[1][:-1]) * reach**2
    strongest = np.argsort(-jump)[: MOST_CORNERS - 1]
    return np.union1d(inner[:1], inner[strongest])
